// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Converts between the coordinates of files and degrees of WGS 84, by PROJ through GDAL. Longitude and
// easting come first everywhere ("traditional GIS order"), whatever the definition of a CRS says.
#pragma once

#include <memory>
#include <ogr_spatialref.h>
#include <span>
#include <string>
#include <vector>

#include "core/vec.h"
#include "scene/place/input/area_test.h"

namespace greatx::scene::place {

/// Registers GDAL's drivers, and keeps PROJ and GDAL from opening connections.
void prepare_gdal();

/// While it lives, GDAL's messages on this thread come here and not to stderr.
class GdalMessages {
 public:
  GdalMessages();
  ~GdalMessages();
  GdalMessages(const GdalMessages&) = delete;
  GdalMessages& operator=(const GdalMessages&) = delete;
  /// Returns ": MESSAGE" of the last error or else warning, or an empty text.
  std::string suffix() const;
  bool failed() const { return !error_.empty(); }
  void note(bool error, const char* message) { (error ? error_ : warning_) = message; }

 private:
  std::string error_, warning_;
};

/// Converts coordinates of one CRS. Heights are left alone: they stay above the file's vertical datum.
class Projection {
 public:
  /// Takes the CRS that place.yaml gives, or else that of the file, which may be null. Throws UserError if
  /// there is none or if it is not one of the Earth's surface. `where` names the source in messages.
  Projection(std::string where, const std::string& given, const OGRSpatialReference* of_file);
  ~Projection();
  Projection(Projection&&) noexcept;

  /// Converts in place. Throws UserError for a point that is not finite, has no image or lies beyond a pole.
  void to_degrees(std::span<dvec2> points) const;
  dvec2 to_degrees(const dvec2& point) const;
  /// Converts in place; a point without image becomes NaN.
  void from_degrees(std::span<dvec2> degrees) const;
  /// Returns a sentence if PROJ has a more accurate conversion whose grid is not installed, or an empty text.
  std::string missing_grid() const;
  /// Returns a sentence if the middle of an extent lies more than 3 degrees outside the area for which the
  /// CRS is made (EPSG's "area of use"), as it does if x and y are swapped, or an empty text.
  std::string outside_use(const Box& degrees) const;
  bool same_crs(const Projection& other) const;
  bool geographic() const { return geographic_; }

 private:
  std::string where_;
  OGRSpatialReference crs_;
  bool geographic_ = false;
  std::unique_ptr<OGRCoordinateTransformation> to_, from_;
};

}  // namespace greatx::scene::place
