// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <functional>

#include "core/random.h"
#include "core/units.h"
#include "rf/antenna/antenna.h"

namespace greatx::rf {

inline double power(const Jones& field) { return std::norm(field.theta) + std::norm(field.phi); }

inline dvec3 direction_of(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

inline dvec3 random_direction(RandomStream& random) {
  const double z = random.uniform(-1.0, 1.0), azimuth = random.uniform(-pi, pi);
  const double rho = std::sqrt(1.0 - z * z);
  return {rho * std::cos(azimuth), rho * std::sin(azimuth), z};
}

/// Returns (1/4 pi) times the integral of the gain over the sphere, by the midpoint rule.
inline double mean_gain(const ElementPattern& pattern, double slant, int zeniths, int azimuths) {
  double sum = 0.0;
  for (int i = 0; i < zeniths; ++i) {
    const double theta = (i + 0.5) * pi / zeniths;
    for (int j = 0; j < azimuths; ++j)
      sum += power(element_field(pattern, slant, direction_of(theta, (j + 0.5) * 2.0 * pi / azimuths - pi))) *
             std::sin(theta);
  }
  return sum * pi / (2.0 * zeniths * azimuths);
}

/// Samples the pattern F_theta, F_phi = `field`(theta, phi) on a regular grid.
inline PatternTable sampled(uint32_t zeniths, uint32_t azimuths, double first_azimuth,
                            const std::function<Jones(double, double)>& field) {
  std::vector<Jones> samples;
  for (uint32_t i = 0; i < zeniths; ++i)
    for (uint32_t j = 0; j < azimuths; ++j)
      samples.push_back(field(i * pi / (zeniths - 1), first_azimuth + j * 2.0 * pi / azimuths));
  return PatternTable({zeniths, azimuths, first_azimuth}, std::move(samples));
}

/// Returns a pattern that exercises a whole table: it is complex, has both components and varies with
/// azimuth.
inline Jones curly_field(double theta, double phi) {
  return {Complex(std::sin(theta) * std::cos(phi), 0.3 * std::cos(theta)),
          Complex(0.2 * std::sin(phi), std::sin(theta) * std::sin(theta) * std::cos(2.0 * phi))};
}

}  // namespace greatx::rf
