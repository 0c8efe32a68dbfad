// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/daylight/twilight.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/units.h"

namespace greatx::render {

namespace {

/// Describes a piece of log10(lux) = a + b x + c x^2 + d x^3 with x = elevation / 90 degrees, from `low` up
/// to the next piece.
struct Piece {
  double low;  ///< degrees
  double a, b, c, d;
  double log_lux(double elevation_deg) const {
    const double x = elevation_deg / 90.0;
    return a + x * (b + x * (c + x * d));
  }
};

constexpr Piece sun_pieces[] = {
    {-18.0, 13.84, 262.72, 1447.42, 2797.93}, {-12.0, 2.70, 12.17, -431.69, -1899.83},
    {-5.0, 2.88, 21.81, -258.11, -858.36},    {-0.8, 2.88, 22.26, -207.64, 1034.30},
    {5.0, 3.05, 13.28, -45.98, 64.33},        {20.0, 3.74, 3.97, -4.07, 1.47}};

constexpr Piece moon_pieces[] = {{-0.8, -2.79, 24.27, -252.95, 1321.29},
                                 {5.0, -2.58, 12.58, -42.58, 59.06},
                                 {20.0, -1.95, 4.06, -4.24, 1.56}};

double lux_of(std::span<const Piece> pieces, double elevation_deg) {
  double value = pieces[0].log_lux(elevation_deg);
  for (const Piece& piece : pieces.subspan(1)) {
    constexpr double half = 0.25;  // degrees over which two pieces are blended
    const double share = std::clamp((elevation_deg - piece.low + half) / (2.0 * half), 0.0, 1.0);
    if (share > 0.0) value = std::lerp(value, piece.log_lux(elevation_deg), share);
  }
  return std::pow(10.0, value);
}

}  // namespace

double sunlight_lux(double elevation) {
  // At -18 degrees the cubics give natural_night_lux to its last digit, so the larger of the two is
  // continuous.
  const double h = degrees(elevation);
  return h <= -18.0 ? natural_night_lux : std::max(natural_night_lux, lux_of(sun_pieces, h));
}

double full_moonlight_lux(double elevation) {
  const double h = degrees(elevation);
  if (h <= -2.0) return 0.0;
  return lux_of(moon_pieces, h) * std::clamp((h + 2.0) / 1.2, 0.0, 1.0);
}

double night_sky_lux(double zenith_cd_m2) { return 4.0 / 3.0 * pi * zenith_cd_m2; }

double night_shape(double z) { return 1.0 + 2.0 * (1.0 - z) * (1.0 - z); }

double moon_phase_share(double phase_angle) {
  const double i = std::abs(degrees(phase_angle));
  return std::pow(10.0, -0.4 * (0.026 * i + 4e-9 * i * i * i * i));
}

double overcast_lux(double elevation) {
  const double clear = 0.2 * sunlight_lux(elevation);
  const double cover = 300.0 + 21000.0 * std::sin(elevation);
  return std::lerp(clear, cover, std::clamp(degrees(elevation) / 2.0, 0.0, 1.0));
}

}  // namespace greatx::render
