// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Ties a scene to the Earth: the scene's x, y, z are east, north and up in the plane that touches the
// ellipsoid of WGS 84 at the scene's origin (EPSG method 9837, "geographic to topocentric").
#pragma once

#include <string>

#include "core/vec.h"

namespace greatx {

/// A place on the Earth (WGS 84, EPSG:4979).
struct Geodetic {
  double latitude_deg = 0.0;   ///< north positive, -90...90
  double longitude_deg = 0.0;  ///< east positive, -180...180
  double height_m = 0.0;       ///< above the ellipsoid
  bool operator==(const Geodetic&) const = default;
};

/// Names the place of a scene's origin. Heights of maps are above a vertical datum near the sea's level; they
/// lie `undulation_m` above the ellipsoid's height: h = H + N.
struct Georeference {
  Geodetic origin;             ///< of x = y = z = 0
  double undulation_m = 0.0;   ///< N at the origin, taken as constant over the scene
  std::string vertical_datum;  ///< for people, "NAP"; empty: unknown
  bool operator==(const Georeference&) const = default;
};

/// Returns the Earth-centred position in metres (EPSG Guidance Note 7-2, method 9602).
dvec3 geocentric(const Geodetic& place);
/// Returns the inverse. It is exact to a nanometre from 1000 km below the ellipsoid to 10,000 km above it
/// (Bowring's formula, repeated).
Geodetic geodetic(const dvec3& geocentric_m);

/// Converts between places on the Earth and the scene's x, y, z.
class LocalFrame {
 public:
  /// Throws UserError if latitude or longitude is out of range or a number is not finite.
  explicit LocalFrame(const Georeference& reference);

  dvec3 local(const Geodetic& place) const;
  Geodetic place(const dvec3& local_m) const;
  /// Does the same with heights above the vertical datum.
  dvec3 local_of_datum(const Geodetic& place) const;
  Geodetic datum_place(const dvec3& local_m) const;
  const Georeference& reference() const { return reference_; }

 private:
  Georeference reference_;
  dvec3 origin_{0.0};  ///< geocentric
  dmat3 local_from_earth_{1.0};
};

}  // namespace greatx
