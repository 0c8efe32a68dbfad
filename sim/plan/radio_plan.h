// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "rf/atmosphere/weather.h"
#include "sim/scenario/scenario.h"

namespace greatx::sim {

/// Returns the weather of the environment as rf/ describes it.
rf::Weather weather_of(const Environment& environment);

}  // namespace greatx::sim
