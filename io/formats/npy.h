// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes and reads NumPy's .npy format, version 1.0 (numpy.lib.format; NEP 1), little endian, C order. NaN
// and infinities are stored bit for bit. A written header always takes 256 bytes, so that the first axis of a
// stack can be rewritten in place when the stack is complete, and the data are 64-byte aligned in a memory
// map.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/record.h"
#include "io/files/file.h"

namespace greatx::io {

inline constexpr uint64_t npy_header_bytes = 256;

/// Returns the 256 bytes before the data.
Bytes npy_header(DType dtype, const std::vector<int64_t>& shape);
/// Returns a whole file.
Bytes encode_npy(const Array& array);

/// Reads rows of a .npy file on demand.
class NpyFile {
 public:
  /// Throws UserError if the file is not .npy 1.0, not in C order, not of a type of DType, or does not have
  /// the size that its shape requires.
  explicit NpyFile(const std::filesystem::path& path);
  DType dtype() const { return dtype_; }
  const std::vector<int64_t>& shape() const { return shape_; }
  uint64_t file_bytes() const { return file_.size(); }
  int64_t rows() const { return shape_.empty() ? 1 : shape_[0]; }
  Array read() const { return shape_.empty() ? read_scalar() : read_rows(0, rows()); }
  /// Reads rows first .. last-1 along the first axis.
  Array read_rows(int64_t first, int64_t last) const;

 private:
  Array read_scalar() const;
  File file_;
  DType dtype_ = DType::u8;
  std::vector<int64_t> shape_;
  uint64_t data_offset_ = 0;
};

}  // namespace greatx::io
