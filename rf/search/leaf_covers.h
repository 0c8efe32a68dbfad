// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds the polygons that may hide something in a leaf of BeamCells, nearest first. A leaf may hold tens of
// thousands of them, because a beam that leaves the ground of a city sees all of it near the horizon. What is
// hidden there is mostly hidden by the nearest few.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "rf/search/convex.h"
#include "scene/description/box_tree.h"

namespace greatx::rf {

struct LeafCover {
  SlopeRect box;
  double min_depth = 0.0;           ///< of its facet in the leaf
  uint32_t facet = 0, polygon = 0;  ///< of the view
};

class LeafCovers {
 public:
  void clear() { covers_.clear(); }
  /// Covers are added by ascending min_depth.
  void add(const LeafCover& cover) { covers_.push_back(cover); }
  /// Must be called after the last cover.
  void build();

  /// Calls visit(cover), in the order of the covers, for those whose boxes overlap `box` and whose min_depth
  /// is at most `depth`, until it returns true. Returns whether it did. The cost is that of the covers
  /// visited, with a few more and a logarithm.
  template <typename Visit>
  bool visit_until(const SlopeRect& box, double depth, const Visit& visit);
  /// Returns the number of covers compared with a box since this object was made.
  uint64_t compared() const { return compared_; }

 private:
  /// A range of covers_ with a tree of its own. Each is as large as all before it: what is hidden by covers
  /// near the beginning needs no look at the large trees.
  struct Block {
    uint32_t first = 0;
    scene::BoxTree tree;
  };
  /// Number of covers at the beginning that are tried one after the other.
  static constexpr uint32_t first_block = 128;

  std::vector<LeafCover> covers_;
  std::vector<Block> blocks_;
  std::vector<scene::Bounds> bounds_;
  std::vector<uint32_t> found_;
  uint64_t compared_ = 0;
};

template <typename Visit>
bool LeafCovers::visit_until(const SlopeRect& box, double depth, const Visit& visit) {
  const size_t near = std::min<size_t>(covers_.size(), first_block);
  for (size_t i = 0; i < near; ++i) {
    if (covers_[i].min_depth > depth) return false;
    ++compared_;
    if (covers_[i].box.overlaps(box) && visit(covers_[i])) return true;
  }
  const auto outside = [&](const scene::Bounds& bounds) {
    return bounds.min.x > box.max_a || bounds.max.x < box.min_a || bounds.min.y > box.max_b ||
           bounds.max.y < box.min_b;
  };
  for (const Block& block : blocks_) {
    if (covers_[block.first].min_depth > depth) return false;
    found_.clear();
    block.tree.visit_until(outside, [&](uint32_t index) {
      const LeafCover& cover = covers_[block.first + index];
      ++compared_;
      if (cover.min_depth <= depth && cover.box.overlaps(box)) found_.push_back(block.first + index);
      return false;
    });
    std::sort(found_.begin(), found_.end());
    for (const uint32_t index : found_)
      if (visit(covers_[index])) return true;
  }
  return false;
}

}  // namespace greatx::rf
