// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "draw/report/blobs.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/formats/deflate.h"
#include "io/formats/html_text.h"

namespace greatx::io::report {

namespace {
constexpr int packing_level = 6;
}

uint64_t Blobs::page_bytes(size_t first, size_t last) const {
  uint64_t sum = 0;
  for (size_t i = first; i < last; ++i) sum += base64_size(blobs_[i].size()) + blob_overhead;
  return sum;
}

Bytes packed(std::span<const uint32_t> values, int bytes, size_t row) {
  GREATX_CHECK(bytes == 1 || bytes == 2 || bytes == 4, "integers of {} bytes", bytes);
  const size_t count = values.size();
  Bytes planes(count * static_cast<size_t>(bytes));
  for (size_t i = 0; i < count; ++i) {
    uint32_t value = values[i];
    if (row > 0 && i % row != 0) value -= values[i - 1];
    for (size_t b = 0; b < static_cast<size_t>(bytes); ++b)
      planes[b * count + i] = static_cast<std::byte>(value >> (8 * b) & 255u);
  }
  Bytes result;
  append_deflated(planes, packing_level, result);
  return result;
}

Bytes packed_text(std::string_view text) {
  Bytes result;
  append_deflated(bytes_of(text), packing_level, result);
  return result;
}

LogCode LogCode::of(std::span<const float> values, double ratio) {
  double low = std::numeric_limits<double>::infinity(), high = 0.0;
  for (const float value : values) {
    if (!std::isfinite(value) || !(value > 0.0f)) continue;
    low = std::min(low, static_cast<double>(value));
    high = std::max(high, static_cast<double>(value));
  }
  if (!(high > 0.0)) return {1.0, ratio};
  return {low, std::max(ratio, std::pow(high / low, 1.0 / 65533.0))};
}

uint32_t LogCode::code(double value) const {
  if (!std::isfinite(value) || !(value > 0.0)) return 0;
  const double step = std::round(std::log(value / low) / std::log(ratio));
  return 1 + static_cast<uint32_t>(std::clamp(step, 0.0, 65534.0));
}

}  // namespace greatx::io::report
