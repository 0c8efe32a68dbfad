// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/tradeoff/calibration/ticks.h"

#include <algorithm>

namespace greatx::sim {

namespace {

constexpr int64_t block_length = 3, check_blocks = 4, remembered_ticks = 6;

}  // namespace

MeasurePlan calibration_ticks(const Scenario& scenario) { return plan_blocks(scenario, 2, block_length - 1); }

std::optional<MeasurePlan> check_ticks(const Scenario& scenario, bool remembers) {
  const int64_t stride = ticks_between_records(scenario), records = scenario.ticks / stride;
  MeasurePlan plan;
  plan.each_tick = true;
  plan.ticks = block_length - 1;
  if (remembers) {
    plan.warm_up = block_length;
    plan.ticks = std::min(records - block_length, remembered_ticks);
    return plan.ticks > 0 ? std::optional(plan) : std::nullopt;
  }
  const int64_t room = records - 2 * block_length;
  const int64_t blocks = std::min(room / block_length, check_blocks);
  if (blocks <= 0) return {};
  plan.starts.clear();
  for (int64_t b = 0; b < blocks; ++b)
    plan.starts.push_back(stride * (block_length + (2 * b + 1) * (room - block_length) / (2 * blocks)));
  return plan;
}

}  // namespace greatx::sim
