// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Describes the power that a rough surface sends back to a radar: its normalized radar cross-section sigma0,
// m^2 per m^2 of the surface, over the grazing angle psi and the frequency f.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace greatx::scene {

enum class ClutterForm : unsigned char {
  /// sigma0 = level + angle log10(psi/20 deg) + frequency log10(f/10 GHz), dB (G. P. Kulemin,
  /// "Millimeter-Wave Radar Targets and Clutter", Artech House, 2003).
  kulemin,
  /// sigma0 = gamma(f) sin(psi) with gamma = level + frequency log10(f/10 GHz), dB (M. W. Long, "Radar
  /// Reflectivity of Land and Sea", 3rd ed., Artech House, 2001).
  constant_gamma,
  /// Water: V. Gregers-Hansen, R. Mital, "An improved empirical model for radar sea clutter reflectivity",
  /// IEEE Trans. Aerosp. Electron. Syst. 48(4), 2012; `sea_state` 0 to 6.
  sea
};

/// The model of a surface. Cross-polarized power is `cross_db` relative to the mean of HH and VV.
struct SurfaceClutter {
  ClutterForm form = ClutterForm::kulemin;
  double level_db = 0.0;
  double angle_db = 0.0;      ///< per decade of the grazing angle
  double frequency_db = 0.0;  ///< per decade of frequency
  double sea_state = 0.0;
  double cross_db = -10.0;
  friend bool operator==(const SurfaceClutter&, const SurfaceClutter&) = default;
};

/// Returns the model called `name`, or nothing. docs/clutter.md has the table with sources and validity.
std::optional<SurfaceClutter> clutter_called(const std::string& name);
/// Returns every name that clutter_called() knows.
std::vector<std::string> clutter_names();

/// sigma0, linear, in the polarizations horizontal and vertical to the surface.
struct Backscatter {
  double hh = 0.0, vv = 0.0, hv = 0.0;
};
/// `sine` is that of the grazing angle, 0 to 1; `frequency_hz` is above 0.
Backscatter backscatter(const SurfaceClutter& clutter, double sine, double frequency_hz);

}  // namespace greatx::scene
