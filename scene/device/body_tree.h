// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the tree of boxes around the bodies that move, which is made anew when one of them has moved.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "scene/description/scene.h"
#include "scene/device/sah_tree.h"

namespace greatx::scene {

class BodyTree {
 public:
  BodyTree() = default;
  explicit BodyTree(const Scene& scene);

  /// Returns whether no body that moves has triangles.
  bool empty() const { return bodies_.empty(); }
  /// Returns the number of words that `write` fills.
  size_t word_count() const;
  /// Writes the words that shaders/shared/tree.h lays out, for bodies at `poses` (local coordinates). A box
  /// holds its body however the device rounds the pose.
  void write(std::span<const Pose> poses, std::span<uint32_t> words);

 private:
  struct Moving {
    uint32_t body = 0;
    dvec3 center{0.0}, half{0.0};  ///< of its box, in its own frame
  };
  struct Subtree {
    uint32_t reference = 0;
    TreeBox box;
  };
  class Division;
  static TreeBox posed(const Moving& moving, const Pose& pose);

  std::vector<Moving> bodies_;
  std::vector<TreeBox> boxes_;   ///< where the bodies are, in the order of bodies_
  std::vector<uint32_t> order_;  ///< places in bodies_, as the tree divides them
};

}  // namespace greatx::scene
