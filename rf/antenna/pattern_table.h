// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A field pattern given by samples, as measured or computed elsewhere.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rf/antenna/spherical.h"

namespace greatx::rf {

/// Samples of (F_theta, F_phi) on a regular grid of the sphere: zenith i * pi/(zeniths - 1), both poles
/// included; azimuth first_azimuth + j * 2 pi/azimuths, once around.
///
/// Between them each component is interpolated bilinearly, as a complex amplitude, over zenith and azimuth.
/// For a component that is twice differentiable the error is at most
///     (dtheta^2 max|d^2 F/dtheta^2| + dphi^2 max|d^2 F/dphi^2|) / 8,
/// steps and derivatives in rad: halving the steps quarters it. At a bend of the pattern (TR 38.901's element
/// where its attenuation meets the floor) it falls with the step alone. The poles need no rule of their own:
/// components are smooth in (theta, phi) up to them, and on the z axis azimuth is 0, as everywhere in
/// rf/antenna. Amplitudes whose phase turns by much of a turn from sample to sample (a phase centre
/// wavelengths off the origin) interpolate badly: the bound says so.
class PatternTable {
 public:
  struct Grid {
    uint32_t zeniths = 0, azimuths = 0;  ///< at least 3, at least 4
    double first_azimuth = 0.0;          ///< rad
  };
  /// `samples`: [zeniths, azimuths], C order, finite. `name` and `sha256` are those of the file it came
  /// from; without a hash it is that of the samples.
  PatternTable(const Grid& grid, std::vector<Jones> samples, std::string name = {}, std::string sha256 = {});

  /// The pattern at zenith in [0, pi] and any azimuth, rad.
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
