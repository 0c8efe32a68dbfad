// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the shadows of lamps that stand still. Each has a square tile of one map: a perspective view along
// its axis (of a point light: downwards) with a half-angle of 75 degrees at most. Static casters are drawn
// once. Casters that move are drawn every tick into a copy. Below these tiles the map has room for those of
// lamps that move (renderer/light/beam_shadow.h), which pictures draw.
//
// No shadows come from passing beams that stand still, from directional lights, from lamps beyond the
// most_lamp_tiles that light the largest areas, and from casters beside a tile (more than 75 degrees from its
// axis) or nearer to the lamp than lamp_shadow_near. What lies beside a tile is lit.
#pragma once

#include <span>
#include <vector>

#include "core/vec.h"
#include "gpu/tick_ring.h"
#include "renderer/light/beam_shadow.h"
#include "renderer/light/casters.h"
#include "scene/device/gpu_scene.h"
#include "shaders/shared/camera.h"
#include "shaders/shared/weather.h"

namespace greatx::render {

/// The illuminance at which a lamp without a stated range ends, lux.
inline constexpr double lamp_least_lux = 1e-3;
/// Returns the reach of a lamp in metres: its range, or sqrt(I / lamp_least_lux) if it states none; +inf for
/// a directional one.
double lamp_reach(const scene::PunctualLight& light);

/// Returns the luminous flux of a lamp, lm per channel; 0 for a directional one. Between the cones of a spot
/// the intensity falls with the square of a ramp in the cosine (KHR_lights_punctual). Of a passing beam it is
/// that of its cone at the beam's mean intensity over the cone.
dvec3 lamp_flux(const scene::PunctualLight& light);

inline constexpr double lamp_tile_half_angle = 1.3089969;  ///< rad, 75 degrees
inline constexpr uint32_t lamp_map_texels = 3072, least_lamp_tile = 128, most_lamp_tile = 512;
inline constexpr uint32_t most_lamp_tiles =
    (lamp_map_texels / least_lamp_tile) * (lamp_map_texels / least_lamp_tile);

/// Holds the place of a lamp's tile.
struct LampTile {
  dvec3 across{
      0.0};  ///< unit times half of the tile's edge in uv over the tangent of its half-angle; 0: none
  dvec2 center{0.0};  ///< uv
};

struct LampShadowOptions {
  bool wanted = false, alpha_mask = false;
  bool beams = false;  ///< shadows of spots that move are wanted
};

class LampShadows {
 public:
  LampShadows() = default;
  /// Renders the static casters in a set-up submission.
  LampShadows(const scene::GpuScene& scene, const LampShadowOptions& options);

  /// Records the casters that move, at this tick's poses.
  void record(gpu::TickSlot& slot, std::span<const Pose> body_poses);
  /// Chooses the spots that move for a picture, and records their tiles. Pictures that are recorded before
  /// keep theirs.
  std::vector<BeamTile> record_beams(gpu::TickSlot& slot, std::span<const Pose> body_poses,
                                     const BeamView& view);
  bool any_beams() const { return beams_.any(); }
  /// Fills in the map's part of the block.
  void describe(shared::GpuWeather& block) const;
  gpu::Descriptor descriptor() const;
  /// The tiles by the scene's lights.
  const std::vector<LampTile>& tiles() const { return tiles_; }
  uint32_t tile_count() const { return static_cast<uint32_t>(lamps_.size()); }
  uint32_t tile_texels() const { return tile_texels_; }

 private:
  struct Lamp {
    uint32_t light = 0;
    dvec3 position{0.0}, axis{0.0}, across{0.0}, up{0.0};  ///< the last three are unit
    double reach = 0.0, tangent = 1.0;
    uint32_t x = 0, y = 0;  ///< texel where the tile begins
  };
  struct Square {
    uint32_t x = 0, y = 0, size = 0;
  };
  void place_lamps();
  /// Makes room for the tiles of spots that move.
  void place_beams();
  bool changes() const { return !moving_.bodies.empty() || beams_.any(); }
  void draw_static(bool alpha_mask);
  shared::CasterConstants view_of(const Lamp& lamp) const;
  /// Returns the square of texels that a sphere may cover; size 0: none.
  Square square_of(const Lamp& lamp, const dvec3& center, double radius) const;

  const scene::GpuScene* scene_ = nullptr;
  std::vector<Lamp> lamps_;
  std::vector<LampTile> tiles_;
  MovingCasters moving_;  ///< for lamps that stand and lamps that move
  BeamShadows beams_;
  uint32_t tile_texels_ = 0, map_texels_ = 1;
  uint32_t beam_top_ = 0;        ///< row where the tiles of spots that move begin
  gpu::Image static_map_, map_;  ///< the second only where casters or lamps move
  gpu::Sampler sampler_;
  std::vector<Square> changed_;  ///< squares of map_ that differ from static_map_
};

}  // namespace greatx::render
