// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds half-spaces in the frame of a body, and tells which boxes are outside one of them.
#pragma once

#include <array>
#include <span>

#include "core/error.h"
#include "core/vec.h"
#include "rf/facets/facet_world.h"
#include "scene/description/scene.h"

namespace greatx::rf {

/// The half-space normal . x + offset >= 0.
struct KeptSide {
  dvec3 normal{0.0};
  double offset = 0.0;
};

/// Turns a half-space of local coordinates into the frame of a body with the given pose.
inline KeptSide in_body(const KeptSide& side, const Pose& pose) {
  return {glm::conjugate(pose.orientation) * side.normal, side.offset + glm::dot(side.normal, pose.position)};
}

class BodySpaces {
 public:
  /// Turns half-spaces of local coordinates into the frame of `body`.
  BodySpaces(std::span<const KeptSide> spaces, const FacetWorld& world, uint32_t body)
      : count_(spaces.size()) {
    GREATX_CHECK(count_ <= spaces_.size(), "{} half-spaces", count_);
    for (size_t i = 0; i < count_; ++i) {
      const KeptSide side = body == 0 ? spaces[i] : in_body(spaces[i], world.motion(body).pose);
      spaces_[i] = {side.normal, glm::abs(side.normal), side.offset};
    }
  }
  /// Returns whether all of a box lies outside one of the half-spaces.
  bool outside(const scene::Bounds& box) const {
    const dvec3 center = box.center(), half = 0.5 * (box.max - box.min);
    for (size_t i = 0; i < count_; ++i)
      if (glm::dot(spaces_[i].normal, center) + spaces_[i].offset + glm::dot(spaces_[i].reach, half) < 0.0)
        return true;
    return false;
  }

 private:
  struct Space {  // members stay uninitialized
    dvec3 normal, reach;
    double offset;
  };
  std::array<Space, 8> spaces_;
  size_t count_;
};

}  // namespace greatx::rf
