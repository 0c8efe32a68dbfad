// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/description/box_tree.h"

#include <algorithm>
#include <numeric>

namespace greatx::scene {
namespace {

constexpr uint32_t boxes_of_leaf = 4;

}  // namespace

BoxTree::BoxTree(std::span<const Bounds> boxes) : order_(boxes.size()) {
  if (boxes.empty()) return;
  std::iota(order_.begin(), order_.end(), 0u);
  nodes_.push_back({{}, 0, static_cast<uint32_t>(order_.size())});
  for (uint32_t node = 0; node < nodes_.size(); ++node) split(node, boxes);
}

void BoxTree::split(uint32_t node, std::span<const Bounds> boxes) {
  const uint32_t first = nodes_[node].first, count = nodes_[node].count;
  Bounds bounds, centers;
  for (uint32_t index = first; index < first + count; ++index) {
    bounds.add(boxes[order_[index]]);
    centers.add(boxes[order_[index]].center());
  }
  nodes_[node].bounds = bounds;
  if (count <= boxes_of_leaf) return;
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

void BoxTree::sort_from(std::vector<uint32_t>& found, size_t already) {
  std::sort(found.begin() + static_cast<std::ptrdiff_t>(already), found.end());
}

}  // namespace greatx::scene
