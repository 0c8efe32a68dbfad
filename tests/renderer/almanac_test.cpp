// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks the sun and the moon against worked examples in textbooks and against figures of published almanacs.
#include "renderer/daylight/almanac.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"

namespace greatx::test {
namespace {

using namespace greatx::render;

/// Converts a Julian ephemeris day to UTC seconds. Delta T of the year is accurate enough for the examples.
double unix_of(double jde, double year) { return (jde - 2440587.5) * 86400.0 - delta_t(year); }

double compass_deg(const Sighting& sighting) {
  return std::fmod(450.0 - degrees(sighting.azimuth), 360.0);  // from north towards east
}

/// Returns the unit vector to the refracted place: x east, y north, z up.
dvec3 direction_of(const Sighting& sighting) {
  return {std::cos(sighting.elevation) * std::cos(sighting.azimuth),
          std::cos(sighting.elevation) * std::sin(sighting.azimuth), std::sin(sighting.elevation)};
}

TEST(Almanac, SunOfMeeusExample25a) {
  // 1992 October 13, 0h TD.
  const GeocentricPlace sun = sun_from_earth(2448908.5);
  EXPECT_NEAR(degrees(sun.right_ascension) + 360.0, 198.38083, 5e-6);
  EXPECT_NEAR(degrees(sun.declination), -7.78507, 5e-6);
  EXPECT_NEAR(degrees(sun.longitude) + 360.0, 199.90895, 1e-5);
  EXPECT_NEAR(sun.distance_m / 149597870700.0, 0.99766, 5e-6);
}

TEST(Almanac, MoonOfMeeusExample47a) {
  // 1992 April 12, 0h TD.
  const GeocentricPlace moon = moon_from_earth(2448724.5);
  EXPECT_NEAR(degrees(moon.longitude), 133.162655, 1e-6);
  EXPECT_NEAR(degrees(moon.latitude), -3.229126, 1e-6);
  EXPECT_NEAR(moon.distance_m, 368409.7e3, 50.0);
  EXPECT_NEAR(degrees(moon.right_ascension), 134.688470, 1e-4);  // nutation has only its main terms: 0.5"
  EXPECT_NEAR(degrees(moon.declination), 13.768368, 5e-5);
}

TEST(Almanac, PhaseOfMeeusExample48a) {
  const double i = phase_angle(sun_from_earth(2448724.5), moon_from_earth(2448724.5));
  EXPECT_NEAR(degrees(i), 69.0756, 1e-3);
  EXPECT_NEAR(illuminated_share(i), 0.6786, 5e-5);
}

TEST(Almanac, SunOfTheSolarPositionAlgorithmsExample) {
  // Reda and Andreas 2003, appendix A.5: 2003-10-17 12:30:30, UTC - 7 h.
  const SunAndMoon sky = sun_and_moon(1066419030.0, {.latitude = radians(39.742476),
                                                     .longitude = radians(-105.1786),
                                                     .height_m = 1830.14,
                                                     .pressure_hpa = 820.0,
                                                     .temperature_k = 284.15});
  EXPECT_NEAR(90.0 - degrees(sky.sun.elevation), 50.11162, 0.01);
  EXPECT_NEAR(compass_deg(sky.sun), 194.34024, 0.01);
  EXPECT_NEAR(degrees(sky.sun.angular_radius), 0.2675, 5e-4);
}

TEST(Almanac, EquinoxesAndSolsticesOfMeeusTable) {
  // Meeus, ch. 27: example 27.a is the June solstice 1962 at JDE 2437837.39245 (longitude 90), and table 27.E
  // lists 1996 to 2000 in dynamical time. The longitude of the sun grows by 0.0007 degrees per minute: 0.01
  // degrees are a quarter of an hour.
  const auto longitude_deg = [](double jde) {
    return std::fmod(degrees(sun_from_earth(jde).longitude) + 360.0, 360.0);
  };
  EXPECT_NEAR(longitude_deg(2437837.39245), 90.0, 0.01);
  const double june_2000 = 2451716.57500;      // 2000 June 21 01:48:46 TD
  const double december_2000 = 2451900.06837;  // 2000 December 21 13:38:30 TD
  EXPECT_NEAR(longitude_deg(june_2000), 90.0, 0.01);
  EXPECT_NEAR(longitude_deg(december_2000), 270.0, 0.01);
  EXPECT_NEAR(degrees(sun_from_earth(june_2000).declination), 23.438, 0.002);
  EXPECT_NEAR(degrees(sun_from_earth(december_2000).declination), -23.438, 0.002);
}

TEST(Almanac, FullMoonAndTotalEclipse) {
  // Greatest eclipse of 2024 April 8, 18:17:18 UT, 25.286 N 104.139 W (Espenak, NASA): the discs are
  // concentric, the altitude of the sun is 69.8 degrees and its azimuth 149 degrees.
  const SunAndMoon dark =
      sun_and_moon(1712600238.0, {.latitude = radians(25.286), .longitude = radians(-104.139)});
  EXPECT_NEAR(degrees(dark.sun.elevation), 69.8, 0.06);
  EXPECT_NEAR(compass_deg(dark.sun), 149.4, 0.5);
  const double apart = std::acos(glm::dot(direction_of(dark.sun), direction_of(dark.moon)));
  EXPECT_LT(degrees(apart), 0.02);
  EXPECT_NEAR(dark.moon.angular_radius / dark.sun.angular_radius, 1.0566, 0.004);  // magnitude of the eclipse
  EXPECT_NEAR(degrees(dark.moon_phase_angle), 180.0, 1.0);
  // The full moon of 2000 January 21, 04:40 UT, is a total lunar eclipse: the phase angle is near 0.
  EXPECT_LT(degrees(sun_and_moon(948429600.0, {}).moon_phase_angle), 1.0);
}

TEST(Almanac, AzimuthTurnsFromEastToNorth) {
  // North of the tropics, the sun rises in the east (x), culminates in the south (-y) and sets in the west.
  const Observer paris{.latitude = radians(48.8566), .longitude = radians(2.3522)};
  const double noon =
      1773446400.0 + 43200.0 - 564.0 + 540.0;  // 2026-03-14, local noon by the equation of time
  const dvec3 morning = direction_of(sun_and_moon(noon - 5.0 * 3600.0, paris).sun);
  const dvec3 midday = direction_of(sun_and_moon(noon, paris).sun);
  const dvec3 evening = direction_of(sun_and_moon(noon + 5.0 * 3600.0, paris).sun);
  EXPECT_GT(morning.x, 0.9);
  EXPECT_LT(evening.x, -0.9);
  EXPECT_LT(midday.y, -0.6);
  EXPECT_LT(std::abs(midday.x), 0.05);
}

TEST(Almanac, MoonsParallaxIsADegreeAtTheHorizon) {
  // Where the moon is at the zenith, it is 1.7 % nearer than where it rises. At the horizon, the parallax
  // lowers the moon by almost a degree.
  double highest = -1.0, lowest_gap = 1.0, widest_gap = 0.0;
  for (int hour = 0; hour < 25; ++hour) {
    const double t = unix_of(2448724.5, 1992.3) + 3600.0 * hour;
    const SunAndMoon sky = sun_and_moon(t, {.latitude = radians(13.8), .pressure_hpa = 0.0});
    highest = std::max(highest, degrees(sky.moon.elevation));
    const double gap = moon_from_earth(2448724.5 + hour / 24.0).distance_m - sky.moon.distance_m;
    lowest_gap = std::min(lowest_gap, gap / 6378e3);
    widest_gap = std::max(widest_gap, gap / 6378e3);
  }
  EXPECT_GT(highest, 80.0);
  EXPECT_GT(widest_gap, 0.97);  // nearer by an Earth radius at the zenith
  EXPECT_LT(lowest_gap, -0.5);
}

TEST(Almanac, RefractionOfThePublishedTable) {
  // Meeus, example 16.a: the refraction is 28.754' at an apparent altitude of 30', that is, a true one of
  // 1.246'. It is 34' at the horizon.
  const auto minutes = [](double true_deg) {
    return 60.0 * degrees(refraction(radians(true_deg), 1010.0, 283.0));
  };
  EXPECT_NEAR(minutes(-34.0 / 60.0), 34.0, 0.6);
  EXPECT_NEAR(minutes(1.246 / 60.0), 28.754, 0.1);
  EXPECT_NEAR(minutes(45.0), 1.0, 0.02);
  EXPECT_LT(minutes(90.0), 0.01);
  EXPECT_EQ(minutes(-7.0), 0.0);
  for (double h = -8.0; h < 2.0; h += 0.01) EXPECT_NEAR(minutes(h), minutes(h + 0.01), 0.2) << h;
}

TEST(Almanac, DeltaTIsContinuous) {
  EXPECT_NEAR(delta_t(2000.0), 63.83, 0.1);  // observed
  EXPECT_NEAR(delta_t(1950.0), 29.1, 0.2);
  for (const double year : {1920.0, 1941.0, 1961.0, 1986.0, 2005.0, 2050.0})
    EXPECT_NEAR(delta_t(year - 1e-6), delta_t(year), 0.6) << year;
}

}  // namespace
}  // namespace greatx::test
