// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Ties a scene to the Earth: the scene's x, y, z are east, north and up in the plane that touches the
// ellipsoid of WGS 84 at the scene's origin (EPSG method 9837, "geographic to topocentric").
//
//   latitude, longitude, height (Geodetic)
//     -> geocentric x, y, z     geocentric(), geodetic()            EPSG method 9602
//     -> the scene's x, y, z    LocalFrame, made of a Georeference  EPSG method 9836: a shift and a rotation
//
// The frame is a plane, and the ellipsoid curves away below it: a point at height 0 that is 10 km from the
// origin has z = -7.9 m. Both ways are exact to nanometres, so that no distance limits their use but that of
// the plane.
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

/// Says where heights begin.
enum class HeightOf {
  datum,      ///< at the scene's vertical datum, near the level of the sea
  ellipsoid,  ///< at the ellipsoid of WGS 84
};

/// Names the place of a scene's origin. Heights of maps are above a vertical datum near the sea's level. The
/// height h above the ellipsoid is greater than the height H above the datum by the undulation N: h = H + N.
struct Georeference {
  Geodetic origin;             ///< of x = y = z = 0
  double undulation_m = 0.0;   ///< N at the origin, taken as constant over the scene
  std::string vertical_datum;  ///< for people, "NAP"; empty: unknown
  bool operator==(const Georeference&) const = default;
};

/// The bounds of a georeference's height and undulation. The undulations of the Earth's geoid are within
/// 110 m; the datum of a building site may be anywhere.
inline constexpr double most_origin_height_m = 1e6, most_undulation_m = 1e4;

/// Returns the Earth-centred position in metres (EPSG Guidance Note 7-2, method 9602).
dvec3 geocentric(const Geodetic& place);
/// Returns the inverse, with a longitude of -180...180. It is exact to some nanometres from 5000 km below the
/// ellipsoid outwards (Bowring's formula, repeated until it stands still). At a pole the longitude is 0.
/// Nearer to the centre of the Earth than 50 km several places have the same position; the result is finite
/// there and not exact.
Geodetic geodetic(const dvec3& geocentric_m);

/// Converts between places on the Earth and the scene's x, y, z.
class LocalFrame {
 public:
  /// Throws UserError "latitude_deg: expected ..., found ..." if a number is out of its range or not finite.
  explicit LocalFrame(const Georeference& reference);

  dvec3 local(const Geodetic& place) const;
  Geodetic place(const dvec3& local_m) const;
  /// Do the same with heights above the vertical datum.
  dvec3 local_of_datum(const Geodetic& place) const;
  Geodetic datum_place(const dvec3& local_m) const;
  /// Does the same with heights as `heights` says.
  dvec3 local(const Geodetic& place, HeightOf heights) const {
    return heights == HeightOf::datum ? local_of_datum(place) : local(place);
  }
  const Georeference& reference() const { return reference_; }

 private:
  Georeference reference_;
  dvec3 origin_{0.0};  ///< geocentric
  dmat3 local_from_earth_{1.0};
};

}  // namespace greatx
