// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Filters the lines of a PNG picture (section 9 of the standard): a line becomes the filter's number and the
// differences of its bytes from their neighbours. Only Sub and Up are used, since readers in NumPy undo these
// by sums over whole lines; the other filters go from byte to byte.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace greatx::io {

enum class PngFilters {
  up,         ///< Up in every line
  sub_or_up,  ///< in each line the one whose differences have the smaller sum of magnitudes; Sub of equals
};

/// Describes the lines of a picture as they lie in memory.
struct PngLines {
  const std::byte* pixels = nullptr;
  size_t row_bytes = 0, rows = 0;
  size_t pixel_bytes = 1;
  bool swap = false;  ///< whether pairs of bytes change their places: 16-bit values, big-endian in a file
};

/// Writes all filtered lines to `out`, which takes their size. `swap` goes with `up` only.
void filter_lines(const PngLines& lines, PngFilters filters, std::vector<std::byte>& out);

}  // namespace greatx::io
