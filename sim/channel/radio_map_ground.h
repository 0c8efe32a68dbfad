// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What lies beneath the cells of a radio map that is draped over the scene. fp64, on the host.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/vec.h"
#include "scene/description/scene.h"
#include "scene/description/triangle_tree.h"

namespace greatx::sim {

/// What a map is draped over. `ground`: where people and cars are: the highest surface of the classes ground,
/// road, pavement, lane_marking and water; in a scene that has none of them, the lowest surface that faces
/// up. `roofs`: the highest surface of ground and buildings (all classes but vegetation, poles, lamps, masts,
/// vehicles, UAVs, furniture and people): what a flying platform has beneath.
enum class MapOver { ground, roofs };

/// Vertical lines through everything that never moves.
class GroundHeights {
 public:
  /// `scene` may go afterwards.
  GroundHeights(const scene::Scene& scene, MapOver over);

  /// World z of the surface at world (x, y); none: nothing lies there. Edges belong to their triangles.
  /// Thread-safe.
  std::optional<double> at(const dvec2& world) const;
  /// Which surfaces count, in words.
  const std::string& rule() const { return rule_; }

 private:
  dvec3 origin_{0.0};
  std::string rule_;
  bool lowest_ = false;  ///< of several surfaces
  double below_ = 0.0, above_ = 0.0;
  std::vector<scene::FacetTriangle> triangles_;
  scene::TriangleTree tree_;
};

}  // namespace greatx::sim
