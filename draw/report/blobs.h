// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The bytes of a report, and the codes of the numbers in them. page/blobs.js reads them again.
//
// A packed array is a sequence of unsigned integers of 1, 2 or 4 bytes. If it has rows, each integer is
// replaced by its difference to the one before it in the row, modulo 2^(8 bytes). Then come all lowest bytes,
// then all next bytes, and so on; zlib packs the whole (RFC 1950). Neighbours are alike, so that the
// differences are small and the higher bytes are mostly equal.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "io/files/file.h"

namespace greatx::io::report {

/// Holds the bytes by number. A number is the place in the order of add().
class Blobs {
 public:
  size_t add(Bytes bytes) {
    blobs_.push_back(std::move(bytes));
    return blobs_.size() - 1;
  }
  const Bytes& at(size_t number) const { return blobs_.at(number); }
  size_t size() const { return blobs_.size(); }
  /// Returns the characters that blobs first..last-1 take in the page.
  uint64_t page_bytes(size_t first, size_t last) const;

 private:
  std::vector<Bytes> blobs_;
};
/// The characters around the base64 of a blob.
inline constexpr size_t blob_overhead = 64;

/// Packs integers of `bytes` (1, 2 or 4) each. `row`: the length of a row for differences; 0: no differences.
Bytes packed(std::span<const uint32_t> values, int bytes, size_t row);
/// Packs text.
Bytes packed_text(std::string_view text);

/// Codes positive numbers by even steps of their logarithm: value = low * ratio^(code - 1) for codes above 0.
/// 0 stands for infinity (sky) and for numbers that are not positive. The relative error is at most
/// (ratio - 1) / 2, and the largest code is 65535.
struct LogCode {
  double low = 1.0, ratio = 1.002;
  /// Chooses `low` as the least positive finite value. Raises `ratio` if 65535 codes would not do.
  static LogCode of(std::span<const float> values, double ratio);
  uint32_t code(double value) const;
};

}  // namespace greatx::io::report
