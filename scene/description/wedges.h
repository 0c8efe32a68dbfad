// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines edges that diffract: straight edges where two facets meet, or where one facet ends.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "core/vec.h"
#include "scene/description/scene.h"

namespace greatx::scene {

inline constexpr uint32_t no_facet = ~0u;

/// Describes a straight edge with its two faces, in its body's frame (body 0: local coordinates). The
/// exterior, where waves travel, spans n pi from face 0 to face n, turning about the edge from a to b by the
/// right hand: n = (2 pi - interior angle)/pi. Facets reflect on both sides, so geometry defines the exterior
/// and winding does not: it is the side that is wider than pi. Hence n is in (1, 2]: 3/2 for the corner of a
/// house seen from outside and for the corner of a pillar in a room, and 2 for a half-plane. The narrow side
/// (the corner of a room) does not diffract: there the waves reflected by both faces join without a gap.
struct Wedge {
  dvec3 a{0.0}, b{0.0};  ///< ends of the edge
  dvec3 tangent_0{0.0};  ///< unit, in face 0, perpendicular to the edge, pointing away from it
  /// Unit, perpendicular to the edge and to tangent_0, pointing into the exterior:
  /// tangent_0 x normal_0 = (b - a)/|b - a|.
  dvec3 normal_0{0.0};
  double n = 2.0;
  uint32_t facet_0 = no_facet;  ///< into Scene::facets; the lower index of the two
  /// With no_facet this is a free edge: n = 2, both faces are sides of facet_0, and face 0 is its front.
  uint32_t facet_n = no_facet;
  uint32_t body = 0;
};

struct WedgeOptions {
  bool free_edges = false;  ///< edges of a single facet: borders of thin plates
  /// Facets that meet this close to flat ((n - 1) pi) make a seam, not a wedge.
  double flat_angle_rad = 0.035;
  double min_length_m = 1e-3;  ///< shorter edges are left out and counted
  /// Points this close together are in one place (as for merging, BuildOptions).
  double weld_distance_m = 1e-4;
};

/// Holds the straight pieces of all edges of a scene with the facets around them. Wedges by different options
/// follow from it, for those who need several kinds of them: to look for pieces takes nearly all of the time.
class EdgeSurvey {
 public:
  /// The scene outlives the survey and stays as it is.
  EdgeSurvey(const Scene& scene, const WedgeOptions& least);
  ~EdgeSurvey();
  EdgeSurvey(const EdgeSurvey&) = delete;
  EdgeSurvey& operator=(const EdgeSurvey&) = delete;

  /// Whether wedges() answers: the options have the survey's weld distance, at least its flat angle, and free
  /// edges only if it has them.
  bool covers(const WedgeOptions& options) const;
  /// Returns what find_wedges() returns. Threads may call it at once.
  std::vector<Wedge> wedges(const WedgeOptions& options, uint64_t* too_short = nullptr) const;

 private:
  struct Pieces;
  const Scene* scene_;
  WedgeOptions least_;
  std::unique_ptr<Pieces> pieces_;
};

/// Finds every wedge of the scene, in a canonical order (body, facets, position). The facets of one body
/// around an edge decide as follows:
/// - A facet that ends at the edge goes off in one direction, and one that contains the edge goes off in two.
///   A box that stands on a ground, with or without common vertices, therefore has no wedge along its foot,
///   and neither has a storey on a wider one.
/// - Between neighbouring directions at most one gap is wider than pi. If there is such a gap, there is a
///   wedge between the two facets beside the gap, however many facets meet. Otherwise there is no wedge
///   (roofs of two houses that touch, corner to corner).
/// - Of facets in the same place (duplicates, two sides of one sheet) the lowest index counts.
/// - A single direction makes a free edge.
/// Edges need no common vertices. Pieces are compared where they overlap, however each side is split, and are
/// joined again into one wedge per straight run between the same two facets. Facets of different bodies make
/// no wedge. `too_short` receives the number of wedges that are left out because they are too short. `known`
/// spares work if it is a survey of the scene that covers the options.
std::vector<Wedge> find_wedges(const Scene& scene, const WedgeOptions& options = {},
                               uint64_t* too_short = nullptr, const EdgeSurvey* known = nullptr);

/// Tells whether find_wedges() finds one that `wanted` accepts. It looks at small bodies first and ends with
/// the first such wedge, so that a scene with a car costs a car's time.
bool any_wedge(const Scene& scene, const WedgeOptions& options,
               const std::function<bool(const Wedge&)>& wanted);

}  // namespace greatx::scene
