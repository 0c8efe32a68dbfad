// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "core/geodesy.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"

namespace greatx {
namespace {

constexpr double equator_m = 6378137.0, flat = 1.0 / 298.257223563;
constexpr double polar_m = equator_m * (1.0 - flat);

LocalFrame frame_at(double latitude_deg, double longitude_deg, double height_m, double undulation_m = 0.0) {
  return LocalFrame({{latitude_deg, longitude_deg, height_m}, undulation_m, ""});
}

double distance_m(const dvec3& a, const dvec3& b) { return glm::length(a - b); }

TEST(Geodesy, PolesAndEquatorHaveClosedForms) {
  for (const double height : {-1000.0, 0.0, 8848.0, 1e6}) {
    EXPECT_LT(distance_m(geocentric({0.0, 0.0, height}), {equator_m + height, 0.0, 0.0}), 1e-9);
    EXPECT_LT(distance_m(geocentric({0.0, 90.0, height}), {0.0, equator_m + height, 0.0}), 1e-9);
    EXPECT_LT(distance_m(geocentric({0.0, 180.0, height}), {-equator_m - height, 0.0, 0.0}), 2e-9);
    EXPECT_LT(distance_m(geocentric({90.0, 33.0, height}), {0.0, 0.0, polar_m + height}), 2e-9);
    EXPECT_LT(distance_m(geocentric({-90.0, 33.0, height}), {0.0, 0.0, -polar_m - height}), 2e-9);
  }
}

// EPSG Guidance Note 7-2 (IOGP 373-7-2, 2019), the examples of methods 9602 and 9837.
TEST(Geodesy, GuidanceNoteExamples) {
  const Geodetic place{53.0 + 48.0 / 60.0 + 33.820 / 3600.0, 2.0 + 7.0 / 60.0 + 46.380 / 3600.0, 73.0};
  EXPECT_LT(distance_m(geocentric(place), {3771793.968, 140253.342, 5124304.349}), 1e-3);
  const Geodetic back = geodetic({3771793.968, 140253.342, 5124304.349});
  EXPECT_NEAR(back.latitude_deg, place.latitude_deg, 0.0005 / 3600.0);
  EXPECT_NEAR(back.longitude_deg, place.longitude_deg, 0.0005 / 3600.0);
  EXPECT_NEAR(back.height_m, 73.0, 1e-3);
  const LocalFrame frame = frame_at(55.0, 5.0, 200.0);
  EXPECT_LT(distance_m(frame.local(place), {-189013.869, -128642.040, -4220.171}), 1e-3);
  EXPECT_LT(distance_m(geocentric(frame.place({-189013.869, -128642.040, -4220.171})), geocentric(place)),
            1e-3);
}

/// A place and its position in a frame as PROJ 9.1.1 computes it: cct -d 6 +proj=pipeline +step +proj=cart
/// +ellps=WGS84 +step +proj=topocentric +ellps=WGS84 +lat_0=... +lon_0=... +h_0=...
struct ProjCase {
  Geodetic origin, place;
  dvec3 local_m;
};

TEST(Geodesy, AgreesWithProjToAMillimetreAtTenKilometres) {
  constexpr Geodetic delft{52.0116, 4.3571, 45.0}, fiji{-17.0, 179.99, 60.0}, ushuaia{-54.8, -68.3, 25.0},
      north{90.0, 0.0, 0.0}, south{-90.0, 30.0, 2835.0}, zero{0.0, 0.0, 0.0};
  const ProjCase cases[] = {
      {delft, {52.05, 4.5, 60.0}, {9803.232578, 4282.363689, 6.043678}},
      {delft, {52.0116, 4.3571, 45.0}, {0.0, 0.0, 0.0}},
      {delft, {52.0116, 4.36, 145.0}, {199.119280, 0.003972, 99.996898}},
      {delft, {52.0116, 4.2115, 45.0}, {-9996.993940, 10.011041, -7.818219}},
      {delft, {51.9217, 4.3571, 0.0}, {0.0, -10002.873978, -52.847491}},
      {delft, {52.07, 4.46, 10045.0}, {7067.025277, 6513.297659, 9992.777161}},
      {fiji, {-17.02, -179.95, 30.0}, {6388.500656, -2214.375723, -33.585161}},
      {fiji, {-16.95, 179.93, 530.0}, {-6391.371345, 5532.932676, 464.385090}},
      {fiji, {-17.0, 180.0, 1000.0}, {1065.025209, -0.027173, 939.911120}},
      {fiji, {-17.0, -180.0, 1000.0}, {1065.025209, -0.027173, 939.911120}},
      {ushuaia, {-54.85, -68.3, 100.0}, {0.0, -5566.101749, 72.571326}},
      {ushuaia, {-54.72, -68.2, 1500.0}, {6445.408564, 8903.023610, 1465.539073}},
      {north, {89.95, 0.0, 10.0}, {0.0, -5584.706981, 7.563212}},
      {north, {89.91, 90.0, 2000.0}, {10055.595534, 0.0, 1992.102352}},
      {north, {90.0, -135.0, 100.0}, {0.0, 0.0, 100.0}},
      {north, {89.92, 12.0, 10.0}, {1857.801019, -8740.266610, 3.761823}},
      {south, {-89.92, 45.0, 2850.0}, {2313.711495, 8634.888855, 8.759054}},
      {south, {-90.0, -100.0, 3000.0}, {0.0, 0.0, 165.0}},
      {zero, {0.05, -0.07, 0.0}, {-7792.359470, 5528.713103, -7.172438}},
      {zero, {-0.08, 0.05, 500.0}, {5566.404776, -8846.637381, 491.395079}},
  };
  for (const ProjCase& c : cases) {
    const LocalFrame frame({c.origin, 0.0, ""});
    const dvec3 local = frame.local(c.place);
    EXPECT_LT(distance_m(local, c.local_m), 1e-6) << c.place.latitude_deg << ' ' << c.place.longitude_deg;
    EXPECT_LT(distance_m(geocentric(frame.place(c.local_m)), geocentric(c.place)), 1e-6);
  }
}

/// Returns the largest distance between a place of the globe at a height and the place that its position is
/// taken for, and the largest difference of heights.
dvec2 worst_round_trip_m(double height_m) {
  double apart = 0.0, heights = 0.0;
  for (double latitude = -90.0; latitude <= 90.0; latitude += 2.5)
    for (double longitude = -180.0; longitude < 180.0; longitude += 15.0) {
      const dvec3 position = geocentric({latitude, longitude, height_m});
      const Geodetic back = geodetic(position);
      apart = std::max(apart, distance_m(geocentric(back), position));
      heights = std::max(heights, std::abs(back.height_m - height_m));
      EXPECT_LE(std::abs(back.latitude_deg), 90.0);
      EXPECT_LE(std::abs(back.longitude_deg), 180.0);
    }
  return {apart, heights};
}

TEST(Geodesy, RoundTripsOverTheGlobe) {
  for (const double height : {-1000.0, -11.0, 0.0, 400.0, 8848.0, 1e5, 1e6}) {
    const dvec2 worst = worst_round_trip_m(height);
    EXPECT_LT(worst.x, 1e-8) << height;
    EXPECT_LT(worst.y, 1e-8) << height;
  }
}

TEST(Geodesy, RoundTripsFarFromTheGroundToo) {
  for (const double height : {-5e6, -1e6, 1e7, 3.6e7, 1e8}) {
    const dvec2 worst = worst_round_trip_m(height);
    const double digits = 4e-15 * (std::abs(height) + equator_m);  // some units in the last place
    EXPECT_LT(worst.x, digits) << height;
    EXPECT_LT(worst.y, digits) << height;
  }
}

TEST(Geodesy, IsFiniteEvenAtTheCentreOfTheEarth) {
  for (const dvec3& point : {dvec3(0.0), dvec3(1.0, 0.0, 0.0), dvec3(0.0, -2e4, 1.0), dvec3(0.0, 0.0, 1e-3),
                             dvec3(4e4, 0.0, 0.0), dvec3(3.0, 4.0, -4.2e4)}) {
    const Geodetic place = geodetic(point);
    EXPECT_LE(std::abs(place.latitude_deg), 90.0);
    EXPECT_LE(std::abs(place.longitude_deg), 180.0);
    EXPECT_LT(distance_m(geocentric(place), point), 1e5) << point.x << ' ' << point.y << ' ' << point.z;
  }
}

TEST(Geodesy, PolesHaveLongitudeZero) {
  const Geodetic north = geodetic({0.0, 0.0, polar_m + 5.0}), south = geodetic({0.0, 0.0, -polar_m + 7.0});
  EXPECT_EQ(north.latitude_deg, 90.0);
  EXPECT_EQ(north.longitude_deg, 0.0);
  EXPECT_NEAR(north.height_m, 5.0, 1e-8);
  EXPECT_EQ(south.latitude_deg, -90.0);
  EXPECT_NEAR(south.height_m, -7.0, 1e-8);
}

// A short step along the meridian is the radius of curvature M times the angle, along the parallel it is
// N cos(latitude) times the angle, and a long one leaves the plane by d^2 / 2R.
TEST(Geodesy, AxesAreEastNorthUp) {
  for (const double latitude : {-75.0, -30.0, 0.0, 48.0, 89.0}) {
    const LocalFrame frame = frame_at(latitude, -122.0, 0.0);
    const double sine = std::sin(radians(latitude)), e2 = flat * (2.0 - flat);
    const double w = std::sqrt(1.0 - e2 * sine * sine);
    const double meridian = equator_m * (1.0 - e2) / (w * w * w), prime = equator_m / w;
    constexpr double step_deg = 1e-5;
    const dvec3 north = frame.local({latitude + step_deg, -122.0, 0.0}),
                east = frame.local({latitude, -122.0 + step_deg, 0.0}),
                up = frame.local({latitude, -122.0, 1.0});
    EXPECT_NEAR(north.y, meridian * radians(step_deg), 1e-6);
    EXPECT_NEAR(north.x, 0.0, 1e-8);
    EXPECT_NEAR(east.x, prime * std::cos(radians(latitude)) * radians(step_deg), 1e-6);
    EXPECT_LT(distance_m(up, {0.0, 0.0, 1.0}), 5e-9);
    const dvec3 far = frame.local(frame.place({10e3, 0.0, 0.0}));
    EXPECT_LT(distance_m(far, {10e3, 0.0, 0.0}), 1e-8);
    EXPECT_NEAR(frame.place({10e3, 0.0, 0.0}).height_m, 10e3 * 10e3 / (2.0 * prime), 1e-4);
  }
}

TEST(Geodesy, DatumHeightsLieBelowByTheUndulation) {
  const LocalFrame frame = frame_at(52.0, 4.0, 45.0, 43.4);
  EXPECT_LT(distance_m(frame.local_of_datum({52.0, 4.0, 1.6}), dvec3(0.0)), 1e-8);
  EXPECT_EQ(frame.local({52.0, 4.01, 3.0}, HeightOf::datum), frame.local({52.0, 4.01, 46.4}));
  EXPECT_EQ(frame.local({52.0, 4.01, 3.0}, HeightOf::ellipsoid), frame.local({52.0, 4.01, 3.0}));
  EXPECT_NEAR(frame.datum_place(dvec3(0.0)).height_m, 1.6, 1e-8);
}

TEST(Geodesy, RefusesOriginsThatAreNotOnEarth) {
  const auto message = [](const Georeference& reference) -> std::string {
    try {
      const LocalFrame frame(reference);
    } catch (const UserError& error) {
      return error.what();
    }
    return "no error";
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(message({{90.5, 0.0, 0.0}, 0.0, ""}), "latitude_deg: expected -90 to 90 degrees, found 90.5");
  EXPECT_EQ(message({{0.0, -181.0, 0.0}, 0.0, ""}),
            "longitude_deg: expected -180 to 180 degrees, found -181");
  EXPECT_EQ(message({{nan, 0.0, 0.0}, 0.0, ""}), "latitude_deg: expected -90 to 90 degrees, found nan");
  EXPECT_EQ(message({{0.0, 0.0, 2e6}, 0.0, ""}),
            "height_m: expected -1000000 to 1000000 metres, found 2000000");
  EXPECT_EQ(message({{0.0, 0.0, 0.0}, -1e300, ""}),
            "undulation_m: expected -10000 to 10000 metres, found -1e300");
  EXPECT_EQ(message({{-90.0, 180.0, -400.0}, 17.0, "EGM96"}), "no error");
}

}  // namespace
}  // namespace greatx
