// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/formats/ply.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <sstream>

#include "io/formats/vertex_rows.h"

namespace greatx::io {

namespace {

struct TypeName {
  DType dtype;
  std::string_view name;
};
/// Lists the types that are read. The first name of a type is written, except that u32 is written as i32.
/// Open3D's tensor reader drops properties of any other name, among them "ushort" and "uint".
constexpr TypeName type_names[] = {{DType::u8, "uchar"},    {DType::u16, "uint16"},  {DType::i32, "int"},
                                   {DType::f32, "float"},   {DType::f64, "double"},  {DType::u32, "uint"},
                                   {DType::u8, "uint8"},    {DType::u16, "ushort"},  {DType::i32, "int32"},
                                   {DType::f32, "float32"}, {DType::f64, "float64"}, {DType::u32, "uint32"}};

std::string_view ply_type(DType dtype) {
  const DType written = dtype == DType::u32 ? DType::i32 : dtype;
  for (const TypeName& type : type_names)
    if (type.dtype == written) return type.name;
  GREATX_CHECK(false, "PLY has no type for {}", numpy_name(dtype));
  return {};
}

/// Throws UserError if an array of u32 holds a number that i32 cannot hold.
void check_fits(const std::string& name, const Array& array) {
  if (array.dtype != DType::u32) return;
  const std::span<const uint32_t> values = array.as<uint32_t>();
  const auto most = std::max_element(values.begin(), values.end());
  if (most != values.end() && *most > uint32_t{INT32_MAX})
    throw_user_error("PLY: {}: expected numbers up to {}, found {}", name, INT32_MAX, *most);
}

struct PlyHeader {
  int64_t vertices = -1;
  std::vector<VertexProperty> properties;
};

void parse_property(PlyHeader& header, const std::string& line, const std::string& file) {
  std::istringstream words(line);
  std::string keyword, type, property;
  words >> keyword >> type >> property;
  for (const TypeName& candidate : type_names) {
    if (candidate.name != type) continue;
    header.properties.push_back({property, candidate.dtype});
    return;
  }
  throw_user_error("{}: expected a property of a PLY type, found \"{}\"", file, line);
}

PlyHeader parse_header(std::string_view text, const std::string& file) {
  PlyHeader header;
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
  const std::vector<VertexProperty> properties = vertex_properties(names, arrays);
  for (size_t i = 1; i < arrays.size(); ++i) check_fits(names[i], *arrays[i]);
  std::string header =
      fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", arrays[0]->shape[0]);
  for (const VertexProperty& property : properties)
    header += fmt::format("property {} {}\n", ply_type(property.dtype), property.name);
  return with_vertex_rows(header + "end_header\n", arrays);
}

std::map<std::string, Array> decode_ply(std::span<const std::byte> file, const std::string& name) {
  constexpr std::string_view end_mark = "end_header\n";
  const std::optional<std::string_view> text = text_header(file, end_mark);
  if (!text) throw_user_error("{}: expected a PLY file", name);
  const PlyHeader header = parse_header(*text, name);
  const std::span<const std::byte> data = file.subspan(text->size() + end_mark.size());
  const auto count = static_cast<size_t>(header.vertices);
  const size_t stride = row_bytes(header.properties);
  if (stride == 0 || data.size() / stride != count || data.size() % stride != 0)
    throw_user_error("{}: expected {} vertices of {} bytes, found {} bytes", name, count, stride,
                     data.size());
  return vertex_columns(header.properties, count, data);
}

}  // namespace greatx::io
