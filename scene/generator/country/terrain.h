// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The country's ground: one warped grid whose columns follow the road, so that the road is part of the
// surface and not laid over it.
#pragma once

#include <string>
#include <vector>

#include "core/random.h"
#include "scene/generator/mesh/mesh_builder.h"

namespace greatx::scene::generator {

/// A level place (a farmyard) or a hollow (a pond): heights go from `level` inside to the hills' outside.
struct Site {
  dvec2 center{0.0};
  double inner_m = 0.0, outer_m = 0.0;
  double level = 0.0;
};

class Terrain {
 public:
  Terrain(double size_m, RandomStream& random);

  double half() const { return half_; }
  /// Middle of the road at x, and its direction there.
  double road_y(double x) const;
  dvec2 road_direction(double x) const;
  /// Length of the road from the west edge to x, m.
  double road_length(double x) const;
  /// Height of the formula behind the grid, m.
  double height(const dvec2& point) const;

  void flatten(const Site& site) { sites_.push_back(site); }

  /// Grid, after every site is known. Row i has x = row_x(i); columns run south to north, 0...columns() - 1.
  void build_grid();
  int rows() const { return rows_; }
  int columns() const { return columns_; }
  /// Columns of the road's south and north edge.
  int road_south() const { return side_ + 1; }
  int road_north() const { return side_ + 2; }
  const dvec3& vertex(int row, int column) const {
    return grid_[static_cast<size_t>(row * columns_ + column)];
  }

  /// What a cell looks like: -1 leaves it out.
  struct Cover {
    int material = -1;
    double angle = 0.0;       ///< of the texture's x axis against the world's, rad
    dvec2 offset{0.0};        ///< of the texture, in tiles
    bool along_road = false;  ///< the texture follows the road, one width of it across
  };
  /// The surface; `cover_of(row, column)` for the cell north-east of that vertex. Smooth normals.
  void add_surface(MeshBuilder& mesh, const std::function<Cover(int row, int column)>& cover_of) const;
  /// Sides and underside.
  void add_base(MeshBuilder& mesh) const;

 private:
  double hills(const dvec2& point) const;
  dvec3 normal(int row, int column) const;
  dvec2 uv(const Cover& cover, int row, int column) const;

  struct Wave {
    dvec2 k;
    double amplitude, phase;
  };
  double half_;
  std::vector<Wave> waves_, bends_;
  std::vector<Site> sites_;
  int rows_ = 0, columns_ = 0, side_ = 0;
  std::vector<dvec3> grid_;
};

inline constexpr double road_half_width_m = 3.0;
inline constexpr double verge_m = 1.8;

}  // namespace greatx::scene::generator
