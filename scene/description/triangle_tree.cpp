// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/description/triangle_tree.h"

#include <algorithm>
#include <numeric>

namespace greatx::scene {
namespace {

constexpr uint32_t leaf_size = 4;

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

TriangleTree::TriangleTree(std::span<const FacetTriangle> triangles) : order_(triangles.size()) {
  if (triangles.empty()) return;
  std::iota(order_.begin(), order_.end(), 0u);
  std::vector<Bounds> boxes(triangles.size());
  for (size_t index = 0; index < triangles.size(); ++index)
    for (const dvec3& corner : triangles[index].corners) boxes[index].add(corner);
  nodes_.push_back({{}, 0, static_cast<uint32_t>(order_.size())});
  for (uint32_t node = 0; node < nodes_.size(); ++node) split(node, boxes);
}

void TriangleTree::split(uint32_t node, std::vector<Bounds>& boxes) {
  const uint32_t first = nodes_[node].first, count = nodes_[node].count;
  Bounds bounds, centers;
  for (uint32_t index = first; index < first + count; ++index) {
    bounds.add(boxes[order_[index]]);
    centers.add(boxes[order_[index]].center());
  }
  nodes_[node].bounds = bounds;
  if (count <= leaf_size) return;
  const dvec3 size = centers.size();
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const auto begin = order_.begin() + first;
  std::nth_element(begin, begin + count / 2, begin + count, [&](uint32_t left, uint32_t right) {
    return std::pair(boxes[left].center()[axis], left) < std::pair(boxes[right].center()[axis], right);
  });
  const auto children = static_cast<uint32_t>(nodes_.size());
  nodes_.push_back({{}, first, count / 2});
  nodes_.push_back({{}, first + count / 2, count - count / 2});
  nodes_[node].first = children;
  nodes_[node].count = 0;
}

void TriangleTree::near_segment(const dvec3& a, const dvec3& b, double distance_m,
                                std::vector<uint32_t>& found) const {
  const size_t already = found.size();
  std::vector<uint32_t> pending;
  if (!nodes_.empty()) pending.push_back(0);
  while (!pending.empty()) {
    const TreeNode& node = nodes_[pending.back()];
    pending.pop_back();
    if (!meets(node.bounds, a, b - a, distance_m)) continue;
    if (node.count == 0) {
      pending.push_back(node.first);
      pending.push_back(node.first + 1);
      continue;
    }
    found.insert(found.end(), order_.begin() + node.first, order_.begin() + node.first + node.count);
  }
  std::sort(found.begin() + static_cast<ptrdiff_t>(already), found.end());
}

}  // namespace greatx::scene
