// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tells on the host, at very low cost, that a point is outside all foliage.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "rf/facets/facet_kind.h"
#include "scene/description/scene.h"

namespace greatx::rf {

/// Holds the foliage of the static world as boxes around its volumes, and a grid of the cells that the boxes
/// touch. A volume is the region that a group of foliage facets encloses; facets belong to one group if they
/// touch within `touch_m`.
class FoliageVolumes {
 public:
  static constexpr double touch_m = 0.01;

  /// `kinds`: [facets of the scene].
  FoliageVolumes(const scene::Scene& scene, const FacetKinds& kinds);

  /// Returns false only if `point` (local coordinates) is at least 0.1 m outside the box of every volume.
  bool may_contain(const dvec3& point) const;
  /// Returns the boxes of the volumes, in an unspecified order that never changes.
  const std::vector<scene::Bounds>& boxes() const { return boxes_; }

 private:
  void make_grid();
  std::vector<scene::Bounds> boxes_;
  dvec3 corner_{0.0};  ///< least corner of the grid
  double cell_m_ = 1.0;
  size_t cells_[3] = {0, 0, 0};
  std::vector<uint8_t> touched_;  ///< [x, y, z]: 1 if a box touches the cell
};

}  // namespace greatx::rf
