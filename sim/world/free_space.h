// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Judges drawn trajectories by a world: whether the model of a node keeps its clearance from the static world
// and from the other nodes.
#pragma once

#include <vector>

#include "sim/scenario/trajectory.h"
#include "sim/world/solids.h"
#include "sim/world/world.h"

namespace greatx::sim {

/// A node fills a sphere about its origin that holds its model, however its parts turn, and the places of its
/// sensors. A course keeps clear if, from the first tick to the last, the sphere stays `clearance_m` from
/// every surface of the static world and from the spheres of the other nodes, and begins outside of solids.
///
/// The course is followed by conservative advancement: no surface can come nearer than the present distance
/// less the way that the fastest speed allows, so the next look is at the time when that is used up. A look
/// asks for `slack_m` more than the clearance, and a step is at least as long as half of that lasts. Hence
/// the clearance itself is kept at every instant, and a course is refused in vain only if it keeps less than
/// `slack_m` more.
class WorldFreeSpace : public FreeSpace {
 public:
  static constexpr double slack_m = 2e-3;

  /// Both outlive this.
  WorldFreeSpace(const Scenario& scenario, const World& world);
  std::optional<Obstacle> too_near(uint32_t node, double clearance_m, const Course& course,
                                   std::span<const Neighbour> neighbours, double end_s) const override;
  /// Returns the radius of a node's sphere, m.
  double radius_m(uint32_t node) const { return radii_[node]; }

 private:
  const World& world_;
  std::vector<double> radii_;       ///< [nodes]
  std::vector<uint8_t> is_static_;  ///< [nodes] the node is part of the static world, or fills nothing
};

}  // namespace greatx::sim
