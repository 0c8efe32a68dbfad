// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks the fringe currents of edges: their coefficients, the integral along an edge, and the echoes of a
// plate whose edges the geometrical theory of diffraction gives in closed form.
#include <gtest/gtest.h>

#include "rf/radar/echoes/fringe.h"
#include "tests/rf/radar_reflectors.h"

namespace greatx::rf {
namespace {

using namespace rf::testing;

TEST(RadarFringe, AHalfPlaneSeenAlongItsFaceSendsBackAllOfTheElectricFieldAlongItsEdge) {
  const Fringe edge_on = fringe(2.0, pi, pi);
  EXPECT_NEAR(edge_on.soft, -1.0, 1e-9);
  EXPECT_NEAR(edge_on.hard, 0.0, 1e-9);
  // At normal incidence f and f0 are both infinite; f - f0 tends to -1/2, and so does g - g0.
  const Fringe normal = fringe(2.0, 0.5 * pi, 0.5 * pi);
  EXPECT_NEAR(normal.soft, -0.5, 1e-4);
  EXPECT_NEAR(normal.hard, -0.5, 1e-4);
}

TEST(RadarFringe, NothingIsBeyondPhysicalOpticsWhereTheWedgeIsFlat) {
  for (const double angle : {0.4, 1.0, 2.0, 2.7}) {
    const Fringe flat = fringe(1.0 + 1e-9, angle, angle);
    EXPECT_NEAR(flat.soft, 0.0, 1e-6) << angle;
    EXPECT_NEAR(flat.hard, 0.0, 1e-6) << angle;
  }
}

TEST(RadarFringe, CoefficientsAreContinuousAtAllAngles) {
  for (const double n : {1.2, 1.5, 1.75, 2.0}) {
    const double step = 2e-4, width = n * pi;
    for (const double apart : {0.0, 0.7}) {
      Fringe before = fringe(n, 0.02, 0.02 + apart);
      for (double angle = 0.02 + step; angle + apart < width - 0.02; angle += step) {
        const Fringe now = fringe(n, angle, angle + apart);
        EXPECT_NEAR(now.soft, before.soft, 0.01) << n << " " << angle << " " << apart;
        // Where a face becomes dark, physical optics loses its currents at once, and the fringe makes up.
        if (apart == 0.0) {
          EXPECT_NEAR(now.hard, before.hard, 0.01) << n << " " << angle;
        }
        before = now;
      }
    }
  }
}

TEST(RadarFringe, TheIntegralAlongAnEdgeIsThatOfQuadrature) {
  for (const double offset : {0.0, 0.3, 3.0, 20.0}) {
    const PhaseLine line{{offset, 15.0}, {offset + 0.4, 14.0}, k};
    constexpr double from = -1.0, to = 1.7;
    constexpr int steps = 400'000;
    Complex sure(0.0), found(0.0);
    for (int i = 0; i < steps; ++i)
      sure +=
          std::polar((to - from) / steps, -k * (line.length(from + (to - from) * (i + 0.5) / steps) - 29.0));
    std::vector<LineContribution> contributions;
    integrate(line, from, to, contributions);
    for (const LineContribution& c : contributions)
      found += c.value * std::polar(1.0, -k * (line.length(c.at) - 29.0));
    EXPECT_LT(std::abs(found - sure), 0.01 * std::abs(sure)) << offset;
  }
}

/// Returns the cross-section, dBsm, of what comes back from the given range on: of an edge of a plate that
/// reaches from x = 0 to x = 4, is 0.3 m wide and is seen from below x = 0 at an elevation.
double near_edge_db(double elevation_deg, double slant, bool edges) {
  TinyScene tiny;
  tiny.object("plate").quad({0, -0.15, 0}, {4, -0.15, 0}, {4, 0.15, 0}, {0, 0.15, 0});
  EchoScene scene(tiny);
  const Pose radar = looking(from(180.0, elevation_deg), dvec3(0.0));
  EchoOptions options = exact(5.0, 4000);
  options.edges = edges;
  options.max_bounces = 1;
  EchoEnd end;
  end.slant = slant;
  const EchoList list = scene.find(options, radar, {}, nullptr, end);
  EchoList near;
  for (const Echo& echo : list.echoes)
    if (0.5 * speed_of_light * echo.delay.coefficients[0] < range_m + 0.5) near.echoes.push_back(echo);
  return section_db(field_of(near), range_m, range_m);
}

TEST(RadarFringe, AnEdgeOfAPlateSendsBackWhatTheGeometricalTheoryOfDiffractionHas) {
  for (const double elevation : {10.0, 20.0, 40.0}) {
    // f and g of a half-plane for backscatter from the angle 180 degrees less the elevation:
    // (-1 -+ 1/cos)/2; sigma = L^2 f^2/pi.
    const double cosine = std::cos(pi - radians(elevation));
    const auto section = [&](double f) { return decibels(0.09 * f * f / pi); };
    EXPECT_NEAR(near_edge_db(elevation, 0.5 * pi, true), section(0.5 * (-1.0 + 1.0 / cosine)), 0.1)
        << elevation;
    // At 10 degrees it is 57 dB below a square metre, less than the corners send back.
    if (elevation > 15.0) {
      EXPECT_NEAR(near_edge_db(elevation, 0.0, true), section(0.5 * (-1.0 - 1.0 / cosine)), 0.3) << elevation;
    }
    // Physical optics alone has tan(elevation)/2 for both.
    EXPECT_NEAR(near_edge_db(elevation, 0.5 * pi, false), section(0.5 * std::tan(radians(elevation))), 0.1);
  }
}

}  // namespace
}  // namespace greatx::rf
