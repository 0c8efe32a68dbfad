// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/tradeoff/calibration/ticks.h"

#include <algorithm>

namespace greatx::sim {

namespace {

constexpr int64_t block_length = 3, remembered_ticks = 6;
/// Four blocks leave room for others between them from so many records on.
constexpr int64_t long_records = 7 * block_length;

int64_t records_of(const Scenario& scenario) { return scenario.ticks / ticks_between_records(scenario); }

}  // namespace

MeasurePlan calibration_ticks(const Scenario& scenario, Effort effort) {
  if (effort == Effort::slow) {
    MeasurePlan plan = plan_blocks(scenario, 2, 1);
    plan.warm_up = 0;
    return plan;
  }
  const bool four = effort == Effort::joint && records_of(scenario) >= long_records;
  return plan_blocks(scenario, four ? 4 : 2, block_length - 1);
}

std::optional<MeasurePlan> check_ticks(const Scenario& scenario, Effort effort, bool remembers) {
  MeasurePlan plan;
  plan.each_tick = true;
  plan.ticks = block_length - 1;
  if (remembers) {
    plan.warm_up = block_length;
    plan.ticks = std::min(records_of(scenario) - block_length, remembered_ticks);
    return plan.ticks > 0 ? std::optional(plan) : std::nullopt;
  }
  const int64_t stride = ticks_between_records(scenario);
  const MeasurePlan chosen = calibration_ticks(scenario, Effort::joint);
  const int64_t most = effort == Effort::slow || chosen.starts.size() > 2 ? 2 : 4;  // of blocks in a gap
  plan.starts.clear();
  for (size_t i = 0; i + 1 < chosen.starts.size(); ++i) {
    const int64_t begin = chosen.starts[i] / stride + block_length;
    const int64_t gap = chosen.starts[i + 1] / stride - begin, blocks = std::min(most, gap / block_length);
    for (int64_t b = 0; b < blocks; ++b)
      plan.starts.push_back(stride * (begin + b * gap / blocks + (gap / blocks - block_length) / 2));
  }
  if (plan.starts.empty()) return std::nullopt;
  if (effort == Effort::slow) {
    plan.starts = {plan.starts.front(), plan.starts.back()};
    plan.starts.resize(plan.starts.front() == plan.starts.back() ? 1 : 2);
    plan.warm_up = 0;
    plan.ticks = 1;
  }
  return plan;
}

}  // namespace greatx::sim
