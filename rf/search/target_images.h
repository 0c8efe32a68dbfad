// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A target as every facet mirrors it, and the beams that ask for it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/vec.h"
#include "rf/search/beam_scene.h"
#include "rf/search/beam_search.h"

namespace greatx::rf {

/// Everything that is reached on straight lines from `apex` through a rectangle in a mirror's plane, beyond it; or, without
/// a mirror, everything.
struct Pyramid {
  dvec3 apex{0.0};
  bool mirror = false;
  dvec3 normal{0.0};  ///< of the mirror, towards the paths
  double offset = 0.0;
  dvec3 center{0.0}, half_a{0.0}, half_b{0.0};  ///< of the rectangle, widened by what roundings can do
  std::array<HalfSpace, 5> sides;  ///< that hold all of it; those that roundings could turn are left out
  uint32_t side_count = 0;

  std::span<const HalfSpace> region() const { return std::span(sides).first(side_count); }
};

/// `extent_m`: no coordinate of the scene is larger. None: the image lies in its mirror, nothing is reflected.
std::optional<Pyramid> make_pyramid(const SequenceBeam& beam, const BeamFacet& mirror, double extent_m);

/// What of a facet's rectangle lies in a pyramid, as the beam that goes on from there; none: nothing.
std::optional<SequenceBeam> cut_to(const Pyramid& pyramid, const BeamFacet& facet);

/// The images of one target in the facets of a scene, in a tree of boxes.
class TargetImages {
 public:
  TargetImages(const BeamScene& scene, const dvec3& target);

  /// visit(facet) for every facet (BeamScene's) by which a path from the pyramid may reach the target, in an order that
  /// depends on the scene and the target alone.
  template <typename Visit>
  void reached_from(const Pyramid& pyramid, const Visit& visit) const {
    if (boxes_.empty()) return;
    uint32_t stack[64], size = 0;
    stack[size++] = 0;
    while (size > 0) {
      const Box& box = boxes_[stack[--size]];
      if (outside(box, pyramid)) continue;
      if (box.count == 0) {
        stack[size++] = box.first + 1;
        stack[size++] = box.first;
        continue;
      }
      for (uint32_t i = box.first; i < box.first + box.count; ++i)
        if (joins(pyramid, images_[i])) visit(images_[i].facet);
    }
  }

 private:
  struct Image {
    dvec3 position{0.0};
    uint32_t facet = 0;
  };
  struct Box {
    dvec3 center{0.0}, half{0.0};
    uint32_t first = 0, count = 0;  ///< count 0: an inner node, its children are first and first + 1
  };
  static bool outside(const Box& box, const Pyramid& pyramid);
  bool joins(const Pyramid& pyramid, const Image& image) const;
  void split(uint32_t box, uint32_t first, uint32_t count);

  const BeamScene* scene_;
  std::vector<Image> images_;
  std::vector<Box> boxes_;
};

}  // namespace greatx::rf
