// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A beam, and the facets as its apex sees them: projected onto slopes (a, b), so that straight edges stay straight and
// the inverse depth of a plane is an affine function.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "rf/search/beam_scene.h"

namespace greatx::rf {

struct SlopeRect {
  double min_a = 0.0, max_a = 0.0, min_b = 0.0, max_b = 0.0;
  friend bool operator==(const SlopeRect&, const SlopeRect&) = default;
};

/// All rays from the apex with slopes inside the window: direction a * right + b * up + forward. They start at depth
/// near_m (the mirror), depth being counted along `forward`.
struct Beam {
  static constexpr uint32_t no_mirror = ~0u;
  dvec3 apex{0.0};
  dvec3 right{0.0}, up{0.0}, forward{0.0};  ///< unit, perpendicular
  double near_m = 0.0;                      ///< 0: no mirror, rays start at the apex
  SlopeRect window;
  uint32_t mirror = no_mirror;  ///< in the BeamScene
};

/// A piece of an outline in slopes.
struct ViewEdge {
  double min_a, max_a, min_b, max_b;  ///< with room for where the edge may be
  double normal_a, normal_b,
      offset;                  ///< |normal . x - offset|: distance from its line; normal of unit length
  double room;                 ///< how far it may be from where it is drawn
  dvec2 ends[2];               ///< from, to
  uint32_t edge, vertices[2];  ///< of the scene; none: the end is cut off
  bool left;  ///< a choice of side, opposite for two facets on either side of their common edge
};

struct ViewFacet {
  enum class Role : uint8_t { facet, mirror, wedge };
  Role role = Role::facet;
  uint32_t scene_facet = 0;  ///< BeamScene's; of a wedge: its index in the list given
  FacetKind kind = FacetKind::opaque;
  bool regular = true;
  /// Depth along the ray with slopes x is distance / (n + na a + nb b).
  double n = 0.0, na = 0.0, nb = 0.0;
  double distance = 0.0;                    ///< of its plane from the apex, > 0
  double min_depth = 0.0, max_depth = 0.0;  ///< of its points, with room; none of it is outside
  double contact_m =
      0.0;  ///< rays may start this far behind its plane and still meet it where it touches the mirror
  uint32_t first_edge = 0, edge_count = 0;
  double extent = 0.0;  ///< longer side of the rectangle around its projection, cut to the window
  uint32_t wedge_faces[2] = {~0u, ~0u};  ///< BeamScene's; they never hide it

  double slope_sum(double a, double b) const { return n + na * a + nb * b; }
};

/// Everything that may be met by a beam.
class BeamView {
 public:
  explicit BeamView(const BeamScene& scene) : scene_(&scene) {}
  /// Forgets the beam before. `edge_strips`: see BeamSearchOptions; `wedges`: look at them, too.
  void look(const Beam& beam, bool edge_strips, bool wedges);

  const BeamScene& scene() const { return *scene_; }
  const Beam& beam() const { return beam_; }
  /// The mirror first, if the beam has one; then facets, then wedges, each in ascending order.
  std::span<const ViewFacet> facets() const { return facets_; }
  std::span<const ViewEdge> edges() const { return edges_; }
  /// Errors of positions in this beam, metres: what roundings of the apex can do.
  double rounding_m() const { return rounding_m_; }
  /// Room that a cover needs before and behind it, metres: four times shared::visibility_tolerance.
  double room_m() const { return room_m_; }
  /// Length of the direction with the largest slopes of the window.
  double longest_direction() const { return longest_direction_; }

  /// Does a facet hold the point that the ray with these slopes meets its plane at?
  bool contains(const ViewFacet& facet, double a, double b) const;

 private:
  dvec3 in_frame(const dvec3& point) const {
    const dvec3 from_apex = point - beam_.apex;
    return {glm::dot(beam_.right, from_apex), glm::dot(beam_.up, from_apex),
            glm::dot(beam_.forward, from_apex)};
  }
  void add_mirror();
  void add_facet(uint32_t scene_facet, bool edge_strips);
  void add_wedge(const BeamWedge& wedge, bool edge_strips);
  bool hidden_by_its_mirror(const BeamFacet& facet, const ViewFacet& view, bool edge_strips) const;
  void add_edge(ViewFacet& view, dvec3 from, dvec3 to, double displacement_m, double least_depth,
                ViewEdge edge);
  void finish(ViewFacet& view);

  const BeamScene* scene_;
  Beam beam_;
  SlopeRect clip_;  ///< the window with a wide border
  double rounding_m_ = 0.0, room_m_ = 0.0, mesh_m_ = 0.0, longest_direction_ = 0.0, longest_clip_ = 0.0;
  std::vector<ViewFacet> facets_;
  std::vector<ViewEdge> edges_;
  std::vector<uint32_t> gathered_;
  std::vector<dvec3> corners_;  ///< of the facet being added: its borders' ends, in the beam's frame
};

}  // namespace greatx::rf
