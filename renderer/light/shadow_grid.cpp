// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/light/shadow_grid.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/error.h"
#include "core/vec.h"

namespace greatx::render {

namespace {

constexpr uint32_t most_cells_along = 64;
constexpr uint32_t header_words = sizeof(shared::ShadowTilesHeader) / sizeof(uint32_t);
constexpr uint32_t tile_words = sizeof(shared::GpuShadowTile) / sizeof(uint32_t);

/// Holds the cells that a tile comes near: columns and rows, the last ones included.
struct CellSpan {
  uint32_t left = 0, right = 0, low = 0, high = 0;
};

shared::ShadowTilesHeader header_of(std::span<const shared::GpuShadowTile> tiles) {
  shared::ShadowTilesHeader header{};
  header.min = vec2(1e30f);
  header.max = vec2(-1e30f);
  float diameters = 0.0f;
  for (const shared::GpuShadowTile& tile : tiles) {
    header.min = glm::min(header.min, vec2(tile.center) - tile.radius);
    header.max = glm::max(header.max, vec2(tile.center) + tile.radius);
    diameters += 2.0f * tile.radius;
  }
  header.columns = header.rows = header.cells_per_m = 1.0f;
  if (tiles.empty()) return header;
  // Cells are about as large as a body, so that a body lies in four cells or so.
  const vec2 size = header.max - header.min;
  const float edge =
      std::max({diameters / float(tiles.size()), std::max(size.x, size.y) / float(most_cells_along), 1e-3f});
  header.cells_per_m = 1.0f / edge;
  header.columns = std::clamp(std::ceil(size.x / edge), 1.0f, float(most_cells_along));
  header.rows = std::clamp(std::ceil(size.y / edge), 1.0f, float(most_cells_along));
  return header;
}

CellSpan cells_of(const shared::ShadowTilesHeader& header, const shared::GpuShadowTile& tile) {
  // The shader rounds a point's cell by less than this share of a cell.
  constexpr float slack = 1e-3f;
  const auto cell = [&](float place, float from, float count) {
    return static_cast<uint32_t>(
        std::clamp(std::floor((place - from) * header.cells_per_m), 0.0f, count - 1.0f));
  };
  const float reach = tile.radius + slack / header.cells_per_m;
  return {cell(tile.center.x - reach, header.min.x, header.columns),
          cell(tile.center.x + reach, header.min.x, header.columns),
          cell(tile.center.y - reach, header.min.y, header.rows),
          cell(tile.center.y + reach, header.min.y, header.rows)};
}

}  // namespace

std::vector<uint32_t> shadow_grid(std::span<const shared::GpuShadowTile> tiles) {
  const shared::ShadowTilesHeader header = header_of(tiles);
  const auto columns = static_cast<uint32_t>(header.columns), rows = static_cast<uint32_t>(header.rows);
  std::vector<uint32_t> counts(size_t{columns} * rows);
  std::vector<CellSpan> spans;
  spans.reserve(tiles.size());
  const auto for_cells = [&](const CellSpan& span, auto&& visit) {
    for (uint32_t row = span.low; row <= span.high; ++row)
      for (uint32_t column = span.left; column <= span.right; ++column) visit(row * columns + column);
  };
  for (const shared::GpuShadowTile& tile : tiles) {
    spans.push_back(cells_of(header, tile));
    for_cells(spans.back(), [&](uint32_t cell) { ++counts[cell]; });
  }
  // Tiles are read as quadruples of words.
  uint32_t next = (header_words + columns * rows + 3) / 4;
  std::vector<uint32_t> words(size_t{4} * next);
  std::memcpy(words.data(), &header, sizeof header);
  for (size_t cell = 0; cell < counts.size(); ++cell) {
    if (counts[cell] > shared::shadow_cell_most)
      throw_user_error("scene: expected shadows of at most {} moving bodies at one place, found {}",
                       shared::shadow_cell_most, counts[cell]);
    words[header_words + cell] = next << shared::shadow_cell_bits;
    next += counts[cell] * tile_words / 4;
  }
  words.resize(size_t{4} * next);
  for (size_t i = 0; i < tiles.size(); ++i)
    for_cells(spans[i], [&](uint32_t cell) {
      uint32_t& word = words[header_words + cell];
      const size_t at = size_t{4} * (word >> shared::shadow_cell_bits) +
                        size_t{tile_words} * (word & shared::shadow_cell_most);
      std::memcpy(&words[at], &tiles[i], sizeof tiles[i]);
      ++word;
    });
  return words;
}

}  // namespace greatx::render
