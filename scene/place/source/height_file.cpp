// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/source/height_file.h"

#include <algorithm>
#include <cmath>
#include <gdal_alg.h>
#include <limits>
#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "scene/place/source/raster.h"

namespace greatx::scene::place {

namespace {

using Kind = Finding::Kind;

/// Returns the metres of a unit's name, or nothing for one that is not known.
std::optional<double> metres_of(std::string name) {
  std::ranges::transform(name, name.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
  if (name == "m" || name == "metre" || name == "meter" || name == "metres" || name == "meters") return 1.0;
  if (name == "ft" || name == "foot" || name == "feet" || name == "foot (international)" ||
      name == "international foot")
    return 0.3048;
  if (name == "us-ft" || name == "us survey foot" || name == "us survey feet" || name == "foot_us" ||
      name == "ft_us" || name == "ftus" || name == "ft-us")
    return 1200.0 / 3937.0;
  if (name == "cm" || name == "centimetre" || name == "centimeter") return 0.01;
  if (name == "dm" || name == "decimetre" || name == "decimeter") return 0.1;
  return std::nullopt;
}

/// Returns the metres of one unit of the file's heights.
double unit_of(const HeightSource& source, GDALRasterBand& band, const OGRSpatialReference* crs,
               const std::string& where) {
  std::optional<double> stated;
  const std::string name = band.GetUnitType() != nullptr ? band.GetUnitType() : "";
  if (!name.empty()) {
    stated = metres_of(name);
    if (!stated && !source.unit_m)
      throw_user_error("{}: the file states the unit '{}', which is not known: add unit: m, ft or us-ft",
                       where, printable(name));
  } else if (crs != nullptr && crs->IsCompound()) {
    stated = crs->GetTargetLinearUnits("COMPD_CS|VERT_CS");
  }
  // The two kinds of feet differ by two millionths, which is 1 mm at 500 m: below what heights resolve.
  if (stated && source.unit_m && std::abs(*stated / *source.unit_m - 1.0) > 1e-5)
    throw_user_error("{}: unit: expected the file's own, {} m, found {} m", where, *stated, *source.unit_m);
  return source.unit_m ? *source.unit_m : stated.value_or(1.0);
}

bool same_value(double value, double no_data, bool single) {
  return value == no_data || (single && static_cast<float>(value) == static_cast<float>(no_data));
}

}  // namespace

HeightTile read_heights(const HeightSource& source, const Box& degrees, Notes& notes) {
  const Raster raster(source.file, source.crs);
  HeightTile result;
  result.source = source.name;
  result.projection = raster.projection();
  result.extent = raster.extent();
  result.licence = raster.licence();
  GDALRasterBand& band = *raster.dataset().GetRasterBand(1);
  const double unit = unit_of(source, band, raster.dataset().GetSpatialRef(), raster.where());
  if (GDALDataTypeIsComplex(band.GetRasterDataType()) || band.GetColorInterpretation() == GCI_PaletteIndex)
    throw_user_error("{}: expected heights, found a picture", raster.where());
  if (raster.dataset().GetRasterCount() != 1)
    throw_user_error("{}: expected one band of heights, found {} bands", raster.where(),
                     raster.dataset().GetRasterCount());
  const auto window = raster.window(degrees, 2);
  if (const std::string grid = raster.projection()->missing_grid(); !grid.empty())
    notes.add(Kind::doubtful, "datum_grid_missing", "", grid);
  if (const std::string use = raster.projection()->outside_use(result.extent); !use.empty())
    notes.add(Kind::doubtful, "crs_outside_its_area", "", use);
  if (!window || window->columns < 2 || window->rows < 2) return result;
  result.columns = static_cast<uint32_t>(window->columns);
  result.rows = static_cast<uint32_t>(window->rows);
  const size_t count = static_cast<size_t>(result.columns) * result.rows;
  require_within(raster.where(), count, place_heights);
  const auto& t = raster.transform();
  result.transform = {t[0] + t[1] * window->column + t[2] * window->row, t[1], t[2],
                      t[3] + t[4] * window->column + t[5] * window->row, t[4], t[5]};
  std::vector<double>& values = result.heights_m;
  values.resize(count);
  if (band.RasterIO(GF_Read, window->column, window->row, window->columns, window->rows, values.data(),
                    window->columns, window->rows, GDT_Float64, 0, 0) != CE_None)
    throw_user_error("{}: the heights cannot be read{}", raster.where(), raster.messages().suffix());
  int has_no_data = 0;
  const double no_data = band.GetNoDataValue(&has_no_data);
  int has_scale = 0, has_offset = 0;
  const double scale = band.GetScale(&has_scale), offset = band.GetOffset(&has_offset);
  const bool single = band.GetRasterDataType() == GDT_Float32;
  size_t outliers = 0;
  dvec2 outer(std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity());
  for (double& height : values) {
    const double stored = height;
    height = ((has_scale != 0 ? scale * stored : stored) + (has_offset != 0 ? offset : 0.0)) * unit;
    if (!std::isfinite(stored) || (has_no_data != 0 && same_value(stored, no_data, single)) ||
        (source.no_data && same_value(stored, *source.no_data, single))) {
      height = std::numeric_limits<double>::quiet_NaN();
    } else if (source.valid_m && (height < source.valid_m->x || height > source.valid_m->y)) {
      ++outliers;
      outer = {std::min(outer.x, height), std::max(outer.y, height)};
      height = std::numeric_limits<double>::quiet_NaN();
    }
  }
  if (outliers > 0)
    notes.add(Kind::left_out, "heights_not_valid", "",
              fmt::format(
                  "{} of {} heights around the area are outside [{}, {}] m (from {} to {} m) and count as no "
                  "data.",
                  outliers, count, source.valid_m->x, source.valid_m->y, outer.x, outer.y));
  return result;
}

namespace {

/// Where a tile's first pixel lies in the lattice of another, in whole pixels; nothing if they share none.
std::optional<std::array<int64_t, 2>> offset_in(const HeightTile& tile, const HeightTile& lattice) {
  const auto &a = lattice.transform, &b = tile.transform;
  const double size = std::hypot(a[1], a[4]);
  const double extent = std::max({tile.columns, tile.rows, lattice.columns, lattice.rows});
  for (const int i : {1, 2, 4, 5})
    if (std::abs(a[i] - b[i]) * extent > 0.01 * size) return std::nullopt;
  if (!tile.projection->same_crs(*lattice.projection)) return std::nullopt;
  const double x = tile.projection->geographic() ? longitude_near(b[0], a[0]) : b[0];
  const double dx = x - a[0], dy = b[3] - a[3], determinant = a[1] * a[5] - a[2] * a[4];
  const double column = (dx * a[5] - dy * a[2]) / determinant, row = (a[1] * dy - a[4] * dx) / determinant;
  if (std::abs(column - std::round(column)) > 0.01 || std::abs(row - std::round(row)) > 0.01)
    return std::nullopt;
  if (std::abs(column) > 1e8 || std::abs(row) > 1e8) return std::nullopt;
  return std::array{static_cast<int64_t>(std::llround(column)), static_cast<int64_t>(std::llround(row))};
}

/// Puts a tile's pixels into those of another, which grows.
void join_tile(HeightTile& all, const HeightTile& tile, const std::array<int64_t, 2>& offset) {
  const int64_t left = std::min<int64_t>(0, offset[0]), top = std::min<int64_t>(0, offset[1]);
  const int64_t right = std::max<int64_t>(all.columns, offset[0] + tile.columns),
                bottom = std::max<int64_t>(all.rows, offset[1] + tile.rows);
  const auto columns = static_cast<uint64_t>(right - left), rows = static_cast<uint64_t>(bottom - top);
  require_within(tile.source, saturating_product({columns, rows}), place_heights);
  std::vector<double> heights(columns * rows, std::numeric_limits<double>::quiet_NaN());
  const auto put = [&](const HeightTile& from, int64_t column, int64_t row) {
    for (uint32_t r = 0; r < from.rows; ++r)
      for (uint32_t c = 0; c < from.columns; ++c) {
        double& target = heights[static_cast<size_t>(row + r) * columns + static_cast<size_t>(column + c)];
        if (std::isnan(target)) target = from.heights_m[static_cast<size_t>(r) * from.columns + c];
      }
  };
  put(all, -left, -top);
  put(tile, offset[0] - left, offset[1] - top);
  auto& t = all.transform;
  t[0] += t[1] * static_cast<double>(left) + t[2] * static_cast<double>(top);
  t[3] += t[4] * static_cast<double>(left) + t[5] * static_cast<double>(top);
  all.columns = static_cast<uint32_t>(columns);
  all.rows = static_cast<uint32_t>(rows);
  all.heights_m = std::move(heights);
  all.source += " + " + tile.source;
}

}  // namespace

std::vector<HeightTile> join_tiles(std::vector<HeightTile> tiles) {
  std::vector<HeightTile> joined;
  for (HeightTile& tile : tiles) {
    if (tile.columns == 0) continue;
    bool done = false;
    for (HeightTile& other : joined) {
      const auto offset = offset_in(tile, other);
      if (!offset) continue;
      join_tile(other, tile, *offset);
      done = true;
      break;
    }
    if (!done) joined.push_back(std::move(tile));
  }
  return joined;
}

HeightSamples samples_of(const HeightTile& tile) {
  HeightSamples result{tile.source, tile.columns, tile.rows, {}};
  result.samples.reserve(tile.heights_m.size());
  std::vector<dvec2> row(tile.columns);
  const auto& t = tile.transform;
  for (uint32_t r = 0; r < tile.rows; ++r) {
    for (uint32_t c = 0; c < tile.columns; ++c)
      row[c] = {t[0] + t[1] * (c + 0.5) + t[2] * (r + 0.5), t[3] + t[4] * (c + 0.5) + t[5] * (r + 0.5)};
    tile.projection->to_degrees(row);
    for (uint32_t c = 0; c < tile.columns; ++c)
      result.samples.emplace_back(row[c], tile.heights_m[static_cast<size_t>(r) * tile.columns + c]);
  }
  return result;
}

HeightGrid grid_in_frame(const HeightSamples& samples, const LocalFrame& frame) {
  HeightGrid grid{samples.columns, samples.rows, {}, samples.source};
  grid.samples.reserve(samples.samples.size());
  for (const dvec3& sample : samples.samples) {
    // A sample without data lies where the ellipsoid would be, a matter of centimetres.
    const bool known = !std::isnan(sample.z);
    dvec3 place = frame.local_of_datum(
        {sample.y, sample.x,
         known ? sample.z : frame.reference().origin.height_m - frame.reference().undulation_m});
    if (!known) place.z = std::numeric_limits<double>::quiet_NaN();
    grid.samples.push_back(place);
  }
  return grid;
}

namespace {

/// Interpolates the voids of a file from its own data; empty if it has none.
std::vector<double> interpolated(const HeightSamples& grid) {
  std::vector<float> heights(grid.samples.size());
  std::vector<uint8_t> mask(grid.samples.size());
  // Heights about their mean, so that single precision keeps them to 0.1 mm.
  double mean = 0.0;
  size_t known = 0;
  for (const dvec3& sample : grid.samples)
    if (!std::isnan(sample.z)) mean += sample.z, ++known;
  if (known == 0) return {};
  mean /= static_cast<double>(known);
  for (size_t i = 0; i < heights.size(); ++i) {
    mask[i] = std::isnan(grid.samples[i].z) ? 0 : 255;
    heights[i] = mask[i] != 0 ? static_cast<float>(grid.samples[i].z - mean) : 0.0f;
  }
  GDALDriver* memory = GetGDALDriverManager()->GetDriverByName("MEM");
  const int columns = static_cast<int>(grid.columns), rows = static_cast<int>(grid.rows);
  const auto make = [&](GDALDataType type, void* data) {
    std::unique_ptr<GDALDataset> dataset(memory->Create("", columns, rows, 1, type, nullptr));
    GREATX_CHECK(
        dataset != nullptr && dataset->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, columns, rows, data,
                                                                  columns, rows, type, 0, 0) == CE_None,
        "{}: a raster in memory", grid.source);
    return dataset;
  };
  const auto target = make(GDT_Float32, heights.data()), known_at = make(GDT_Byte, mask.data());
  const double reach = std::hypot(columns, rows);
  GREATX_CHECK(GDALFillNodata(target->GetRasterBand(1), known_at->GetRasterBand(1), reach, 0, 0, nullptr,
                              nullptr, nullptr) == CE_None,
               "{}: GDALFillNodata", grid.source);
  GREATX_CHECK(target->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, columns, rows, heights.data(), columns, rows,
                                                  GDT_Float32, 0, 0) == CE_None,
               "{}: a raster in memory", grid.source);
  std::vector<double> result(heights.size());
  for (size_t i = 0; i < heights.size(); ++i) result[i] = mean + static_cast<double>(heights[i]);
  return result;
}

/// Returns for each sample how many samples away the nearest one with data is, diagonals counting as one.
std::vector<uint32_t> steps_to_data(const HeightSamples& grid) {
  constexpr uint32_t unseen = std::numeric_limits<uint32_t>::max();
  std::vector<uint32_t> steps(grid.samples.size(), unseen);
  std::vector<size_t> front;
  for (size_t i = 0; i < grid.samples.size(); ++i)
    if (!std::isnan(grid.samples[i].z)) steps[i] = 0, front.push_back(i);
  for (size_t next = 0; next < front.size(); ++next) {
    const int64_t column = static_cast<int64_t>(front[next] % grid.columns),
                  row = static_cast<int64_t>(front[next] / grid.columns);
    for (int64_t r = std::max<int64_t>(0, row - 1); r <= std::min<int64_t>(grid.rows - 1, row + 1); ++r)
      for (int64_t c = std::max<int64_t>(0, column - 1); c <= std::min<int64_t>(grid.columns - 1, column + 1);
           ++c) {
        const size_t other = static_cast<size_t>(r) * grid.columns + static_cast<size_t>(c);
        if (steps[other] != unseen) continue;
        steps[other] = steps[front[next]] + 1;
        front.push_back(other);
      }
  }
  return steps;
}

}  // namespace

