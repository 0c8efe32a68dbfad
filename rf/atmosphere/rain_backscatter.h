// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes what raindrops send back to a radar. Drops are spheres of water (water.h) of the sizes of J. S.
// Marshall, W. McK. Palmer, "The distribution of raindrops with size", J. Meteorol. 5(4), 1948:
//   N(D) = 8000 m^-3 mm^-1 e^{-4.1 mm^-1 R^{-0.21} D},   R in mm/h, D up to 7 mm.
// Each scatters by Mie's series (C. F. Bohren, D. R. Huffman, "Absorption and Scattering of Light by Small
// Particles", 1983, 4.88, 4.62 and section 4.6). A drop of D falls with 9.65 - 10.3 e^{-0.6 D/mm} m/s (D.
// Atlas, R. C. Srivastava, R. S. Sekhon, "Doppler radar characteristics of precipitation at vertical
// incidence", Rev. Geophys. 11(1), 1973).
#pragma once

namespace greatx::rf {

inline constexpr double rain_backscatter_min_hz = 1e9, rain_backscatter_max_hz = 300e9;
constexpr bool rain_backscatter_covers(double frequency_hz) {
  return frequency_hz >= rain_backscatter_min_hz && frequency_hz <= rain_backscatter_max_hz;
}

/// Holds cross-sections of a sphere, m^2.
struct SphereSections {
  double back = 0.0;        ///< radar cross-section
  double extinction = 0.0;  ///< absorbed and scattered
};
SphereSections sphere_sections(double diameter_m, double frequency_hz, double temperature_k);

struct RainBackscatter {
  double reflectivity_per_m = 0.0;    ///< eta: radar cross-section of a cubic metre, m^2/m^3
  double extinction_db_per_km = 0.0;  ///< for comparison with P.838
  double fall_m_s = 0.0;              ///< mean speed of fall, weighted with the cross-sections
  double fall_spread_m_s = 0.0;       ///< its standard deviation
};
/// Throws UserError if the frequency is not covered. Returns zeros without rain.
RainBackscatter rain_backscatter(double frequency_hz, double temperature_k, double rain_mm_h);

}  // namespace greatx::rf
