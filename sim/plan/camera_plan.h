// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Decides the effects of cameras. The other parts of the effect plan use the same summaries of scene and
// scenario.
#pragma once

#include <string>

#include "renderer/light/lighting.h"
#include "scene/description/scene.h"
#include "sim/plan/effect_planner.h"

namespace greatx::sim {

/// Summarizes the properties of the scene that effects depend on.
struct Offers {
  bool triangles = false, static_triangles = false, moving_triangles = false;
  bool textures = false, normal_maps = false, reflectance_textures = false, alpha_mask = false,
       emissive = false, switched_lamps = false;
  bool panes = false;            ///< a camera may see through a material
  bool markings = false;         ///< static lane markings
  bool thin_lines = false;       ///< static meshes that may hold poles, wires and rails
  bool smooth = false;           ///< a material may be smooth enough to mirror
  double width_m = 0.0;          ///< the diagonal of its bounds, seen from above
  double brightest_cd_m2 = 0.0;  ///< the highest luminance that a material emits
  size_t lights = 0;
  /// The highest illuminance that a single lamp gives the ground.
  double lamp_illuminance_lux = 0.0;
  render::HorizonKind horizon = render::HorizonKind::none;  ///< the land that suits the scene
};

/// Summarizes what the scenario asks of cameras, event cameras and LiDARs.
struct CameraAsks {
  size_t cameras = 0, event_cameras = 0, lidars = 0;
  size_t shared_pixels = 0;  ///< event cameras that share the pixels of a camera
  bool rgb = false, depth = false, ids = false, hdr = false;
  bool depth_ray = false, normals = false, flow = false, boxes = false;
  bool wide_lens = false, rolling_shutter = false, chromatic_aberration = false;
  bool smooth_edges = false, distortion = false, vignetting = false, noise = false, glare = false,
       drops = false, motion_blur = false, automatic_exposure = false, adaptive_events = false;
  bool color() const { return rgb || hdr || event_cameras > 0; }
  /// Whether the shots of some LiDAR are spread over time.
  bool sweep = false;
};

Offers offers_of(const scene::Scene& scene);
CameraAsks camera_asks_of(const Scenario& scenario);

/// Returns "fog and rain leave N m of visibility".
std::string haze_reason(const Environment& environment);

/// Decides the effects of cameras. Throws UserError if a lens is not invertible over its picture, or passes
/// no light somewhere in it.
void plan_camera(EffectPlan& plan, const Planner& planner, const Scenario& scenario, const Offers& offers,
                 const CameraAsks& asks);

}  // namespace greatx::sim