namespace {

/// How far a sample may be from the median of its neighbours, by their mean distance: a slope of 56 degrees.
constexpr double most_spike = 1.5;

/// Says how many samples of the area stand out of their neighbours so far that they are hardly ground.
void report_spikes(const HeightGrid& grid, const AreaTest& area, const std::string& what, Notes& notes) {
  size_t spikes = 0;
  double worst = 0.0;
  for (uint32_t row = 1; row + 1 < grid.rows; ++row)
    for (uint32_t column = 1; column + 1 < grid.columns; ++column) {
      const dvec3& sample = grid.samples[static_cast<size_t>(row) * grid.columns + column];
      if (std::isnan(sample.z) || !area.contains(dvec2(sample))) continue;
      std::array<double, 8> heights{};
      size_t known = 0;
      double distance = 0.0;
      for (uint32_t r = row - 1; r <= row + 1; ++r)
        for (uint32_t c = column - 1; c <= column + 1; ++c) {
          const dvec3& other = grid.samples[static_cast<size_t>(r) * grid.columns + c];
          if ((r == row && c == column) || std::isnan(other.z)) continue;
          heights[known++] = other.z;
          distance += glm::distance(dvec2(sample), dvec2(other));
        }
      if (known < 5) continue;
      const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(known / 2);
      std::nth_element(heights.begin(), middle, heights.begin() + static_cast<std::ptrdiff_t>(known));
      const double height = std::abs(sample.z - *middle);
      if (height <= most_spike * distance / static_cast<double>(known)) continue;
      ++spikes;
      worst = std::max(worst, height);
    }
  if (spikes > 0)
    notes.add(Kind::doubtful, what + "_spike", "",
              fmt::format(
                  "{} samples within the area are farther from the median of their neighbours than {} times "
                  "their distance, {:.1f} m at most; they are kept (valid_m takes such out).",
                  spikes, most_spike, worst));
}

}  // namespace

