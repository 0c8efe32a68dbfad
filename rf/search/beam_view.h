// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Projects the facets that a beam may meet onto slopes (a, b), as the beam's apex sees them. Straight edges
// stay straight, and the inverse depth of a plane is an affine function.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "rf/search/beam_scene.h"
#include "rf/search/convex.h"

namespace greatx::rf {

/// Describes all rays from the apex with slopes inside the window: the direction is a * right + b * up +
/// forward. Depth is counted along `forward`. The rays start at depth near_m (the mirror).
struct Beam {
  static constexpr uint32_t no_mirror = ~0u;
  dvec3 apex{0.0};
  dvec3 right{0.0}, up{0.0}, forward{0.0};  ///< unit, perpendicular
  double near_m = 0.0;                      ///< 0 without a mirror: rays start at the apex
  SlopeRect window;
  double min_sum = -1e300, max_sum = 1e300;                ///< bounds of a + b
  double min_difference = -1e300, max_difference = 1e300;  ///< bounds of a - b
  uint32_t mirror = no_mirror;                             ///< facet of the BeamScene
};

/// Holds a convex piece of a facet in slopes.
struct ViewPolygon {
  uint32_t first = 0, count = 0;  ///< range of corners
  SlopeRect box;
  double max_depth = 0.0;  ///< largest depth of a corner
};

struct ViewFacet {
  uint32_t scene_facet = 0;  ///< facet of the BeamScene; for a wedge its index in the given list
  FacetKind kind = FacetKind::opaque;
  bool is_wedge = false;  ///< an edge: it has two ends and no polygons
  bool hides = false;     ///< stops rays, at least those in `start`
  /// The depth along the ray with slopes (a, b) is distance / (n + na a + nb b).
  double n = 0.0, na = 0.0, nb = 0.0;
  double distance = 0.0;                    ///< distance of its plane from the apex, > 0
  double min_depth = 0.0, max_depth = 0.0;  ///< depths of its points
  HalfPlane start;                          ///< rays that start well before the facet
  SlopeRect box;
  uint32_t first_polygon = 0, polygon_count = 0;
  dvec2 ends[2];                         ///< ends of a wedge
  uint32_t wedge_faces[2] = {~0u, ~0u};  ///< facets of the BeamScene, which never hide the wedge

  double slope_sum(double a, double b) const { return n + na * a + nb * b; }
};

/// Holds all facets and wedges that a beam may meet.
class BeamView {
 public:
  explicit BeamView(const BeamScene& scene) : scene_(&scene) {}
  /// Sets the beam and discards the beam before. `clearance_m`: see BeamSearchOptions. Facets of
  /// `transparent_body` hide nothing. `wedges`: includes wedges.
  void look(const Beam& beam, double clearance_m, uint32_t transparent_body, bool wedges);

  const BeamScene& scene() const { return *scene_; }
  const Beam& beam() const { return beam_; }
  /// Returns the facets and then the wedges, each in ascending order.
  std::span<const ViewFacet> facets() const { return facets_; }
  std::span<const ViewPolygon> polygons(const ViewFacet& facet) const {
    return std::span(polygons_).subspan(facet.first_polygon, facet.polygon_count);
  }
  std::span<const dvec2> corners(const ViewPolygon& polygon) const {
    return std::span(corners_).subspan(polygon.first, polygon.count);
  }
  /// Returns the number of polygons of the scene that were looked at for this beam.
  uint64_t examined() const { return examined_; }
  /// Returns BeamSearchOptions::clearance_m with room for the mesh's fp32; 0: none.
  double clearance_m() const { return clearance_m_; }
  /// Returns the room that a cover needs in front and behind if nothing else is known, metres: four times
  /// shared::visibility_tolerance.
  double room_m() const { return room_m_; }
  double rounding_m() const { return rounding_m_; }
  /// Returns how far behind a plane something must be before an obstacle in that plane hides it, metres.
  /// Planes that meet at an angle need no room: the excess that they hide lies within the clearance of their
  /// common edge.
  double room_between(const dvec3& normal, const dvec3& other) const;

 private:
  dvec3 in_frame(const dvec3& point) const {
    const dvec3 from_apex = point - beam_.apex;
    return {glm::dot(beam_.right, from_apex), glm::dot(beam_.up, from_apex),
            glm::dot(beam_.forward, from_apex)};
  }
  void add_facet(uint32_t scene_facet, std::span<const uint32_t> polygons, uint32_t transparent_body);
  bool add_polygon(ViewFacet& view, std::span<const uint32_t> vertices, double least_depth,
                   double least_rise);
  void add_wedge(const BeamWedge& wedge);
  void find_start(ViewFacet& view, const BeamFacet& facet);

  const BeamScene* scene_;
  Beam beam_;
  double rounding_m_ = 0.0, room_m_ = 0.0, clearance_m_ = 0.0, longest_direction_ = 0.0;
  std::vector<ViewFacet> facets_;
  std::vector<ViewPolygon> polygons_;
  std::vector<dvec2> corners_;
  std::vector<uint32_t> gathered_;
  uint64_t examined_ = 0;
};

}  // namespace greatx::rf
