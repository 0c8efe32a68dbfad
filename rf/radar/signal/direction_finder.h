// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The direction whose beam is strongest.
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
  double power_w =
      0.0;  ///< of the beam: |mean of the antennas|^2; bistatic: mean over the transmitters of their receivers'
  dvec3 unit() const {
    return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
            std::sin(elevation)};
  }
};

/// Bartlett's beam (H. L. Van Trees, "Optimum Array Processing", 2002, 2.4 and 8.4): searched over the half
/// space in front of the array, x > 0, a fifth of a beam apart, then refined to 1e-7 rad. What the elements
/// cannot tell is 0: the elevation of a row along y, the azimuth of a column along z, both of one antenna. A
/// row reads the azimuth that its cone has at elevation 0.
class DirectionFinder {
 public:
  explicit DirectionFinder(const RadarSignalConfig& config);

  bool finds_azimuth() const { return azimuths_.size() > 1; }
  bool finds_elevation() const { return elevations_.size() > 1; }
  /// snapshot: [rx, tx], one cell of the spectrum with the delays of TDM taken out.
  Direction find(std::span<const std::complex<double>> snapshot) const;

 private:
  double power(std::span<const std::complex<double>> snapshot, double azimuth, double elevation) const;

  RadarSignalConfig config_;
  std::vector<double> azimuths_, elevations_;
  std::vector<std::complex<float>> steering_;  ///< [azimuths, elevations, rx, tx], conjugated
};

}  // namespace greatx::rf
