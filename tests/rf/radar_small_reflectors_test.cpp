// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks that reflectors far smaller than the tubes of the grid are found at the default settings, with the
// cross-sections of their closed forms, wherever they stand.
#include <gtest/gtest.h>

#include "tests/rf/radar_reflectors.h"

namespace greatx::rf {
namespace {

using namespace rf::testing;

enum class Kind { plate, dihedral, trihedral };

/// Adds a reflector of size `side` at `at` whose axis points to the origin, turned by `off` rad about z.
void add_reflector(TinyScene& tiny, Kind kind, double side, const dvec3& at, double off) {
  const dvec3 to = glm::normalize(-at);
  const dquat turn = orientation_from_yaw_pitch_roll(std::atan2(to.y, to.x) + off,
                                                     -std::atan2(to.z, std::hypot(to.x, to.y)), 0.0);
  const auto point = [&](double x, double y, double z) { return at + turn * (side * dvec3(x, y, z)); };
  tiny.object("reflector");
  if (kind == Kind::plate) {
    tiny.quad(point(0, -0.5, -0.5), point(0, 0.5, -0.5), point(0, 0.5, 0.5), point(0, -0.5, 0.5));
  } else if (kind == Kind::dihedral) {
    const double s = std::sqrt(0.5);
    tiny.quad(point(0, 0, -0.5), point(s, s, -0.5), point(s, s, 0.5), point(0, 0, 0.5))
        .quad(point(0, 0, -0.5), point(0, 0, 0.5), point(s, -s, 0.5), point(s, -s, -0.5));
  } else {
    // The three edges make equal angles with the axis.
    const double c = 1.0 / std::sqrt(3.0), s = std::sqrt(2.0 / 3.0);
    const auto edge = [&](int i) {
      const double turned = 2.0 * pi * i / 3.0;
      return dvec3(c, s * std::cos(turned), s * std::sin(turned));
    };
    for (int i = 0; i < 3; ++i) {
      const dvec3 a = edge(i), b = edge((i + 1) % 3);
      tiny.triangle(point(0, 0, 0), point(a.x, a.y, a.z), point(b.x, b.y, b.z));
    }
  }
}

/// Returns the largest cross-section of the closed form, dBsm.
double closed_form_db(Kind kind, double side, double wavelength) {
  const double fourth = side * side * side * side / (wavelength * wavelength);
  switch (kind) {
    case Kind::plate:
      return decibels(4.0 * pi * fourth);
    case Kind::dihedral:
      return decibels(8.0 * pi * fourth);
    case Kind::trihedral:
      return decibels(4.0 / 3.0 * pi * fourth);
  }
  return 0.0;
}

TEST(RadarSmallReflectors, AllAreFoundAtDefaultSettingsWithTheirSections) {
  for (const double carrier : {10e9, 24e9, 77e9, 140e9}) {
    const double wavelength = speed_of_light / carrier;
    uint32_t index = 0;
    for (const Kind kind : {Kind::plate, Kind::dihedral, Kind::trihedral})
      for (const double side : {0.08, 0.15, 0.4}) {
        ++index;
        if (side > 0.2 && carrier > 30e9) continue;  // the far field begins beyond 80 m
        const double azimuth = -0.9 + 0.21 * index, elevation = 0.2 - 0.05 * index;
        const double distance = 40.0 + 7.3 * index;
        const dvec3 at = distance * dvec3(std::cos(elevation) * std::cos(azimuth),
                                          std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
        TinyScene tiny;
        add_reflector(tiny, kind, side, at, 0.0);
        const scene::Scene scene = tiny.build();
        scene::GpuScene gpu(test::device(), scene, {});
        const std::vector<RadioSurface> conductors(scene.materials.size(), conductor());
        EchoOptions options;
        options.merge_share = 0.0;
        const Pose radar{};
        EchoFinder finder(gpu, RadioSurfaces(conductors, carrier), EchoEnd{}, std::nullopt, options);
        const EchoList list = trace_echoes(finder, gpu, scene.bodies.size(), at_rest(radar, radar));
        Complex sum(0.0);
        // The closed form is that of the echo over all surfaces.
        for (const Echo& echo : list.echoes)
          if (echo.bounces == 1 + static_cast<uint32_t>(kind))
            sum += echo.amplitude *
                   std::polar(1.0, -2.0 * pi * std::remainder(carrier * echo.delay.coefficients[0], 1.0));
        const double four_pi = 4.0 * pi;
        const double found = decibels(std::norm(sum) * four_pi * four_pi * four_pi * std::pow(distance, 4.0) /
                                      (wavelength * wavelength));
        EXPECT_NEAR(found, closed_form_db(kind, side, wavelength), 0.5)
            << carrier / 1e9 << " GHz, kind " << int(kind) << ", " << side << " m";
      }
  }
}

}  // namespace
}  // namespace greatx::rf
