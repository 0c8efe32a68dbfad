// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/lidar/scan/footprint.h"

#include <cmath>

#include "core/error.h"
#include "core/units.h"

namespace greatx::render {

std::vector<SubRay> sub_rays(double divergence, uint32_t rings) {
  GREATX_CHECK(rings <= most_rings, "{} rings", rings);
  GREATX_CHECK(rings == 0 || (divergence > 0.0 && divergence < 0.5), "divergence of {} rad", divergence);
  if (rings == 0) return {SubRay{}};
  // u = 2 r^2/w^2 is distributed as exp(-u), so a ring's energy and its mean of u have a closed form.
  const double step = 1.0 / rings;
  const auto u_of = [&](double radius) { return 2.0 * radius * radius; };
  const double center = u_of(0.5 * step);
  std::vector<SubRay> rays{{vec2(0.0f), static_cast<float>(1.0 - std::exp(-center))}};
  for (uint32_t ring = 1; ring <= rings; ++ring) {
    const double inner = u_of((ring - 0.5) * step), outer = u_of((ring + 0.5) * step);
    const bool last = ring == rings;
    const double energy = std::exp(-inner) - (last ? 0.0 : std::exp(-outer));
    const double moment = (inner + 1.0) * std::exp(-inner) - (last ? 0.0 : (outer + 1.0) * std::exp(-outer));
    // The disc's own moment is moved to the first ring, since the disc's ray stands on the axis.
    const double extra = ring == 1 ? 1.0 - (center + 1.0) * std::exp(-center) : 0.0;
    const double radius = 0.5 * divergence * std::sqrt(0.5 * (moment + extra) / energy);
    const uint32_t count = 6 * ring;
    for (uint32_t i = 0; i < count; ++i) {
      const double angle = 2.0 * pi * (i + 0.5 * (ring % 2)) / count;
      rays.push_back(
          {vec2(radius * std::cos(angle), radius * std::sin(angle)), static_cast<float>(energy / count)});
    }
  }
  return rays;
}

}  // namespace greatx::render
