// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the surface beneath the cells of a radio map that is draped over the scene. fp64, on the host.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/vec.h"
#include "scene/description/scene.h"
#include "scene/description/triangle_tree.h"

namespace greatx::sim {

/// Selects the surface over which a map is draped. `ground` is the highest surface of the classes ground,
/// road, pavement, lane_marking and water, where people and cars are; in a scene that has none of them, it is
/// the lowest surface that faces up. `roofs` is the highest surface of ground and buildings, which a flying
/// platform has beneath it. It includes all classes but vegetation, poles, lamps, masts, vehicles, UAVs,
/// furniture and people.
enum class MapOver { ground, roofs };

/// Intersects vertical lines with everything that never moves.
class GroundHeights {
 public:
  /// `scene` need not outlive this.
  GroundHeights(const scene::Scene& scene, MapOver over);

  /// Returns the world z of the surface at world (x, y), or nothing if there is none. Edges belong to their
  /// triangles. Thread-safe.
  std::optional<double> at(const dvec2& world) const;
  /// Describes in words which surfaces count.
  const std::string& rule() const { return rule_; }

 private:
  dvec3 origin_{0.0};
  std::string rule_;
  bool lowest_ = false;  ///< takes the lowest of several surfaces, else the highest
  double below_ = 0.0, above_ = 0.0;
  std::vector<scene::FacetTriangle> triangles_;
  scene::TriangleTree tree_;
};

}  // namespace greatx::sim
