// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Gathers the light that the surroundings send to a place, for the effect `bounced_light`.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/vec.h"
#include "renderer/light/azimuth_looks.h"
#include "renderer/light/surroundings.h"

namespace greatx::render {

/// Light that surfaces send to a place: the irradiance over pi of a surface that faces along +x, -x, +y, -y,
/// +z or -z. For another normal n it is c + v . n + w n_z^2, where c is the mean of the four level
/// directions. The values up and down are kept so, and the others if both level axes get the same light.
struct BouncedLight {
  std::array<dvec3, 6> facing{};
  dvec3 constant() const { return 0.25 * (facing[0] + facing[1] + facing[2] + facing[3]); }
  dvec3 along(int axis) const { return 0.5 * (facing[2 * axis] - facing[2 * axis + 1]); }
  dvec3 upright() const { return 0.5 * (facing[4] + facing[5]) - constant(); }
  dvec3 over_pi(const dvec3& n) const {
    return glm::max(constant() + along(0) * n.x + along(1) * n.y + along(2) * n.z + upright() * (n.z * n.z),
                    dvec3(0.0));
  }
};

class LightGathering {
 public:
  /// `surroundings` outlives this.
  explicit LightGathering(const Surroundings& surroundings);
  /// Gathers the light that surfaces send to a point at a height over the floor. It looks along 16 azimuths.
  BouncedLight at(const dvec2& place, double height) const;
  /// Gathers the light from above the horizon alone, which is that of level ground: its irradiance over pi.
  dvec3 on_ground(const dvec2& place, double height) const;

 private:
  class Bands;
  class Hidden;
  /// What a gathering reads of each cell at which it looks, apart from the rest so that it stays in caches.
  struct Column {
    float top, bottom, ground;
  };
  /// A part of a wall between two heights, which sends one radiance.
  struct WallPart {
    double bottom, top;
    dvec3 radiance;
  };
  struct WallParts {
    std::array<WallPart, 3> part;
    size_t count = 0;
    void add(double bottom, double top, const dvec3& radiance) {
      if (top > bottom) part[count++] = {bottom, top, radiance};
    }
  };
  WallParts wall_seen(size_t i, double distance, int azimuth) const;
  bool stands(size_t i) const { return columns_[i].top > columns_[i].ground + low_thing_m; }
  std::optional<size_t> column_at(const dvec2& place, int azimuth, double distance) const;
  double first_standing(const dvec2& place, int azimuth, double nearer, double farther) const;
  void look_along(const dvec2& place, double height, int azimuth, Bands& bands) const;

  const Surroundings* surroundings_;
  AzimuthLooks<16> looks_;
  std::vector<Column> columns_;
};

}  // namespace greatx::render
