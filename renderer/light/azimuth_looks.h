// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The places at which one looks for what stands around a point of a field of cells.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "core/units.h"
#include "core/vec.h"

namespace greatx::render {

/// Holds distances that grow, and the steps to them along azimuths, in cells. They are the same for all
/// points of a field.
template <int azimuths>
struct AzimuthLooks {
  AzimuthLooks(double cell_m, double first_m, double farthest_m, double growth_of_distance)
      : growth(growth_of_distance) {
    for (double distance = first_m; distance < farthest_m; distance = after(distance))
      distances.push_back(distance);
    for (int k = 0; k < azimuths; ++k) {
      const double azimuth = (k + 0.5) * 2.0 * pi / azimuths;
      along[k] = {std::cos(azimuth), std::sin(azimuth)};
      for (const double distance : distances) steps[k].push_back(along[k] * (distance / cell_m));
    }
  }
  /// Returns the distance that follows one.
  double after(double distance) const { return distance * growth + 0.1; }

  double growth;
  std::vector<double> distances;
  std::array<dvec2, azimuths> along;
  std::array<std::vector<dvec2>, azimuths> steps;
};

}  // namespace greatx::render
