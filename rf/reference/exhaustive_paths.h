// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The reference that greatx's specular paths are held against: every sequence of facets is tried, host, fp64.
// It shares no code with the searches (rf/search/, rf/search/candidate_search.h), the image tree
// (rf/geometry/geometry.h) or the GPU passes; only FacetWorld's planes and its test of a point in a facet are
// the same.
//
// Sequences are pruned by two bounds alone, neither of which can lose a path:
// - pyramids: what an image sees through the convex hull of the facet that it was mirrored at, and of those
//   before as
//   the mirrors show them; a facet (or a receiver) wholly outside of one side of one of them cannot be next;
// - sides: each of two consecutive facets must have a corner on the side of the other that reflects.
// Nothing is pruned by occlusion: what stands in the way is worked out for whole paths, against all
// triangles.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/vec.h"
#include "rf/facets/facet_kind.h"
#include "rf/facets/facet_world.h"
#include "rf/geometry/path.h"
#include "scene/description/scene.h"

namespace greatx::rf::reference {

struct ExhaustiveOptions {
  uint32_t max_depth = 3;          ///< reflections + walls passed
  uint32_t max_transmissions = 0;  ///< walls passed (FacetKind::wall) on a whole path
  uint32_t threads = 0;            ///< 0: as many as the machine has. The result does not depend on it
  uint32_t transmitter_body = 0, receiver_body = 0;  ///< bodies that do not hide what they carry; 0: none
  std::function<void(double done)> progress;  ///< from the calling thread now and then, 0 to 1; may be empty
};

struct ExhaustiveResult {
  /// [receivers]: line of sight, reflections and walls passed, canonical order. Vertices of walls included.
  std::vector<std::vector<GeometricPath>> paths;
  std::vector<uint64_t>
      sequences;  ///< [max_depth + 1]: sequences of reflections that the bounds left, by their number
  uint64_t geometric_paths = 0;  ///< of these, with occlusion not looked at, duplicates included
};

/// What counts as a path is what rf/geometry/geometry.h says: reflections on either side of a facet; facets
/// closed within PosedFacet::tolerance_m; an end in a facet's plane is not reflected by it; two reflections
/// in one point only in an inner corner; paths with one polyline (reflection points within 1e-6 m, 1e-9 of
/// the length beyond 1 km) are one, the first sequence in canonical order. What blocks:
/// rf/reference/occluders.h.
///
/// `body_poses` [bodies] is what `world` was posed with. Throws UserError naming the receiver if a position
/// is not finite.
ExhaustiveResult exhaustive_paths(const scene::Scene& scene, const FacetWorld& world,
                                  std::span<const Pose> body_poses, const FacetKinds& kinds,
                                  const dvec3& transmitter, std::span<const dvec3> receivers,
                                  const ExhaustiveOptions& options);

}  // namespace greatx::rf::reference
