// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks pictures of the ground: formats, world files, unknown pixels, and those that are resampled.
#include <array>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scene/place/place_folder.h"
#include "tests/scene/place/raster_writer.h"

namespace greatx::scene::place {
namespace {

using test::findings_of;
using test::message_of;
using test::PlaceFolder;
using test::TiffOptions;
using test::write_raster;
using testing::HasSubstr;

const std::string picture_area = "area: {bounds_deg: [48.002, 10.002, 48.008, 10.008]}\n";

/// Returns the colour at a place, or nothing where the picture has none.
std::optional<std::array<int, 3>> colour(const GroundPicture& picture, const dvec2& local) {
  const dvec2 pixel = picture.pixel_from_local * dvec3(local, 1.0);
  if (!(pixel.x >= 0.0 && pixel.y >= 0.0 && pixel.x < picture.width && pixel.y < picture.height))
    return std::nullopt;
  const size_t at = static_cast<size_t>(pixel.y) * picture.width + static_cast<size_t>(pixel.x);
  if (!picture.known.empty() && picture.known[at] == 0) return std::nullopt;
  return std::array<int, 3>{picture.rgb[3 * at], picture.rgb[3 * at + 1], picture.rgb[3 * at + 2]};
}

/// Column and row of a picture as colours, so that places can be read off it.
double ramp(int band, int column, int row) {
  return band == 0 ? column : band == 1 ? row : band == 2 ? 7 : 255;
}

/// Expects that the colours at places are those of (column, row) of a picture of 200 x 200 pixels of 5e-5
/// degrees from (10.0, 48.01).
void expect_ramp(const PlaceInput& input, bool grey = false) {
  ASSERT_EQ(input.pictures.size(), 1u);
  const LocalFrame frame(input.reference);
  for (const dvec2 place : {dvec2(0.3, 0.4), dvec2(-151.0, 88.0), dvec2(133.0, -144.0), dvec2(20.0, 199.0)}) {
    const Geodetic at = frame.datum_place({place, 0.0});
    const double column = (at.longitude_deg - 10.0) / 5e-5 - 0.5,
                 row = (48.01 - at.latitude_deg) / 5e-5 - 0.5;
    const auto found = colour(input.pictures[0], place);
    ASSERT_TRUE(found);
    EXPECT_NEAR((*found)[0], column, 1.01);
    EXPECT_NEAR((*found)[1], grey ? column : row, 1.01);
    EXPECT_EQ((*found)[2], grey ? (*found)[0] : 7);
  }
}

TEST(PlacePicture, GeoTiffAndWorldFiles) {
  const PlaceFolder folder;
  TiffOptions options;
  options.type = GDT_Byte;
  options.meanings = {GCI_RedBand, GCI_GreenBand, GCI_BlueBand, GCI_AlphaBand};
  write_raster(folder.path("rgb.tif"), "GTiff", 3, 200, 200, 10.0, 48.01, 5e-5, options, ramp);
  write_raster(folder.path("rgba.tif"), "GTiff", 4, 200, 200, 10.0, 48.01, 5e-5, options, ramp);
  write_raster(folder.path("p.png"), "PNG", 3, 200, 200, 0, 0, 1, options, ramp);
  options.meanings = {GCI_GrayIndex};
  write_raster(folder.path("grey.tif"), "GTiff", 1, 200, 200, 10.0, 48.01, 5e-5, options, ramp);
  // A world file gives the centre of the upper left pixel.
  folder.write("p.pgw", "0.00005\n0\n0\n-0.00005\n10.000025\n48.009975\n");
  std::filesystem::remove(folder.path("p.png.aux.xml"));
  for (const char* file : {"rgb.tif", "rgba.tif", "grey.tif", "p.png"}) {
    const PlaceInput input =
        folder.read(picture_area + fmt::format("pictures: [{{file: {}, crs: \"EPSG:4326\"}}]\n", file));
    expect_ramp(input, std::string(file) == "grey.tif");
    EXPECT_TRUE(input.findings.empty()) << file;
  }
  EXPECT_THAT(message_of([&] { folder.read(picture_area + "pictures: [{file: p.png}]\n"); }),
              HasSubstr("no coordinate system"));
  std::filesystem::remove(folder.path("p.pgw"));
  EXPECT_THAT(
      message_of([&] { folder.read(picture_area + "pictures: [{file: p.png, crs: \"EPSG:4326\"}]\n"); }),
      HasSubstr("world file"));
}

TEST(PlacePicture, PalettesAndUnknownPixels) {
  const PlaceFolder folder;
  TiffOptions options;
  options.type = GDT_Byte;
  options.meanings = {GCI_RedBand, GCI_GreenBand, GCI_BlueBand, GCI_AlphaBand};
  write_raster(folder.path("rgba.tif"), "GTiff", 4, 200, 200, 10.0, 48.01, 5e-5, options,
               [](int band, int column, int row) {
                 return band < 3 ? ramp(band, column, row) : column < 100 ? 0 : 255;
               });
  const PlaceInput input = folder.read(picture_area + "pictures: [{file: rgba.tif}]\n");
  EXPECT_FALSE(colour(input.pictures.at(0), {-50.0, 0.0}));
  EXPECT_TRUE(colour(input.pictures[0], {50.0, 0.0}));
  ASSERT_EQ(findings_of(input, "pictures_do_not_cover").size(), 1u);
  EXPECT_THAT(findings_of(input, "pictures_do_not_cover")[0].detail, HasSubstr("50.0 %"));

  GDALAllRegister();
  std::unique_ptr<GDALDataset> tiff(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      folder.path("p.tif").c_str(), 200, 200, 1, GDT_Byte, nullptr));
  std::array<double, 6> transform{10.0, 5e-5, 0.0, 48.01, 0.0, -5e-5};
  tiff->SetGeoTransform(transform.data());
  OGRSpatialReference crs;
  crs.importFromEPSG(4326);
  tiff->SetSpatialRef(&crs);
  GDALColorTable table;
  const GDALColorEntry green{10, 200, 30, 255};
  table.SetColorEntry(3, &green);
  tiff->GetRasterBand(1)->SetColorTable(&table);
  tiff->GetRasterBand(1)->Fill(3);
  tiff.reset();
  const PlaceInput paletted = folder.read(picture_area + "pictures: [{file: p.tif}]\n");
  EXPECT_EQ(colour(paletted.pictures.at(0), {1.0, 1.0}).value(), (std::array<int, 3>{10, 200, 30}));

