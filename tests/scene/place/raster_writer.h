// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes rasters by GDAL for the tests of terrain and pictures.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <gdal_priv.h>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace greatx::scene::place::test {

struct TiffOptions {
  int epsg = 4326;  ///< 0: none
  std::optional<double> no_data;
  std::string unit;
  bool pixel_is_point = false;
  std::vector<GDALColorInterp> meanings;
  GDALDataType type = GDT_Float32;
};

/// Writes a raster whose upper left corner is at (left, top). Bands have `value(band, column, row)`.
inline void write_raster(const std::filesystem::path& file, const char* driver, int bands, int columns,
                         int rows, double left, double top, double cell, const TiffOptions& options,
                         const std::function<double(int, int, int)>& value) {
  GDALAllRegister();
  const bool tiff = std::string(driver) == "GTiff";
  std::unique_ptr<GDALDataset> memory(GetGDALDriverManager()->GetDriverByName("MEM")->Create(
      "", columns, rows, bands, options.type, nullptr));
  std::array<double, 6> transform{left, cell, 0.0, top, 0.0, -cell};
  if (tiff) memory->SetGeoTransform(transform.data());
  if (options.epsg != 0) {
    OGRSpatialReference crs;
    crs.importFromEPSG(options.epsg);
    memory->SetSpatialRef(&crs);
  }
  if (options.pixel_is_point) memory->SetMetadataItem("AREA_OR_POINT", "Point");
  for (int band = 0; band < bands; ++band) {
    GDALRasterBand& target = *memory->GetRasterBand(band + 1);
    if (options.no_data) target.SetNoDataValue(*options.no_data);
    if (!options.unit.empty()) target.SetUnitType(options.unit.c_str());
    if (static_cast<size_t>(band) < options.meanings.size())
      target.SetColorInterpretation(options.meanings[band]);
    std::vector<double> values;
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column) values.push_back(value(band, column, row));
    ASSERT_EQ(target.RasterIO(GF_Write, 0, 0, columns, rows, values.data(), columns, rows, GDT_Float64, 0, 0),
              CE_None);
  }
  std::unique_ptr<GDALDataset> written(GetGDALDriverManager()->GetDriverByName(driver)->CreateCopy(
      file.c_str(), memory.get(), FALSE, nullptr, nullptr, nullptr));
  ASSERT_TRUE(written);
}

}  // namespace greatx::scene::place::test
