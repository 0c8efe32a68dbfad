// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/rig_bench.h"

#include <algorithm>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "apps/bench/measure.h"
#include "io/dataset/dataset_writer.h"
#include "sim/dataset/dataset_info.h"
#include "sim/run/simulator.h"
#include "sim/scenario/parse/load_scenario.h"
#include "sim/scenario/sensor_kinds.h"

namespace greatx::apps {

namespace {

/// Measures one row: a scenario that runs block by block.
class Row {
 public:
  /// `folder`: folder of the data set; empty: nothing is written.
  Row(gpu::Device& device, std::string name, sim::Experiment experiment, const std::filesystem::path& folder)
      : name_(std::move(name)), experiment_(std::move(experiment)), simulator_(device, experiment_) {
    if (!folder.empty()) {
      writer_ = std::make_unique<io::DatasetWriter>(
          folder, sim::dataset_info(experiment_, device, simulator_.sensors()));
      writer_->begin_sequence(0);
    }
    simulator_.start(0);
  }

  /// Runs the remaining ticks before `end` and waits until their files are written.
  void run(int64_t end, bool counts) {
    const int64_t ticks = end - begin_;
    const double cpu_before = cpu_milliseconds();
    const Clock::time_point begin = Clock::now();
    RecordSink& sink = writer_ ? static_cast<RecordSink&>(*writer_) : discard_;
    while (simulator_.next_tick() < end && simulator_.step(sink)) continue;
    simulator_.drain(sink);
    if (writer_) writer_->flush();
    begin_ = end;
    if (!counts) return;
    wall_.push_back(milliseconds_since(begin) / double(ticks));
    cpu_.push_back((cpu_milliseconds() - cpu_before) / double(ticks));
  }

  /// The row has more than the first one, and not less.
  void adds() { adds_ = true; }

  nlohmann::json result(const Row& whole) const {
    nlohmann::json row{{"name", name_}, {"wall_ms", distribution(wall_)}, {"cpu_ms", distribution(cpu_)}};
    if (this == &whole) return row;
    const double sign = adds_ ? -1.0 : 1.0;
    row["cost_wall_ms"] = sign * median_difference(whole.wall_, wall_);
    row["cost_cpu_ms"] = sign * median_difference(whole.cpu_, cpu_);
    return row;
  }

 private:
  static double median_difference(const std::vector<double>& more, const std::vector<double>& less) {
    std::vector<double> differences;
    for (size_t i = 0; i < more.size(); ++i) differences.push_back(more[i] - less[i]);
    return distribution(std::move(differences))["median"];
  }

  std::string name_;
  sim::Experiment experiment_;
  sim::Simulator simulator_;
  std::unique_ptr<io::DatasetWriter> writer_;
  Discard discard_;
  int64_t begin_ = 0;
  bool adds_ = false;
  std::vector<double> wall_, cpu_;
};

/// Returns nodes of so many cars. They stand in rows of ten, 12 m apart, around the origin, and each drives
/// along a curve of its own, so that its shadow changes at every tick.
std::vector<sim::NodeConfig> moving_cars(uint32_t count, const sim::Scenario& scenario) {
  const double seconds = double(scenario.ticks) / scenario.tick_rate_hz.value();
  std::string text = "greatx: 1\nname: cars\nticks: 1\ntick_rate_hz: 1\nnodes:\n";
  for (uint32_t i = 0; i < count; ++i) {
    const double x = 12.0 * (i / 10) - 60.0, y = 12.0 * (i % 10) - 54.0, aside = i % 2 == 0 ? 2.0 : -2.0;
    text += fmt::format(
        "  - name: bench_car_{}\n    model: {{generate: {{kind: car}}}}\n    class: vehicle\n"
        "    trajectory: {{type: waypoints, interpolation: smooth, points: [{{t_s: 0, position_m: [{}, {}, "
        "0]}},"
        " {{t_s: {}, position_m: [{}, {}, 0]}}, {{t_s: {}, position_m: [{}, {}, 0]}}]}}\n",
        i, x, y, 0.5 * seconds, x + 8.0, y + aside, seconds, x + 16.0, y - aside);
  }
  return sim::parse_scenario(text, "bench --bodies", ".").nodes;
}

class Bench {
 public:
  Bench(const ScenarioOptions& options, const RunOptions& run, const RigBenchOptions& bench)
      : options_(bench),
        scenario_(load_scenario(options)),
        world_(std::make_shared<const sim::World>(sim::load_world(scenario_))),
        device_(run.device_options()) {
    const int64_t least = options_.warm_up + options_.block;
    if (scenario_.ticks < least)
      throw_user_error(
          "{}: bench --rig: expected {} ticks at least, {} to warm up and {} of a block, found {}",
          scenario_.name, least, options_.warm_up, options_.block, scenario_.ticks);
    options_.rounds = static_cast<uint32_t>(
        std::min<int64_t>(options_.rounds, (scenario_.ticks - options_.warm_up) / options_.block));
  }

