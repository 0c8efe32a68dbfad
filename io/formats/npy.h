// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// NumPy's .npy format, version 1.0 (numpy.lib.format; NEP 1), little endian, C order. NaN and infinities are
// stored bit for bit. The header always takes 256 bytes, so that a stack's first axis can be rewritten in
// place when it is complete, and the data are 64-byte aligned when memory-mapped.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/record.h"
#include "io/files/file.h"

namespace greatx::io {

inline constexpr uint64_t npy_header_bytes = 256;

/// The 256 bytes before the data.
Bytes npy_header(DType dtype, const std::vector<int64_t>& shape);
/// A whole file.
Bytes encode_npy(const Array& array);

/// A .npy file open for reading; rows are read on demand.
class NpyFile {
 public:
  /// Throws UserError if the file is not .npy 1.0 in C order of a type that DType knows, or shorter than its
  /// shape.
  explicit NpyFile(const std::filesystem::path& path);
  DType dtype() const { return dtype_; }
  const std::vector<int64_t>& shape() const { return shape_; }
  uint64_t file_bytes() const { return file_.size(); }
  int64_t rows() const { return shape_.empty() ? 1 : shape_[0]; }
  Array read() const { return shape_.empty() ? read_scalar() : read_rows(0, rows()); }
  /// Rows first..last-1 along the first axis.
  Array read_rows(int64_t first, int64_t last) const;

 private:
  Array read_scalar() const;
  File file_;
  DType dtype_ = DType::u8;
  std::vector<int64_t> shape_;
  uint64_t data_offset_ = 0;
};

}  // namespace greatx::io
