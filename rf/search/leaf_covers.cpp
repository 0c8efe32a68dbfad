// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/search/leaf_covers.h"

namespace greatx::rf {

void LeafCovers::build() {
  blocks_.clear();
  for (size_t first = first_block; first < covers_.size(); first *= 2) {
    bounds_.clear();
    for (size_t i = first; i < std::min(covers_.size(), 2 * first); ++i) {
      const SlopeRect& box = covers_[i].box;
      scene::Bounds bounds;
      bounds.add(dvec3(box.min_a, box.min_b, 0.0));
      bounds.add(dvec3(box.max_a, box.max_b, 0.0));
      bounds_.push_back(bounds);
    }
    blocks_.push_back({static_cast<uint32_t>(first), scene::BoxTree(bounds_)});
  }
}

}  // namespace greatx::rf
