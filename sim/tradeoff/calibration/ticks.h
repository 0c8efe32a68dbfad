// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The ticks of a calibration, and those that check it. Inside of sim/tradeoff/calibration.
#pragma once

#include <optional>

#include "sim/tradeoff/measure.h"

namespace greatx::sim {

/// Two blocks of two ticks after one tick of warm-up: at the begin and at the end of the scenario.
MeasurePlan calibration_ticks(const Scenario& scenario);

/// Up to four blocks of two ticks after one tick of warm-up, between the blocks of the calibration; none if
/// no tick is left there. If a sensor of the scenario remembers, it is one block after the calibration's.
std::optional<MeasurePlan> check_ticks(const Scenario& scenario, bool remembers);

}  // namespace greatx::sim
