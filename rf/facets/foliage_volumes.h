// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Where foliage may be: tells, on the host and at next to no cost, that a point is outside of all of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "rf/facets/facet_kind.h"
#include "scene/description/scene.h"

namespace greatx::rf {

/// The foliage of the static world, as boxes around the volumes and a grid of the cells that they touch. A
/// volume is what facets of foliage enclose that touch each other, within `touch_m`.
class FoliageVolumes {
 public:
  static constexpr double touch_m = 0.01;

  /// `kinds`: [facets of the scene].
  FoliageVolumes(const scene::Scene& scene, const FacetKinds& kinds);

  /// False: `point` (local coordinates) is at least 0.1 m outside of every volume's box.
  bool may_contain(const dvec3& point) const;
  /// Boxes of the volumes, in no particular order but always the same.
  const std::vector<scene::Bounds>& boxes() const { return boxes_; }

 private:
  void make_grid();
  std::vector<scene::Bounds> boxes_;
  dvec3 corner_{0.0};  ///< of the grid
  double cell_m_ = 1.0;
  size_t cells_[3] = {0, 0, 0};
  std::vector<uint8_t> touched_;  ///< [x, y, z]: 1 where a box is
};

}  // namespace greatx::rf
