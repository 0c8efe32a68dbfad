// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Describes the land beyond the scene, which pictures show as a background (docs/light.md). Nothing but the
// camera's radiance knows of it: depth stays infinite and ids stay 0 there.
#pragma once

#include <array>

#include "core/vec.h"
#include "renderer/light/lighting.h"
#include "scene/description/scene.h"
#include "shaders/shared/horizon.h"

namespace greatx::render {

class Sky;

/// Returns the land that suits a scene: `city` where buildings cover a twelfth of it, else `country` where
/// its ground is mostly green or brown, else `plain`; `none` for scenes smaller than 60 m, which are objects
/// and rooms.
HorizonKind horizon_of(const scene::Scene& scene);

/// Returns the height at which the land lies: that below which a tenth of the scene's border is.
double land_height(const scene::Scene& scene);

/// Returns the mean colour of what faces upwards in the static scene, below `height`, linear Rec. 709.
dvec3 ground_color(const scene::Scene& scene, double height);

/// Returns the extinction of clear air near the ground, 1/m: air itself, and aerosol of the given turbidity
/// with a scale height of 1.2 km.
double clear_air_extinction(double turbidity);

/// Returns the radiance of the sky over the horizon by azimuth, for LandLight. The air between the eye and
/// the land scatters the light of a wide part of the sky. Under clouds, each cloud would else stain all the
/// air below it, so their sky is smoothed with a Hann window of 60 degrees.
std::array<dvec3, shared::air_azimuths> air_light_of(const Sky& sky, bool clouds);

/// Holds the light that falls on the land, lux per channel.
struct LandLight {
  dvec3 key{0.0};           ///< on a surface that faces the key light
  dvec3 sky{0.0};           ///< on level ground, from the sky alone
  double key_height = 0.0;  ///< sine of the key light's elevation
  dvec3 lamps{0.0};         ///< on level ground, by the scene's own lamps, in the mean over the scene
  /// Radiances of shared::GpuHorizon::air_light.
  std::array<dvec3, shared::air_azimuths> air_light{};
};

/// Fills in the description that shaders read. `kind` is neither none nor automatic.
shared::GpuHorizon describe_horizon(const scene::Scene& scene, HorizonKind kind, const Lighting& lighting,
                                    const LandLight& light);

}  // namespace greatx::render
