// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Opens a raster by GDAL and finds the pixels of an area.
#pragma once

#include <array>
#include <gdal_priv.h>
#include <memory>
#include <optional>
#include <string>

#include "scene/place/source/crs.h"
#include "scene/place/source/map_contents.h"

namespace greatx::scene::place {

/// Pixels [column, column + columns) x [row, row + rows).
struct PixelWindow {
  int column = 0, row = 0, columns = 0, rows = 0;
};

class Raster {
 public:
  /// Throws UserError if the file is no raster, has no place on the Earth (neither GeoTIFF's tags nor a world
  /// file), or no CRS.
  Raster(const std::filesystem::path& file, const std::string& crs);
  GDALDataset& dataset() const { return *dataset_; }
  const std::shared_ptr<const Projection>& projection() const { return projection_; }
  /// Returns the affine map of GDAL: x = t[0] + t[1] column + t[2] row, y = t[3] + t[4] column + t[5] row.
  const std::array<double, 6>& transform() const { return transform_; }
  const std::string& where() const { return where_; }
  const GdalMessages& messages() const { return messages_; }

  /// Returns the place of a pixel's (column, row) in degrees; centres are at half-integers.
  std::vector<dvec2> places(std::vector<dvec2> pixels) const;
  /// Returns the inverse; NaN where there is none.
  std::vector<dvec2> pixels(std::vector<dvec2> degrees) const;
  /// Returns degrees whose longitudes are those nearest to the file's, for files in degrees.
  std::vector<dvec2> turned_to_file(std::vector<dvec2> degrees) const;
  /// Returns the box of all pixels in degrees.
  Box extent() const;
  /// Returns the pixels of the box and `more` pixels around them, or nothing if they do not meet.
  std::optional<PixelWindow> window(const Box& degrees, int more) const;
  std::string licence() const;

 private:
  struct Close {
    void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
  };
  std::string where_;
  GdalMessages messages_;
  std::unique_ptr<GDALDataset, Close> dataset_;
  std::shared_ptr<const Projection> projection_;
  std::array<double, 6> transform_{}, inverse_{};
};

}  // namespace greatx::scene::place
