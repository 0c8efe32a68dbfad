// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// LiDAR: what renderer/lidar.cpp and shaders/lidar/ agree on.
#ifndef GREATX_SHADERS_SHARED_LIDAR_H
#define GREATX_SHADERS_SHARED_LIDAR_H
#include "scene.h"

GREATX_SHARED_BEGIN

const uint lidar_angles_binding =
    first_pass_binding;  // vec2[channels + steps]: cos, sin of each elevation, then azimuth
const uint lidar_poses_binding =
    first_pass_binding + 1u;  // GpuBody[1 or steps]: local_from_sensor at the shot's time
const uint lidar_returns_binding =
    first_pass_binding + 2u;  // LidarReturn[steps * channels], azimuth step major

// A workgroup is a patch of neighbouring beams, so that the lanes that run together walk through the same boxes
// (docs/lidar.md has the measurements).
const uint lidar_patch_azimuths = 8u;
const uint lidar_patch_channels = 4u;

// Specialization constants.
const uint lidar_exclude_body_id = 0u;          // there is an own body that the beams pass through
const uint lidar_alpha_mask_id = 1u;            // sweep_textured: masks let beams through
const uint lidar_textured_reflectance_id = 2u;  // sweep_textured: base-colour textures vary the reflectance
const uint lidar_base_color_arrays_id = 3u;     // sweep_textured: lib/textures.glsl

const uint lidar_no_object = 0u;

struct LidarConstants {
  uint channels;
  uint azimuth_steps;
  uint pose_count;  // 1 or azimuth_steps
  uint excluded_body;
  float min_range;     // m
  float max_range;     // m
  uint wavelength_nm;  // 905 or 1550
};

struct LidarReturn {
  float range;      // m along the beam; +inf: nothing within reach
  float intensity;  // reflectance times cosine of the angle of incidence
  uint instance;    // index + 1; 0: none
  uint material;    // index + 1; 0: none
};

GREATX_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(greatx::shared::LidarConstants) == 28);
static_assert(sizeof(greatx::shared::LidarReturn) == 16);
#endif
#endif
