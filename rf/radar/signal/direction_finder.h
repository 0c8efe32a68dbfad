// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the direction in which the beam of an array is strongest.
#pragma once

#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "rf/config/radar_config.h"

namespace greatx::rf {

struct Direction {
  double azimuth = 0.0;    ///< rad from the array's x towards its y
  double elevation = 0.0;  ///< rad above its x-y plane
  /// Power of the beam, |mean of the antennas|^2. For a bistatic radar it is the mean, over the transmitters,
  /// of |mean of the receivers|^2.
  double power_w = 0.0;
  dvec3 unit() const {
    return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
            std::sin(elevation)};
  }
};

/// An array with a smaller extent along an axis, in wavelengths, does not measure the angle of that axis.
inline constexpr double least_extent_wavelengths = 0.05;
/// Returns the extent of the virtual antennas along an axis of the array, in wavelengths.
double extent_wavelengths(const RadarSignalConfig& config, const dvec3& axis);

/// Computes Bartlett's beam (H. L. Van Trees, "Optimum Array Processing", 2002, 2.4 and 8.4). The search
/// covers the half space x > 0 in front of the array in steps of a fifth of a beam. The maximum is then
/// refined to 1e-7 rad. An angle that the elements cannot measure is 0: the elevation for a row along y, the
/// azimuth for a column along z, and both for one antenna. A row gives the azimuth that its cone has at
/// elevation 0.
class DirectionFinder {
 public:
  explicit DirectionFinder(const RadarSignalConfig& config);

  bool finds_azimuth() const { return azimuths_.size() > 1; }
  bool finds_elevation() const { return elevations_.size() > 1; }
  /// Returns the direction of the strongest beam. `snapshot` is [rx, tx]: one cell of the spectrum, corrected
  /// for the delays of TDM.
  Direction find(std::span<const std::complex<double>> snapshot) const;

 private:
  /// `phasors` is working memory.
  double power(std::span<const std::complex<double>> snapshot, double azimuth, double elevation,
               std::vector<std::complex<double>>& phasors) const;

  RadarSignalConfig config_;
  std::vector<double> azimuths_, elevations_;
  std::vector<std::complex<float>> steering_;  ///< [azimuths, elevations, rx, tx], conjugated
};

}  // namespace greatx::rf
