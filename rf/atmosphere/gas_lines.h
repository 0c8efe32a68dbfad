// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace greatx::rf {

/// A row of ITU-R P.676-13, Annex 1, Table 1.
struct OxygenLine {
  double f0_ghz;
  double a1;      ///< strength, 1e-7 kHz/hPa
  double a2;      ///< its dependence on temperature
  double a3;      ///< width, 1e-4 GHz/hPa
  double a4;      ///< its dependence on temperature
  double a5, a6;  ///< interference of overlapping lines, 1e-4/hPa
};

/// A row of ITU-R P.676-13, Annex 1, Table 2.
struct WaterVapourLine {
  double f0_ghz;
  double b1;      ///< strength, 0.1 kHz/hPa
  double b2;      ///< its dependence on temperature
  double b3, b4;  ///< width, 1e-4 GHz/hPa, and its dependence on temperature
  double b5, b6;  ///< broadening by water vapour itself and its dependence on temperature
};

std::span<const OxygenLine> oxygen_lines();             ///< 44
std::span<const WaterVapourLine> water_vapour_lines();  ///< 35; the last one stands for all lines above 1 THz

}  // namespace greatx::rf
