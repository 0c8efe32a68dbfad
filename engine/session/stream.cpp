// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/session/stream.h"

#include <string_view>

#include <nlohmann/json.hpp>

#include "core/error.h"

namespace greatx::engine {

namespace {

constexpr std::string_view broken =
    "a run that was interrupted or ended with an error cannot go on; run() begins another";

}  // namespace

void check_instant(const sim::Scenario& scenario, uint32_t sequence, int64_t tick) {
  if (tick < 0 || tick >= scenario.ticks)
    throw_user_error("tick: expected 0 to {}, the last tick of {}, found {}", scenario.ticks - 1,
                     scenario.name, tick);
  if (sequence >= scenario.sequences)
    throw_user_error("sequence: expected 0 to {}, found {}", scenario.sequences - 1, sequence);
}

Stream::Stream(std::shared_ptr<const sim::Experiment> experiment, std::shared_ptr<Gpu> gpu, uint32_t sequence,
               int64_t first_tick)
    : experiment_(std::move(experiment)),
      gpu_(std::move(gpu)),
      simulator_(std::make_unique<sim::Simulator>(gpu_->device, *experiment_)) {
  simulator_->start(sequence, first_tick);
}

Stream::~Stream() {
  const std::lock_guard lock(gpu_->mutex);
  gpu_->device.wait_idle();
  simulator_.reset();
}

std::string Stream::sensors() const {
  nlohmann::ordered_json sensors = nlohmann::ordered_json::array();
  for (const SensorSpec& spec : simulator_->sensors()) {
    nlohmann::ordered_json arrays = nlohmann::ordered_json::array();
    for (const ArraySpec& array : spec.arrays)
      arrays.push_back({{"name", array.name}, {"unit", array.unit}, {"description", array.description}});
    sensors.push_back({{"name", spec.name},
                       {"kind", spec.kind},
                       {"rate_hz", spec.rate},
                       {"arrays", std::move(arrays)},
                       {"metadata", nlohmann::ordered_json::parse(
                                        spec.metadata_json.empty() ? "{}" : spec.metadata_json)}});
  }
  return sensors.dump();
}

std::optional<Packet> Stream::next() {
  const std::lock_guard lock(gpu_->mutex);
  if (broken_) throw_user_error("{}", broken);
  broken_ = true;
  while (queue_.packets.empty())
    if (!simulator_->step(queue_)) break;
  broken_ = false;
  gpu_->check_validation();
  if (queue_.packets.empty()) return std::nullopt;
  std::optional<Packet> packet = std::move(queue_.packets.front());
  queue_.packets.pop_front();
  return packet;
}

void Stream::restart(uint32_t sequence, int64_t first_tick) {
  check_instant(experiment_->scenario, sequence, first_tick);
  const std::lock_guard lock(gpu_->mutex);
  if (broken_) throw_user_error("{}", broken);
  broken_ = true;
  simulator_->drain(queue_);
  queue_.packets.clear();
  simulator_->start(sequence, first_tick);
  broken_ = false;
}

std::string Stream::summary() {
  const std::lock_guard lock(gpu_->mutex);
  const sim::RunStatistics statistics = simulator_->statistics();
  nlohmann::ordered_json json{{"ticks", statistics.ticks},
                              {"counters", nlohmann::ordered_json::object()},
                              {"notes", nlohmann::ordered_json::object()}};
  for (const auto& [name, count] : statistics.counters) json["counters"][name] = count;
  for (const auto& [name, text] : statistics.notes) json["notes"][name] = text;
  json["warnings"] = statistics.warnings;
  return json.dump();
}

}  // namespace greatx::engine
