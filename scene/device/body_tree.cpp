// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/device/body_tree.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "scene/description/index_bounds.h"
#include "scene/device/tree_words.h"

namespace greatx::scene {

/// Divides the bodies at the median along the widest axis of their centres. `write` makes it anew.
class BodyTree::Division {
 public:
  Division(const BodyTree& tree, std::span<uint32_t> order, const TreeFrame& frame, TreeWriter& writer)
      : tree_(tree), order_(order), frame_(frame), writer_(writer) {}

  Subtree divide(size_t first, size_t count) {
    if (count == 1) {
      const uint32_t place = order_[first];
      return {shared::tree_leaf | tree_.bodies_[place].body, tree_.boxes_[place]};
    }
    halve(order_.subspan(first, count));
    const size_t node = next_;
    next_ += 2;
    const Subtree left = divide(first, count / 2), right = divide(first + count / 2, count - count / 2);
    writer_.put_child(node, frame_, left.box, left.reference);
    writer_.put_child(node + 1, frame_, right.box, right.reference);
    Subtree both{static_cast<uint32_t>(node), left.box};
    both.box.add(right.box);
    return both;
  }

 private:
  void halve(std::span<uint32_t> places) const {
    TreeBox centers;
    for (const uint32_t place : places) centers.add(tree_.boxes_[place].center());
    const vec3 size = centers.max - centers.min;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    std::nth_element(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(places.size() / 2),
                     places.end(), [&](uint32_t a, uint32_t b) {
                       return std::pair(tree_.boxes_[a].center()[axis], a) <
                              std::pair(tree_.boxes_[b].center()[axis], b);
                     });
  }

  const BodyTree& tree_;
  std::span<uint32_t> order_;
  const TreeFrame& frame_;
  TreeWriter& writer_;
  size_t next_ = shared::body_tree_head;  ///< quadruple of the next inner node
};

BodyTree::BodyTree(const Scene& scene) {
  for (uint32_t body = 1; body < scene.bodies.size(); ++body) {
    Bounds bounds;
    const Body& range = scene.bodies[body];
    for (uint32_t p = range.first_primitive; p < range.first_primitive + range.primitive_count; ++p) {
      const Primitive& primitive = scene.primitives[p];
      bounds.add(bounds_of_indices(scene, primitive.first_index, primitive.index_count));
    }
    if (!bounds.empty()) bodies_.push_back({body, bounds.center(), 0.5 * bounds.size()});
  }
  boxes_.resize(bodies_.size());
  order_.resize(bodies_.size());
}

size_t BodyTree::word_count() const {
  const size_t inner_nodes = bodies_.empty() ? 0 : bodies_.size() - 1;
  return 4 * (shared::body_tree_head + 2 * inner_nodes);
}

/// Returns a box around a body. The device rounds the pose to fp32 and takes rays into the body's frame with
/// it. Each of the two moves a point by a few roundings of its coordinates, which 2^-21 of the largest one
/// exceeds.
TreeBox BodyTree::posed(const Moving& moving, const Pose& pose) {
  const dmat3 turn = glm::mat3_cast(pose.orientation);
  const dvec3 center = pose.apply(moving.center),
              half = glm::abs(turn[0]) * moving.half.x + glm::abs(turn[1]) * moving.half.y +
                     glm::abs(turn[2]) * moving.half.z,
              reach = glm::abs(center) + half;
  const double room = 0x1p-21 * std::max({reach.x, reach.y, reach.z});
  return {vec3(center - half - room), vec3(center + half + room)};
}

void BodyTree::write(std::span<const Pose> poses, std::span<uint32_t> words) {
  TreeWriter writer(words);
  TreeBox all;
  for (size_t i = 0; i < bodies_.size(); ++i) {
    boxes_[i] = posed(bodies_[i], poses[bodies_[i].body]);
    all.add(boxes_[i]);
  }
  const TreeFrame frame(all);
  std::iota(order_.begin(), order_.end(), 0u);
  const uint32_t root = bodies_.empty()
                            ? shared::tree_none
                            : Division(*this, order_, frame, writer).divide(0, order_.size()).reference;
  writer.put(0, frame.low(), root);
  writer.put(1, frame.step(), 0);
}

}  // namespace greatx::scene
