// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the reference paths over one edge or two: every sequence of facets before and after them is tried at
// every wedge and at every pair of wedges. It shares no code with rf/search/, rf/paths/, rf/edges/ or
// rf/field/, and finds the points on the edges by bisection instead of Keller's closed form and Newton's
// method.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "rf/facets/facet_kind.h"
#include "rf/facets/facet_world.h"
#include "rf/geometry/path.h"
#include "scene/description/scene.h"
#include "scene/description/wedges.h"

namespace greatx::rf::reference {

struct DiffractionOptions {
  uint32_t max_depth = 3;          ///< interactions of a path
  uint32_t max_transmissions = 0;  ///< walls (FacetKind::wall) that a whole path may pass
  uint32_t max_beside = 2;         ///< reflections on each side of the edges
  uint32_t max_edges = 1;          ///< edges of a path, 1 or 2
  /// [wedges] whether a path may bend at the end a, and at the end b. Empty: at no end.
  std::vector<std::array<bool, 2>> open_ends;
  double most_excess_m = 0.0;  ///< of a path over an end against the way over the edge's line
};

/// Returns [receivers] all paths with one diffraction or more by these rules, in canonical order:
/// - The points on the edges are where the unfolded path is shortest, and lie between the edges' ends.
/// - The points before and after an edge lie in the wedge's exterior.
/// - No reflection next to an edge is at one of the wedge's own faces, which belongs to the edge's field.
/// - A path over an open end of an edge is at most `most_excess_m` longer than the shortest unfolded way over
///   the line of the edge, and no facet within 0.2 mm of the end reflects it next to the end. It is seen from
///   the edge, 2 mm from the end (or the middle of a shorter edge). Such a path has no second edge.
/// - Between two edges the path is straight. Their points are a millimetre apart at least.
/// - Reflections and obstruction are those of exhaustive_paths(). The faces of the wedge do not block.
/// All wedges belong to the static world, and nothing carries the ends. `body_poses` [bodies] are those of
/// `world`.
std::vector<std::vector<GeometricPath>> exhaustive_diffraction(
    const scene::Scene& scene, const FacetWorld& world, std::span<const Pose> body_poses,
    const FacetKinds& kinds, std::span<const scene::Wedge> wedges, const dvec3& transmitter,
    std::span<const dvec3> receivers, const DiffractionOptions& options);

}  // namespace greatx::rf::reference