HeightField join_samples(std::vector<HeightSamples> samples, const LocalFrame& frame, const AreaTest& area,
                         bool fill, const std::string& what, std::vector<Finding>& findings) {
  HeightField raw;
  for (const HeightSamples& one : samples) raw.add(grid_in_frame(one, frame));
  bool changed = false;
  for (size_t g = 0; g < samples.size(); ++g) {
    const HeightGrid& grid = raw.grids()[g];
    std::vector<size_t> voids;
    size_t inside = 0, empty_inside = 0;
    for (size_t i = 0; i < grid.samples.size(); ++i) {
      const bool in_area = area.contains(dvec2(grid.samples[i]));
      inside += in_area;
      if (!std::isnan(grid.samples[i].z) || raw.at(dvec2(grid.samples[i]))) continue;
      voids.push_back(i);
      empty_inside += in_area;
    }
    Notes notes(grid.source, findings);
    if (fill) report_spikes(grid, area, what, notes);
    if (voids.empty()) continue;
    const std::vector<double> heights = fill ? interpolated(samples[g]) : std::vector<double>();
    if (heights.empty()) {
      if (empty_inside > 0)
        notes.add(fill ? Kind::left_out : Kind::doubtful, what + "_void", "",
                  fmt::format("{} of {} samples within the area have no height.", empty_inside, inside));
      continue;
    }
    const std::vector<uint32_t> steps = steps_to_data(samples[g]);
    uint32_t farthest = 0;
    for (const size_t i : voids)
      if (area.contains(dvec2(grid.samples[i]))) farthest = std::max(farthest, steps[i]);
    for (const size_t i : voids) samples[g].samples[i].z = heights[i];
    changed = true;
    notes.add(Kind::repaired, what + "_void_filled", "",
              fmt::format("{} of {} samples within the area, and {} around it, have no height; they are "
                          "interpolated by inverse distance from the samples around the void, at most {} "
                          "samples away in the area.",
                          empty_inside, inside, voids.size() - empty_inside, farthest));
  }
  if (!changed) return raw;
  raw = {};  // the two at once would be the largest thing in memory
  HeightField joined;
  for (const HeightSamples& one : samples) joined.add(grid_in_frame(one, frame));
  return joined;
}

}  // namespace greatx::scene::place
