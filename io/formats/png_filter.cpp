// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/formats/png_filter.h"

#include <cstring>

#include "core/error.h"

namespace greatx::io {

namespace {

// The loops below work on plain pointers, so that the compiler makes vector code of them.

void filter_up(const uint8_t* line, const uint8_t* above, size_t count, uint8_t* __restrict to) {
  for (size_t i = 0; i < count; ++i) to[i] = static_cast<uint8_t>(line[i] - above[i]);
}

/// Does the same and exchanges the bytes of each pair. Each byte has a difference of its own, without carry.
void filter_up_swapped(const uint8_t* line, const uint8_t* above, size_t count, uint8_t* __restrict to) {
  for (size_t i = 0; i < count; i += 2) {
    uint16_t value = 0, over = 0;
    std::memcpy(&value, line + i, sizeof value);
    std::memcpy(&over, above + i, sizeof over);
    const auto low = static_cast<uint16_t>((value - over) & 0xff),
               high = static_cast<uint16_t>((value >> 8) - (over >> 8));
    const auto pair = static_cast<uint16_t>(low << 8 | (high & 0xff));
    std::memcpy(to + i, &pair, sizeof pair);
  }
}

void filter_sub(const uint8_t* line, size_t pixel_bytes, size_t count, uint8_t* __restrict to) {
  std::memcpy(to, line, pixel_bytes);
  for (size_t i = pixel_bytes; i < count; ++i) to[i] = static_cast<uint8_t>(line[i] - line[i - pixel_bytes]);
}

/// Returns the sum of the magnitudes of differences modulo 256.
uint32_t magnitude(const uint8_t* differences, size_t count) {
  uint32_t sum = 0;
  for (size_t i = 0; i < count; ++i) {
    const uint8_t down = differences[i], up = static_cast<uint8_t>(-down);
    sum += down < up ? down : up;
  }
  return sum;
}

}  // namespace

void filter_lines(const PngLines& lines, PngFilters filters, std::vector<std::byte>& out) {
  constexpr uint8_t sub = 1, up = 2;
  const size_t row = lines.row_bytes;
  GREATX_CHECK(row >= lines.pixel_bytes && !(lines.swap && (filters != PngFilters::up || row % 2 != 0)),
               "lines of {} bytes", row);
  out.resize((row + 1) * lines.rows);
  const std::vector<uint8_t> nothing(row);
  std::vector<uint8_t> other(filters == PngFilters::up ? 0 : row);
  const auto* line = reinterpret_cast<const uint8_t*>(lines.pixels);
  const uint8_t* above = nothing.data();
  auto* to = reinterpret_cast<uint8_t*>(out.data());
  for (size_t y = 0; y < lines.rows; ++y, above = line, line += row, to += row) {
    uint8_t& filter = *to++ = up;
    if (lines.swap)
      filter_up_swapped(line, above, row, to);
    else
      filter_up(line, above, row, to);
    if (filters == PngFilters::up) continue;
    filter_sub(line, lines.pixel_bytes, row, other.data());
    if (magnitude(other.data(), row) > magnitude(to, row)) continue;
    filter = sub;
    std::memcpy(to, other.data(), row);
  }
}

}  // namespace greatx::io
