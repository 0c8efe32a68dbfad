// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A coarse model of the static world for light that surfaces reflect: level cells, each a column with a top,
// mean colours, what its walls emit, and the height up to which it lies in the shadow of the key light. Two
// effects read it. `bounced_light` takes from it the light that reaches a place after one reflection; it is
// gathered once, over the cells, at two heights (light_gathering.h). `glass` looks into it along mirrored
// rays. surroundings_words.h writes what shaders read of both. docs/global_light.md has the errors.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "renderer/light/glow_average.h"
#include "renderer/light/sky_view.h"
#include "renderer/light/wall_glow.h"
#include "scene/description/scene.h"

namespace greatx::render {

/// What stands lower than this over the ground is part of it, m.
inline constexpr float low_thing_m = 1.0f;
/// What is higher than this over the ground is higher than a person, m.
inline constexpr float standing_m = 2.0f;
/// The share of the sky that a wall in a street sees beside its own half.
inline constexpr double wall_sky_share = 0.7;

/// One column of the static world. Heights are above HeightField::floor.
struct SurroundingCell {
  float top = 0.0f;     ///< of the highest surface
  float bottom = 0.0f;  ///< where what stands in the cell begins; it may hang in the air, as a crown does
  float ground = 0.0f;  ///< of the lowest level surface
  float shadow = 0.0f;  ///< what is lower lies in the shadow of the key light
  dvec3 top_albedo{0.0}, ground_albedo{0.0}, wall_albedo{0.0};
  dvec2 wall_normal{0.0};  ///< unit, outwards; zero if no wall stands here
  WallGlow glow;           ///< what the wall emits
  /// Whether something stands here that is higher than a person.
  bool stands() const { return top > ground + standing_m; }
};

/// The light that falls on the surroundings, per channel.
struct SurroundingLight {
  dvec3 key_direction{0.0, 0.0, 1.0};
  dvec3 key_lux{0.0};  ///< on a surface that faces the key light
  dvec3 sky_lux{0.0};  ///< on level ground under a free sky
  dvec3 beyond{0.0};   ///< radiance of the ground beyond the cells
};

/// What in the scene sends light of its own.
struct SurroundingSources {
  std::span<const scene::PunctualLight> lamps;  ///< those that stand light the ground, without shadows
  bool glow = false;                            ///< walls send the light that their materials emit
};

class Surroundings {
 public:
  /// Colours are means over materials and their textures.
  Surroundings(const scene::Scene& scene, const HeightField& field, const SurroundingLight& light,
               const SurroundingSources& sources);

  const HeightField& field() const { return *field_; }
  const SurroundingCell& cell(uint32_t column, uint32_t row) const {
    return cells_[size_t{row} * field_->width + column];
  }
  const std::vector<SurroundingCell>& cells() const { return cells_; }
  const SurroundingLight& light() const { return light_; }
  float most_top() const { return most_top_; }  ///< the highest top
  /// Returns the radiance of the highest surface of a cell.
  const dvec3& top_radiance(size_t index) const { return top_radiance_[index]; }
  const dvec3& ground_radiance(size_t index) const { return ground_radiance_[index]; }
  /// Returns the radiance that the wall in a cell reflects at a height.
  dvec3 wall_radiance(const SurroundingCell& cell, double height) const;
  /// Returns what the wall in a cell emits, averaged over this many cells to both sides along it.
  const WallGlow& glow(size_t cell, double cells_aside) const { return glow_average_.at(cell, cells_aside); }
  /// Returns for each cell how many columns of cells (or rows, along y) a level ray passes, the own one
  /// included, before something may stand in its way, wherever in the cell and in the octant of directions
  /// (shaders/shared/surroundings.h) it goes. 0: something stands in the cell or beside it.
  std::vector<uint16_t> free_cells(uint32_t octant) const;

 private:
  void paint(const scene::Scene& scene);
  void emit(const scene::Scene& scene);
  void thicken_walls();
  void cast_shadows();
  void average_glow();
  void shine(std::span<const scene::PunctualLight> lamps);

  const HeightField* field_;
  SurroundingLight light_;
  std::vector<SurroundingCell> cells_;
  float most_top_ = 0.0f;
  GlowAverage glow_average_;
  std::vector<dvec3> top_radiance_, ground_radiance_;
};

}  // namespace greatx::render
