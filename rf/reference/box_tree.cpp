// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/reference/box_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace greatx::rf::reference {

namespace {

constexpr uint32_t largest_leaf = 4;

dvec3 absolute(const dvec3& v) { return glm::abs(v); }

}  // namespace

BoxTree::BoxTree(const std::vector<scene::Bounds>& boxes) : items_(boxes.size()) {
  if (boxes.empty()) return;
  std::iota(items_.begin(), items_.end(), 0u);
  nodes_.reserve(2 * boxes.size());
  nodes_.emplace_back();
  split(0, 0, static_cast<uint32_t>(boxes.size()), boxes);
}

/// Splits the boxes into halves at the median of their centres along the longest axis: at most 32 levels.
void BoxTree::split(uint32_t index, uint32_t first, uint32_t count, const std::vector<scene::Bounds>& boxes) {
  scene::Bounds all;
  for (uint32_t i = 0; i < count; ++i) all.add(boxes[items_[first + i]]);
  nodes_[index].center = all.center();
  // The box grows by many times the roundings of its own centre and half size.
  nodes_[index].half = 0.5 * all.size() + 1e-12 * (absolute(all.min) + absolute(all.max));
  if (count <= largest_leaf) {
    nodes_[index].first = first;
    nodes_[index].count = count;
    return;
  }
  const dvec3 size = all.size();
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const auto begin = items_.begin() + static_cast<std::ptrdiff_t>(first);
  const uint32_t lower = count / 2;
  std::nth_element(begin, begin + lower, begin + count, [&](uint32_t a, uint32_t b) {
    const double center_a = boxes[a].center()[axis], center_b = boxes[b].center()[axis];
    return center_a != center_b ? center_a < center_b : a < b;
  });
  const uint32_t child = static_cast<uint32_t>(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  nodes_[index].first = child;
  split(child, first, lower, boxes);
  split(child + 1, first + lower, count - lower, boxes);
}

bool BoxTree::outside(const Node& node, std::span<const HalfSpace> half_spaces) {
  return std::any_of(half_spaces.begin(), half_spaces.end(), [&](const HalfSpace& half) {
    return half.depth(node.center) + glm::dot(absolute(half.normal), node.half) < 0.0;
  });
}

/// Tests the separating axes: first those of the box, then their products with the segment (C. Ericson,
/// "Real-Time Collision Detection", 2005, section 5.3.3).
bool BoxTree::missed(const Node& node, const dvec3& a, const dvec3& b) {
  const dvec3 half_way = 0.5 * (b - a), middle = 0.5 * (a + b) - node.center;
  const dvec3 reach = absolute(half_way);
  for (int i = 0; i < 3; ++i)
    if (std::abs(middle[i]) > node.half[i] + reach[i]) return true;
  const double room =
      1e-12 * (reach.x + reach.y + reach.z) *
      (std::abs(middle.x) + std::abs(middle.y) + std::abs(middle.z) + reach.x + reach.y + reach.z);
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const double distance = std::abs(middle[j] * half_way[k] - middle[k] * half_way[j]);
    if (distance > node.half[j] * reach[k] + node.half[k] * reach[j] + room) return true;
  }
  return false;
}

}  // namespace greatx::rf::reference
