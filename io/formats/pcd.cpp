// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/formats/pcd.h"

#include <algorithm>
#include <sstream>

#include <fmt/ranges.h>

#include "io/formats/vertex_rows.h"

namespace greatx::io {

namespace {

struct TypeLetter {
  DType dtype;
  char letter;
};
constexpr TypeLetter type_letters[] = {{DType::u8, 'U'}, {DType::u16, 'U'}, {DType::u32, 'U'},
                                       {DType::i8, 'I'}, {DType::i32, 'I'}, {DType::f32, 'F'},
                                       {DType::f64, 'F'}};

char letter_of(DType dtype) {
  for (const TypeLetter& type : type_letters)
    if (type.dtype == dtype) return type.letter;
  GREATX_CHECK(false, "PCD has no type for {}", numpy_name(dtype));
  return '\0';
}

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

/// Maps the first word of each header line to its other words.
using PcdHeader = std::map<std::string, std::vector<std::string>>;

const std::vector<std::string>& values_of(const PcdHeader& header, const std::string& key, size_t count,
                                          const std::string& name) {
  const auto found = header.find(key);
  if (found == header.end() || (count > 0 && found->second.size() != count))
    throw_user_error("{}: expected a PCD header with {} and {} values of it", name, key, count);
  return found->second;
}

std::vector<VertexProperty> properties_of(const PcdHeader& header, const std::string& name) {
  const std::vector<std::string>& fields = values_of(header, "FIELDS", 0, name);
  if (fields.empty()) throw_user_error("{}: expected a line FIELDS with one field or more, found none", name);
  const std::vector<std::string>&sizes = values_of(header, "SIZE", fields.size(), name),
        &types = values_of(header, "TYPE", fields.size(), name),
        &counts = values_of(header, "COUNT", fields.size(), name);
  std::vector<VertexProperty> properties;
  for (size_t i = 0; i < fields.size(); ++i) {
    const auto* type =
        std::find_if(std::begin(type_letters), std::end(type_letters), [&](const TypeLetter& t) {
          return types[i] == std::string(1, t.letter) && sizes[i] == std::to_string(size_of(t.dtype));
        });
    if (type == std::end(type_letters) || counts[i] != "1")
      throw_user_error(
          "{}: expected fields of one value of a known type, found {} of size {}, type {}, count {}", name,
          fields[i], sizes[i], types[i], counts[i]);
    properties.push_back({fields[i], type->dtype});
  }
  return properties;
}

}  // namespace

Bytes encode_pcd(const std::vector<std::string>& names, const std::vector<const Array*>& arrays) {
  std::vector<std::string> fields, sizes, types, counts;
  for (const VertexProperty& property : vertex_properties(names, arrays)) {
    fields.push_back(property.name);
    sizes.push_back(std::to_string(size_of(property.dtype)));
    types.emplace_back(1, letter_of(property.dtype));
    counts.emplace_back("1");
  }
  const std::string header = fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS {}\nSIZE {}\nTYPE {}\nCOUNT {}\nWIDTH "
      "{}\n"
      "HEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {}\nDATA binary\n",
      fmt::join(fields, " "), fmt::join(sizes, " "), fmt::join(types, " "), fmt::join(counts, " "),
      arrays[0]->shape[0], arrays[0]->shape[0]);
  return with_vertex_rows(header, arrays);
}

std::map<std::string, Array> decode_pcd(std::span<const std::byte> file, const std::string& name) {
  constexpr std::string_view end_mark = "\nDATA binary\n";
  const std::optional<std::string_view> text = text_header(file, end_mark);
  if (!text) throw_user_error("{}: expected a PCD file with binary data", name);
  PcdHeader header;
  std::istringstream lines{std::string(*text)};
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> words = words_of(line);
    if (words.empty() || words[0].starts_with('#')) continue;
    header[words[0]] = {words.begin() + 1, words.end()};
  }
  const std::vector<VertexProperty> properties = properties_of(header, name);
  const std::span<const std::byte> data = file.subspan(text->size() + end_mark.size());
  const size_t stride = row_bytes(properties);
  const std::string& points = values_of(header, "POINTS", 1, name)[0];
  if (data.size() % stride != 0 || points != std::to_string(data.size() / stride))
    throw_user_error("{}: expected {} points of {} bytes, found {} bytes", name, points, stride, data.size());
  return vertex_columns(properties, data.size() / stride, data);
}

Bytes encode_kitti(const Array& points) {
  GREATX_CHECK(points.dtype == DType::f32 && points.shape.size() == 2 && points.shape[1] == 4,
               "points of {} axes, {}", points.shape.size(), numpy_name(points.dtype));
  return {points.bytes.begin(), points.bytes.end()};
}

Array decode_kitti(std::span<const std::byte> file, const std::string& name) {
  if (file.size() % 16 != 0)
    throw_user_error("{}: expected points of 16 bytes, found {} bytes", name, file.size());
  Array points(DType::f32, {static_cast<int64_t>(file.size() / 16), 4});
  std::copy(file.begin(), file.end(), points.bytes.begin());
  return points;
}

}  // namespace greatx::io
