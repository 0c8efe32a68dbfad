// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace greatx::rf {

/// Holds a row of ITU-R P.676-13, Annex 1, Table 1.
struct OxygenLine {
  double f0_ghz;
  double a1;      ///< line strength, 1e-7 kHz/hPa
  double a2;      ///< temperature dependence of the strength
  double a3;      ///< line width, 1e-4 GHz/hPa
  double a4;      ///< temperature dependence of the width
  double a5, a6;  ///< interference of overlapping lines, 1e-4/hPa
};

/// Holds a row of ITU-R P.676-13, Annex 1, Table 2.
struct WaterVapourLine {
  double f0_ghz;
  double b1;      ///< line strength, 0.1 kHz/hPa
  double b2;      ///< temperature dependence of the strength
  double b3, b4;  ///< line width, 1e-4 GHz/hPa, and its temperature dependence
  double b5, b6;  ///< self-broadening by water vapour and its temperature dependence
};

/// Returns the 44 lines of oxygen.
std::span<const OxygenLine> oxygen_lines();
/// Returns the 35 lines of water vapour. The last one represents all lines above 1 THz.
std::span<const WaterVapourLine> water_vapour_lines();

}  // namespace greatx::rf
