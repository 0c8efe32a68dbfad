// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/assemble/picture_cover.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/srgb.h"

namespace greatx::scene::place {

namespace {

/// Halves a picture: each pixel is the mean of four in linear light. A last odd row or column is left out.
void halve(generator::Raster& raster, std::vector<uint8_t>& known) {
  const uint32_t width = raster.width / 2, height = raster.height / 2;
  double linear[256];
  for (int i = 0; i < 256; ++i) linear[i] = linear_from_srgb(i / 255.0);
  std::vector<uint8_t> rgb(size_t{width} * height * 3), mask(known.empty() ? 0 : size_t{width} * height);
  for (uint32_t y = 0; y < height; ++y)
    for (uint32_t x = 0; x < width; ++x) {
      const size_t first = size_t{2 * y} * raster.width + 2 * x;
      const std::array<size_t, 4> from{first, first + 1, first + raster.width, first + raster.width + 1};
      for (size_t c = 0; c < 3; ++c) {
        double sum = 0.0;
        for (const size_t pixel : from) sum += linear[raster.rgb[3 * pixel + c]];
        rgb[3 * (size_t{y} * width + x) + c] =
            static_cast<uint8_t>(std::lround(255.0 * srgb_from_linear(sum / 4.0)));
      }
      if (!mask.empty())
        mask[size_t{y} * width + x] = static_cast<uint8_t>(
            std::all_of(from.begin(), from.end(), [&](size_t pixel) { return known[pixel] != 0; }));
    }
  raster = {width, height, std::move(rgb)};
  known = std::move(mask);
}

}  // namespace

PictureCover::PictureCover(const std::vector<GroundPicture>& pictures, uint32_t most_px,
                           std::vector<Finding>& findings) {
  for (const GroundPicture& picture : pictures) {
    Tile tile;
    tile.name = fmt::format("picture_{}", tiles_.size());
    tile.raster = {picture.width, picture.height, picture.rgb};
    tile.known = picture.known;
    uint32_t used_width = picture.width, used_height = picture.height;
    while (tile.raster.width > most_px || tile.raster.height > most_px) {
      halve(tile.raster, tile.known);
      used_width = picture.width / tile.raster.width * tile.raster.width;
      used_height = picture.height / tile.raster.height * tile.raster.height;
    }
    if (tile.raster.width != picture.width)
      findings.push_back({Finding::Kind::repaired, "picture_made_smaller", picture.source,
                          fmt::format("{} x {} pixels became {} x {}", picture.width, picture.height,
                                      tile.raster.width, tile.raster.height)});
    const glm::dmat3x2& m = picture.pixel_from_local;
    const dvec2 scale(1.0 / used_width, 1.0 / used_height);
    tile.uv_from_place = {m[0] * scale, m[1] * scale, m[2] * scale};
    // The corners of what is used, back in the scene's frame.
    const glm::dmat2 turn(m[0], m[1]);
    const glm::dmat2 back = glm::inverse(turn);
    for (const dvec2& pixel :
         {dvec2(0.0), dvec2(0.0, used_height), dvec2(used_width, used_height), dvec2(used_width, 0.0)})
      tile.border.push_back(back * (pixel - m[2]));
    tiles_.push_back(std::move(tile));
  }
}

dvec2 PictureCover::uv(size_t picture, const dvec2& place) const {
  const glm::dmat3x2& m = tiles_[picture].uv_from_place;
  return m[0] * place.x + m[1] * place.y + m[2];
}

bool PictureCover::Tile::holds(const dvec2& place) const {
  constexpr double slack = 1e-5;  // the mesh is divided at the border, but its corners are rounded
  const dvec2 at = uv_from_place[0] * place.x + uv_from_place[1] * place.y + uv_from_place[2];
  if (at.x < -slack || at.y < -slack || at.x > 1.0 + slack || at.y > 1.0 + slack) return false;
  if (known.empty()) return true;
  const auto x = static_cast<uint32_t>(std::clamp(at.x * raster.width, 0.0, raster.width - 1.0)),
             y = static_cast<uint32_t>(std::clamp(at.y * raster.height, 0.0, raster.height - 1.0));
  return known[size_t{y} * raster.width + x] != 0;
}

std::optional<size_t> PictureCover::over(const dvec2& a, const dvec2& b, const dvec2& c) const {
  for (size_t i = 0; i < tiles_.size(); ++i)
    if (tiles_[i].holds(a) && tiles_[i].holds(b) && tiles_[i].holds(c)) return i;
  return std::nullopt;
}

std::vector<Ring> PictureCover::borders() const {
  std::vector<Ring> result;
  for (const Tile& tile : tiles_) result.push_back(tile.border);
  return result;
}

std::map<std::string, generator::TextureMaps> PictureCover::textures() const {
  std::map<std::string, generator::TextureMaps> result;
  for (const Tile& tile : tiles_) result[tile.name].color = tile.raster;
  return result;
}

}  // namespace greatx::scene::place
