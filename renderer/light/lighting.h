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
#include "renderer/light/lamp_shadow.h"
#include "renderer/light/rain_cover.h"
#include "renderer/light/shadow.h"
#include "renderer/surface/mark_map.h"
#include "renderer/surface/surface_tables.h"
#include "scene/device/gpu_scene.h"

namespace greatx::render {

enum class SkyModel {
  clear,     ///< renderer/light/sky.h: day, twilight and night
  overcast,  ///< clouds from horizon to horizon, three times as bright at the zenith as at the horizon
  uniform,   ///< the same white radiance from everywhere, ground included: a closed form for tests, a furnace
};

/// Names the land that pictures show beyond the scene (renderer/light/horizon.h).
enum class HorizonKind : uint32_t { none, plain, city, country, automatic };

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
  double clouds = 0.0;                 ///< share of the sky's area under clouds, of a clear sky
  uint64_t cloud_seed = 1;
  HorizonKind horizon = HorizonKind::automatic;  ///< the land beyond the scene
  double rain_mm_h = 0.0;  ///< of the drops that streaks show; its extinction is in the haze
  double wetness = 0.0;    ///< of surfaces under the sky: 0 dry, 1 soaked
  double puddles = 0.0;    ///< share of level ground under water
  double snow = 0.0;       ///< share of what faces upwards that snow covers
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
  bool sun = true;               ///< the key light: sun or moon
  bool sky = true;               ///< the sky as background, ambient light and reflection
  bool static_shadows = true;    ///< only with the key light
  bool moving_shadows = true;    ///< only with the key light
  bool shadow_cascades = false;  ///< renderer/light/near_shadow.h; only with static_shadows
  bool textures = true;
  bool normal_maps = true;
  bool alpha_mask = true;
  bool emissive = true;
  bool switched_lamps = true;  ///< lamps that switch (scene/description/lamps.h) glow as their factors say
  bool punctual_lights = true;
  bool haze = false;          ///< fog and rain
  bool night_sky = false;     ///< stars, the moon's disc
  bool clouds = false;        ///< renderer/light/clouds.h
  bool horizon = false;       ///< the land beyond the scene, renderer/light/horizon.h
  bool markings = false;      ///< far markings by their share of a pixel, renderer/surface/mark_map.h
  bool thin_lines = false;    ///< renderer/camera/thin_lines.h
  bool wet_surfaces = false;  ///< renderer/light/weather.h
  bool snow_cover = false;
  bool rain_streaks = false;       ///< renderer/camera/streaks.h; darkens haze by what the streaks take
  bool lamp_shadows = false;       ///< renderer/light/lamp_shadow.h
  bool beam_shadows = true;        ///< renderer/light/beam_shadow.h; only with lamp_shadows
  bool lamp_halos = false;         ///< only with haze and lamps
  bool ambient_occlusion = false;  ///< occlusion of sky light by static bodies
  bool contact_occlusion = false;  ///< occlusion of sky light by moving bodies
  bool bounced_light = false;      ///< light that the static world reflects once; with ambient_occlusion
  bool glass = false;              ///< smooth surfaces mirror the static world
  bool panes = false;              ///< glass lets light through, renderer/camera/panes.h
  bool specular = true;            ///< off: every surface is Lambertian
};

/// Describes the drops that are drawn one by one (shaders/shared/weather.h).
struct FallingDrops {
  double per_m3 = 0.0;            ///< drops that are no thinner than least_drop_mm
  double slope_per_mm = 1.0;      ///< of the logarithm of their number over their diameter
  double reach_m = 0.0;           ///< they are drawn up to this planar depth
  double extinction_per_m = 0.0;  ///< the area of their discs in a unit of volume
  dvec3 radiance{0.0};            ///< cd/m^2
};
/// Returns the drops of rain after J. S. Marshall and W. Mc K. Palmer (1948), without their radiance. A unit
/// solid angle holds 4000 of them at most.
FallingDrops falling_drops(double rain_mm_h);

class Sky;

class SceneLighting {
 public:
  /// Bakes the sky and renders the static shadow map (set-up submissions). `scene` outlives this. Throws
  /// UserError if a value of `lighting` is out of its range.
  SceneLighting(const scene::GpuScene& scene, const Lighting& lighting, const CameraEffects& effects);

  /// Records where the moving bodies' shadows are, once a tick, after the scene's update and before the
  /// cameras. The poses are those given to GpuScene::record_update.
  void record(gpu::TickSlot& slot, std::span<const Pose> body_poses);
  /// Records the moving bodies' shadows that may fall into a picture, as far as they have changed.
  void draw_shadows(gpu::TickSlot& slot, const MovingShadows::Outside& outside) const;
  /// Records the shadows of spots that move, for one picture: before its shading, after that of others.
  std::vector<BeamTile> draw_beams(gpu::TickSlot& slot, const BeamView& view) const;

  const CameraEffects& effects() const { return effects_; }
  /// The land that pictures show beyond the scene; none without the effect.
  HorizonKind horizon_kind() const { return horizon_kind_; }
  const scene::GpuScene& scene() const { return *scene_; }
  /// The poses of the tick that is being recorded; [0] is the identity.
  const std::vector<Pose>& body_poses() const { return body_poses_; }
  const ShadowMaps& shadows() const { return shadows_; }
  const LampShadows& lamp_shadows() const { return lamp_shadows_; }
  const FallingDrops& drops() const { return drops_; }
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
  void bake_land(const Lighting& lighting, const Sky& sky, const dvec3& sky_lux);
  void bake_panorama_of(const Sky& sky, double scale);

  /// Returns the mean illuminance of the scene's ground by the lamps that stand still, lux per channel.
  dvec3 lamps_on_ground() const;
  void bake_weather(const Lighting& lighting, const Sky& sky);

  const scene::GpuScene* scene_;
  CameraEffects effects_;             ///< the effects asked for, less those that this light cannot cast
  mutable ShadowMaps shadows_;        ///< its atlas is a cache: cameras fill in the tiles that they need
  mutable LampShadows lamp_shadows_;  ///< cameras draw the tiles of lamps that move
  RainCover rain_cover_;
  FallingDrops drops_;
  gpu::Buffer weather_;  ///< GpuWeather
  double ground_illuminance_lux_ = 0.0;
  gpu::Image environment_;
  gpu::Sampler environment_sampler_;
  gpu::Image sky_view_;  ///< renderer/light/sky_view.h; one texel without ambient_occlusion
  gpu::Sampler sky_view_sampler_;
  gpu::Buffer stars_;  ///< shared::GpuStar [star_cells^2]; one without night_sky
  gpu::Buffer block_;  ///< GpuLighting
  HorizonKind horizon_kind_ = HorizonKind::none;
  gpu::Buffer horizon_;                    ///< GpuHorizon
  gpu::Image panorama_;                    ///< renderer/light/panorama.h; one texel without clouds
  gpu::Buffer surroundings_;               ///< renderer/light/surroundings.h; one word without its effects
  std::vector<ContactBox> contact_boxes_;  ///< empty without contact_occlusion
  gpu::Slice contact_;                     ///< words of the boxes at this tick
  SurfaceTables surfaces_;
  MarkMap marks_;
  std::vector<Pose> body_poses_;
};

}  // namespace greatx::render
