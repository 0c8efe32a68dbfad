// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Radiance of sky and sun as functions of direction, and what is baked from them. Colours are linear Rec. 709.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "renderer/light/atmosphere.h"
#include "renderer/light/lighting.h"

namespace greatx::render {

/// 0.2126 R + 0.7152 G + 0.0722 B (ITU-R BT.709).
double luminance(const dvec3& color);

/// Angular radius of the sun's disc, rad.
inline constexpr double sun_radius = 0.004652;

class Sky {
 public:
  explicit Sky(const Lighting& lighting);
  /// cd/m^2 per channel from a unit direction, z up; without the sun's disc.
  dvec3 radiance(const dvec3& direction) const;
  /// lux per channel on a surface facing the sun; zero below the horizon.
  const dvec3& sun_illuminance() const { return sun_illuminance_; }
  double illuminance() const { return illuminance_; }

 private:
  dvec3 above(const dvec3& direction) const;  ///< not yet scaled

  SkyModel model_;
  double illuminance_;  ///< of the sky on level ground
  Atmosphere atmosphere_;
  dvec3 white_;  ///< what is shown as white
  double scale_ = 1.0;
  dvec3
      sun_direction_;  ///< raised to the horizon if below: what the sky looks like then is outside the model
  dvec3 sun_illuminance_{0.0};
  dvec3 ground_{0.0};  ///< radiance below the horizon
};

/// Irradiance over pi in real spherical harmonics to order 2, with the basis' constants multiplied in, in the order of
/// light.glsl; its luminance straight up is exactly the sky's illuminance over pi.
std::array<dvec3, 9> sky_irradiance(const Sky& sky);

/// Octahedral environment map, RGBA half floats, one vector a mip level. Texels hold radiance / scale.
struct EnvironmentMap {
  double scale = 1.0;
  std::vector<std::vector<uint16_t>> levels;
};
EnvironmentMap bake_environment(const Sky& sky, uint32_t size, uint32_t levels);

}  // namespace greatx::render
