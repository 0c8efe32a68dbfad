// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "scene/build/build.h"

namespace greatx::scene {

/// Triangles of one instance with one material, with what is needed to tell which of them touch.
struct FacetInput {
  std::vector<dvec3> corners;      ///< three a triangle, in the body's frame, in winding order; no zero area
  std::vector<uint32_t> vertices;  ///< three a triangle: equal numbers = the same place
  double noise_m = 0.0;            ///< how far the file's fp32 may have moved a corner
};

/// A facet of a FacetInput: its plane n . x = offset and its triangles.
struct FacetGroup {
  dvec3 normal{0.0};
  double offset = 0.0;
  uint32_t first = 0, count = 0;  ///< into FacetGroups::triangles
};

struct FacetGroups {
  std::vector<FacetGroup> groups;
  std::vector<uint32_t> triangles;  ///< of one group after the other, ascending in each
};

/// Merges edge-connected triangles that face the same way and whose corners all lie within
/// `options.coplanar_distance_m` of the facet's plane: its area-weighted normal through its area-weighted
/// centroid. Normals may differ by `options.coplanar_angle_rad`, plus what `noise_m` can do to a thin
/// triangle's. Every triangle ends in exactly one facet; facets come in order of their first triangle. No
/// binning: planes are compared with the facet that grows, so that nothing can fall across the edge of a bin.
/// Of many triangles around one edge those are compared alone whose normals are near enough, so that a fan of
/// n takes n log n. `crowd`: from so many triangles around an edge on; what comes out does not depend on it.
FacetGroups merge_coplanar(const FacetInput& input, const BuildOptions& options, uint32_t crowd = 16);

}  // namespace greatx::scene
