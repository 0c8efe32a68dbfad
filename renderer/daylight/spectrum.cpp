// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/daylight/spectrum.h"

namespace greatx::render {

namespace {

double bump(double x, double center, double below, double above) {
  const double t = (x - center) / (x < center ? below : above);
  return std::exp(-0.5 * t * t);
}

dvec3 eye(double nm) {
  return {1.056 * bump(nm, 599.8, 37.9, 31.0) + 0.362 * bump(nm, 442.0, 16.0, 26.7) -
              0.065 * bump(nm, 501.1, 20.4, 26.2),
          0.821 * bump(nm, 568.8, 46.9, 40.5) + 0.286 * bump(nm, 530.9, 16.3, 31.1),
          1.217 * bump(nm, 437.0, 11.8, 36.0) + 0.681 * bump(nm, 459.0, 26.0, 13.8)};
}

/// Returns the colour that each band of sunlight adds.
std::array<dvec3, bands> sunlight_colors() {
  constexpr std::array<double, bands> sun{1.50, 1.85, 1.98, 1.88, 1.85, 1.76, 1.62, 1.49};  // W/m^2/nm
  std::array<dvec3, bands> colors{};
  double luminance = 0.0;
  for (int i = 0; i < bands; ++i) {
    dvec3 xyz(0.0);
    for (int nm = 0; nm < 40; ++nm) xyz += eye(380.5 + 40.0 * i + nm) * sun[i];
    luminance += xyz.y;
    // The matrix is that of IEC 61966-2-1.
    colors[i] = {3.2406 * xyz.x - 1.5372 * xyz.y - 0.4986 * xyz.z,
                 -0.9689 * xyz.x + 1.8758 * xyz.y + 0.0415 * xyz.z,
                 0.0557 * xyz.x - 0.2040 * xyz.y + 1.0570 * xyz.z};
  }
  for (dvec3& color : colors) color /= luminance;
  return colors;
}

}  // namespace

dvec3 color_of(const Spectrum& share_of_sun) {
  static const std::array<dvec3, bands> colors = sunlight_colors();
  dvec3 sum(0.0);
  for (int i = 0; i < bands; ++i) sum += colors[i] * share_of_sun.v[i];
  return sum;
}

}  // namespace greatx::render
