// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines stars and the moon's disc. The stars are drawn from a seed with the true numbers per magnitude.
// They are not the real constellations, and they stand still in the local frame.
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/light/lighting.h"
#include "shaders/shared/camera.h"

namespace greatx::render {

/// The illuminance of a star of visual magnitude 0, outside the air: C. W. Allen, "Astrophysical Quantities"
/// (1973), section 12: 2.54e-6 lux.
inline constexpr double magnitude_0_lux = 2.54e-6;

/// Returns the number of stars of the whole sphere brighter than a magnitude from -1 to 6: 2, 4, 15, 48, 171,
/// 513, 1602, 4800 at -1, 0, ... 6 (after Allen's Astrophysical Quantities, 4th ed. (2000), section 19.6, and
/// the Bright Star Catalogue). Between them the logarithm is linear.
double stars_brighter_than(double magnitude);

struct Star {
  dvec3 direction;   ///< unit
  double magnitude;  ///< outside the air
  double warmth;     ///< 0 bluish white to 1 orange
};
/// Returns one entry a cell of shared::star_cells^2 octahedral cells. The magnitude is +inf where there is no
/// star.
std::vector<Star> draw_stars(uint64_t seed);

/// Returns the stars that the shader reads. Stars below the horizon are left out. Those above it are weakened
/// by the air (0.19 magnitudes a vertical air mass, clear) and by the haze's depth.
std::vector<shared::GpuStar> gpu_stars(const std::vector<Star>& stars, double haze_depth);

/// Fills in the moon's part. `lux_on_facing` is its light that arrives, per channel.
void describe_moon(shared::GpuLighting& block, const Lighting& lighting, const dvec3& lux_on_facing);

}  // namespace greatx::render
