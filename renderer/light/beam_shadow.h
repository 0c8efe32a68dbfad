// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the shadows of spots that move: head lamps of vehicles, searchlights of drones. For each picture
// the lamps that matter to it get tiles of one map, and everything that may hide their light is drawn into
// them anew, at this tick's poses: the static world and the bodies that move, without the lamp's own body. So
// a picture depends on no tick and no camera before it.
//
// Lamps are chosen by bodies, since both head lamps of a car matter alike. A body's score is the light of its
// lamps times the part of the picture that the lit road may fill. most_beam_bodies bodies get tiles. Their
// shadows fade by (score / score of the best body without tiles - 1) / beam_fade, so that a body that gains
// or loses its tiles has no shadow at that moment: nothing pops, and nothing has to be remembered.
//
// Each lamp has a map of its own. One map from the middle of a pair would shift the shadow of a thing at the
// distance d, on a wall at the distance D, by 0.7 m (D - d) / d for lamps 1.4 m apart: as much as a person is
// wide from D = 2 d on.
//
// No shadows come from point lights that move, from what lies wholly above the cut-off of a passing beam,
// where 1.5 per cent of its peak goes (crowns of trees, upper floors), from what is nearer to a lamp than
// lamp_shadow_near along its axis, and from what lies beside the tile: more than 35 degrees to the side
// (where a passing beam ends), 14 above or 19 below its axis; of a cone, more than 60 degrees from its axis.
// What lies there is lit.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/vec.h"
#include "gpu/tick_ring.h"
#include "renderer/light/casters.h"
#include "renderer/light/shadow_raster.h"
#include "scene/device/gpu_scene.h"
#include "shaders/shared/camera.h"

namespace greatx::render {

inline constexpr uint32_t most_beam_bodies = 4, most_beam_tiles = 8;
inline constexpr double beam_fade = 0.25;
/// Half of the angle that a tile of a cone covers, at most, rad.
inline constexpr double most_cone_half_angle = 1.0471976;

/// The axes of a spot at a tick, local axes, unit: along its beam, and up and to the right across it.
struct BeamAxes {
  dvec3 along{1.0, 0.0, 0.0}, up{0.0, 0.0, 1.0}, right{0.0, -1.0, 0.0};
};
BeamAxes beam_axes(const scene::PunctualLight& light, const Pose& body);

/// The tile of a lamp in one picture.
struct BeamTile {
  uint32_t light = 0;     ///< of the scene
  dvec2 center{0.0};      ///< uv
  dvec2 scale{0.0};       ///< uv over the tangents to the right and up
  double strength = 0.0;  ///< of the shadow, 0 to 1
};

/// What a picture sees, as far as the choice of lamps needs it.
struct BeamView {
  dvec3 eye{0.0};
  /// Returns the share of a ball in the picture, about: continuous, 0 if it lies outside.
  std::function<double(const dvec3& center, double radius)> share;
};

struct BeamShadowOptions {
  bool wanted = false, alpha_mask = false;
};

class BeamShadows {
 public:
  BeamShadows() = default;
  BeamShadows(const scene::GpuScene& scene, const BeamShadowOptions& options);

  /// Whether there is a lamp that may get a tile.
  bool any() const { return !bodies_.empty(); }
  /// The size of the part of a map that all tiles fill, texels, in a map that is at least so wide.
  uvec2 area(uint32_t width) const;

  /// Chooses the lamps of a picture, without their places in the map.
  std::vector<BeamTile> choose(std::span<const Pose> body_poses, const BeamView& view) const;
  /// Places the chosen lamps' tiles below the row `top` of the map and records what they hold.
  void record(gpu::TickSlot& slot, gpu::Image& map, uint32_t top, std::span<const Pose> body_poses,
              const MovingCasters& moving, std::span<BeamTile> tiles) const;

 private:
  /// A body and its spots.
  struct Bearer {
    uint32_t body = 0;
    std::vector<uint32_t> lights;
  };
  /// A tile's perspective.
  struct Frustum {
    dvec3 position{0.0};
    BeamAxes axes;
    dvec2 half{1.0};      ///< tangents
    double middle = 0.0;  ///< tangent of the tile's middle above the axis
    double reach = 0.0;
    bool passing = false;  ///< it has the cut-off of a passing beam
    shared::CasterConstants constants() const;
    /// Whether a box with these half edges lies outside, or wholly above the cut-off of a passing beam.
    bool outside(const dvec3& center, const dvec3& half_edges) const;
    bool outside(const dvec3& center, double radius) const;
  };
  Frustum frustum_of(uint32_t light, std::span<const Pose> body_poses) const;
  void draw_static(gpu::Cmd& cmd, const Frustum& frustum, const std::vector<CasterBlock>& blocks,
                   bool joins) const;

  const scene::GpuScene* scene_ = nullptr;
  std::vector<Bearer> bodies_;
  StaticCasters still_;
  gpu::GraphicsPipeline still_opaque_, still_masked_;
};

}  // namespace greatx::render
