// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Provides reflectors with the size a = 0.1 m at 77 GHz and the closed forms of their radar cross-sections,
// dBsm.
#pragma once

#include <algorithm>

#include "core/random.h"
#include "tests/rf/radar_echo_scenes.h"

namespace greatx::rf::testing {

using test::TinyScene;

inline constexpr double a = 0.1, range_m = 400.0, k = 2.0 * pi / radar_wavelength_m;

inline TinyScene plate() {
  TinyScene tiny;
  const double h = 0.5 * a;
  tiny.object("plate").quad({0, -h, -h}, {0, h, -h}, {0, h, h}, {0, -h, h});
  return tiny;
}

inline TinyScene dihedral() {
  TinyScene tiny;
  tiny.object("dihedral")
      .quad({0, 0, 0}, {a, 0, 0}, {a, 0, a}, {0, 0, a})
      .quad({0, 0, 0}, {0, 0, a}, {0, a, a}, {0, a, 0});
  return tiny;
}

inline TinyScene trihedral() {
  TinyScene tiny;
  const dvec3 o(0.0), x(a, 0, 0), y(0, a, 0), z(0, 0, a);
  tiny.object("trihedral").triangle(o, x, y).triangle(o, z, x).triangle(o, y, z);
  return tiny;
}

/// Returns a sphere of 12 n^2 triangles with a side of about r pi/(2 n). The sphere is a cube with n x n
/// squares on each face, projected onto the sphere. The mesh is turned and its vertices are displaced at
/// random. In a regular mesh, rows of facets near the shadow boundary lie half a wavelength behind each other
/// and add a Bragg reflection of up to 0.7 dB.
inline TinyScene ball(double radius, int n) {
  TinyScene tiny;
  tiny.object("ball");
  const dquat turn = orientation_from_yaw_pitch_roll(0.4, 0.7, 1.1);
  for (int face = 0; face < 6; ++face) {
    const auto at = [&](int i, int j) {
      const double u = std::tan(0.25 * pi * (2.0 * i / n - 1.0)),
                   v = std::tan(0.25 * pi * (2.0 * j / n - 1.0));
      const double sign = face < 3 ? 1.0 : -1.0;
      dvec3 p(sign, sign * u, v);
      p = glm::normalize(face % 3 == 0 ? p : face % 3 == 1 ? dvec3(p.z, p.x, p.y) : dvec3(p.y, p.z, p.x));
      const dvec3 place = glm::floor(p * 1e6 + 0.5);  // shared vertices get the same displacement
      RandomStream random(1, static_cast<uint32_t>(int64_t(place.x) * 7919 + int64_t(place.y)),
                          static_cast<uint32_t>(int64_t(place.z)));
      const double step = 0.25 * 0.5 * pi / n;
      p += step * dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      return radius * (turn * glm::normalize(p));
    };
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        tiny.triangle(at(i, j), at(i + 1, j), at(i + 1, j + 1))
            .triangle(at(i, j), at(i + 1, j + 1), at(i, j + 1));
  }
  return tiny;
}

/// Returns the cross-section, dBsm, of a convex mesh of conductors in physical optics by brute force:
/// quadrature over m^2 points of every lit triangle.
inline double brute_force_db(const scene::Scene& scene, const dvec3& radar, int m) {
  Complex sum(0.0);
  const double distance = glm::length(radar);
  for (const scene::FacetTriangle& t : scene.facet_triangles) {
    const dvec3 u = t.corners[1] - t.corners[0], v = t.corners[2] - t.corners[0], cross = glm::cross(u, v);
    const double area = 0.5 * glm::length(cross);
    const dvec3 normal = cross / (2.0 * area);
    if (glm::dot(normal, radar - t.corners[0]) <= 0.0) continue;
    for (int i = 0; i < m; ++i)
      for (int h = 0; h < 2 * (m - i) - 1; ++h) {
        const double third = (h % 2 + 1) / 3.0, b = (i + third) / m, c = (h / 2 + third) / m;
        const dvec3 arm = radar - (t.corners[0] + b * u + c * v);
        const double r = glm::length(arm);
        sum += std::polar(area / (m * m) * glm::dot(normal, arm) / r * std::pow(distance / r, 2),
                          -2.0 * k * (r - distance));
      }
  }
  return decibels(4.0 * pi / (radar_wavelength_m * radar_wavelength_m) * std::norm(sum));
}

inline dvec3 from(double azimuth_deg, double elevation_deg, double distance = range_m) {
  const double az = radians(azimuth_deg), el = radians(elevation_deg);
  return distance * dvec3(std::cos(el) * std::cos(az), std::cos(el) * std::sin(az), std::sin(el));
}

inline double sinc(double x) { return x == 0.0 ? 1.0 : std::sin(x) / x; }

inline double plate_db(double pattern) {
  return decibels(4.0 * pi * std::pow(a, 4) / (radar_wavelength_m * radar_wavelength_m) * pattern * pattern);
}

/// Returns the cross-section of the plate, dBsm: 4 pi a^4/lambda^2 (cos(theta) sinc(k a sin(theta)))^2 (C. A.
/// Balanis, Advanced Engineering Electromagnetics, 11.3).
inline double plate_db_at(double degrees) {
  return plate_db(std::cos(radians(degrees)) * sinc(k * a * std::sin(radians(degrees))));
}

inline EchoOptions exact(double half_m, uint32_t tubes) {
  EchoOptions options = around(half_m, range_m, tubes);
  options.border_floor_m2 = 0.0;
  options.max_echoes = 1u << 24;
  return options;
}

/// Returns the cross-section of the trihedral, dBsm: 4 pi A^2/lambda^2. A is the part of the aperture whose
/// mirror image in the apex also lies in the aperture (A. C. Bonkowski et al. 1953). For the direction
/// cosines l <= m <= n, A = a^2 4 l m/(l + m + n) if l + m <= n, else A = a^2 (l + m + n - 2/(l + m + n)).
inline double trihedral_db(dvec3 d) {
  const double low = std::min({d.x, d.y, d.z}), high = std::max({d.x, d.y, d.z}), sum = d.x + d.y + d.z,
               mid = sum - low - high;
  const double area = a * a * (low + mid <= high ? 4.0 * low * mid / sum : sum - 2.0 / sum);
  return decibels(4.0 * pi * area * area / (radar_wavelength_m * radar_wavelength_m));
}

}  // namespace greatx::rf::testing
