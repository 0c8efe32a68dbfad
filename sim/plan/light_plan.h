// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// From the environment as written to the light that falls on the scene: where sun and moon are, how bright
// they and the sky are, what fog and rain leave of it (docs/light.md).
#pragma once

#include <algorithm>

#include "renderer/daylight/haze.h"
#include "renderer/light/lighting.h"
#include "sim/scenario/optics.h"

namespace greatx::sim {

struct ResolvedLight {
  render::Lighting lighting;  ///< all that SceneLighting takes; local axes are the world's
  render::KeyLight key;       ///< what casts shadows, above fog and rain; Body::none: nothing does
  render::LayerLight
      below;  ///< what fog and rain leave of the key light (facing it) and of the sky, on the ground
  double sun_elevation = 0.0,
         moon_elevation = 0.0;  ///< rad, with refraction; the moon's -pi/2 if there is none
  bool haze = false;            ///< fog or rain is there
  bool night_sky =
      false;  ///< stars or the moon's disc can be seen: no clouds, the sun 6 degrees down or the moon up

  /// On level ground, all together.
  double ground_lux() const { return below.direct_lux * std::max(0.0, key.direction.z) + below.sky_lux; }
};

/// Illuminances that the scenario leaves open follow from the positions: with a place and a time, or when the
/// sun is below the horizon, or under clouds, by the models of renderer/daylight/twilight.h; with a sun by
/// hand above the horizon they are 100 000 lux (sun) and 15 000 lux (sky) whatever its height.
ResolvedLight resolve(const Environment& environment);

/// Of fog and rain, 1/m, one way: for cameras and LiDAR alike.
double haze_extinction(const Environment& environment);

}  // namespace greatx::sim
