// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes the words of shaders/shared/tree.h.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>

#include "core/error.h"
#include "scene/device/sah_tree.h"
#include "shaders/shared/tree.h"

namespace greatx::scene {

/// Holds the grid of the boxes' corners, with the shader's own numbers.
class TreeFrame {
 public:
  explicit TreeFrame(const TreeBox& box) {
    if (box.empty()) return;
    const vec3 reach = glm::max(glm::abs(box.min), glm::abs(box.max));
    // a lower limit for flat worlds
    const float least = std::max({reach.x, reach.y, reach.z, 1.0f}) * 0x1p-20f;
    low_ = box.min;
    // The step is a little larger than needed, so that the last step lies beyond the box however the division
    // was rounded.
    step_ = glm::max(box.max - box.min, vec3(least)) * (1.0001f / static_cast<float>(shared::tree_steps));
  }
  const vec3& low() const { return low_; }
  const vec3& step() const { return step_; }
  uint32_t below(const vec3& point, int axis) const { return whole(std::floor(steps(point, axis))); }
  uint32_t above(const vec3& point, int axis) const { return whole(std::ceil(steps(point, axis))); }

 private:
  double steps(const vec3& point, int axis) const {
    return (static_cast<double>(point[axis]) - low_[axis]) / step_[axis];
  }
  static uint32_t whole(double steps) {
    GREATX_CHECK(steps >= 0.0 && steps <= shared::tree_steps, "a corner {} steps into the frame", steps);
    return static_cast<uint32_t>(steps);
  }

  vec3 low_{0.0f}, step_{1.0f};
};

/// Writes quadruples into words [4 * quads].
class TreeWriter {
 public:
  explicit TreeWriter(std::span<uint32_t> words) : words_(words) {}
  void put(size_t quad, uint32_t x, uint32_t y, uint32_t z, uint32_t w) {
    const std::span<uint32_t> words = words_.subspan(4 * quad, 4);
    words[0] = x, words[1] = y, words[2] = z, words[3] = w;
  }
  void put(size_t quad, const vec3& value, uint32_t last) {
    put(quad, std::bit_cast<uint32_t>(value.x), std::bit_cast<uint32_t>(value.y),
        std::bit_cast<uint32_t>(value.z), last);
  }
  /// Writes a child of an inner node. Its box is rounded outwards to steps of the frame.
  void put_child(size_t quad, const TreeFrame& frame, const TreeBox& box, uint32_t reference) {
    put(quad, frame.below(box.min, 0) | frame.below(box.min, 1) << 16,
        frame.below(box.min, 2) | frame.above(box.max, 0) << 16,
        frame.above(box.max, 1) | frame.above(box.max, 2) << 16, reference);
  }

 private:
  std::span<uint32_t> words_;
};

}  // namespace greatx::scene
