// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The ticks of a calibration, and those that check it. Inside of sim/tradeoff/calibration.
#pragma once

#include <cstdint>
#include <optional>

#include "sim/tradeoff/measure.h"

namespace greatx::sim {

enum class Effort : uint8_t {
  slow,     ///< two ticks without any of warm-up: settings that take long
  singles,  ///< two blocks of two ticks, each after one of warm-up: effects and knobs by themselves
  joint     ///< four such blocks, or two in a short scenario: joint settings, which are chosen from
};
MeasurePlan calibration_ticks(const Scenario& scenario, Effort effort);

/// Blocks of two ticks after one of warm-up, between those of Effort::joint: up to six in all; with
/// Effort::slow up to two ticks without warm-up. None if no tick is left there. If a sensor of the scenario
/// remembers, it is one block after the calibration's.
std::optional<MeasurePlan> check_ticks(const Scenario& scenario, Effort effort, bool remembers);

}  // namespace greatx::sim
