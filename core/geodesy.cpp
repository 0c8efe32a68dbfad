// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "core/geodesy.h"

#include <cmath>

#include "core/error.h"
#include "core/expected.h"
#include "core/units.h"

namespace greatx {

namespace {

// WGS 84 (NGA.STND.0036, Table 3.1): the semi-major axis and the flattening define the ellipsoid.
constexpr double semi_major = 6378137.0, flattening = 1.0 / 298.257223563;
constexpr double semi_minor = semi_major * (1.0 - flattening);
constexpr double eccentricity_2 = flattening * (2.0 - flattening);
constexpr double second_eccentricity_2 = eccentricity_2 / (1.0 - eccentricity_2);

}  // namespace

dvec3 geocentric(const Geodetic& place) {
  const double latitude = radians(place.latitude_deg), longitude = radians(place.longitude_deg);
  const double sine = std::sin(latitude), cosine = std::cos(latitude);
  const double normal = semi_major / std::sqrt(1.0 - eccentricity_2 * sine * sine);
  return {(normal + place.height_m) * cosine * std::cos(longitude),
          (normal + place.height_m) * cosine * std::sin(longitude),
          (normal * (1.0 - eccentricity_2) + place.height_m) * sine};
}

Geodetic geodetic(const dvec3& p) {
  const double across = std::hypot(p.x, p.y);
  const double longitude = across > 0.0 ? std::atan2(p.y, p.x) : 0.0;
  if (across == 0.0 && p.z == 0.0) return {90.0, degrees(longitude), -semi_minor};
  // The sine and the cosine of the parametric latitude stand for it, since its tangent is infinite at a pole.
  // A step shrinks the error by some 1e-3 near the ellipsoid and by less within the Earth.
  double sine = p.z / semi_minor, cosine = across / semi_major, latitude = 0.0;
  constexpr int most_steps = 50;
  for (int step = 0; step < most_steps; ++step) {
    const double length = std::hypot(sine, cosine);
    sine /= length, cosine /= length;
    const double up = p.z + second_eccentricity_2 * semi_minor * sine * sine * sine,
                 out = across - eccentricity_2 * semi_major * cosine * cosine * cosine;
    const double before = latitude;
    latitude = std::atan2(up, out);
    if (step > 0 && std::abs(latitude - before) < 1e-16) break;
    sine = semi_minor * std::sin(latitude), cosine = semi_major * std::cos(latitude);
  }
  // This expression of the height is stable at the poles and at the equator alike.
  const double s = std::sin(latitude), c = std::cos(latitude);
  const double height = across * c + p.z * s - semi_major * std::sqrt(1.0 - eccentricity_2 * s * s);
  return {degrees(latitude), degrees(longitude), height};
}

LocalFrame::LocalFrame(const Georeference& reference) : reference_(reference) {
  const auto& [latitude_deg, longitude_deg, height_m] = reference.origin;
  const auto require = [](const char* what, const char* unit, double value, double most) {
    if (!(std::abs(value) <= most))
      throw_user_error("{}: expected {} to {} {}, found {}", what, number_words(-most), number_words(most),
                       unit, number_words(value));
  };
  require("latitude_deg", "degrees", latitude_deg, 90.0);
  require("longitude_deg", "degrees", longitude_deg, 180.0);
  require("height_m", "metres", height_m, most_origin_height_m);
  require("undulation_m", "metres", reference.undulation_m, most_undulation_m);
  origin_ = geocentric(reference.origin);
  const double latitude = radians(latitude_deg), longitude = radians(longitude_deg);
  const double sl = std::sin(latitude), cl = std::cos(latitude), so = std::sin(longitude),
               co = std::cos(longitude);
  const dvec3 east(-so, co, 0.0), north(-sl * co, -sl * so, cl), up(cl * co, cl * so, sl);
  local_from_earth_ = glm::transpose(dmat3(east, north, up));
}

dvec3 LocalFrame::local(const Geodetic& place) const {
  return local_from_earth_ * (geocentric(place) - origin_);
}

Geodetic LocalFrame::place(const dvec3& local_m) const {
  return geodetic(origin_ + glm::transpose(local_from_earth_) * local_m);
}

dvec3 LocalFrame::local_of_datum(const Geodetic& place) const {
  return local({place.latitude_deg, place.longitude_deg, place.height_m + reference_.undulation_m});
}

Geodetic LocalFrame::datum_place(const dvec3& local_m) const {
  Geodetic found = place(local_m);
  found.height_m -= reference_.undulation_m;
  return found;
}

}  // namespace greatx
