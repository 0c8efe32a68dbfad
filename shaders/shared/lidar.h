// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// LiDAR. renderer/lidar/ and shaders/lidar/ share these definitions.
#ifndef GREATX_SHADERS_SHARED_LIDAR_H
#define GREATX_SHADERS_SHARED_LIDAR_H
#include "pane.h"
#include "scene.h"

GREATX_SHARED_BEGIN

#ifdef __cplusplus
using std::exp;
using std::sqrt;
#endif

const uint lidar_beams_binding = first_pass_binding;        // LidarBeam[shots]
const uint lidar_poses_binding = first_pass_binding + 1u;   // GpuBody[1 or instants]: local_from_sensor
const uint lidar_echoes_binding = first_pass_binding + 2u;  // LidarEcho[slots][shots][sub-rays]
// vec2[sub-rays]: offsets; only of beams that spread
const uint lidar_sub_rays_binding = first_pass_binding + 3u;
const uint lidar_panes_binding = first_pass_binding + 4u;    // LidarPane[materials]; only with glass
const uint lidar_targets_binding = first_pass_binding + 5u;  // LidarTarget[targets]; only with moving targets
const uint lidar_motions_binding = first_pass_binding + 6u;  // GpuBody[]: tick_from_shot

// A workgroup is a patch of neighbouring beams, so that the lanes that run together walk through the same
// boxes (docs/lidar.md has the measurements).
const uint lidar_patch_columns = 8u;
const uint lidar_patch_rows = 4u;

// Specialization constants.
const uint lidar_exclude_body_id = 0u;          // there is an own body, through which the beams pass
const uint lidar_divergence_id = 1u;            // sub-rays around each beam's axis
const uint lidar_glass_id = 2u;                 // panes let a part through
const uint lidar_target_motion_id = 3u;         // bodies stand where they are at the shot's time
const uint lidar_alpha_mask_id = 4u;            // sweep_textured: masks let beams through
const uint lidar_textured_reflectance_id = 5u;  // sweep_textured: base-colour textures vary the reflectance
const uint lidar_base_color_arrays_id = 6u;     // sweep_textured: lib/textures.glsl

const uint lidar_no_object = 0u;
// The LidarTarget::first_motion of a body that stays where it is at the tick.
const uint lidar_still = 0xffffffffu;
// The most panes that a ray may pass; the next one ends it. Clear glass transmits 0.92^32 = 7 % of the light
// on the way there and back.
const uint lidar_most_panes = 16u;
// The most echoes of a ray. They come from the first panes that return light, and from the surface that ends
// the ray.
const uint lidar_glass_slots = 5u;

struct LidarBeam {
  vec3 direction;  // unit, sensor frame
  uint instant;    // index into the poses, if there are several
};

struct LidarConstants {
  uint columns;
  uint rows;
  uint sub_rays;
  uint pose_count;  // 1 or the instants
  uint excluded_body;
  uint apart;  // 1: bodies are met one by one, and only those of the targets
  uint targets;
  uint wavelength_nm;      // 905 or 1550
  float min_range;         // m
  float max_range;         // m
  float refractive_index;  // refractive index of glass
  float half_divergence;   // rad, to 1/e^2; 0: no width
};

struct LidarEcho {
  float range;      // m along the beam
  float intensity;  // the returned part of all light that the ray carries (docs/lidar.md)
  float share;      // part of the ray's energy that goes no further than this surface
  uint instance;    // index + 1; 0: none, and none in the slots behind
  uint material;    // index + 1; 0: none
};

// Describes a material that lets light through.
struct LidarPane {
  float sheets;      // number of glass sheets one behind the other; 0: opaque
  float clearness;   // transmitted part of the light that is not reflected
  float scattering;  // diffuse reflectance: dirt, frosting
};

// Describes a body at the times of the shots.
struct LidarTarget {
  uint body;
  uint first_motion;  // index of its first motion, one motion an instant; lidar_still: none
  vec4 sphere;        // local coordinates: holds the body at every instant
};

/// Returns the light that a mirror gives back into a receiver beside the transmitter, as the intensity of a
/// diffuse surface that gives as much. A Gaussian beam of 1/e^2 half-angle `half_divergence` comes back from
/// a mirror image 2 R cos(theta) away and `theta` off its axis. Its irradiance there is 2 / (pi (2 R
/// cos(theta) half_divergence)^2) exp(-2 theta^2 / half_divergence^2). A diffuse surface gives rho / (pi
/// R^2).
GREATX_FUNCTION float glare_intensity(float sine, float cosine, float half_divergence) {
  float off = sine / half_divergence;  // the angle is a few milliradians wherever the result is not 0
  return exp(-2.0f * off * off) / (2.0f * half_divergence * half_divergence * cosine * cosine);
}

GREATX_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(greatx::shared::LidarBeam) == 16);
static_assert(sizeof(greatx::shared::LidarConstants) == 48);
static_assert(sizeof(greatx::shared::LidarEcho) == 20);
static_assert(sizeof(greatx::shared::LidarPane) == 12);
static_assert(sizeof(greatx::shared::LidarTarget) == 24);
#endif
#endif
