// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the reference paths with which greatx's specular paths are compared. It tries every sequence of
// facets, on the host in fp64. It shares no code with the searches (rf/search/), the image tree
// (rf/geometry/geometry.h) or the GPU passes, except FacetWorld's planes and its test of a point in a facet.
//
// Only two bounds prune sequences, and neither can lose a path:
// - Pyramids. A pyramid holds everything that an image sees through the convex hull of the facet that
//   mirrored it. The pyramids of earlier facets count as well, as the mirrors show them. A facet or a
//   receiver that lies wholly outside one side of one pyramid cannot be next.
// - Sides. Each of two consecutive facets must have a corner on the reflecting side of the other.
// Occlusion prunes nothing: whole paths are tested against all triangles.
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
  uint32_t max_depth = 3;                            ///< reflections and passed walls of a path
  uint32_t max_transmissions = 0;                    ///< walls (FacetKind::wall) that a whole path may pass
  uint32_t threads = 0;                              ///< 0: one per core; the result does not depend on it
  uint32_t transmitter_body = 0, receiver_body = 0;  ///< bodies that do not hide what they carry; 0: none
  /// The calling thread calls this function from time to time with the share done, 0 to 1. May be empty.
  std::function<void(double done)> progress;
};

struct ExhaustiveResult {
  /// [receivers]: line of sight, reflections and passed walls, in canonical order. Walls have vertices, too.
  std::vector<std::vector<GeometricPath>> paths;
  /// [max_depth + 1]: number of reflection sequences that the bounds left, by number of reflections.
  std::vector<uint64_t> sequences;
  uint64_t geometric_paths = 0;  ///< paths of these sequences before occlusion, duplicates included
};

/// Returns all paths by the rules of rf/geometry/geometry.h. Reflections happen on either side of a facet.
/// Facets are closed within PosedFacet::tolerance_m. A facet does not reflect an end that lies in its plane.
/// Two reflections at one point are a path only in an inner corner. Paths with one polyline (reflection
/// points within 1e-6 m, or 1e-9 of the length beyond 1 km) are one path, with the first sequence in
/// canonical order. rf/reference/occluders.h defines what blocks a path.
///
/// `body_poses` [bodies] are the poses of `world`. Throws UserError, which names the receiver, if a position
/// is not finite.
ExhaustiveResult exhaustive_paths(const scene::Scene& scene, const FacetWorld& world,
                                  std::span<const Pose> body_poses, const FacetKinds& kinds,
                                  const dvec3& transmitter, std::span<const dvec3> receivers,
                                  const ExhaustiveOptions& options);

}  // namespace greatx::rf::reference
