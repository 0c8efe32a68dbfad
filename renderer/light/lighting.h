// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines sun, sky and shadows of a scene, which all its cameras share. They are made once, and only the
// shadows of moving bodies change.
#pragma once

#include <span>
#include <vector>

#include "core/vec.h"
#include "gpu/cmd.h"
#include "gpu/tick_ring.h"
#include "renderer/light/contact.h"
#include "renderer/light/shadow.h"
#include "renderer/surface/surface_tables.h"
#include "scene/device/gpu_scene.h"

namespace greatx::render {

enum class SkyModel {
  clear,     ///< renderer/light/sky.h: day, twilight and night
  overcast,  ///< clouds from horizon to horizon, three times as bright at the zenith as at the horizon
  uniform,   ///< the same white radiance from everywhere, ground included: a closed form for tests, a furnace
};

/// Describes the light that reaches the scene from outside. It is photometric, in lux. The sun's and the
/// sky's colours are scaled so that 0.2126 R + 0.7152 G + 0.0722 B of a horizontal plane's irradiance is
/// exactly sun sin(elevation) + sky.
struct Lighting {
  dvec3 sun_direction{0.0, 0.0, 1.0};  ///< unit, local axes (x east, y north, z up), to the sun
  /// On a surface facing the sun. There is no light while the sun is below the horizon.
  double sun_illuminance_lux = 100000.0;
  dvec3 moon_direction{0.0, 0.0, -1.0};
  double moon_illuminance_lux = 0.0;     ///< on a surface facing the moon
  double moon_phase_angle = 0.0;         ///< rad: 0 full, pi new; changes only the disc
  double sky_illuminance_lux = 15000.0;  ///< on level ground from the sky alone
  /// Luminance of city light at the zenith. It has the colour and gradient of a night sky.
  double sky_glow_cd_m2 = 0.0;
  SkyModel sky_model = SkyModel::clear;
  double turbidity = 2.0;  ///< haziness, 1.1 (purest air) to 10 (hazy); clear sky only
  /// Albedo of the ground below the horizon, beyond the scene; clear sky only.
  double ground_albedo = 0.15;
  double haze_extinction_per_m = 0.0;  ///< extinction of fog and rain, renderer/daylight/haze.h
  double haze_depth = 0.0;             ///< vertical optical depth of fog and rain between scene and sky
  uint64_t star_seed = 1;
  uint32_t static_shadow_texels = 4096;  ///< edge of the map over everything that never moves
  uint32_t moving_shadow_texels = 128;   ///< edge of a moving body's tile, at most

  /// Returns the direction to the sun at `azimuth` from x towards y and `elevation` above the horizon, rad.
  static dvec3 direction(double azimuth, double elevation);
};

/// Describes the one light that casts shadows: the sun while it is up, else the moon.
struct KeyLight {
  enum class Body { none, sun, moon };
  dvec3 direction{0.0, 0.0, 1.0};  ///< unit
  double lux = 0.0;                ///< on a surface that faces it, above fog and rain
  Body body = Body::none;
};
KeyLight key_light(const Lighting& lighting);

/// Holds the effects that the effect plan switches on; names that the plan has, too, are the same
/// (sim/plan/effect_list.h). An effect that is off is not in the pipelines, not rendered and not uploaded.
/// Textures, normal maps and alpha masks need GpuSceneOptions::textures.
struct CameraEffects {
  bool sun = true;             ///< the key light: sun or moon
  bool sky = true;             ///< the sky as background, ambient light and reflection
  bool static_shadows = true;  ///< only with the key light
  bool moving_shadows = true;  ///< only with the key light
  bool textures = true;
  bool normal_maps = true;
  bool alpha_mask = true;
  bool emissive = true;
  bool punctual_lights = true;
  bool haze = false;               ///< fog and rain
  bool night_sky = false;          ///< stars, the moon's disc
  bool ambient_occlusion = false;  ///< occlusion of sky light by static bodies
  bool contact_occlusion = false;  ///< occlusion of sky light by moving bodies
  bool bounced_light = false;      ///< light that the static world reflects once; with ambient_occlusion
  bool glass = false;              ///< smooth surfaces mirror the static world
  bool specular = true;            ///< off: every surface is Lambertian
};

class Sky;

class SceneLighting {
 public:
  /// Bakes the sky and renders the static shadow map (set-up submissions). `scene` outlives this. Throws
  /// UserError if a value of `lighting` is out of its range.
  SceneLighting(const scene::GpuScene& scene, const Lighting& lighting, const CameraEffects& effects);

  /// Records the moving bodies' shadows, once a tick, after the scene's update and before the cameras. The
  /// poses are those given to GpuScene::record_update.
  void record(gpu::TickSlot& slot, std::span<const Pose> body_poses);

  const CameraEffects& effects() const { return effects_; }
  const scene::GpuScene& scene() const { return *scene_; }
  /// The poses of the tick that is being recorded; [0] is the identity.
  const std::vector<Pose>& body_poses() const { return body_poses_; }
  const ShadowMaps& shadows() const { return shadows_; }
  /// The illuminance of level ground from sun and sky, less the part that an effect leaves out.
  double ground_illuminance_lux() const { return ground_illuminance_lux_; }
  const SurfaceTables& surfaces() const { return surfaces_; }
  /// The bindings and descriptors of the scene and its surfaces, which passes over pixels' triangles share.
  static std::vector<gpu::Binding> surface_bindings();
  std::vector<gpu::Descriptor> surface_descriptors() const;
  /// The bindings and descriptors that every camera's shading shares. The lamps are not among them, since
  /// each camera has its own.
  static std::vector<gpu::Binding> bindings();
  std::vector<gpu::Descriptor> descriptors() const;

 private:
  void bake(const Lighting& lighting, const Sky& sky);
  void bake_sky_view(shared::GpuLighting& block, const Sky& sky, const KeyLight& key);

  const scene::GpuScene* scene_;
  CameraEffects effects_;  ///< the effects asked for, less those that this light cannot cast
  ShadowMaps shadows_;
  double ground_illuminance_lux_ = 0.0;
  gpu::Image environment_;
  gpu::Sampler environment_sampler_;
  gpu::Image sky_view_;  ///< renderer/light/sky_view.h; one texel without ambient_occlusion
  gpu::Sampler sky_view_sampler_;
  gpu::Buffer surroundings_;               ///< renderer/light/surroundings.h; one word without its effects
  std::vector<ContactBox> contact_boxes_;  ///< empty without contact_occlusion
  gpu::Slice contact_;                     ///< words of the boxes at this tick
  gpu::Buffer stars_;                      ///< shared::GpuStar [star_cells^2]; one without night_sky
  gpu::Buffer block_;                      ///< GpuLighting
  SurfaceTables surfaces_;
  std::vector<Pose> body_poses_;
};

}  // namespace greatx::render
