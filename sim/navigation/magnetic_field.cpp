// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/navigation/magnetic_field.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/units.h"

namespace greatx::navigation {

namespace {

constexpr int field_degree = 8;
constexpr size_t field_terms = field_degree * (field_degree + 2);
using Coefficients = std::array<double, field_terms>;

// Gauss coefficients of 2020.0, nT, and their change, nT/year: for each degree n the orders m = 0...n, of
// each order g and h, but for m = 0 g alone.
// clang-format off
constexpr Coefficients field_2020 = {
    -29404.8, -1450.9, 4652.5,
    -2499.6, 2982.0, -2991.6, 1677.0, -734.6,
    1363.2, -2381.2, -82.1, 1236.2, 241.9, 525.7, -543.4,
    903.0, 809.5, 281.9, 86.3, -158.4, -309.4, 199.7, 48.0, -349.7,
    -234.3, 363.2, 47.7, 187.8, 208.3, -140.7, -121.2, -151.2, 32.3, 13.5, 98.9,
    66.0, 65.5, -19.1, 72.9, 25.1, -121.5, 52.8, -36.2, -64.5, 13.5, 8.9, -64.7, 68.1,
    80.6, -76.7, -51.5, -8.2, -16.9, 56.5, 2.2, 15.8, 23.5, 6.4, -2.2, -7.2, -27.2, 9.8, -1.8,
    23.7, 9.7, 8.4, -17.6, -15.3, -0.5, 12.8, -21.1, -11.7, 15.3, 14.9, 13.7, 3.6, -16.5, -6.9, -0.3,
    2.8,
};
constexpr Coefficients field_change = {
    5.7, 7.4, -25.9,
    -11.0, -7.0, -30.2, -2.1, -22.4,
    2.2, -5.9, 6.0, 3.1, -1.1, -12.0, 0.5,
    -1.2, -1.6, -0.1, -5.9, 6.5, 5.2, 3.6, -5.1, -5.0,
    -0.3, 0.5, 0.0, -0.6, 2.5, 0.2, -0.6, 1.3, 3.0, 0.9, 0.3,
    -0.5, -0.3, 0.0, 0.4, -1.6, 1.3, -1.3, -1.4, 0.8, 0.0, 0.0, 0.9, 1.0,
    -0.1, -0.2, 0.6, 0.0, 0.6, 0.7, -0.8, 0.1, -0.2, -0.5, -1.1, -0.8, 0.1, 0.8, 0.3,
    0.0, 0.1, -0.2, -0.1, 0.6, 0.4, -0.2, -0.1, 0.5, 0.4, -0.3, 0.3, -0.4, -0.1, 0.5, 0.4, 0.0,
};
// clang-format on

/// Schmidt's quasi-normal associated Legendre functions of cos(theta), and their derivatives by theta.
struct Legendre {
  double p[field_degree + 1][field_degree + 1] = {}, d[field_degree + 1][field_degree + 1] = {};

  Legendre(double c, double s) {
    p[0][0] = 1.0;
    for (int n = 1; n <= field_degree; ++n) {
      const double top = n == 1 ? 1.0 : std::sqrt((2.0 * n - 1.0) / (2.0 * n));
      p[n][n] = top * s * p[n - 1][n - 1];
      d[n][n] = top * (s * d[n - 1][n - 1] + c * p[n - 1][n - 1]);
      for (int m = 0; m < n; ++m) {
        const double over = 1.0 / std::sqrt(static_cast<double>(n * n - m * m));
        const double back = std::sqrt(std::max(0.0, static_cast<double>((n - 1) * (n - 1) - m * m)));
        const double p2 = n > 1 ? p[n - 2][m] : 0.0, d2 = n > 1 ? d[n - 2][m] : 0.0;
        p[n][m] = over * ((2.0 * n - 1.0) * c * p[n - 1][m] - back * p2);
        d[n][m] = over * ((2.0 * n - 1.0) * (c * d[n - 1][m] - s * p[n - 1][m]) - back * d2);
      }
    }
  }
};

/// Returns the field along r, theta (southwards) and phi (eastwards) of a sphere, nT.
dvec3 field_on_sphere(double radius_m, double c, double s, double phi, double years) {
  constexpr double reference_radius_m = 6371200.0;
  const Legendre legendre(c, s);
  dvec3 field(0.0);
  const double ratio = reference_radius_m / radius_m;
  double power = ratio * ratio;
  size_t term = 0;
  const auto next = [&] {
    const double value = field_2020[term] + years * field_change[term];
    ++term;
    return value;
  };
  for (int n = 1; n <= field_degree; ++n) {
    power *= ratio;
    for (int m = 0; m <= n; ++m) {
      const double g = next(), h = m == 0 ? 0.0 : next();
      const double cosine = std::cos(m * phi), sine = std::sin(m * phi);
      const double even = g * cosine + h * sine, odd = -g * sine + h * cosine;
      field += power * dvec3((n + 1) * even * legendre.p[n][m], -even * legendre.d[n][m],
                             -m * odd * legendre.p[n][m] / s);
    }
  }
  return field;
}

}  // namespace

dvec3 magnetic_field(const Geodetic& place, double year) {
  const dvec3 at = geocentric(place);
  const double radius = glm::length(at), phi = radians(place.longitude_deg);
  // The functions of order m have the factor s^m, so that p / s stays finite at the poles.
  const double s = std::max(std::hypot(at.x, at.y) / radius, 1e-9), c = at.z / radius;
  const double years = std::clamp(year, first_field_year, last_field_year) - first_field_year;
  const dvec3 field = 1e-9 * field_on_sphere(radius, c, s, phi, years);
  // From the sphere's axes to those of the ellipsoid: a turn by the difference of the two latitudes.
  const double latitude = radians(place.latitude_deg);
  const double turn = latitude - std::asin(std::clamp(c, -1.0, 1.0));
  const double north = -field.y, up = field.x;
  return {field.z, north * std::cos(turn) - up * std::sin(turn),
          north * std::sin(turn) + up * std::cos(turn)};
}

double year_of(double unix_s) { return 1970.0 + unix_s / (365.2425 * 86400.0); }

}  // namespace greatx::navigation
