// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The camera's shaders and renderer/light/horizon.h share this description of the land beyond the scene.
#ifndef GREATX_SHADERS_SHARED_HORIZON_H
#define GREATX_SHADERS_SHARED_HORIZON_H
#include "glsl.h"

GREATX_SHARED_BEGIN

/// The values of spec_horizon.
const uint horizon_none = 0u;
const uint horizon_plain = 1u;
const uint horizon_city = 2u;
const uint horizon_country = 3u;

/// The height over the land that nothing on it exceeds, m: houses of the city, woods of the country.
const float city_top = 32.0f;
const float country_top = 16.0f;
/// The edges of the squares of a house or a field, m.
const float city_lot = 40.0f;
const float country_lot = 60.0f;
/// Houses and woods end at this distance from the eye; then the profile of the horizon begins, m.
const float land_reach = 2200.0f;
const uint land_steps = 40u;  // squares that a ray looks at, at most
/// The azimuths, from x towards y, at which GpuHorizon::air_light is known.
const uint air_azimuths = 128u;

/// Describes the land. Radiances are cd/m^2 per channel.
struct GpuHorizon {
  vec3 sunlit;  ///< radiance of white level ground in the light of sun and sky
  float floor;  ///< height of the land, local z
  vec3 shaded;  ///< radiance of white level ground in the light of the sky alone
  float air;    ///< extinction of clear air, 1/m
  vec2 min;     ///< bounds of the scene in local x, y: nothing stands within
  vec2 max;
  vec3 key;     ///< radiance of a white surface that faces the key light, from that light alone
  float lit;    ///< radiance of a lit window
  vec3 albedo;  ///< of plain land; the mean of the scene's ground
  uint seed;
  vec3 lamps;  ///< radiance of white level ground in the light of street lamps
  float pad;
  /// The radiance that the air scatters into the view over a long way, which is that of the sky over the
  /// horizon: at azimuths (i + 0.5) 2 pi / air_azimuths.
  vec4 air_light[air_azimuths];
};

GREATX_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(greatx::shared::GpuHorizon) == 96 + 16 * greatx::shared::air_azimuths);
#endif
#endif
