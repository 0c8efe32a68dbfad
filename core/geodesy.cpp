// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "core/geodesy.h"

#include <cmath>

#include "core/error.h"
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
  // Bowring's parametric latitude converges by a factor of some 1e-6 per step near the ellipsoid.
  double tangent = p.z / across * (semi_major / semi_minor);
  double latitude = 0.0;
  for (int step = 0; step < 6; ++step) {
    const double cosine = 1.0 / std::hypot(1.0, tangent),
                 sine = std::isinf(tangent) ? std::copysign(1.0, tangent) : tangent * cosine;
    latitude = std::atan2(p.z + second_eccentricity_2 * semi_minor * sine * sine * sine,
                          across - eccentricity_2 * semi_major * cosine * cosine * cosine);
    tangent = (semi_minor / semi_major) * std::tan(latitude);
  }
  const double sine = std::sin(latitude), cosine = std::cos(latitude);
  // This expression of the height is stable at the poles and at the equator alike.
  const double normal = semi_major / std::sqrt(1.0 - eccentricity_2 * sine * sine);
  const double height = across * cosine + p.z * sine - normal * (1.0 - eccentricity_2 * sine * sine);
  return {degrees(latitude), degrees(std::atan2(p.y, p.x)), height};
}

LocalFrame::LocalFrame(const Georeference& reference) : reference_(reference) {
  const auto& [latitude_deg, longitude_deg, height_m] = reference.origin;
  if (!(std::abs(latitude_deg) <= 90.0))
    throw_user_error("georeference: latitude: expected -90 to 90 degrees, found {}", latitude_deg);
  if (!(std::abs(longitude_deg) <= 180.0))
    throw_user_error("georeference: longitude: expected -180 to 180 degrees, found {}", longitude_deg);
  if (!std::isfinite(height_m) || !std::isfinite(reference.undulation_m))
    throw_user_error("georeference: height: expected finite numbers, found {} and {}", height_m,
                     reference.undulation_m);
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
