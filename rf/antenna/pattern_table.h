// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds a field pattern as samples that were measured or computed elsewhere.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rf/antenna/spherical.h"

namespace greatx::rf {

/// Holds samples of (F_theta, F_phi) on a regular grid of the sphere. Zenith i is i * pi/(zeniths - 1), with
/// both poles included. Azimuth j is first_azimuth + j * 2 pi/azimuths, once around.
///
/// Each component is interpolated bilinearly, as a complex amplitude, over zenith and azimuth. For a
/// component that is twice differentiable the error is at most
///     (dtheta^2 max|d^2 F/dtheta^2| + dphi^2 max|d^2 F/dphi^2|) / 8,
/// with steps and derivatives in rad: half the step gives a quarter of the error. At a bend of the pattern
/// (where the attenuation of TR 38.901's element reaches its limit) the error is only proportional to the
/// step. The poles need no special rule: the components are smooth in (theta, phi) up to the poles, and
/// azimuth is 0 on the z axis, as everywhere in rf/antenna. The bound also shows that amplitudes interpolate
/// badly if their phase turns by a large part of a turn between samples, as it does when the phase centre is
/// wavelengths away from the origin.
class PatternTable {
 public:
  struct Grid {
    uint32_t zeniths = 0, azimuths = 0;  ///< at least 3 zeniths and 4 azimuths
    double first_azimuth = 0.0;          ///< rad
  };
  /// `samples`: [zeniths, azimuths], C order, finite. `name` and `sha256` describe the file that the samples
  /// came from. If `sha256` is empty, the table hashes its grid and samples.
  PatternTable(const Grid& grid, std::vector<Jones> samples, std::string name = {}, std::string sha256 = {});

  /// Returns the pattern at a zenith in [0, pi] and any azimuth, rad.
  Jones at(double zenith, double azimuth) const;

  const Grid& grid() const { return grid_; }
  const std::vector<Jones>& samples() const { return samples_; }
  const std::string& name() const { return name_; }
  const std::string& sha256() const { return sha256_; }

 private:
  Grid grid_;
  double per_zenith_, per_azimuth_;  ///< samples per rad
  std::vector<Jones> samples_;
  std::string name_, sha256_;
};

}  // namespace greatx::rf
