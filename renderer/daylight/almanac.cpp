// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/daylight/almanac.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "core/units.h"
#include "renderer/daylight/moon_terms.h"

namespace greatx::render {

namespace {

constexpr double astronomical_unit_m = 149597870700.0;                                 // IAU 2012, exact
constexpr double earth_equator_m = 6378137.0, earth_flattening = 1.0 / 298.257223563;  // WGS 84
constexpr double sun_radius_m = 6.957e8, moon_radius_m = 1.7374e6;                     // IAU 2015

double centuries(double jde) { return (jde - 2451545.0) / 36525.0; }

double turn(double angle_deg) { return radians(std::remainder(angle_deg, 360.0)); }

/// Holds the main terms of ch. 22: within 0.5" in longitude and 0.1" in obliquity.
struct Nutation {
  double longitude, obliquity;  ///< rad; the obliquity is the true one, mean plus nutation
};

Nutation nutation(double t) {
  const double node = turn(125.04452 - 1934.136261 * t), sun = turn(280.4665 + 36000.7698 * t),
               moon = turn(218.3165 + 481267.8813 * t);
  const double longitude = -17.20 * std::sin(node) - 1.32 * std::sin(2.0 * sun) -
                           0.23 * std::sin(2.0 * moon) + 0.21 * std::sin(2.0 * node);
  const double shift = 9.20 * std::cos(node) + 0.57 * std::cos(2.0 * sun) + 0.10 * std::cos(2.0 * moon) -
                       0.09 * std::cos(2.0 * node);
  const double mean = 84381.448 - 46.8150 * t - 0.00059 * t * t + 0.001813 * t * t * t;  // eq. 22.2
  return {radians(longitude / 3600.0), radians((mean + shift) / 3600.0)};
}

/// Applies ch. 13, eq. 13.3 and 13.4.
void to_equator(GeocentricPlace& place, double longitude, double obliquity) {
  const double l = longitude, b = place.latitude;
  place.right_ascension =
      std::atan2(std::sin(l) * std::cos(obliquity) - std::tan(b) * std::sin(obliquity), std::cos(l));
  place.declination =
      std::asin(std::sin(b) * std::cos(obliquity) + std::cos(b) * std::sin(obliquity) * std::sin(l));
}

/// Returns the apparent sidereal time at Greenwich, rad (ch. 12, eq. 12.4), for a Julian day of UT.
double sidereal_time(double jd, const Nutation& nutation) {
  const double t = centuries(jd);
  const double mean =
      280.46061837 + 360.98564736629 * (jd - 2451545.0) + 0.000387933 * t * t - t * t * t / 38710000.0;
  return turn(mean) + nutation.longitude * std::cos(nutation.obliquity);
}

Sighting sight(const GeocentricPlace& place, double sidereal, const Observer& observer, double radius_m) {
  // The axes are those of the equator: x in the observer's meridian, y west, z north. The parallax is the
  // difference of two points.
  const double hour_angle = sidereal + observer.longitude - place.right_ascension;
  const dvec3 body = place.distance_m * dvec3(std::cos(place.declination) * std::cos(hour_angle),
                                              std::cos(place.declination) * std::sin(hour_angle),
                                              std::sin(place.declination));
  const double sine = std::sin(observer.latitude), cosine = std::cos(observer.latitude);
  const double e2 = earth_flattening * (2.0 - earth_flattening);
  const double normal = earth_equator_m / std::sqrt(1.0 - e2 * sine * sine);
  const dvec3 from((normal + observer.height_m) * cosine, 0.0,
                   (normal * (1.0 - e2) + observer.height_m) * sine);
  const dvec3 seen = body - from;
  const double up = seen.x * cosine + seen.z * sine, north = seen.z * cosine - seen.x * sine, east = -seen.y;
  Sighting sighting;
  sighting.distance_m = glm::length(seen);
  sighting.azimuth = std::atan2(north, east);
  sighting.true_elevation = std::atan2(up, std::hypot(north, east));
  sighting.elevation = sighting.true_elevation +
                       refraction(sighting.true_elevation, observer.pressure_hpa, observer.temperature_k);
  sighting.angular_radius = std::asin(radius_m / sighting.distance_m);
  return sighting;
}

}  // namespace

double delta_t(double year) {
  const auto polynomial = [](double t, std::initializer_list<double> coefficients) {
    double sum = 0.0, power = 1.0;
    for (const double c : coefficients) {
      sum += c * power;
      power *= t;
    }
    return sum;
  };
  if (year < 1920.0) return polynomial(year - 1900.0, {-2.79, 1.494119, -0.0598939, 0.0061966, -0.000197});
  if (year < 1941.0) return polynomial(year - 1920.0, {21.20, 0.84493, -0.076100, 0.0020936});
  if (year < 1961.0) return polynomial(year - 1950.0, {29.07, 0.407, -1.0 / 233.0, 1.0 / 2547.0});
  if (year < 1986.0) return polynomial(year - 1975.0, {45.45, 1.067, -1.0 / 260.0, -1.0 / 718.0});
  if (year < 2005.0)
    return polynomial(year - 2000.0, {63.86, 0.3345, -0.060374, 0.0017275, 0.000651814, 0.00002373599});
  if (year < 2050.0) return polynomial(year - 2000.0, {62.92, 0.32217, 0.005589});
  const double u = (year - 1820.0) / 100.0;
  return -20.0 + 32.0 * u * u - 0.5628 * (2150.0 - year);
}

double julian_day(double unix_s) { return 2440587.5 + unix_s / 86400.0; }

GeocentricPlace sun_from_earth(double jde) {
  const double t = centuries(jde);
  const double mean_longitude = 280.46646 + 36000.76983 * t + 0.0003032 * t * t;
  const double anomaly = turn(357.52911 + 35999.05029 * t - 0.0001537 * t * t);
  const double eccentricity = 0.016708634 - 0.000042037 * t - 0.0000001267 * t * t;
  const double center = (1.914602 - 0.004817 * t - 0.000014 * t * t) * std::sin(anomaly) +
                        (0.019993 - 0.000101 * t) * std::sin(2.0 * anomaly) +
                        0.000289 * std::sin(3.0 * anomaly);
  const double node = turn(125.04 - 1934.136 * t);
  GeocentricPlace place;
  // The longitude gets aberration and nutation.
  place.longitude = turn(mean_longitude + center - 0.00569 - 0.00478 * std::sin(node));
  const double mean_obliquity = (84381.448 - 46.8150 * t - 0.00059 * t * t + 0.001813 * t * t * t) / 3600.0;
  to_equator(place, place.longitude, radians(mean_obliquity + 0.00256 * std::cos(node)));
  place.distance_m = astronomical_unit_m * 1.000001018 * (1.0 - eccentricity * eccentricity) /
                     (1.0 + eccentricity * std::cos(anomaly + radians(center)));
  return place;
}

GeocentricPlace moon_from_earth(double jde) {
  const double t = centuries(jde), t2 = t * t, t3 = t2 * t, t4 = t3 * t;
  const double longitude =
      218.3164477 + 481267.88123421 * t - 0.0015786 * t2 + t3 / 538841.0 - t4 / 65194000.0;
  const double l = turn(longitude);
  const double d = turn(297.8501921 + 445267.1114034 * t - 0.0018819 * t2 + t3 / 545868.0 - t4 / 113065000.0);
  const double m = turn(357.5291092 + 35999.0502909 * t - 0.0001536 * t2 + t3 / 24490000.0);
  const double m1 = turn(134.9633964 + 477198.8675055 * t + 0.0087414 * t2 + t3 / 69699.0 - t4 / 14712000.0);
  const double f = turn(93.2720950 + 483202.0175233 * t - 0.0036539 * t2 - t3 / 3526000.0 + t4 / 863310000.0);
  const double a1 = turn(119.75 + 131.849 * t), a2 = turn(53.09 + 479264.290 * t),
               a3 = turn(313.45 + 481266.484 * t);
  const double e = 1.0 - 0.002516 * t - 0.0000074 * t2;
  const auto scale = [&](int anomaly) { return anomaly == 0 ? 1.0 : std::abs(anomaly) == 1 ? e : e * e; };
  double sum_l = 3958.0 * std::sin(a1) + 1962.0 * std::sin(l - f) + 318.0 * std::sin(a2);
  double sum_r = 0.0;
  for (const MoonTerm& term : moon_longitude_terms) {
    const double argument = term.d * d + term.m * m + term.m1 * m1 + term.f * f;
    sum_l += term.sine * scale(term.m) * std::sin(argument);
    sum_r += term.cosine * scale(term.m) * std::cos(argument);
  }
  double sum_b = -2235.0 * std::sin(l) + 382.0 * std::sin(a3) + 175.0 * std::sin(a1 - f) +
                 175.0 * std::sin(a1 + f) + 127.0 * std::sin(l - m1) - 115.0 * std::sin(l + m1);
  for (const MoonTerm& term : moon_latitude_terms)
    sum_b += term.sine * scale(term.m) * std::sin(term.d * d + term.m * m + term.m1 * m1 + term.f * f);
  GeocentricPlace place;
  place.longitude = turn(longitude + sum_l * 1e-6);
  place.latitude = radians(sum_b * 1e-6);
  place.distance_m = 385000560.0 + sum_r;
  const Nutation wobble = nutation(t);
  to_equator(place, place.longitude + wobble.longitude, wobble.obliquity);
  return place;
}

double phase_angle(const GeocentricPlace& sun, const GeocentricPlace& moon) {
  const double cosine = std::sin(sun.declination) * std::sin(moon.declination) +
                        std::cos(sun.declination) * std::cos(moon.declination) *
                            std::cos(sun.right_ascension - moon.right_ascension);
  const double elongation = std::acos(glm::clamp(cosine, -1.0, 1.0));
  return std::atan2(sun.distance_m * std::sin(elongation),
                    moon.distance_m - sun.distance_m * std::cos(elongation));
}

double illuminated_share(double phase_angle) { return 0.5 * (1.0 + std::cos(phase_angle)); }

double refraction(double true_elevation, double pressure_hpa, double temperature_k) {
  constexpr double unseen = -5.0 / 6.0, gone = -6.0;
  const double h = degrees(true_elevation);
  if (h <= gone) return 0.0;
  const double used = std::max(h, unseen);
  const double minutes = 1.02 / std::tan(radians(used + 10.3 / (used + 5.11)));
  const double fade = h < unseen ? (h - gone) / (unseen - gone) : 1.0;
  // Within a tenth of a minute of the zenith the formula passes below 0.
  return std::max(0.0, radians(minutes / 60.0) * fade * pressure_hpa / 1010.0 * 283.0 / temperature_k);
}

SunAndMoon sun_and_moon(double unix_s, const Observer& observer) {
  const double jd = julian_day(unix_s);
  const double jde = jd + delta_t(2000.0 + (jd - 2451544.5) / 365.2425) / 86400.0;
  const double sidereal = sidereal_time(jd, nutation(centuries(jde)));
  const GeocentricPlace sun = sun_from_earth(jde), moon = moon_from_earth(jde);
  SunAndMoon both;
  both.sun = sight(sun, sidereal, observer, sun_radius_m);
  both.moon = sight(moon, sidereal, observer, moon_radius_m);
  both.moon_phase_angle = phase_angle(sun, moon);
  return both;
}

}  // namespace greatx::render
