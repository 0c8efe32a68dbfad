// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Gathers the light that the surroundings send to places, for the effect `bounced_light`.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "renderer/light/azimuth_looks.h"
#include "renderer/light/surroundings.h"

namespace greatx::render {

/// Light that surfaces send to a place: real spherical harmonics of order 1 of the irradiance over pi, as a
/// constant and a vector: c + v . n.
struct BouncedLight {
  dvec3 constant{0.0};
  std::array<dvec3, 3> along{};  ///< for x, y, z
  dvec3 over_pi(const dvec3& n) const {
    return glm::max(constant + along[0] * n.x + along[1] * n.y + along[2] * n.z, dvec3(0.0));
  }
};

class LightGathering {
 public:
  /// `surroundings` outlives this.
  explicit LightGathering(const Surroundings& surroundings);
  /// Gathers the light that surfaces send to a point at a height over the floor. It looks along 16 azimuths.
  BouncedLight at(const dvec2& place, double height) const;

 private:
  class Bands;
  /// What a gathering reads of each cell at which it looks, apart from the rest so that it stays in caches.
  struct Column {
    float top, bottom, ground;
  };
  void look_along(const dvec2& middle, double height, int azimuth, Bands& bands) const;

  const Surroundings* surroundings_;
  AzimuthLooks<16> looks_;
  std::vector<Column> columns_;
};

/// Appends the words of `columns` x `rows` places (shaders/shared/surroundings.h): the light at two heights
/// over the ground.
void put_bounced_light(std::vector<uint32_t>& words, const Surroundings& surroundings, uint32_t columns,
                       uint32_t rows);

}  // namespace greatx::render
