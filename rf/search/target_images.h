// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds the mirror images of a target in every facet and finds those inside a beam.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/vec.h"
#include "rf/search/beam_scene.h"
#include "rf/search/beam_search.h"

namespace greatx::rf {

/// Describes everything that straight lines from `apex` reach through a rectangle in a mirror's plane, beyond
/// the mirror. Without a mirror it describes everything.
struct Pyramid {
  dvec3 apex{0.0};
  bool mirror = false;
  dvec3 normal{0.0};  ///< normal of the mirror, towards the paths
  double offset = 0.0;
  dvec3 center{0.0}, half_a{0.0}, half_b{0.0};  ///< the rectangle, widened by possible roundings
  std::array<HalfSpace, 5> sides;  ///< contain the pyramid; sides that roundings could turn are left out
  uint32_t side_count = 0;

  std::span<const HalfSpace> region() const { return std::span(sides).first(side_count); }
};

/// Returns the pyramid of a beam that leaves `mirror`. `extent_m`: no coordinate of the scene is larger.
/// Returns none if the image lies in the mirror's plane, so that nothing is reflected.
std::optional<Pyramid> make_pyramid(const SequenceBeam& beam, const BeamFacet& mirror, double extent_m);

/// Returns the part of a facet's rectangle that lies in a pyramid, as the beam that goes on from there; none
/// if there is no such part.
std::optional<SequenceBeam> cut_to(const Pyramid& pyramid, const BeamFacet& facet);

/// Holds the images of one target in facets of a scene, in a tree of boxes.
class TargetImages {
 public:
  /// Takes all facets of the scene, or those of `seen`, ascending.
  TargetImages(const BeamScene& scene, const dvec3& target);
  TargetImages(const BeamScene& scene, const dvec3& target, std::span<const uint32_t> seen);

  /// Calls visit(facet) for every facet of the BeamScene over which a path from the pyramid may reach the
  /// target. The order depends on the scene and the target alone.
  template <typename Visit>
  void reached_from(const Pyramid& pyramid, const Visit& visit) const {
    if (nodes_.empty()) return;
    const Sides sides = sides_of(pyramid);
    uint32_t stack[256], size = 0;
    stack[size++] = 0;
    while (size > 0) {
      const Node& node = nodes_[stack[--size]];
      std::array<float, lanes> least = within(node, sides);
      for (uint32_t lane = 0; lane < node.count; ++lane) {
        if (least[lane] < 0.0f) continue;
        if (!node.leaf)
          stack[size++] = node.first + lane;
        else if (const Image& image = images_[node.first + lane]; joins(pyramid, image))
          visit(image.facet);
      }
    }
  }

 private:
  static constexpr uint32_t lanes = 8;
  struct Image {
    dvec3 position{0.0};
    uint32_t facet = 0;
  };
  /// Holds boxes around up to eight children, or around images (boxes without size). They are in fp32 and
  /// side by side, because a search spends most of its time on them.
  struct Node {
    float center[3][lanes] = {}, half[3][lanes] = {};
    uint32_t first = 0, count = 0;  ///< range of children, or of images in a leaf
    bool leaf = true;
  };
  /// Holds the sides of a pyramid in fp32, with room for its rounding.
  struct Sides {
    float normal[5][3], span[5][3], offset[5];  ///< span: |normal|
    uint32_t count = 0;
  };
  Sides sides_of(const Pyramid& pyramid) const;
  /// Returns how far each child reaches into all half-spaces; < 0 if it is outside one of them.
  static std::array<float, lanes> within(const Node& node, const Sides& sides);
  bool joins(const Pyramid& pyramid, const Image& image) const;
  void add(uint32_t facet, const dvec3& target);
  void plant();
  void build(uint32_t node, uint32_t first, uint32_t count);

  const BeamScene* scene_;
  std::vector<Image> images_;
  std::vector<Node> nodes_;
  double extent_m_ = 0.0;  ///< largest coordinate of an image
};

}  // namespace greatx::rf
