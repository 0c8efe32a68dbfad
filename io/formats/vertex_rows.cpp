// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/formats/vertex_rows.h"

#include <algorithm>
#include <cstring>

namespace greatx::io {

std::vector<VertexProperty> vertex_properties(const std::vector<std::string>& names,
                                              const std::vector<const Array*>& arrays) {
  GREATX_CHECK(!arrays.empty() && names.size() == arrays.size(), "{} names, {} arrays", names.size(),
               arrays.size());
  const Array& points = *arrays[0];
  GREATX_CHECK(points.dtype == DType::f32 && points.shape.size() == 2 && points.shape[1] == 4,
               "points of {} axes, {}", points.shape.size(), numpy_name(points.dtype));
  std::vector<VertexProperty> properties;
  for (const char* axis : {"x", "y", "z", "intensity"}) properties.push_back({axis, DType::f32});
  for (size_t i = 1; i < arrays.size(); ++i) {
    GREATX_CHECK(arrays[i]->shape == std::vector<int64_t>{points.shape[0]}, "property {} of {} axes",
                 names[i], arrays[i]->shape.size());
    properties.push_back({names[i], arrays[i]->dtype});
  }
  return properties;
}

size_t row_bytes(const std::vector<VertexProperty>& properties) {
  size_t bytes = 0;
  for (const VertexProperty& property : properties) bytes += size_of(property.dtype);
  return bytes;
}

namespace {

/// Copies `count` values of `width` bytes to places that are `stride` bytes apart.
template <size_t width>
void spread(const std::byte* in, size_t count, std::byte* out, size_t stride) {
  for (size_t i = 0; i < count; ++i, in += width, out += stride) std::memcpy(out, in, width);
}

/// Does so with a width that is known when this is compiled, so that a value is one move.
void spread(const std::byte* in, size_t width, size_t count, std::byte* out, size_t stride) {
  switch (width) {
    case 1:
      return spread<1>(in, count, out, stride);
    case 2:
      return spread<2>(in, count, out, stride);
    case 4:
      return spread<4>(in, count, out, stride);
    case 8:
      return spread<8>(in, count, out, stride);
    case 16:
      return spread<16>(in, count, out, stride);
    default:
      GREATX_CHECK(false, "values of {} bytes", width);
  }
}

}  // namespace

Bytes with_vertex_rows(const std::string& header, const std::vector<const Array*>& arrays) {
  const auto count = static_cast<size_t>(arrays[0]->shape[0]);
  size_t stride = 16;
  for (size_t i = 1; i < arrays.size(); ++i) stride += size_of(arrays[i]->dtype);
  Bytes file(header.size() + count * stride);
  std::memcpy(file.data(), header.data(), header.size());
  constexpr size_t piece = 512;  // rows, which stay in the nearest cache until all columns are in
  for (size_t first = 0; first < count; first += piece) {
    const size_t rows = std::min(piece, count - first);
    std::byte* out = file.data() + header.size() + first * stride;
    for (size_t i = 0; i < arrays.size(); ++i) {
      const size_t width = i == 0 ? 16 : size_of(arrays[i]->dtype);
      spread(arrays[i]->bytes.data() + first * width, width, rows, out, stride);
      out += width;
    }
  }
  return file;
}

std::map<std::string, Array> vertex_columns(const std::vector<VertexProperty>& properties, size_t count,
                                            std::span<const std::byte> data) {
  const size_t stride = row_bytes(properties);
  GREATX_CHECK(data.size() == count * stride, "{} bytes for {} rows of {}", data.size(), count, stride);
  std::map<std::string, Array> arrays;
  size_t column = 0;
  for (const VertexProperty& property : properties) {
    Array array(property.dtype, {static_cast<int64_t>(count)});
    const size_t width = size_of(property.dtype);
    for (size_t vertex = 0; vertex < count; ++vertex)
      std::memcpy(array.bytes.data() + vertex * width, data.data() + vertex * stride + column, width);
    column += width;
    arrays.emplace(property.name, std::move(array));
  }
  return arrays;
}

std::optional<std::string_view> text_header(std::span<const std::byte> file, std::string_view end_mark) {
  constexpr size_t longest = 65536;
  const std::string_view text(reinterpret_cast<const char*>(file.data()), std::min(file.size(), longest));
  const size_t end = text.find(end_mark);
  return end == text.npos ? std::nullopt : std::optional(text.substr(0, end));
}

}  // namespace greatx::io
