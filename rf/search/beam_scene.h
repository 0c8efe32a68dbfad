// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds the scene for beams: facets as convex polygons. Facets, polygons and wedges are in a tree of boxes
// each. A facet may have thousands of polygons all over the scene, such as the ground of a city, so that a
// beam must not look at all polygons of a facet that it meets.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "rf/facets/facet_kind.h"
#include "rf/facets/facet_world.h"
#include "scene/description/box_tree.h"
#include "scene/description/wedges.h"

namespace greatx::rf {

/// A convex piece of a facet, counter-clockwise as seen from the side of the normal.
struct BeamPolygon {
  static constexpr uint32_t most_corners = 8;
  uint32_t first = 0, count = 0;  ///< range of corners
  uint32_t facet = 0;             ///< facet of the BeamScene
};

struct BeamFacet {
  uint32_t index = 0;  ///< index in the FacetWorld
  FacetKind kind = FacetKind::opaque;
  uint32_t owner = 0;  ///< PosedFacet::owner
  uint32_t first_polygon = 0, polygon_count = 0;
  dvec3 normal{0.0};  ///< unit
  double offset = 0.0;
  double tolerance_m = 0.0;               ///< PosedFacet::tolerance_m
  dvec3 reference{0.0};                   ///< a corner, in the plane
  dvec3 axis_a{0.0}, axis_b{0.0};         ///< unit, in the plane; axis_a is along the longest edge
  double offset_a = 0.0, offset_b = 0.0;  ///< a = axis_a . x - offset_a
  double min_a = 0.0, max_a = 0.0, min_b = 0.0, max_b = 0.0;
  scene::Bounds bounds;
};

/// Describes an edge that diffracts, in local coordinates.
struct BeamWedge {
  dvec3 a{0.0}, b{0.0};
  uint32_t index = 0;              ///< index in the given list
  uint32_t faces[2] = {~0u, ~0u};  ///< facets of the BeamScene; ~0u: none, or left out
};

/// Describes the half-space normal . x >= offset.
struct HalfSpace {
  dvec3 normal{0.0};
  double offset = 0.0;
};

class BeamScene {
 public:
  /// Foliage and absent facets are left out. So are facets of bodies other than 0, which move, unless
  /// `moving_bodies`, and wedges without a face among the remaining facets.
  BeamScene(const FacetWorld& world, const FacetKinds& kinds, std::span<const scene::Wedge> wedges,
            bool moving_bodies);

  const FacetWorld& world() const { return *world_; }
  uint32_t facet_count() const { return static_cast<uint32_t>(facets_.size()); }
  const BeamFacet& facet(uint32_t index) const { return facets_[index]; }
  static constexpr uint32_t none = ~0u;
  /// Returns the index here of a facet of the world; none if it was left out.
  uint32_t index_of(uint32_t facet) const { return index_of_[facet]; }
  std::span<const BeamPolygon> polygons(const BeamFacet& facet) const {
    return std::span(polygons_).subspan(facet.first_polygon, facet.polygon_count);
  }
  /// Returns the vertices of a polygon.
  std::span<const uint32_t> corners(const BeamPolygon& polygon) const {
    return std::span(corners_).subspan(polygon.first, polygon.count);
  }
  const BeamPolygon& polygon(uint32_t index) const { return polygons_[index]; }
  uint32_t wedge_count() const { return static_cast<uint32_t>(wedges_.size()); }
  /// Wedges are ordered by the first of their faces.
  const BeamWedge& wedge(uint32_t index) const { return wedges_[index]; }
  const dvec3& vertex(uint32_t index) const { return vertices_[index]; }
  /// Returns the largest absolute coordinate of a vertex, metres.
  double largest_coordinate() const { return largest_coordinate_; }

  /// Appends, in ascending order, the facets whose boxes are not outside any of the half-spaces.
  void gather(std::span<const HalfSpace> region, std::vector<uint32_t>& facets) const;
  /// Does the same for polygons. They are ordered by facet.
  void gather_polygons(std::span<const HalfSpace> region, std::vector<uint32_t>& polygons) const;
  /// Does the same for wedges.
  void gather_wedges(std::span<const HalfSpace> region, std::vector<uint32_t>& wedges) const;

 private:
  void add(const FacetWorld& world, uint32_t index, FacetKind kind,
           std::span<const std::array<uint32_t, 3>> triangles);
  void add_polygons(BeamFacet& facet, std::span<const std::array<uint32_t, 3>> triangles);
  void add_wedges(std::span<const scene::Wedge> wedges);

  const FacetWorld* world_;
  std::vector<dvec3> vertices_;
  std::vector<BeamFacet> facets_;
  std::vector<uint32_t> index_of_;  ///< [facets of the world]
  std::vector<BeamPolygon> polygons_;
  std::vector<uint32_t> corners_;
  std::vector<BeamWedge> wedges_;
  std::vector<scene::Bounds> polygon_bounds_, wedge_bounds_;
  scene::BoxTree facet_tree_, polygon_tree_, wedge_tree_;
  double largest_coordinate_ = 0.0;
};

}  // namespace greatx::rf
