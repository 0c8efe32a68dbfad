// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/description/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace greatx::scene {
namespace {

/// Returns whether the segment a + t (b - a), t in [0, 1], meets the box grown by `distance`, by the method
/// of slabs.
bool meets(const Bounds& box, const dvec3& a, const dvec3& along, double distance) {
  // Most boxes lie beside the segment along an axis. They need no division to tell, and the room keeps the
  // answers as those of the slabs.
  for (int axis = 0; axis < 3; ++axis) {
    const double room = 1e-12 * std::abs(along[axis]);
    if (box.min[axis] - distance - a[axis] > std::max(along[axis], 0.0) + room ||
        box.max[axis] + distance - a[axis] < std::min(along[axis], 0.0) - room)
      return false;
  }
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

/// Tells on which side of an edge a line through the origin passes. The two triangles of an edge ask with its
/// ends in opposite order and get opposite answers, whatever the rounding.
bool left_of(const dvec3& direction, const dvec3& from, const dvec3& to) {
  const bool swapped = std::tie(to.x, to.y, to.z) < std::tie(from.x, from.y, from.z);
  const dvec3 &low = swapped ? to : from, &high = swapped ? from : to;
  return (glm::dot(direction, glm::cross(low, high)) >= 0.0) != swapped;
}

}  // namespace

dvec3 nearest_on_triangle(const dvec3& p, const FacetTriangle& triangle) {
  const auto& [a, b, c] = triangle.corners;
  const auto on_side = [&](const dvec3& from, const dvec3& to) {
    const dvec3 along = to - from;
    const double length2 = glm::dot(along, along);
    return length2 > 0.0 ? from + std::clamp(glm::dot(p - from, along) / length2, 0.0, 1.0) * along : from;
  };
  const dvec3 normal = glm::cross(b - a, c - a);
  const double area2 = glm::dot(normal, normal);
  const auto inside = [&](const dvec3& from, const dvec3& to) {
    return glm::dot(glm::cross(to - from, p - from), normal) >= 0.0;
  };
  if (area2 > 0.0 && inside(a, b) && inside(b, c) && inside(c, a))
    return p - glm::dot(p - a, normal) / area2 * normal;
  dvec3 nearest = on_side(a, b);
  for (const dvec3& other : {on_side(b, c), on_side(c, a)})
    if (glm::length(other - p) < glm::length(nearest - p)) nearest = other;
  return nearest;
}

std::optional<double> line_meets_triangle(const dvec3& origin, const dvec3& direction,
                                          const FacetTriangle& triangle) {
  const dvec3 a = triangle.corners[0] - origin, b = triangle.corners[1] - origin,
              c = triangle.corners[2] - origin;
  const bool left = left_of(direction, a, b);
  if (left_of(direction, b, c) != left || left_of(direction, c, a) != left) return std::nullopt;
  const dvec3 normal = glm::cross(b - a, c - a);
  const double slope = glm::dot(normal, direction);
  if (slope == 0.0) return std::nullopt;
  return glm::dot(normal, a) / slope;
}

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
