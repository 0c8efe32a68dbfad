// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Divides a diverging beam into rays around its axis that share its energy.
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.h"

namespace greatx::render {

struct SubRay {
  vec2 offset{0.0f};  ///< tangents of the angles off the axis, to the left and up
  float weight = 1.0f;
};

inline constexpr uint32_t most_rings = 8;

/// Returns the rays of a Gaussian beam whose irradiance falls to 1/e^2 at half of `divergence` (rad, the full
/// angle) off its axis, w away from it.
///
/// The parts of the beam are the disc r < w/(2 n) and `rings` n rings around it: ring i goes from (i - 1/2)
/// w/n to (i + 1/2) w/n, and the last one goes out to infinity. A ring's weight is its share of the energy,
/// exp(-2 r1^2/w^2) - exp(-2 r2^2/w^2) (physics of a TEM00 mode). Its 6 i rays stand where r^2 has the ring's
/// mean. The first ring's rays stand a little further out, for the disc, whose ray is on the axis. Every
/// other ring is turned by half a step. The weights thus sum to one, and the footprint's second moment is the
/// beam's, w^2/2, whatever n. With 0 `rings` there is only the axis.
std::vector<SubRay> sub_rays(double divergence, uint32_t rings);

}  // namespace greatx::render
