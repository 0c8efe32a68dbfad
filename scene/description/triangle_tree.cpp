// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/description/triangle_tree.h"

#include <algorithm>

namespace greatx::scene {
namespace {

/// Returns whether the segment a + t (b - a), t in [0, 1], meets the box grown by `distance`, by the method
/// of slabs.
bool meets(const Bounds& box, const dvec3& a, const dvec3& along, double distance) {
  double enter = 0.0, leave = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box.min[axis] - distance - a[axis], high = box.max[axis] + distance - a[axis];
    if (along[axis] == 0.0) {
      if (low > 0.0 || high < 0.0) return false;
      continue;
    }
    const double first = low / along[axis], second = high / along[axis];
    enter = std::max(enter, std::min(first, second));
    leave = std::min(leave, std::max(first, second));
  }
  return enter <= leave;
}

}  // namespace

TriangleTree::TriangleTree(std::span<const FacetTriangle> triangles) {
  std::vector<Bounds> boxes(triangles.size());
  for (size_t index = 0; index < triangles.size(); ++index)
    for (const dvec3& corner : triangles[index].corners) boxes[index].add(corner);
  boxes_ = BoxTree(boxes);
}

void TriangleTree::near_segment(const dvec3& a, const dvec3& b, double distance_m,
                                std::vector<uint32_t>& found) const {
  const dvec3 along = b - a;
  boxes_.gather([&](const Bounds& box) { return !meets(box, a, along, distance_m); }, found);
}

}  // namespace greatx::scene
