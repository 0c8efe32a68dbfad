// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Only the effects that the scene calls for: what the scene offers, what the scenario asks, and what can matter within
// the tolerance decide each effect before anything is built. What is off is not compiled, not recorded and not run.
#pragma once

#include <string>
#include <vector>

#include "scene/description/scene.h"
#include "sim/scenario/scenario.h"

namespace greatx::sim {

/// One decision.
struct Effect {
  std::string name;  ///< as written under `effects:` in a scenario
  bool switchable = true;
  bool on = false;
  std::string reason;  ///< why it is on or off, one line
  std::string bound;   ///< what leaving it off can change at most, or what keeping it on costs; may be empty
  explicit operator bool() const { return on; }
};

struct EffectPlan {
  // What tracing rays needs.
  Effect acceleration_structure, scene_motion;
  // Cameras: what they deliver, what shades pixels, what lens and sensor do.
  Effect camera, rgb, depth, ids, hdr, depth_ray, normals, flow, boxes, event_camera, adaptive_steps, sun,
      sky, static_shadows, moving_shadows, ambient_occlusion, textures, normal_maps, alpha_mask, emissive,
      punctual_lights, haze, night_sky, smooth_edges, lens_distortion, vignetting, motion_blur, auto_exposure,
      sensor_noise;
  // LiDAR.
  Effect lidar, lidar_alpha_mask, lidar_textures, lidar_sweep_motion, lidar_target_motion, lidar_divergence,
      lidar_glass, lidar_haze, lidar_backscatter, lidar_detection, lidar_range_noise;
  // Radar.
  Effect radar, radar_roughness, radar_clutter, radar_noise, radar_phase_noise, radar_quantisation;
  // Radio.
  Effect channel, line_of_sight, reflection, moving_reflectors, transmission, diffraction,
      diffraction_lit_region, free_edges, scattering, roughness, gas, rain, fog, foliage, dispersion, doppler,
      every_element;
  // The check that the modalities see one world.
  Effect consistency;

  /// Every effect, in the order above.
  std::vector<const Effect*> all() const;
  std::vector<Effect*> all();
};

/// Decides every effect. Bodies other than 0 count as moving. `points`: a box, world coordinates, around receivers that
/// the scenario does not have (`--receivers`, the cells of a map, Python); empty: none. Throws UserError for a name under
/// `effects:` that is none, or one that cannot be switched.
EffectPlan make_effect_plan(const Scenario& scenario, const scene::Scene& scene,
                            const scene::Bounds& points = {});

/// Whether both have the same effects on, whatever their bounds.
bool same_effects(const EffectPlan& a, const EffectPlan& b);

}  // namespace greatx::sim
