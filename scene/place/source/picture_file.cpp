// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/source/picture_file.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "scene/place/source/raster.h"

namespace greatx::scene::place {

namespace {

/// Pixels in the file's own grid.
struct Pixels {
  uint32_t width = 0, height = 0;
  std::vector<uint8_t> rgb, known;
};

/// Returns the numbers of the bands that give red, green and blue.
std::array<int, 3> colour_bands(const Raster& raster) {
  GDALDataset& dataset = raster.dataset();
  const int count = dataset.GetRasterCount();
  for (int band = 1; band <= std::min(count, 4); ++band)
    if (dataset.GetRasterBand(band)->GetRasterDataType() != GDT_Byte)
      throw_user_error(
          "{}: expected a picture of 8 bits a sample, found {} (gdal_translate -ot Byte -scale converts it)",
          raster.where(), GDALGetDataTypeName(dataset.GetRasterBand(band)->GetRasterDataType()));
  const bool alpha = dataset.GetRasterBand(count)->GetColorInterpretation() == GCI_AlphaBand;
  if (count - (alpha ? 1 : 0) == 1) return {1, 1, 1};
  std::array<int, 3> bands{};
  for (int band = 1; band <= count; ++band) {
    const auto meaning = dataset.GetRasterBand(band)->GetColorInterpretation();
    if (meaning == GCI_RedBand) bands[0] = band;
    if (meaning == GCI_GreenBand) bands[1] = band;
    if (meaning == GCI_BlueBand) bands[2] = band;
  }
  if (bands[0] != 0 && bands[1] != 0 && bands[2] != 0) return bands;
  if (count == 3 || count == 4) return {1, 2, 3};
  throw_user_error("{}: expected a grey, paletted, RGB or RGBA picture, found {} bands of unknown colours",
                   raster.where(), count);
}

void read_band(const Raster& raster, GDALRasterBand& band, const PixelWindow& window, uint8_t* data,
               int step) {
  if (band.RasterIO(GF_Read, window.column, window.row, window.columns, window.rows, data, window.columns,
                    window.rows, GDT_Byte, step, static_cast<GSpacing>(step) * window.columns) != CE_None)
    throw_user_error("{}: the picture cannot be read{}", raster.where(), raster.messages().suffix());
}

Pixels read_pixels(const Raster& raster, const PixelWindow& window) {
  Pixels pixels{static_cast<uint32_t>(window.columns), static_cast<uint32_t>(window.rows), {}, {}};
  const size_t count = static_cast<size_t>(window.columns) * static_cast<size_t>(window.rows);
  pixels.rgb.resize(3 * count);
  const std::array<int, 3> bands = colour_bands(raster);
  for (int channel = 0; channel < 3; ++channel)
    read_band(raster, *raster.dataset().GetRasterBand(bands[channel]), window, pixels.rgb.data() + channel,
              3);
  GDALRasterBand& first = *raster.dataset().GetRasterBand(bands[0]);
  if ((first.GetMaskFlags() & GMF_ALL_VALID) == 0) {
    pixels.known.resize(count);
    read_band(raster, *first.GetMaskBand(), window, pixels.known.data(), 1);
    for (uint8_t& known : pixels.known) known = known >= 128 ? 1 : 0;
  }
  const GDALColorTable* table = first.GetColorTable();
  if (bands[0] == bands[1] && table != nullptr)
    for (size_t i = 0; i < count; ++i) {
      GDALColorEntry entry{};
      table->GetColorEntryAsRGB(pixels.rgb[3 * i], &entry);
      pixels.rgb[3 * i] = static_cast<uint8_t>(entry.c1);
      pixels.rgb[3 * i + 1] = static_cast<uint8_t>(entry.c2);
      pixels.rgb[3 * i + 2] = static_cast<uint8_t>(entry.c3);
      if (entry.c4 == 0) {
        if (pixels.known.empty()) pixels.known.assign(count, 1);
        pixels.known[i] = 0;
      }
    }
  return pixels;
}

/// Places of a lattice of points of the window: pixels, and where they lie in the frame.
struct Lattice {
  std::vector<dvec2> pixels, local;
};

Lattice lattice_of(const Raster& raster, const PixelWindow& window, const Placement& placement) {
  constexpr int steps = 12;
  Lattice lattice;
  for (int row = 0; row <= steps; ++row)
    for (int column = 0; column <= steps; ++column)
      lattice.pixels.push_back(dvec2(window.columns, window.rows) * dvec2(column, row) / double(steps));
  std::vector<dvec2> in_file = lattice.pixels;
  for (dvec2& pixel : in_file) pixel += dvec2(window.column, window.row);
  for (const dvec2& degrees : raster.places(std::move(in_file)))
    lattice.local.push_back(placement.on_ground(degrees));
  return lattice;
}

/// Returns the affine map local -> pixel of least squares. Positions are taken about their mean.
glm::dmat3x2 fitted(const Lattice& lattice) {
  const double count = static_cast<double>(lattice.local.size());
  dvec2 local_mean(0.0), pixel_mean(0.0);
  for (size_t i = 0; i < lattice.local.size(); ++i)
    local_mean += lattice.local[i] / count, pixel_mean += lattice.pixels[i] / count;
  glm::dmat2 squares(0.0), products(0.0);
  for (size_t i = 0; i < lattice.local.size(); ++i) {
    const dvec2 x = lattice.local[i] - local_mean, p = lattice.pixels[i] - pixel_mean;
    squares += glm::outerProduct(x, x);
    products += glm::outerProduct(p, x);
  }
  const glm::dmat2 linear = products * glm::inverse(squares);
  return {linear[0], linear[1], pixel_mean - linear * local_mean};
}

/// Returns the picture on a grid along x and y, whose pixels are as large as the shorter side of those of the
/// file: bilinear in colour between pixels with data, and with data where the nearest pixel has.
GroundPicture resampled(const Raster& raster, const PixelWindow& window, const Pixels& pixels,
                        const Lattice& lattice, const Placement& placement, Spending& spent) {
  const glm::dmat3x2 fit = fitted(lattice);
  const glm::dmat2 local_from_pixel = glm::inverse(glm::dmat2(fit[0], fit[1]));
  const double size = std::min(glm::length(local_from_pixel[0]), glm::length(local_from_pixel[1]));
  const Box box = box_of(lattice.local);
  GroundPicture picture;
  const dvec2 extent = glm::ceil((box.high - box.low) / size);
  spent.plan(raster.where(),
             saturating_product({static_cast<uint64_t>(extent.x), static_cast<uint64_t>(extent.y), 4}));
  picture.width = std::max(1u, static_cast<uint32_t>(extent.x));
  picture.height = std::max(1u, static_cast<uint32_t>(extent.y));
  picture.pixel_from_local = {dvec2(1.0 / size, 0.0), dvec2(0.0, -1.0 / size),
                              dvec2(-box.low.x, box.high.y) / size};
  picture.rgb.resize(size_t{3} * picture.width * picture.height);
  picture.known.assign(size_t{1} * picture.width * picture.height, 0);
  std::vector<dvec2> row(picture.width);
  for (uint32_t y = 0; y < picture.height; ++y) {
    for (uint32_t x = 0; x < picture.width; ++x) {
      row[x] = placement.degrees_of({box.low.x + (x + 0.5) * size, box.high.y - (y + 0.5) * size});
    }
    const std::vector<dvec2> at = raster.pixels(raster.turned_to_file(row));
    for (uint32_t x = 0; x < picture.width; ++x) {
      const dvec2 pixel = at[x] - dvec2(window.column, window.row) - 0.5;
      const dvec2 nearest = glm::round(pixel);
      if (!(nearest.x >= 0.0 && nearest.y >= 0.0 && nearest.x < pixels.width && nearest.y < pixels.height))
        continue;
      const auto index = [&](double column, double line) {
        return static_cast<size_t>(std::clamp(line, 0.0, pixels.height - 1.0)) * pixels.width +
               static_cast<size_t>(std::clamp(column, 0.0, pixels.width - 1.0));
      };
      const auto known = [&](size_t i) { return pixels.known.empty() || pixels.known[i] != 0; };
      if (!known(index(nearest.x, nearest.y))) continue;
      const dvec2 corner = glm::floor(pixel), part = pixel - corner;
      dvec3 sum(0.0);
      double weights = 0.0;
      for (int k = 0; k < 4; ++k) {
        const int right = k & 1, down = k >> 1;
        const double weight = (right != 0 ? part.x : 1.0 - part.x) * (down != 0 ? part.y : 1.0 - part.y);
        const size_t i = index(corner.x + right, corner.y + down);
        if (!known(i)) continue;
        sum += weight * dvec3(pixels.rgb[3 * i], pixels.rgb[3 * i + 1], pixels.rgb[3 * i + 2]);
        weights += weight;
      }
      const size_t target = size_t{y} * picture.width + x;
      for (int channel = 0; channel < 3; ++channel)
        picture.rgb[3 * target + static_cast<size_t>(channel)] =
            static_cast<uint8_t>(std::lround(sum[channel] / weights));
      picture.known[target] = 1;
    }
  }
  return picture;
}

}  // namespace

PictureRead read_picture(const PictureSource& source, const Box& degrees, const Placement& placement,
                         Spending& spent) {
  const Raster raster(source.file, source.crs);
  PictureRead result{std::nullopt, raster.extent(), raster.licence(), raster.projection()->missing_grid(),
                     raster.projection()->outside_use(raster.extent())};
  const auto window = raster.window(degrees, 1);
  if (!window) return result;
  spent.plan(raster.where(), saturating_product({static_cast<uint64_t>(window->columns),
                                                 static_cast<uint64_t>(window->rows), 4}));
  Pixels pixels = read_pixels(raster, *window);
  const Lattice lattice = lattice_of(raster, *window, placement);
  const glm::dmat3x2 fit = fitted(lattice);
  double error = 0.0;
  for (size_t i = 0; i < lattice.local.size(); ++i)
    error = std::max(error, glm::distance(fit * dvec3(lattice.local[i], 1.0), lattice.pixels[i]));
  if (error <= 0.25) {
    result.picture = GroundPicture{
        pixels.width, pixels.height, std::move(pixels.rgb), std::move(pixels.known), fit, source.name};
  } else {
    result.picture = resampled(raster, *window, pixels, lattice, placement, spent);
    result.picture->source = source.name;
  }
  return result;
}

Box raster_extent(const std::filesystem::path& file, const std::string& crs) {
  return Raster(file, crs).extent();
}

double covered_share(const std::vector<GroundPicture>& pictures, const AreaTest& area) {
  constexpr int steps = 100;
  size_t inside = 0, covered = 0;
  for (int row = 0; row < steps; ++row)
    for (int column = 0; column < steps; ++column) {
      const dvec2 point =
          area.box().low + (area.box().high - area.box().low) * (dvec2(column, row) + 0.5) / double(steps);
      if (!area.contains(point)) continue;
      ++inside;
      covered += std::ranges::any_of(pictures, [&](const GroundPicture& picture) {
        const dvec2 pixel = picture.pixel_from_local * dvec3(point, 1.0);
        if (!(pixel.x >= 0.0 && pixel.y >= 0.0 && pixel.x < picture.width && pixel.y < picture.height))
          return false;
        return picture.known.empty() ||
               picture.known[static_cast<size_t>(pixel.y) * picture.width + static_cast<size_t>(pixel.x)] !=
                   0;
      });
    }
  return inside == 0 ? 0.0 : static_cast<double>(covered) / static_cast<double>(inside);
}

}  // namespace greatx::scene::place
