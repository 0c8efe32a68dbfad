// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/import/ply_mesh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <string_view>

#include "core/budget.h"
#include "core/error.h"

namespace greatx::scene {

namespace {

enum class Format { ascii, little_endian, big_endian };
enum class Type { i8, u8, i16, u16, i32, u32, f32, f64 };

size_t size_of(Type type) {
  constexpr std::array<size_t, 8> sizes{1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<size_t>(type)];
}

std::optional<Type> type_called(std::string_view name) {
  constexpr std::array<std::array<std::string_view, 2>, 8> names{{{"char", "int8"},
                                                                  {"uchar", "uint8"},
                                                                  {"short", "int16"},
                                                                  {"ushort", "uint16"},
                                                                  {"int", "int32"},
                                                                  {"uint", "uint32"},
                                                                  {"float", "float32"},
                                                                  {"double", "float64"}}};
  for (size_t i = 0; i < names.size(); ++i)
    if (name == names[i][0] || name == names[i][1]) return static_cast<Type>(i);
  return std::nullopt;
}

struct Property {
  std::string name;
  Type type = Type::f32;
  std::optional<Type> count;  ///< type of the count, for a list
};

struct Element {
  std::string name;
  uint64_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  Format format = Format::ascii;
  std::vector<Element> elements;
  size_t bytes = 0;  ///< where the body begins
  int lines = 0;
};

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  size_t at = 0;
  while ((at = line.find_first_not_of(" \t\r", at)) != std::string_view::npos) {
    const size_t end = std::min(line.find_first_of(" \t\r", at), line.size());
    words.push_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

/// Reads the header line by line.
class HeaderReader {
 public:
  HeaderReader(std::span<const unsigned char> file, const std::string& name)
      : text_(reinterpret_cast<const char*>(file.data()), file.size()), name_(name) {}

  Header read() {
    if (next_line() != "ply") fail("expected 'ply': not a PLY file");
    bool has_format = false;
    while (true) {
      const std::vector<std::string_view> words = words_of(next_line());
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") break;
      if (words[0] == "format") {
        read_format(words);
        has_format = true;
      } else if (words[0] == "element") {
        read_element(words);
      } else if (words[0] == "property") {
        read_property(words);
      } else {
        fail(fmt::format("expected format, element, property or end_header, found '{}'", words[0]));
      }
    }
    if (!has_format) fail("the header names no format");
    header_.bytes = at_;
    header_.lines = line_;
    return header_;
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { throw UserError({name_, line_}, message); }

  std::string_view next_line() {
    ++line_;
    const size_t end = text_.find('\n', at_);
    // A text of a megabyte without an end is not a header.
    if (end == std::string_view::npos || end > (1u << 20)) fail("the header has no end_header");
    std::string_view line = text_.substr(at_, end - at_);
    if (line.ends_with('\r')) line.remove_suffix(1);
    at_ = end + 1;
    return line;
  }

  void read_format(const std::vector<std::string_view>& words) {
    if (words.size() != 3 || words[2] != "1.0") fail("expected 'format TYPE 1.0'");
    if (words[1] == "ascii")
      header_.format = Format::ascii;
    else if (words[1] == "binary_little_endian")
      header_.format = Format::little_endian;
    else if (words[1] == "binary_big_endian")
      header_.format = Format::big_endian;
    else
      fail(fmt::format("format: expected ascii, binary_little_endian or binary_big_endian, found '{}'",
                       words[1]));
  }

  void read_element(const std::vector<std::string_view>& words) {
    Element element;
    if (words.size() == 3) {
      element.name = words[1];
      const char* const end = words[2].data() + words[2].size();
      const auto [stopped, error] = std::from_chars(words[2].data(), end, element.count);
      if (error == std::errc{} && stopped == end) {
        header_.elements.push_back(std::move(element));
        return;
      }
    }
    fail("expected 'element NAME COUNT'");
  }

  void read_property(const std::vector<std::string_view>& words) {
    if (header_.elements.empty()) fail("a property before the first element");
    const bool list = words.size() == 5 && words[1] == "list";
    if (!list && words.size() != 3) fail("expected 'property TYPE NAME' or 'property list TYPE TYPE NAME'");
    Property property;
    property.name = words.back();
    property.type = type(words[words.size() - 2]);
    if (list) property.count = type(words[2]);
    header_.elements.back().properties.push_back(std::move(property));
  }

  Type type(std::string_view name) const {
    const std::optional<Type> found = type_called(name);
    if (!found) fail(fmt::format("unknown type '{}'", name));
    return *found;
  }

  std::string_view text_;
  std::string name_;
  size_t at_ = 0;
  int line_ = 0;
  Header header_;
};

/// Reads the body value by value.
class BodyReader {
 public:
  BodyReader(std::span<const unsigned char> file, const std::string& name, const Header& header)
      : file_(file), name_(name), format_(header.format), at_(header.bytes), line_(header.lines + 1) {}

  size_t left() const { return file_.size() - at_; }
  const std::string& name() const { return name_; }

  [[noreturn]] void fail(const std::string& message) const {
    if (format_ == Format::ascii) throw UserError({name_, line_}, message);
    throw_user_error("{}: byte {}: {}", name_, at_, message);
  }

  /// A double holds every value of every type exactly.
  double value(Type type) { return format_ == Format::ascii ? ascii_value(type) : binary_value(type); }

 private:
  double ascii_value(Type type) {
    const auto is_space = [](unsigned char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
    while (at_ < file_.size() && is_space(file_[at_]))
      if (file_[at_++] == '\n') ++line_;
    size_t end = at_;
    while (end < file_.size() && !is_space(file_[end])) ++end;
    const char* const first = reinterpret_cast<const char*>(file_.data()) + at_;
    const char* const last = reinterpret_cast<const char*>(file_.data()) + end;
    if (first == last) fail("the file ends early");
    double value = 0.0;
    float narrow = 0.0f;  // a float is parsed as a float, so that it is rounded once
    const auto [stopped, error] =
        type == Type::f32 ? std::from_chars(first, last, narrow) : std::from_chars(first, last, value);
    if (error != std::errc{} || stopped != last)
      fail(fmt::format("expected a number, found '{}'", std::string(first, std::min(last, first + 40))));
    if (type == Type::f32) value = static_cast<double>(narrow);
    at_ = end;
    return value;
  }

  double binary_value(Type type) {
    const size_t size = size_of(type);
    if (left() < size) fail("the file ends early");
    std::array<unsigned char, 8> bytes{};
    std::memcpy(bytes.data(), file_.data() + at_, size);
    static_assert(std::endian::native == std::endian::little);
    if (format_ == Format::big_endian)
      std::reverse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    at_ += size;
    switch (type) {
      case Type::i8:
        return as<int8_t>(bytes);
      case Type::u8:
        return as<uint8_t>(bytes);
      case Type::i16:
        return as<int16_t>(bytes);
      case Type::u16:
        return as<uint16_t>(bytes);
      case Type::i32:
        return as<int32_t>(bytes);
      case Type::u32:
        return as<uint32_t>(bytes);
      case Type::f32:
        return static_cast<double>(as<float>(bytes));
      case Type::f64:
        return as<double>(bytes);
    }
    return 0.0;
  }

  template <typename T>
  static T as(const std::array<unsigned char, 8>& bytes) {
    T value;
    std::memcpy(&value, bytes.data(), sizeof(T));
    return value;
  }

  std::span<const unsigned char> file_;
  std::string name_;
  Format format_;
  size_t at_;
  int line_;
};

class MeshReader {
 public:
  MeshReader(BodyReader& body, PlyMesh& mesh) : body_(body), mesh_(mesh) {}

  void read(const Element& element) {
    // Each value takes at least a byte. The check keeps a false count from allocating memory.
    const uint64_t least = std::max<uint64_t>(1, element.properties.size());
    if (element.count > body_.left() / least)
      body_.fail(fmt::format("{} elements '{}' do not fit into the {} bytes that are left", element.count,
                             element.name, body_.left()));
    // Memory is counted for position and normal of a vertex, and for two triangles of a face.
    if (element.name == "vertex" || element.name == "face")
      memory_.plan(fmt::format("{}: with {} elements '{}'", body_.name(), element.count, element.name),
                   saturating_product({element.count, 6 * sizeof(float)}));
    for (uint64_t i = 0; i < element.count; ++i)
      if (element.name == "vertex")
        read_vertex(element, i);
      else if (element.name == "face")
        read_face(element, i);
      else
        for (const Property& property : element.properties) skip(property);
  }

 private:
  void skip(const Property& property) {
    const uint64_t count = property.count ? list_size(property) : 1;
    for (uint64_t i = 0; i < count; ++i) body_.value(property.type);
  }

  uint64_t list_size(const Property& property) {
    const double count = body_.value(*property.count);
    if (!(count >= 0.0) || count != std::floor(count) || count > static_cast<double>(body_.left()))
      body_.fail(fmt::format("a list '{}' of {} values", property.name, count));
    return static_cast<uint64_t>(count);
  }

  void read_vertex(const Element& element, uint64_t number) {
    std::array<float, 6> values{};
    std::array<bool, 6> found{};
    for (const Property& property : element.properties) {
      constexpr std::array<std::string_view, 6> names{"x", "y", "z", "nx", "ny", "nz"};
      const auto slot = static_cast<size_t>(std::ranges::find(names, property.name) - names.begin());
      if (slot == names.size() || property.count) {
        skip(property);
        continue;
      }
      values[slot] = static_cast<float>(body_.value(property.type));
      found[slot] = true;
      if (!std::isfinite(values[slot]))
        body_.fail(fmt::format("vertex {}: {}: expected a finite number, found {}", number, names[slot],
                               values[slot]));
    }
    if (!found[0] || !found[1] || !found[2]) body_.fail("vertices need the properties x, y and z");
    mesh_.positions.emplace_back(values[0], values[1], values[2]);
    if (found[3] && found[4] && found[5]) mesh_.normals.emplace_back(values[3], values[4], values[5]);
  }

  void read_face(const Element& element, uint64_t number) {
    bool found = false;
    for (const Property& property : element.properties) {
      if (!property.count || (property.name != "vertex_indices" && property.name != "vertex_index")) {
        skip(property);
        continue;
      }
      found = true;
      const uint64_t corners = list_size(property);
      if (corners != 3 && corners != 4)
        body_.fail(fmt::format("face {}: expected 3 or 4 corners, found {}", number, corners));
      std::array<uint32_t, 4> face{};
      for (size_t i = 0; i < corners; ++i) face[i] = vertex_index(property, number);
      mesh_.indices.insert(mesh_.indices.end(), face.begin(), face.begin() + 3);
      if (corners == 4) mesh_.indices.insert(mesh_.indices.end(), {face[0], face[2], face[3]});
    }
    if (!found) body_.fail("faces need the list vertex_indices");
  }

  uint32_t vertex_index(const Property& property, uint64_t face) {
    const double index = body_.value(property.type);
    if (!(index >= 0.0) || index != std::floor(index) || index >= static_cast<double>(mesh_.positions.size()))
      body_.fail(fmt::format("face {}: vertex index {}, but there are {} vertices", face, index,
                             mesh_.positions.size()));
    return static_cast<uint32_t>(index);
  }

  BodyReader& body_;
  PlyMesh& mesh_;
  Spending memory_{budget::import_geometry};
};

}  // namespace

PlyMesh read_ply_mesh(std::span<const unsigned char> file, const std::string& name) {
  const Header header = HeaderReader(file, name).read();
  BodyReader body(file, name, header);
  PlyMesh mesh;
  MeshReader reader(body, mesh);
  for (const Element& element : header.elements) reader.read(element);
  if (mesh.positions.empty()) throw_user_error("{}: no vertices", name);
  if (mesh.indices.empty()) throw_user_error("{}: no faces", name);
  return mesh;
}

}  // namespace greatx::scene
