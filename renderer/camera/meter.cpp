// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/camera/meter.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "renderer/camera/camera.h"

namespace greatx::render {

double metered_ev100(double luminance_cd_m2) { return std::log2(luminance_cd_m2 * (100.0 / 12.5)); }

double anchor_luminance(double ground_illuminance_lux) {
  constexpr double grey = 0.18, least_lux = 1.0;
  return saturation_luminance(metered_ev100(grey / pi * std::max(ground_illuminance_lux, least_lux)));
}

}  // namespace greatx::render
