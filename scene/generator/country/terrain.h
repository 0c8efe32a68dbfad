// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes the ground of the country scene: one warped grid whose columns follow the road, so that the road is
// part of the surface and does not lie over it.
#pragma once

#include <string>
#include <vector>

#include "core/random.h"
#include "scene/generator/mesh/mesh_builder.h"

namespace greatx::scene::generator {

/// A level place (a farmyard) or a hollow (a pond). Heights change from `level` within `inner_m` to those of
/// the hills beyond `outer_m`.
struct Site {
  dvec2 center{0.0};
  double inner_m = 0.0, outer_m = 0.0;
  double level = 0.0;
};

class Terrain {
 public:
  Terrain(double size_m, RandomStream& random);

  double half() const { return half_; }
  /// Return the y of the middle of the road at x, and the direction of the road there.
  double road_y(double x) const;
  dvec2 road_direction(double x) const;
  /// Returns the length of the road from the west edge to x, m.
  double road_length(double x) const;
  /// Returns the height that the grid samples, m.
  double height(const dvec2& point) const;

  void flatten(const Site& site) { sites_.push_back(site); }

  /// Builds the grid; all sites must be known. The vertices of a row have the same x, and rows run west to
  /// east. Columns run south to north, 0...columns() - 1.
  void build_grid();
  int rows() const { return rows_; }
  int columns() const { return columns_; }
  /// Return the columns of the south and the north edge of the road.
  int road_south() const { return side_ + 1; }
  int road_north() const { return side_ + 2; }
  const dvec3& vertex(int row, int column) const {
    return grid_[static_cast<size_t>(row * columns_ + column)];
  }

  /// Describes the look of a cell. Material -1 leaves the cell out.
  struct Cover {
    int material = -1;
    double angle = 0.0;       ///< angle from the world's x axis to the texture's, rad
    dvec2 offset{0.0};        ///< offset of the texture, in tiles
    bool along_road = false;  ///< the texture follows the road, one tile across its width
  };
  /// Adds the surface with smooth normals. `cover_of(row, column)` returns the cover of the cell north-east
  /// of that vertex.
  void add_surface(MeshBuilder& mesh, const std::function<Cover(int row, int column)>& cover_of) const;
  /// Adds the sides and the underside.
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