  options.type = GDT_UInt16;
  write_raster(folder.path("deep.tif"), "GTiff", 3, 20, 20, 10.0, 48.01, 5e-4, options, ramp);
  EXPECT_THAT(message_of([&] { folder.read(picture_area + "pictures: [{file: deep.tif}]\n"); }),
              HasSubstr("8 bits"));
}

/// Meridians converge: a large picture in degrees is no affine map of the frame.
TEST(PlacePicture, BentPicturesAreResampled) {
  const PlaceFolder folder;
  TiffOptions options;
  options.type = GDT_Byte;
  options.meanings = {GCI_RedBand, GCI_GreenBand, GCI_BlueBand};
  // 45 km by 134 km at 70 N; the upper edge is 2.6 km shorter than the lower one, and a pixel is 228 m wide.
  constexpr double left = 10.0, top = 70.6, cell = 0.006;
  write_raster(folder.path("p.tif"), "GTiff", 3, 200, 200, left, top, cell, options, ramp);
  const PlaceInput input = folder.read("area: {extent_of: p.tif}\npictures: [{file: p.tif}]\n");
  const GroundPicture& picture = input.pictures.at(0);
  EXPECT_FALSE(picture.known.empty());
  EXPECT_EQ(picture.pixel_from_local[0].y, 0.0);
  const LocalFrame frame(input.reference);
  for (const dvec2 local :
       {dvec2(0, 0), dvec2(-19'000, 60'000), dvec2(18'000, -60'000), dvec2(20'000, 40'000)}) {
    // The ground at the datum's zero: the plane of x and y lies above it by the Earth's curve.
    const double fall = glm::dot(local, local) / (2.0 * 6.371e6);
    const Geodetic at = frame.place({local, -fall});
    const auto found = colour(picture, local);
    ASSERT_TRUE(found) << local.x;
    EXPECT_NEAR((*found)[0], (at.longitude_deg - left) / cell - 0.5, 1.01);
    EXPECT_NEAR((*found)[1], (top - at.latitude_deg) / cell - 0.5, 1.01);
  }
}

}  // namespace
}  // namespace greatx::scene::place
