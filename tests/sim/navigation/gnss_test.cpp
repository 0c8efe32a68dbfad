// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Satellites, dilutions, positions from ranges, and the errors of a receiver.
#include "sim/navigation/gnss.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"
#include "tests/sim/navigation/gnss_places.h"

namespace greatx::navigation {
namespace {

Sky open_sky() {
  return [](const dvec3&) { return SignalPath{}; };
}

/// A street along x of walls without end: everything across it below `hidden` is hidden, with no reflection.
Sky street(double hidden) {
  return [hidden](const dvec3& direction) {
    const double across = std::atan2(direction.z, std::abs(direction.y));
    return SignalPath{across < hidden ? SignalPath::State::blocked : SignalPath::State::direct, 0.0, 0.0};
  };
}

GnssReceiver without_errors() {
  GnssReceiver receiver;
  receiver.errors = {.code_m = 0.0,
                     .doppler = 0.0,
                     .multipath = 0.0,
                     .orbit_m = 0.0,
                     .ionosphere_m = 0.0,
                     .troposphere_m = 0.0};
  return receiver;
}

TEST(Constellation, HasCircularOrbitsOfHalfASiderealDay) {
  const auto now = nominal_constellation(noon_unix_s);
  const auto later = nominal_constellation(noon_unix_s + 1.0),
             before = nominal_constellation(noon_unix_s - 1.0);
  const double sidereal_day_s = 2.0 * pi / 7.2921151467e-5;
  const auto next_day = nominal_constellation(noon_unix_s + sidereal_day_s);
  for (size_t i = 0; i < satellite_count; ++i) {
    EXPECT_NEAR(glm::length(now[i].position_m), 26559.7e3, 1e-3);
    EXPECT_LE(std::abs(now[i].position_m.z), 26559.7e3 * std::sin(radians(55.0)) + 1e-3);
    EXPECT_LT(glm::length(now[i].velocity - 0.5 * (later[i].position_m - before[i].position_m)), 1e-3);
    EXPECT_LT(glm::length(next_day[i].position_m - now[i].position_m), 1.0) << "ground tracks repeat";
  }
  EXPECT_EQ(slot_name(0), "A1");
  EXPECT_EQ(slot_name(23), "F4");
}

TEST(Constellation, IsWhereTheReferenceOrbitsSayAtTheirEpoch) {
  // At the epoch, A1 has the argument of latitude 268.126 degrees: nearly the southernmost point, 90 degrees
  // before its ascending node at 272.847 - 279.06 degrees of longitude.
  const auto at = nominal_constellation(741484800.0);
  const dvec3 p = at[0].position_m / 26559.7e3;
  EXPECT_NEAR(p.z, std::sin(radians(268.126)) * std::sin(radians(55.0)), 1e-9);
  const double node = radians(272.847 - 279.06);
  EXPECT_NEAR(p.x * std::cos(node) + p.y * std::sin(node), std::cos(radians(268.126)), 1e-9);
}

TEST(Constellation, ShowsAsManySatellitesAsGps) {
  // The share of a sphere of radius a that is above the horizon of a point at radius r is (1 - r / a) / 2; of
  // 24 satellites 9.1 are in view on average. Plan: never fewer than 4 above 5 degrees.
  double sum = 0.0, count = 0.0;
  size_t least = satellite_count;
  for (int latitude = -80; latitude <= 80; latitude += 20)
    for (int longitude = -180; longitude < 180; longitude += 45)
      for (int hour = 0; hour < 24; hour += 3) {
        const LocalFrame frame(
            {{static_cast<double>(latitude), static_cast<double>(longitude), 0.0}, 0.0, ""});
        Gnss gnss(without_errors(), frame, 1, "g", 0, 1.0);
        const GnssEpoch epoch = gnss.measure(noon_unix_s + 3600.0 * hour, {}, {}, open_sky(), 0);
        const double weight = std::cos(radians(latitude));
        for (const SatelliteView& view : epoch.satellites) sum += weight * (view.elevation > 0.0);
        count += weight;
        least = std::min<size_t>(least, epoch.used);
      }
  EXPECT_NEAR(sum / count, 12.0 * (1.0 - 6371.0 / 26559.7), 0.15);
  EXPECT_GE(least, 4u);
}

TEST(Dilutions, AreThoseOfKnownGeometries) {
  // A satellite at the zenith and three at the elevation e, 120 degrees apart: the normal matrix splits.
  // x and y have the variance 1 / (1.5 c^2) each, c = cos(e); z and time are a 2 x 2 problem.
  for (const double elevation : {radians(5.0), radians(20.0), radians(45.0)}) {
    std::vector<dvec3> directions{{0.0, 0.0, 1.0}};
    const double c = std::cos(elevation), s = std::sin(elevation);
    for (int i = 0; i < 3; ++i) {
      const double azimuth = 2.0 * pi * i / 3.0 + 0.3;
      directions.emplace_back(c * std::cos(azimuth), c * std::sin(azimuth), s);
    }
    const auto found = dilutions_of(directions);
    ASSERT_TRUE(found);
    const double hdop = std::sqrt(2.0 / (1.5 * c * c));
    // [1 + 3 s^2, -(1 + 3 s); -(1 + 3 s), 4]: its determinant is 3 (1 - s)^2.
    const double determinant = 3.0 * (1.0 - s) * (1.0 - s);
    const double vdop = std::sqrt(4.0 / determinant), tdop = std::sqrt((1.0 + 3.0 * s * s) / determinant);
    EXPECT_NEAR(found->hdop, hdop, 1e-12);
    EXPECT_NEAR(found->vdop, vdop, 1e-9);
    EXPECT_NEAR(found->tdop, tdop, 1e-9);
    EXPECT_NEAR(found->pdop, std::hypot(hdop, vdop), 1e-9);
    EXPECT_NEAR(found->gdop, std::hypot(found->pdop, tdop), 1e-9);
  }
}

TEST(Dilutions, DoNotExistForDegenerateGeometries) {
  std::vector<dvec3> cone;
  for (int i = 0; i < 6; ++i) cone.emplace_back(0.6 * std::cos(i), 0.6 * std::sin(i), 0.8);
  EXPECT_FALSE(dilutions_of(cone)) << "height and time are one on a cone";
  cone.resize(3);
  EXPECT_FALSE(dilutions_of(cone));
}

TEST(Positioning, IsExactWithoutErrors) {
  const LocalFrame frame(delft);
  Gnss gnss(without_errors(), frame, 1, "g", 0, 0.1);
  for (const dvec3& at : {dvec3(0.0), dvec3(120.0, -340.0, 55.0), dvec3(-9000.0, 4000.0, 900.0)}) {
    const dvec3 velocity(12.0, -3.0, 1.5);
    const GnssEpoch epoch = gnss.measure(noon_unix_s, at, velocity, open_sky(), 0);
    ASSERT_TRUE(epoch.fix);
    EXPECT_LT(glm::length(epoch.fix->position_m - at), 1e-6);
    EXPECT_LT(glm::length(epoch.fix->velocity - velocity), 1e-7);
    EXPECT_NEAR(epoch.fix->clock_m, 0.0, 1e-6);
  }
}

TEST(Positioning, TakesAClockErrorForWhatItIs) {
  const auto satellites = nominal_constellation(noon_unix_s);
  const dvec3 receiver = geocentric(delft.origin), velocity(1.0, 2.0, 3.0);
  std::vector<RangeMeasurement> measurements;
  for (const Satellite& s : satellites) {
    const dvec3 to = s.position_m - receiver;
    if (glm::dot(glm::normalize(to), glm::normalize(receiver)) < 0.1) continue;
    measurements.push_back({s.position_m, s.velocity, glm::length(to) + 12345.6,
                            glm::dot(glm::normalize(to), s.velocity - velocity) - 7.5, 1.0, 0.1});
  }
  const auto fix = solve_position(measurements, receiver + dvec3(1e5, -2e5, 3e4));
  ASSERT_TRUE(fix);
  EXPECT_LT(glm::length(fix->position_m - receiver), 1e-6);
  EXPECT_LT(glm::length(fix->velocity - velocity), 1e-6);
  EXPECT_NEAR(fix->clock_m, 12345.6, 1e-6);
  EXPECT_NEAR(fix->clock_rate, -7.5, 1e-6);
}

TEST(Gnss, ErrorsHaveTheCovarianceThatTheReceiverStates) {
  const LocalFrame frame(delft);
  const GnssReceiver receiver;
  double position = 0.0, velocity = 0.0, worst = 0.0;
  constexpr int sequences = 2000;
  for (uint32_t sequence = 0; sequence < sequences; ++sequence) {
    Gnss gnss(receiver, frame, 1, "g", sequence, 1.0);
    const GnssEpoch epoch = gnss.measure(noon_unix_s, {5.0, 6.0, 7.0}, {1.0, 0.0, 0.0}, open_sky(), 0);
    ASSERT_TRUE(epoch.fix);
    const dvec3 error = epoch.fix->position_m - dvec3(5.0, 6.0, 7.0);
    const dvec3 drift = epoch.fix->velocity - dvec3(1.0, 0.0, 0.0);
    position += glm::dot(error, glm::inverse(epoch.fix->position_covariance) * error);
    velocity += glm::dot(drift, glm::inverse(epoch.fix->velocity_covariance) * drift);
    worst = std::max(worst, glm::length(error));
  }
  // The mean of a chi-square of 3 degrees of freedom; its deviation is sqrt(6 / sequences) = 0.055.
  EXPECT_NEAR(position / sequences, 3.0, 0.2);
  EXPECT_NEAR(velocity / sequences, 3.0, 0.2);
  EXPECT_LT(worst, 25.0);
  EXPECT_GT(worst, 4.0);
}

TEST(Gnss, ErrorsAreSlowAndDoNotDependOnWhereARunBegins) {
  const LocalFrame frame(delft);
  GnssReceiver receiver;
  receiver.errors.code_m = 0.0;
  Gnss gnss(receiver, frame, 1, "g", 0, 0.1), resumed(receiver, frame, 1, "g", 0, 0.1);
  std::vector<dvec3> places;
  for (int i = 0; i < 50; ++i) {
    places.push_back(gnss.measure(noon_unix_s + 0.1 * i, {}, {}, open_sky(), i).fix->position_m);
    if (i > 0) {
      EXPECT_LT(glm::length(places[i] - places[i - 1]), 0.6);
    }
  }
  EXPECT_EQ(resumed.measure(noon_unix_s + 4.9, {}, {}, open_sky(), 49).fix->position_m, places[49]);
}

TEST(Gnss, AStreetHidesSatellitesAndWidensTheErrorAcrossIt) {
  const LocalFrame frame(delft);
  double open_used = 0.0, street_used = 0.0;
  int fixes = 0, worse = 0, dropouts = 0;
  for (int hour = 0; hour < 24; ++hour) {
    Gnss gnss({}, frame, 1, "g", 0, 1.0);
    const double unix_s = noon_unix_s + 3600.0 * hour;
    const GnssEpoch open = gnss.measure(unix_s, {}, {}, open_sky(), 0);
    const GnssEpoch narrow = gnss.measure(unix_s, {}, {}, street(radians(55.0)), 0);
    open_used += open.used, street_used += narrow.used;
    EXPECT_LE(narrow.used, open.used);
    if (narrow.used < 4) {
      EXPECT_FALSE(narrow.fix);
      ++dropouts;
    }
    if (narrow.fix) ++fixes, worse += narrow.fix->dilutions.hdop > open.fix->dilutions.hdop;
    for (const SatelliteView& view : narrow.satellites)
      EXPECT_EQ(std::isnan(view.range_error_m), view.path.state != SignalPath::State::direct);
  }
  EXPECT_LT(street_used, 0.6 * open_used);
  EXPECT_GT(dropouts, 2);
  EXPECT_GT(fixes, 2);
  EXPECT_EQ(worse, fixes);
}

TEST(Gnss, AReflectedPathIsLongerByTheImagesDistance) {
  // A wall 10 m to the west with its face to the east; the satellite in the east at 30 degrees.
  const dvec3 direction(std::cos(radians(30.0)), 0.0, std::sin(radians(30.0)));
  const SignalPath path = reflected_path(direction, {1.0, 0.0, 0.0}, 10.0, {2.0, 5.0, 0.0});
  EXPECT_EQ(path.state, SignalPath::State::reflected);
  EXPECT_NEAR(path.excess_m, 20.0 * std::cos(radians(30.0)), 1e-12);
  EXPECT_NEAR(path.excess_rate, 4.0 * std::cos(radians(30.0)), 1e-12);
  // The same by the mirror image of the receiver and a satellite at a finite distance.
  const dvec3 satellite = 2.2e7 * direction;
  const double image = glm::length(satellite - dvec3(-20.0, 0.0, 0.0)) - glm::length(satellite);
  EXPECT_NEAR(path.excess_m, image, 1e-5);
}

TEST(Gnss, AReflectionMovesThePositionOfAReceiverThatBelievesItAndIsNotInTheCovariance) {
  const LocalFrame frame(delft);
  const auto one_reflected = [](const dvec3& direction) {
    SignalPath path;
    if (direction.x > 0.0 && direction.z < 0.7) path = {SignalPath::State::reflected, 40.0, 0.0};
    return path;
  };
  GnssReceiver believer = without_errors();
  believer.integrity = false;
  Gnss gnss(believer, frame, 1, "g", 0, 1.0), checked(without_errors(), frame, 1, "g", 0, 1.0);
  const GnssEpoch epoch = gnss.measure(noon_unix_s, {}, {}, one_reflected, 0);
  ASSERT_TRUE(epoch.fix);
  EXPECT_GT(glm::length(epoch.fix->position_m), 5.0);
  EXPECT_LT(epoch.fix->position_covariance[0][0], 1e-9);
  EXPECT_EQ(epoch.integrity, Integrity::unknown);
  // One that checks its ranges leaves a single reflection out.
  const SatelliteView& chosen = *std::ranges::find(epoch.satellites, true, &SatelliteView::used);
  const Sky single = [&](const dvec3& direction) {
    return std::abs(std::asin(direction.z) - chosen.elevation) < 1e-12
               ? SignalPath{SignalPath::State::reflected, 40.0, 0.0}
               : SignalPath{};
  };
  const GnssEpoch without = checked.measure(noon_unix_s, {}, {}, single, 0);
  ASSERT_TRUE(without.fix);
  EXPECT_LT(glm::length(without.fix->position_m), 1e-6);
  EXPECT_EQ(without.integrity, Integrity::agree);
  EXPECT_EQ(without.used + 1, epoch.used);
  for (const SatelliteView& view : without.satellites)
    EXPECT_EQ(view.used, view.path.state == SignalPath::State::direct);
}

TEST(Gnss, ObliquitiesAreOneAtTheZenithAndGrowTowardsTheHorizon) {
  EXPECT_NEAR(ionosphere_obliquity(pi / 2.0), 1.0, 5e-4);
  EXPECT_NEAR(ionosphere_obliquity(radians(5.0)), 3.0, 0.1);
  EXPECT_NEAR(troposphere_mapping(pi / 2.0), 1.0, 1e-6);
  EXPECT_NEAR(troposphere_mapping(radians(30.0)), 1.994, 1e-3);
}

}  // namespace
}  // namespace greatx::navigation