  void add_rows() {
    if (!options_.bodies.empty()) return add_bodies();
    add("all, written", scenario_, true);
    add("nothing written", scenario_, false);
    for (size_t n = 0; n < scenario_.nodes.size(); ++n)
      for (size_t s = 0; s < scenario_.nodes[n].sensors.size(); ++s) {
        const sim::SensorConfig& sensor = scenario_.nodes[n].sensors[s];
        // A sensor that does not fire costs nothing by itself, and radars may use it.
        if (!sim::sensor_kind(sensor).fires) continue;
        sim::Scenario without = scenario_;
        without.nodes[n].sensors.erase(without.nodes[n].sensors.begin() + static_cast<std::ptrdiff_t>(s));
        // Event cameras that shared the pixels of this camera now render their own.
        for (sim::SensorConfig& other : without.nodes[n].sensors)
          if (auto* events = std::get_if<sim::EventCameraConfig>(&other.config))
            if (events->camera == sensor.name) events->camera.clear();
        add(fmt::format("without {} {}/{}", sim::sensor_kind(sensor).words, scenario_.nodes[n].name,
                        sensor.name),
            std::move(without), true);
      }
    for (size_t c = 0; c < scenario_.channels.size(); ++c) {
      sim::Scenario without = scenario_;
      without.channels.erase(without.channels.begin() + static_cast<std::ptrdiff_t>(c));
      add(fmt::format("without channel {}", scenario_.channels[c].name), std::move(without), true);
    }
    if (rows_.size() == 2)
      throw_user_error("{}: bench --rig: expected a sensor or a channel, found none", scenario_.name);
  }

  nlohmann::json measure() {
    for (const auto& row : rows_) row->run(options_.warm_up, false);
    for (uint32_t round = 0; round < options_.rounds; ++round) {
      const int64_t end = options_.warm_up + (round + 1) * options_.block;
      for (size_t i = 0; i < rows_.size(); ++i)
        rows_[round % 2 == 0 ? i : rows_.size() - 1 - i]->run(end, true);
    }
    nlohmann::json result{{"scenario", scenario_.name},      {"device", device_.info().name},
                          {"driver", device_.info().driver}, {"cores", std::thread::hardware_concurrency()},
                          {"block", options_.block},         {"rounds", options_.rounds},
                          {"rows", nlohmann::json::array()}};
    for (const auto& row : rows_) result["rows"].push_back(row->result(*rows_.front()));
    check_validation(device_);
    return result;
  }

 private:
  void add(std::string name, sim::Scenario scenario, bool written,
           std::shared_ptr<const sim::World> world = nullptr) {
    const std::filesystem::path folder =
        written ? scratch_.path() / std::to_string(rows_.size()) : std::filesystem::path();
    rows_.push_back(std::make_unique<Row>(
        device_, std::move(name), sim::make_experiment(std::move(scenario), world ? world : world_), folder));
  }

  void add_bodies() {
    for (const uint32_t count : options_.bodies) {
      sim::Scenario with = scenario_;
      for (sim::NodeConfig& car : moving_cars(count, scenario_)) with.nodes.push_back(std::move(car));
      auto world = std::make_shared<const sim::World>(sim::load_world(with));
      add(fmt::format("{} moving cars more", count), std::move(with), true, std::move(world));
      if (rows_.size() > 1) rows_.back()->adds();
    }
  }

  RigBenchOptions options_;
  sim::Scenario scenario_;
  std::shared_ptr<const sim::World> world_;  ///< the same world for all rows
  gpu::Device device_;
  ScratchFolder scratch_;
  std::vector<std::unique_ptr<Row>> rows_;
};

}  // namespace

nlohmann::json rig_bench(const ScenarioOptions& scenario, const RunOptions& run,
                         const RigBenchOptions& options) {
  Bench bench(scenario, run, options);
  bench.add_rows();
  return bench.measure();
}

std::string rig_bench_text(const nlohmann::json& result) {
  std::string text = fmt::format(
      "{} on {} ({}), {} cores, {} rounds of {} ticks, ms of a tick\n{:<40} {:>9} {:>9} {:>9} {:>11} "
      "{:>11}\n",
      result["scenario"].get<std::string>(), result["device"].get<std::string>(),
      result["driver"].get<std::string>(), result["cores"].get<uint32_t>(), result["rounds"].get<uint32_t>(),
      result["block"].get<int64_t>(), "", "min", "median", "cpu", "it costs", "of cpu");
  for (const nlohmann::json& row : result["rows"]) {
    const auto cost = [&](const char* key) {
      return row.contains(key) ? fmt::format("{:.2f}", row[key].get<double>()) : std::string();
    };
    text += fmt::format("{:<40} {:9.2f} {:9.2f} {:9.2f} {:>11} {:>11}\n", row["name"].get<std::string>(),
                        row["wall_ms"]["min"].get<double>(), row["wall_ms"]["median"].get<double>(),
                        row["cpu_ms"]["median"].get<double>(), cost("cost_wall_ms"), cost("cost_cpu_ms"));
  }
  return text;
}

}  // namespace greatx::apps
