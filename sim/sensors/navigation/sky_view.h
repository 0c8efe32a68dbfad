// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds out which satellites a GNSS antenna sees between buildings, and which it hears by a reflection.
#pragma once

#include <span>
#include <vector>

#include "rf/facets/placement.h"
#include "sim/navigation/gnss.h"
#include "sim/world/world.h"

namespace greatx::sim {

/// The surfaces of a world that hide satellites: all but foliage, which the signal passes here. Every surface
/// of any body hides; only walls of the static world reflect.
class SkyView {
 public:
  explicit SkyView(const World& world);  ///< outlives this

  /// Describes an antenna at one instant, in local coordinates.
  struct Antenna {
    dvec3 position{0.0}, velocity{0.0};
    std::span<const Pose> body_poses;
    uint32_t own_body = 0;  ///< whose surfaces do not count; 0: none
  };
  /// Returns what the antenna has in each direction. A hidden satellite is heard over the plane wall with the
  /// shortest path, if the antenna sees the mirror image of the satellite in it and the wall sees the
  /// satellite. Walls are looked for along rays in all directions around the antenna, so that a wall which
  /// none of them meets is missed. `reflections`: otherwise hidden satellites are lost. The arguments outlive
  /// the result.
  navigation::Sky sky(const Antenna& antenna, bool reflections) const;

 private:
  /// A plane wall: n . x = offset, seen from its front.
  struct Wall {
    dvec3 normal{0.0};
    double offset = 0.0;
  };
  std::vector<Wall> walls_around(const Antenna& antenna) const;
  std::optional<navigation::SignalPath> reflected(const Antenna& antenna, std::span<const Wall> walls,
                                                  const dvec3& direction) const;

  const World& world_;
  rf::Surroundings surfaces_;
};

}  // namespace greatx::sim
