// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/paths/scattering_patches.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace greatx::rf {

namespace {

struct Triangle {
  dvec3 corners[3];
};

/// Returns a lower bound of the number of pieces of a triangle, from its area and from its longest side.
double least_pieces(const scene::FacetTriangle& triangle, double side_m) {
  const dvec3 &a = triangle.corners[0], &b = triangle.corners[1], &c = triangle.corners[2];
  const double longest = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)}),
               area = 0.5 * glm::length(glm::cross(b - a, c - a));
  const double of_area =
      area / (0.25 * std::sqrt(3.0)) / side_m / side_m;  // the largest piece is equilateral
  return std::max(of_area, longest / side_m);
}

[[noreturn]] void too_many_patches(double side_m, size_t most) {
  throw_user_error("scattering_patch_m: {} m makes more than {} patches of this scene; expected a larger one",
                   side_m, most);
}

/// Halves the longest side until no side is longer than `side_m`. Appends the pieces in order, first half
/// first.
void cut(const Triangle& triangle, double side_m, uint32_t facet, std::vector<Patch>& patches, size_t first,
         size_t most) {
  int longest = 0;
  double length = 0.0;
  for (int side = 0; side < 3; ++side) {
    const double l = glm::length(triangle.corners[(side + 1) % 3] - triangle.corners[side]);
    if (l > length) longest = side, length = l;
  }
  const dvec3 &a = triangle.corners[longest], &b = triangle.corners[(longest + 1) % 3],
              &c = triangle.corners[(longest + 2) % 3];
  if (length > side_m) {
    const dvec3 middle = 0.5 * (a + b);
    cut({{a, middle, c}}, side_m, facet, patches, first, most);
    cut({{middle, b, c}}, side_m, facet, patches, first, most);
    return;
  }
  if (patches.size() >= most) too_many_patches(side_m, most);
  patches.push_back({facet, static_cast<uint32_t>(patches.size() - first), (a + b + c) / 3.0,
                     0.5 * glm::length(glm::cross(b - a, c - a))});
}

}  // namespace

std::vector<Patch> scattering_patches(const scene::Scene& scene, const FacetKinds& kinds, double side_m,
                                      size_t most) {
  std::vector<Patch> patches;
  for (uint32_t index = 0; index < scene.facets.size(); ++index) {
    const scene::Facet& facet = scene.facets[index];
    const scene::Material& material = scene.materials[facet.material];
    const bool hard = kinds[index] == FacetKind::opaque || kinds[index] == FacetKind::wall;
    if (!hard || !material.radio || material.radio->scattering_coefficient == 0.0) continue;
    const size_t first = patches.size();
    for (uint32_t t = 0; t < facet.triangle_count; ++t) {
      const scene::FacetTriangle& triangle = scene.facet_triangles[facet.first_triangle + t];
      // The bound is tested before the triangle is cut, because halving would not end before fp64 underflows.
      if (!(least_pieces(triangle, side_m) <= static_cast<double>(most))) too_many_patches(side_m, most);
      cut({{triangle.corners[0], triangle.corners[1], triangle.corners[2]}}, side_m, index, patches, first,
          most);
    }
    std::erase_if(patches, [](const Patch& patch) { return patch.area_m2 == 0.0; });
  }
  return patches;
}

}  // namespace greatx::rf
