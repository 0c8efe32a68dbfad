// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the map of markings: seen from above, the share of each texel that lane markings cover. Far away,
// where a marking is thinner than a pixel, shading takes its share from this map (docs/camera.md).
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "gpu/cmd.h"
#include "scene/device/gpu_scene.h"
#include "shaders/shared/marks.h"

namespace greatx::render {

/// Holds the shares on the host, in square blocks of 2^marks_levels texels along a side. Most blocks have no
/// markings and are left out. Row 0 begins at the least y.
struct MarkShares {
  static constexpr uint32_t side = 1u << shared::marks_levels;
  dvec2 corner{0.0};  ///< local x, y of the first texel's corner
  double texel_m = 1.0;
  uint32_t columns = 0, rows = 0;  ///< of blocks
  std::vector<uint32_t> places;    ///< [rows, columns]: index of the block + 1; 0: no markings
  std::vector<float> shares;       ///< [block, side, side], 0 to 1
};

/// Returns whether a triangle's instance is a static road or a static marking: triangle_of_road,
/// triangle_of_mark or 0.
uint32_t marks_of(const scene::Scene& scene, const scene::Primitive& primitive);

/// Returns the exact share of every texel under markings, with at most `most` texels along a side and texels
/// of at least 6 cm. Markings that lie above one another count once at most.
MarkShares mark_shares(const scene::Scene& scene, uint32_t most = 4096);

class MarkMap {
 public:
  MarkMap() = default;
  /// Makes the map if `wanted`, else one of a single texel.
  MarkMap(const scene::GpuScene& scene, bool wanted);
  /// Whether the scene has markings, and the map is there.
  bool any() const { return any_; }
  static std::vector<gpu::Binding> bindings();
  std::vector<gpu::Descriptor> descriptors() const;

 private:
  bool any_ = false;
  gpu::Image map_;
  gpu::Sampler sampler_;
  gpu::Buffer block_;  ///< GpuMarks
};

}  // namespace greatx::render
