// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The light that walls emit (lit windows, shops, signs), summed over the columns of the surroundings: one
// radiance for the lowest metres of a column, where shops are, and one for the rest. The light that leaves
// the triangles is the light that leaves the column, so that hidden faces and fine pictures average out.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/vec.h"
#include "renderer/surface/lamp_glass.h"
#include "scene/description/scene.h"

namespace greatx::render {

/// The radiance that the wall of a column emits below and above shared::surroundings_glow_split, cd/m^2.
struct WallGlow {
  dvec3 low{0.0}, high{0.0};
  bool any() const { return low != dvec3(0.0) || high != dvec3(0.0); }
};

/// A vertical strip of a steep triangle.
struct SteepStrip {
  double low = 0.0, high = 0.0;     ///< heights of its ends, m
  dvec3 low_weights, high_weights;  ///< barycentric coordinates of its ends
  double width = 0.0;               ///< m, along the level
};

class WallGlows {
 public:
  /// `cell_m` is the width of the `cells` columns. Materials of lamps that switch do not glow here.
  WallGlows(const scene::Scene& scene, size_t cells, double cell_m);

  /// Whether any material glows. If not, nothing need be added.
  bool any() const { return any_; }
  /// Whether a triangle emits light that no lamp stands for.
  bool glows(const std::array<dvec3, 3>& corners, uint32_t material) const {
    return pictures_[material] && !glass_.is_glass(0, corners);
  }
  /// Adds a strip of a triangle, whose indices begin at `first_index`, to a column that begins at height
  /// `bottom`.
  void add(size_t cell, double bottom, const SteepStrip& strip, const dvec2& normal, uint32_t first_index,
           uint32_t material);
  /// Returns the radiance that a column from `bottom` to `top` emits to those who see its wall.
  WallGlow of(size_t cell, double bottom, double top) const;

 private:
  /// The emitted radiance over one picture of a texture, as means over a grid.
  struct Picture {
    uint32_t columns = 1, rows = 1;
    bool repeat_u = true, repeat_v = true;
    std::vector<dvec3> radiance;
    const dvec3& at(const dvec2& uv) const;
  };
  /// What the triangles of a column emit: radiance times area, and luminance times area times normal.
  struct Sum {
    dvec3 low{0.0}, high{0.0};
    dvec2 normal{0.0};
  };
  static Picture make_picture(const scene::Scene& scene, const scene::PbrMaterial& pbr);

  const scene::Scene* scene_;
  double cell_m_;
  LampGlass glass_;
  bool any_ = false;
  std::vector<std::optional<Picture>> pictures_;  ///< by material
  std::vector<Sum> sums_;                         ///< by cell; empty if nothing glows
};

}  // namespace greatx::render
