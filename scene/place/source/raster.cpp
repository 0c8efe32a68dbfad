// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/source/raster.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/text.h"

namespace greatx::scene::place {

namespace {
/// The formats of docs/places_reference.md. Others are not opened: some name further files, or addresses.
constexpr const char* raster_drivers[] = {"GTiff", "SRTMHGT", "AAIGrid", "EHdr",        "XYZ",
                                          "DTED",  "PNG",     "JPEG",    "JP2OpenJPEG", nullptr};
}  // namespace

Raster::Raster(const std::filesystem::path& file, const std::string& crs) : where_(file.string()) {
  prepare_gdal();
  dataset_.reset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR,
                                   raster_drivers));
  if (!dataset_ || dataset_->GetRasterCount() == 0)
    throw_user_error("{}: expected a raster (GeoTIFF, HGT, ESRI ASCII grid, PNG, JPEG){}", where_,
                     messages_.suffix());
  if (dataset_->GetGeoTransform(transform_.data()) != CE_None)
    throw_user_error(
        "{}: expected a raster that says where it lies: a GeoTIFF, or a world file (.wld, .pgw, .jgw) beside "
        "it",
        where_);
  if (!GDALInvGeoTransform(transform_.data(), inverse_.data()))
    throw_user_error("{}: the raster's place on the Earth spans no area", where_);
  projection_ = std::make_shared<const Projection>(where_, crs, dataset_->GetSpatialRef());
}

std::vector<dvec2> Raster::places(std::vector<dvec2> pixels) const {
  for (dvec2& pixel : pixels)
    pixel = {transform_[0] + pixel.x * transform_[1] + pixel.y * transform_[2],
             transform_[3] + pixel.x * transform_[4] + pixel.y * transform_[5]};
  projection_->to_degrees(pixels);
  return pixels;
}

std::vector<dvec2> Raster::pixels(std::vector<dvec2> degrees) const {
  projection_->from_degrees(degrees);
  for (dvec2& p : degrees)
    p = {inverse_[0] + p.x * inverse_[1] + p.y * inverse_[2],
         inverse_[3] + p.x * inverse_[4] + p.y * inverse_[5]};
  return degrees;
}

std::vector<dvec2> Raster::turned_to_file(std::vector<dvec2> degrees) const {
  const Box all = extent();
  for (dvec2& point : degrees) point.x = longitude_near(point.x, (all.low.x + all.high.x) / 2.0);
  return degrees;
}

Box Raster::extent() const {
  constexpr int steps = 20;  // edges are curved
  std::vector<dvec2> edge;
  const dvec2 size(dataset_->GetRasterXSize(), dataset_->GetRasterYSize());
  for (int i = 0; i <= steps; ++i) {
    const double part = double(i) / steps;
    for (const dvec2& at : {dvec2(part, 0.0), dvec2(part, 1.0), dvec2(0.0, part), dvec2(1.0, part)})
      edge.push_back(at * size);
  }
  edge = places(std::move(edge));
  Box box;
  for (const dvec2& point : edge) box.add({longitude_near(point.x, edge.front().x), point.y});
  return box;
}

std::optional<PixelWindow> Raster::window(const Box& degrees, int more) const {
  const Box all = extent();
  constexpr int steps = 16;
  Box box;
  for (const double turn : {0.0, 360.0, -360.0}) {
    const Box turned{degrees.low + dvec2(turn, 0.0), degrees.high + dvec2(turn, 0.0)};
    if (!turned.meets(all)) continue;
    std::vector<dvec2> grid;
    for (int row = 0; row <= steps; ++row)
      for (int column = 0; column <= steps; ++column)
        grid.push_back(turned.low + (turned.high - turned.low) * dvec2(column, row) / double(steps));
    for (const dvec2& p : this->pixels(std::move(grid)))
      if (!std::isnan(p.x)) box.add(p);
  }
  if (box.empty()) return std::nullopt;
  const dvec2 size(dataset_->GetRasterXSize(), dataset_->GetRasterYSize());
  const dvec2 low = glm::clamp(glm::floor(box.low) - double(more), dvec2(0.0), size);
  const dvec2 high = glm::clamp(glm::ceil(box.high) + double(more), dvec2(0.0), size);
  if (!(low.x < high.x && low.y < high.y)) return std::nullopt;
  return PixelWindow{static_cast<int>(low.x), static_cast<int>(low.y), static_cast<int>(high.x - low.x),
                     static_cast<int>(high.y - low.y)};
}

std::string Raster::licence() const {
  for (const char* name : {"TIFFTAG_COPYRIGHT", "EXIF_Copyright", "Copyright"})
    if (const char* text = dataset_->GetMetadataItem(name)) return printable(text);
  return {};
}

}  // namespace greatx::scene::place
