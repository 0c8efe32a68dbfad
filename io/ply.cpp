// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/ply.h"

#include <charconv>
#include <cstring>
#include <sstream>

namespace greatx::io {

namespace {

struct TypeName {
  DType dtype;
  std::string_view name;
};
constexpr TypeName type_names[] = {{DType::u8, "uchar"}, {DType::u16, "ushort"}, {DType::u32, "uint"},
                                   {DType::i32, "int"},  {DType::f32, "float"},  {DType::f64, "double"}};

std::string_view ply_type(DType dtype) {
  for (const TypeName& type : type_names)
    if (type.dtype == dtype) return type.name;
  GREATX_CHECK(false, "PLY has no type for {}", numpy_name(dtype));
  return {};
}

struct Property {
  std::string name;
  DType dtype;
};

struct Header {
  int64_t vertices = -1;
  std::vector<Property> properties;
  size_t stride = 0;
};

void parse_property(Header& header, const std::string& line, const std::string& file) {
  std::istringstream words(line);
  std::string keyword, type, property;
  words >> keyword >> type >> property;
  for (const TypeName& candidate : type_names) {
    if (candidate.name != type) continue;
    header.properties.push_back({property, candidate.dtype});
    header.stride += size_of(candidate.dtype);
    return;
  }
  throw_user_error("{}: expected a property of a PLY type, found \"{}\"", file, line);
}

Header parse_header(std::string_view text, const std::string& file) {
  Header header;
  std::istringstream lines{std::string(text)};
  std::string line;
  std::getline(lines, line);
  if (line != "ply") throw_user_error("{}: expected a PLY file", file);
  while (std::getline(lines, line)) {
    if (line.starts_with("comment")) continue;
    if (line == "format binary_little_endian 1.0") continue;
    if (line.starts_with("element vertex ")) {
      const char* const end = line.data() + line.size();
      const auto [next, error] = std::from_chars(line.data() + 15, end, header.vertices);
      if (error == std::errc{} && next == end && header.vertices >= 0) continue;
    } else if (line.starts_with("property ") && header.vertices >= 0) {
      parse_property(header, line, file);
      continue;
    }
    throw_user_error("{}: expected one element vertex in binary little endian, found \"{}\"", file, line);
  }
  if (header.vertices < 0) throw_user_error("{}: expected an element vertex", file);
  return header;
}

}  // namespace

Bytes encode_ply(const std::vector<std::string>& names, const std::vector<const Array*>& arrays) {
  GREATX_CHECK(!arrays.empty() && names.size() == arrays.size(), "{} names, {} arrays", names.size(),
               arrays.size());
  const Array& points = *arrays[0];
  GREATX_CHECK(points.dtype == DType::f32 && points.shape.size() == 2 && points.shape[1] == 4,
               "points of {} axes, {}", points.shape.size(), numpy_name(points.dtype));
  const auto count = static_cast<size_t>(points.shape[0]);
  std::string header = fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", count);
  for (const char* axis : {"x", "y", "z", "intensity"}) header += fmt::format("property float {}\n", axis);
  size_t stride = 16;
  for (size_t i = 1; i < arrays.size(); ++i) {
    GREATX_CHECK(arrays[i]->shape == std::vector<int64_t>{points.shape[0]}, "property {} of {} axes",
                 names[i], arrays[i]->shape.size());
    header += fmt::format("property {} {}\n", ply_type(arrays[i]->dtype), names[i]);
    stride += size_of(arrays[i]->dtype);
  }
  header += "end_header\n";

  Bytes file(header.size() + count * stride);
  std::memcpy(file.data(), header.data(), header.size());
  size_t column = header.size();
  for (size_t i = 0; i < arrays.size(); ++i) {
    const size_t width = i == 0 ? 16 : size_of(arrays[i]->dtype);
    const std::byte* in = arrays[i]->bytes.data();
    std::byte* out = file.data() + column;
    for (size_t vertex = 0; vertex < count; ++vertex, in += width, out += stride) std::memcpy(out, in, width);
    column += width;
  }
  return file;
}

std::map<std::string, Array> decode_ply(std::span<const std::byte> file, const std::string& name) {
  constexpr std::string_view end_mark = "end_header\n";
  const std::string_view text(reinterpret_cast<const char*>(file.data()),
                              std::min<size_t>(file.size(), 65536));
  const size_t end = text.find(end_mark);
  if (end == text.npos) throw_user_error("{}: expected a PLY file", name);
  const Header header = parse_header(text.substr(0, end), name);
  const std::byte* const data = file.data() + end + end_mark.size();
  const size_t found = file.size() - end - end_mark.size();
  const auto count = static_cast<size_t>(header.vertices);
  if (header.stride == 0 || found / header.stride != count || found % header.stride != 0) {
    throw_user_error("{}: expected {} vertices of {} bytes, found {} bytes", name, count, header.stride,
                     found);
  }
  std::map<std::string, Array> arrays;
  size_t column = 0;
  for (const Property& property : header.properties) {
    Array array(property.dtype, {header.vertices});
    const size_t width = size_of(property.dtype);
    for (size_t vertex = 0; vertex < count; ++vertex)
      std::memcpy(array.bytes.data() + vertex * width, data + vertex * header.stride + column, width);
    column += width;
    arrays.emplace(property.name, std::move(array));
  }
  return arrays;
}

}  // namespace greatx::io
