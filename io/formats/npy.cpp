// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/formats/npy.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <optional>

#include <fmt/ranges.h>

namespace greatx::io {

static_assert(std::endian::native == std::endian::little, "arrays are written as they lie in memory");

namespace {

constexpr std::string_view magic = "\x93NUMPY\x01";  // a zero byte, the minor version, follows
constexpr uint64_t preamble = 10;                    // bytes of magic, version and the text's length (u16)

std::optional<DType> dtype_named(std::string_view name) {
  for (const DType dtype : {DType::u8, DType::u16, DType::u32, DType::i8, DType::i32, DType::i64, DType::u64,
                            DType::f32, DType::f64, DType::complex64})
    if (numpy_name(dtype) == name) return dtype;
  return std::nullopt;
}

/// Returns the text between `before` and the next `after`, or an empty text if there is no `before`.
std::string_view between(std::string_view text, std::string_view before, std::string_view after) {
  const size_t start = text.find(before);
  if (start == text.npos) return {};
  text.remove_prefix(start + before.size());
  return text.substr(0, text.find(after));
}

std::vector<int64_t> parse_shape(std::string_view text, const std::string& file) {
  std::vector<int64_t> shape;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at != end) {
    if (*at == ' ' || *at == ',') {
      ++at;
      continue;
    }
    int64_t extent = 0;
    const auto [next, error] = std::from_chars(at, end, extent);
    if (error != std::errc{} || extent < 0)
      throw_user_error("{}: expected a shape of integers from 0 on", file);
    shape.push_back(extent);
    at = next;
  }
  return shape;
}

}  // namespace

Bytes npy_header(DType dtype, const std::vector<int64_t>& shape) {
  std::string text = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': (", numpy_name(dtype));
  for (const int64_t extent : shape) text += fmt::format("{}, ", extent);
  // NumPy writes "(3,)" for one axis and "(3, 4)" for more.
  if (!shape.empty()) text.erase(text.size() - (shape.size() == 1 ? 1 : 2));
  text += "), }";
  GREATX_CHECK(preamble + text.size() < npy_header_bytes, "header of {} bytes for {} axes", text.size(),
               shape.size());
  text = fmt::format("{:<{}}\n", text, npy_header_bytes - preamble - 1);
  Bytes header(npy_header_bytes);
  std::memcpy(header.data(), magic.data(), magic.size());
  const auto length = static_cast<uint16_t>(text.size());
  std::memcpy(header.data() + 8, &length, 2);
  std::memcpy(header.data() + preamble, text.data(), text.size());
  return header;
}

Bytes encode_npy(const Array& array) {
  Bytes file = npy_header(array.dtype, array.shape);
  append(file, array.bytes);
  return file;
}

NpyFile::NpyFile(const std::filesystem::path& path) : file_(File::open_for_reading(path)) {
  const uint64_t size = file_.size();
  std::string start(preamble, '\0');
  if (size >= preamble) file_.read_at(0, std::as_writable_bytes(std::span(start)));
  if (start.substr(0, 8) != std::string(magic) + '\0')
    throw_user_error("{}: expected a .npy file 1.0", path.string());
  uint16_t length = 0;
  std::memcpy(&length, start.data() + 8, 2);
  std::string text(length, '\0');
  file_.read_at(preamble, std::as_writable_bytes(std::span(text)));
  const std::string_view descr = between(text, "'descr': '", "'");
  const std::optional<DType> dtype = dtype_named(descr);
  if (!dtype) throw_user_error("{}: expected an element type that greatx writes", path.string());
  if (text.find("'fortran_order': False") == text.npos)
    throw_user_error("{}: expected C order", path.string());
  dtype_ = *dtype;
  shape_ = parse_shape(between(text, "'shape': (", ")"), path.string());
  data_offset_ = preamble + length;
  uint64_t expected = size_of(dtype_), bound = expected;
  for (const int64_t extent : shape_) {
    // The bound counts an empty axis as 1, because the size of a row must not overflow in an empty array
    // either.
    if (__builtin_mul_overflow(bound, std::max<uint64_t>(1, static_cast<uint64_t>(extent)), &bound))
      throw_user_error("{}: expected a shape of less than 2^64 bytes, found [{}]", path.string(),
                       fmt::join(shape_, ", "));
    expected *= static_cast<uint64_t>(extent);
  }
  if (size - data_offset_ != expected) {
    throw_user_error("{}: expected {} bytes of data, found {}", path.string(), expected, size - data_offset_);
  }
}

Array NpyFile::read_rows(int64_t first, int64_t last) const {
  GREATX_CHECK(!shape_.empty() && 0 <= first && first <= last && last <= shape_[0], "rows {}..{} of {}",
               first, last, rows());
  std::vector<int64_t> shape = shape_;
  uint64_t row_bytes = size_of(dtype_);
  for (size_t axis = 1; axis < shape.size(); ++axis) row_bytes *= static_cast<uint64_t>(shape[axis]);
  shape[0] = last - first;
  Array array(dtype_, shape);
  file_.read_at(data_offset_ + static_cast<uint64_t>(first) * row_bytes, array.bytes);
  return array;
}

Array NpyFile::read_scalar() const {
  Array array(dtype_, {});
  file_.read_at(data_offset_, array.bytes);
  return array;
}

}  // namespace greatx::io
