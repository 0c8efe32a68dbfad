// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the light that falls on the scene from the environment of a scenario: positions and brightness of
// sun and moon, the brightness of the sky, and the attenuation by fog and rain (docs/light.md).
#pragma once

#include <algorithm>

#include "renderer/daylight/haze.h"
#include "renderer/light/lighting.h"
#include "sim/plan/indoors.h"
#include "sim/scenario/optics.h"

namespace greatx::sim {

/// Describes the light of an environment.
struct ResolvedLight {
  render::Lighting lighting;  ///< the input of SceneLighting; local axes are those of the world
  /// The source that casts shadows, above fog and rain; Body::none: there is none.
  render::KeyLight key;
  /// The light on the ground below fog and rain: the key light on a surface that faces it, and the light of
  /// the sky.
  render::LayerLight below;
  /// rad, with refraction. The moon's elevation is -pi/2 if there is no moon.
  double sun_elevation = 0.0, moon_elevation = 0.0;
  bool haze = false;                               ///< there is fog or rain
  bool rain = false, water = false, snow = false;  ///< drops fall; surfaces are wet; snow lies
  /// Stars or the disc of the moon can be seen: there are no clouds, and the sun is more than 6 degrees below
  /// the horizon or the moon is up.
  bool night_sky = false;

  /// Returns the total illuminance of level ground.
  double ground_lux() const { return below.direct_lux * std::max(0.0, key.direction.z) + below.sky_lux; }
};

/// Resolves the light of an environment. Illuminances that the scenario does not give follow from the
/// positions of sun and moon by the models of renderer/daylight/twilight.h if there is a place and a time, if
/// the sun is below the horizon, or if the sky is overcast. With a given sun above the horizon and a clear
/// sky they are 100 000 lux (sun) and 15 000 lux (sky), whatever the sun's elevation. In a closed room there
/// is only the light of its lamps that walls and things have reflected, from everywhere.
ResolvedLight resolve(const Environment& environment, const std::optional<Indoors>& indoors = {});

/// Returns how wet surfaces under the sky are, from 0 to 1: as given, or 1 - exp(-R) in rain of R mm/h, since
/// a millimetre wets a road through.
double wetness_of(const Environment& environment);

/// Returns the share of level ground that lies under water: as given, or a fifth of the square of the
/// wetness.
double puddles_of(const Environment& environment);

/// Returns the extinction coefficient of fog and rain, 1/m, for one way. Cameras and LiDARs use the same
/// value.
double haze_extinction(const Environment& environment);

}  // namespace greatx::sim
