// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/times/time_history.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace greatx::view {

namespace {

constexpr const char* shared_name = "scene, light, checks";

double median_of(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

bool is_wait(const sim::TimeRow& row) { return !row.on_device && row.name.starts_with("wait"); }

/// Returns what a row does: of a pass, its name without that of its sensor.
std::string step_name(const sim::TimeRow& row, const std::string& sensor) {
  if (row.on_device) {
    if (row.name == sensor) return "whole pass";
    return row.name.starts_with(sensor + " ") ? row.name.substr(sensor.size() + 1) : row.name;
  }
  if (row.name == "record") return "set-up";
  if (row.name == "collect") return "results";
  return row.name == "compare" ? "consistency check" : row.name;
}

}  // namespace

std::string milliseconds_text(double milliseconds) {
  const int digits = milliseconds >= 9.95 ? 0 : milliseconds >= 0.995 ? 1 : 2;
  return fmt::format("{:.{}f} ms", milliseconds, digits);
}

void TimeHistory::add(const ShownTick& tick, const std::vector<SensorSpec>& sensors) {
  if (names_.size() != sensors.size()) {
    names_.clear();
    for (const SensorSpec& sensor : sensors) names_.push_back(sensor.name);
    kept_.clear();
  }
  changed_ = true;
  const auto same = std::ranges::find_if(kept_, [&](const Kept& kept) {
    return kept.sequence == tick.sequence && kept.tick == tick.packet.tick && kept.times == tick.times;
  });
  present_ = static_cast<size_t>(same - kept_.begin());
  if (same != kept_.end()) return;
  kept_.push_back({tick.sequence, tick.packet.tick, tick.simulated_ms, tick.times});
  if (kept_.size() <= most_ticks) return;
  kept_.pop_front();
  present_ = kept_.size() - 1;
}

void TimeHistory::sum_up() {
  if (!std::exchange(changed_, false)) return;
  parts_.clear();
  part_sensors_.clear();
  lines_.clear();
  ticks_.clear();
  mean_work_ms_ = mean_wait_ms_ = mean_wall_ms_ = mean_real_ms_ = 0.0;
  std::vector<std::vector<double>> samples;  // [lines_]: ms of each tick in which it ran
  std::vector<double> walls;
  for (size_t i = 0; i < kept_.size(); ++i) {
    const Kept& kept = kept_[i];
    TimedTick& tick = ticks_.emplace_back();
    tick.sequence = kept.sequence;
    tick.tick = kept.tick;
    tick.start_ms = kept.times ? kept.times->start_ms : 0.0;
    tick.wall_ms = std::max(0.0, kept.wall_ms - tick.start_ms);
    tick.real_ms = kept.times ? kept.times->simulated_ms : 0.0;
    walls.push_back(tick.wall_ms);
    mean_wall_ms_ += tick.wall_ms;
    mean_real_ms_ += ticks_.back().real_ms;
    if (kept.times != nullptr) add_rows(i, samples);
  }
  const double count = std::max<double>(1.0, static_cast<double>(kept_.size()));
  for (TimedTick& tick : ticks_) tick.part_ms.resize(parts_.size());
  for (double* const sum : {&mean_work_ms_, &mean_wait_ms_, &mean_wall_ms_, &mean_real_ms_}) *sum /= count;
  for (TimePart& part : parts_) part.mean_ms /= count;
  for (size_t i = 0; i < lines_.size(); ++i) {
    lines_[i].mean_ms /= count;
    lines_[i].ticks = samples[i].size();
    lines_[i].median_ms = median_of(std::move(samples[i]));
  }
  median_wall_ms_ = median_of(std::move(walls));
  std::ranges::stable_sort(lines_, std::ranges::greater{}, &TimeLine::mean_ms);
}

/// Adds the rows of a tick to parts, lines and sums.
void TimeHistory::add_rows(size_t tick, std::vector<std::vector<double>>& samples) {
  const sim::TickTimes& times = *kept_[tick].times;
  device_is_a_cpu_ = times.device_is_a_cpu;
  for (const sim::TimeRow& row : times.rows) {
    if (is_wait(row)) {
      mean_wait_ms_ += row.milliseconds;
      continue;
    }
    const size_t l = line_of(row);
    TimeLine& line = lines_[l];
    TimePart& part = parts_[line.part];
    samples.resize(lines_.size());
    samples[l].push_back(row.milliseconds);
    std::vector<double>& part_ms = ticks_.back().part_ms;
    part_ms.resize(parts_.size());
    part_ms[line.part] += row.milliseconds;
    line.mean_ms += row.milliseconds;
    part.mean_ms += row.milliseconds;
    mean_work_ms_ += row.milliseconds;
    if (tick != present_) continue;
    line.now_ms += row.milliseconds;
    line.count += row.count;
    part.now_ms += row.milliseconds;
  }
}

size_t TimeHistory::part_of(uint32_t sensor) {
  const auto found = std::ranges::find(part_sensors_, sensor);
  if (found != part_sensors_.end()) return static_cast<size_t>(found - part_sensors_.begin());
  part_sensors_.push_back(sensor);
  parts_.push_back({sensor < names_.size() ? names_[sensor] : shared_name});
  return parts_.size() - 1;
}

size_t TimeHistory::line_of(const sim::TimeRow& row) {
  const size_t part = part_of(row.sensor);
  const std::string name = step_name(row, parts_[part].name);
  const auto found = std::ranges::find_if(lines_, [&](const TimeLine& line) {
    return line.part == part && line.on_device == row.on_device && line.name == name;
  });
  if (found != lines_.end()) return static_cast<size_t>(found - lines_.begin());
  TimeLine line;
  line.name = name;
  line.part = part;
  line.on_device = row.on_device;
  lines_.push_back(std::move(line));
  return lines_.size() - 1;
}

std::string TimeHistory::answer() const {
  if (ticks_.empty()) return "No tick has been shown yet.";
  if (lines_.empty())
    return "A data set does not say how long its ticks took. The bars show the time of reading.";
  const auto part = std::ranges::max_element(parts_, {}, &TimePart::mean_ms);
  const auto line = std::ranges::find(lines_, static_cast<size_t>(part - parts_.begin()), &TimeLine::part);
  std::string text = fmt::format(
      "{} takes {:.0f} % of the work of a tick ({} of {}). Its longest step is '{}' on the {}: {}.",
      part->name, 100.0 * part->mean_ms / std::max(mean_work_ms_, 1e-9), milliseconds_text(part->mean_ms),
      milliseconds_text(mean_work_ms_), line->name, line->on_device ? "device" : "host",
      milliseconds_text(line->mean_ms));
  if (mean_real_ms_ > 0.0 && mean_wall_ms_ > 0.0)
    text += fmt::format(" A tick takes {} for {} of simulated time, which is {:.2f} x real time.",
                        milliseconds_text(mean_wall_ms_), milliseconds_text(mean_real_ms_),
                        mean_real_ms_ / mean_wall_ms_);
  return text;
}

}  // namespace greatx::view
