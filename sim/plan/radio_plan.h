// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "rf/atmosphere/weather.h"
#include "sim/scenario/scenario.h"

namespace greatx::sim {

/// The environment's weather, for rf/.
rf::Weather weather_of(const Environment& environment);

}  // namespace greatx::sim
