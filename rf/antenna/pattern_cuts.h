// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Completes a pattern that is known in two planes only, and integrates patterns over the sphere.
#pragma once

#include <string>
#include <vector>

#include "rf/antenna/pattern_table.h"

namespace greatx::rf {

/// Holds what a data sheet gives of an antenna: attenuations in dB (0 or more) below its largest gain.
struct PatternCuts {
  double gain_dbi = 0.0;  ///< the largest gain
  /// [azimuths]: in the plane z = 0 at the azimuths j * 2 pi/azimuths, counter-clockwise seen from above. At
  /// least 4 values.
  std::vector<double> horizontal_db;
  /// [once around]: in the plane y = 0 at the elevations i * 2 pi/size, from +x over +z. A multiple of 4
  /// values, at least 4: the second quarter is behind the antenna.
  std::vector<double> vertical_db;
};

/// Returns the pattern on the sphere: F_theta is the root of the gain, and F_phi is 0. With the attenuations
/// H and V of the cuts, at azimuth phi from -pi to pi and elevation e,
///     A = H(phi) + (1 - t) (V(e) - H(0)) + t (V(pi - e) - H(pi)),  t = |phi|/pi.
/// This is the horizontal projection interpolation of Altair WinProp (WinProp User Guide, "Horizontal
/// Projection Interpolation (HPI) Algorithm"), written for attenuations. If H(0) = V(0) and H(pi) = V(pi), it
/// gives both cuts again. It is exact if A is a sum of a function of azimuth and one of elevation, as it is
/// for a vertical dipole and for TR 38.901's element above its floor. At the poles the formula would depend
/// on azimuth; they get V(pi/2) and V(-pi/2) themselves. `name` and `sha256` are those of the table.
PatternTable pattern_of_cuts(const PatternCuts& cuts, std::string name, std::string sha256);

/// Returns the mean of |F|^2 over the sphere: the power that is radiated, as a fraction of the power that the
/// gain refers to. It is 1 for a directivity. The sum over azimuths is the trapezoidal rule; zeniths have the
/// weights of C. W. Clenshaw and A. R. Curtis, "A method for numerical integration on an automatic computer",
/// Numerische Mathematik 2 (1960), since the mean over azimuth is a smooth function of cos(theta). The result
/// is exact for a field of spherical harmonics of an order below half the number of steps.
double mean_gain(const PatternTable& table);

}  // namespace greatx::rf
