// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/import/mitsuba_xml.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <numbers>

#include <glm/gtc/matrix_transform.hpp>

#include "core/input_file.h"
#include "core/text.h"
#include "scene/files/known_format.h"

namespace greatx::scene {

namespace {

/// Checks depth and text, so that code may visit the elements by recursion, and names may go into glTF and
/// JSON.
class Checker : public pugi::xml_tree_walker {
 public:
  explicit Checker(const MitsubaXml& xml) : xml_(xml) {}
  bool for_each(pugi::xml_node& node) override {
    if (depth() > most_depth) xml_.fail(node, "expected elements nested {} deep at most", most_depth);
    check(node, node.name());
    for (const pugi::xml_attribute& attribute : node.attributes()) {
      check(node, attribute.name());
      check(node, attribute.value());
    }
    return true;
  }

 private:
  static constexpr int most_depth = 64;
  void check(const pugi::xml_node& node, const char* text) const {
    if (const auto bad = find_bad_utf8(text))
      xml_.fail(node, "expected UTF-8, found the byte 0x{:02x} in '{}'",
                static_cast<unsigned char>(text[*bad]), printable(text));
  }
  const MitsubaXml& xml_;
};

}  // namespace

MitsubaXml::MitsubaXml(const std::filesystem::path& file) : file_(file) {
  source_ = InputFile(file, file.string(), budget::import_xml).text();
  for (size_t at = 0; at < source_.size(); ++at)
    if (source_[at] == '\n') line_ends_.push_back(static_cast<std::ptrdiff_t>(at));
  const auto format =
      recognised_format(file, {reinterpret_cast<const unsigned char*>(source_.data()), source_.size()});
  if (format && !format->is_mitsuba) throw UserError(wrong_format(file, *format, "a Mitsuba scene (.xml)"));
  const pugi::xml_parse_result result = document_.load_buffer(source_.data(), source_.size());
  if (!result) throw_user_error_at(location(result.offset), "XML: {}", result.description());
  if (!scene())
    throw_user_error("{}: expected the root element <scene>: not a Mitsuba scene", file_.string());
  Checker checker(*this);
  document_.traverse(checker);
}

SourceLocation MitsubaXml::where(const pugi::xml_node& node) const { return location(node.offset_debug()); }

SourceLocation MitsubaXml::location(std::ptrdiff_t offset) const {
  if (offset < 0) return {file_.string(), 0};
  const auto line = std::lower_bound(line_ends_.begin(), line_ends_.end(), offset) - line_ends_.begin();
  return {file_.string(), 1 + static_cast<int>(line)};
}

std::string MitsubaXml::text(const pugi::xml_node& node, const char* attribute) const {
  const std::string value = node.attribute(attribute).value();
  if (value.empty()) fail(node, "<{}>: expected the attribute {}", node.name(), attribute);
  if (value.front() == '$')
    fail(node, "<{}> {}: parameters are not supported, found '{}'", node.name(), attribute, value);
  return value;
}

double MitsubaXml::number(const pugi::xml_node& node, const char* attribute) const {
  const std::vector<double> values = numbers(node, attribute);
  if (values.size() != 1) fail(node, "<{}> {}: expected one number", node.name(), attribute);
  return values[0];
}

std::vector<double> MitsubaXml::numbers(const pugi::xml_node& node, const char* attribute) const {
  const std::string value = text(node, attribute);
  std::vector<double> values;
  const auto is_gap = [](char c) { return c == ' ' || c == ',' || c == '\t' || c == '\n' || c == '\r'; };
  const char* at = value.data();
  const char* const end = at + value.size();
  while (true) {
    at = std::find_if_not(at, end, is_gap);
    if (at == end) return values;
    double number = 0.0;
    const auto [stopped, error] = std::from_chars(at + (*at == '+' ? 1 : 0), end, number);
    if (error != std::errc{} || (stopped != end && !is_gap(*stopped)) || !std::isfinite(number))
      fail(node, "<{}> {}: expected finite numbers, found '{}'", node.name(), attribute, value);
    values.push_back(number);
    at = stopped;
  }
}

pugi::xml_node MitsubaXml::property(const pugi::xml_node& parent, const char* type, const std::string& name) {
  for (const pugi::xml_node& child : parent.children(type))
    if (child.attribute("name").value() == name) return child;
  return {};
}

std::optional<std::string> MitsubaXml::string(const pugi::xml_node& parent, const std::string& name) const {
  const pugi::xml_node node = property(parent, "string", name);
  if (!node) return std::nullopt;
  return text(node, "value");
}

std::optional<double> MitsubaXml::real(const pugi::xml_node& parent, const std::string& name) const {
  for (const char* type : {"float", "integer"})
    if (const pugi::xml_node node = property(parent, type, name)) return number(node, "value");
  return std::nullopt;
}

bool MitsubaXml::flag(const pugi::xml_node& parent, const std::string& name) const {
  const pugi::xml_node node = property(parent, "boolean", name);
  if (!node) return false;
  const std::string value = text(node, "value");
  if (value == "true") return true;
  if (value == "false") return false;
  fail(node, "{}: expected true or false, found '{}'", name, value);
}

vec3 MitsubaXml::rgb(const pugi::xml_node& node) const {
  const std::string value = text(node, "value");
  vec3 color{0.0f};
  if (value.front() == '#') {
    uint32_t word = 0;
    const char* const end = value.data() + value.size();
    const auto [stopped, error] = std::from_chars(value.data() + 1, end, word, 16);
    if (value.size() != 7 || error != std::errc{} || stopped != end)
      fail(node, "<rgb>: expected #rrggbb, found '{}'", value);
    color = vec3(static_cast<float>(word >> 16), static_cast<float>(word >> 8 & 0xffu),
                 static_cast<float>(word & 0xffu)) /
            255.0f;
  } else {
    const std::vector<double> values = numbers(node, "value");
    if (values.size() != 1 && values.size() != 3)
      fail(node, "<rgb>: expected one or three numbers, found '{}'", value);
    for (int i = 0; i < 3; ++i)
      color[i] = static_cast<float>(values[values.size() == 1 ? 0 : static_cast<size_t>(i)]);
  }
  for (int i = 0; i < 3; ++i)
    if (!(color[i] >= 0.0f && color[i] <= 1.0f))
      fail(node, "<rgb>: expected a reflectance of 0...1, found '{}'", value);
  return color;
}

dvec3 MitsubaXml::xyz(const pugi::xml_node& node, double missing) const {
  if (node.attribute("value")) {
    const std::vector<double> values = numbers(node, "value");
    if (values.size() == 1) return dvec3(values[0]);
    if (values.size() != 3) fail(node, "<{}>: expected one or three numbers", node.name());
    return {values[0], values[1], values[2]};
  }
  dvec3 vector(missing);
  const char* const names[] = {"x", "y", "z"};
  for (int i = 0; i < 3; ++i)
    if (node.attribute(names[i])) vector[i] = number(node, names[i]);
  return vector;
}

dmat4 MitsubaXml::matrix(const pugi::xml_node& node) const {
  const std::vector<double> values = numbers(node, "value");
  if (values.size() != 16 && values.size() != 9)
    fail(node, "<matrix>: expected 16 or 9 numbers, found {}", values.size());
  const int size = values.size() == 16 ? 4 : 3;
  dmat4 matrix(1.0);
  for (int row = 0; row < size; ++row)
    for (int column = 0; column < size; ++column)
      matrix[column][row] = values[static_cast<size_t>(size * row + column)];
  if (dvec4(matrix[0][3], matrix[1][3], matrix[2][3], matrix[3][3]) != dvec4(0, 0, 0, 1))
    fail(node, "<matrix>: expected 0 0 0 1 in the last row");
  return matrix;
}

dmat4 MitsubaXml::transform(const pugi::xml_node& node) const {
  dmat4 total(1.0);
  for (const pugi::xml_node& step : node.children()) {
    const std::string kind = step.name();
    dmat4 matrix_of_step(1.0);
    if (step.type() != pugi::node_element) continue;
    if (kind == "translate") {
      matrix_of_step = glm::translate(dmat4(1.0), xyz(step, 0.0));
    } else if (kind == "scale") {
      matrix_of_step = glm::scale(dmat4(1.0), xyz(step, 1.0));
    } else if (kind == "rotate") {
      const dvec3 axis = xyz(step, 0.0);
      if (axis == dvec3(0.0)) fail(step, "<rotate>: expected an axis that is not zero");
      matrix_of_step =
          glm::rotate(dmat4(1.0), number(step, "angle") * std::numbers::pi / 180.0, glm::normalize(axis));
    } else if (kind == "matrix") {
      matrix_of_step = matrix(step);
    } else {
      fail(step, "<transform>: expected translate, rotate, scale or matrix, found '{}'", kind);
    }
    total = matrix_of_step * total;
  }
  const double determinant = glm::determinant(dmat3(total));
  if (!std::isfinite(determinant) || determinant == 0.0) fail(node, "<transform>: it is singular");
  return total;
}

}  // namespace greatx::scene
