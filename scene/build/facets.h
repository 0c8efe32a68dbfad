// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "scene/build/build.h"

namespace greatx::scene {

/// Holds the triangles of one instance with one material, and the numbers that tell which of them touch.
struct FacetInput {
  /// Three per triangle, in the body's frame, in winding order. No triangle has zero area.
  std::vector<dvec3> corners;
  /// Three per triangle. Equal numbers denote the same place.
  std::vector<uint32_t> vertices;
  double noise_m = 0.0;  ///< how far the file's fp32 may have moved a corner
};

/// A facet of a FacetInput: its plane n . x = offset and its triangles.
struct FacetGroup {
  dvec3 normal{0.0};
  double offset = 0.0;
  uint32_t first = 0, count = 0;  ///< into FacetGroups::triangles
};

struct FacetGroups {
  std::vector<FacetGroup> groups;
  std::vector<uint32_t> triangles;  ///< triangles of one group after the other, ascending in each group
};

/// Merges edge-connected triangles that face the same way and whose corners all lie within
/// `options.coplanar_distance_m` of the plane of the facet. This plane has the area-weighted normal and
/// contains the area-weighted centroid. Normals may differ by `options.coplanar_angle_rad`, plus the angle by
/// which `noise_m` may turn the normal of a thin triangle. Every triangle belongs to exactly one facet.
/// Facets come in the order of their first triangle. The function compares triangles with the growing facet
/// and does not sort planes into bins, whose edges could separate equal planes.
/// If at least `crowd` triangles share an edge, only those whose normals are near enough are compared, so
/// that a fan of n triangles takes n log n steps. The result does not depend on `crowd`.
FacetGroups merge_coplanar(const FacetInput& input, const BuildOptions& options, uint32_t crowd = 16);

}  // namespace greatx::scene
