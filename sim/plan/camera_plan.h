// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The cameras' part of the effect plan, and what every part of it looks at.
#pragma once

#include <string>

#include "scene/description/scene.h"
#include "sim/plan/effect_planner.h"

namespace greatx::sim {

/// What the scene has that some effect needs.
struct Offers {
  bool triangles = false, static_triangles = false, moving_triangles = false;
  bool textures = false, normal_maps = false, reflectance_textures = false, alpha_mask = false,
       emissive = false;
  double brightest_cd_m2 = 0.0;  ///< that a material emits
  size_t lights = 0;
  double lamp_illuminance_lux = 0.0;  ///< the most that a lamp throws on the ground, see lamp_illuminance
};

/// What the scenario asks for.
struct CameraAsks {
  size_t cameras = 0, event_cameras = 0, lidars = 0;
  size_t shared_pixels = 0;  ///< event cameras that share a camera's
  bool rgb = false, depth = false, ids = false, hdr = false;
  bool depth_ray = false, normals = false, flow = false, boxes = false;
  bool smooth_edges = false, distortion = false, vignetting = false, noise = false, motion_blur = false,
       automatic_exposure = false, adaptive_events = false;
  bool color() const { return rgb || hdr || event_cameras > 0; }
  bool sweep = false;
};

Offers offers_of(const scene::Scene& scene);
CameraAsks camera_asks_of(const Scenario& scenario);

/// "fog and rain leave N m of visibility"
std::string haze_reason(const Environment& environment);

void plan_camera(EffectPlan& plan, const Planner& planner, const Scenario& scenario, const Offers& offers,
                 const CameraAsks& asks);

}  // namespace greatx::sim
