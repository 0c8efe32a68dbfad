// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/parse/scenario_yaml.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/text.h"
#include "core/units.h"
#include "core/yaml/yaml.h"

namespace greatx::sim {
namespace {

std::string quoted(const std::string& text) {
  constexpr size_t longest = 60;
  std::string shown = text.substr(0, longest);
  if (const auto cut = find_bad_utf8(shown)) shown.resize(*cut);  // the cut was in the middle of a character
  return fmt::format("'{}'{}", printable(shown), text.size() > longest ? " ..." : "");
}

/// Returns a node's line. A null value has the place of the text that follows it, and `fallback` is then
/// better.
int line_of_value(const YAML::Node& node, int fallback) {
  return node.IsNull() ? fallback : line_of(node, fallback);
}

size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 0; i < a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i + 1;
    for (size_t j = 0; j < b.size(); ++j) {
      const size_t substituted = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, substituted});
    }
  }
  return row.back();
}

bool is_name(const std::string& text) {
  constexpr std::string_view allowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.";
  return !text.empty() && text.size() <= 100 && text[0] != '.' && text[0] != '-' &&
         text.find_first_not_of(allowed) == std::string::npos;
}

}  // namespace

Field::Field(std::shared_ptr<const Source> source, YAML::Node node, std::string path, int line)
    : source_(std::move(source)), node_(std::move(node)), path_(std::move(path)), line_(line) {}

Field Field::parse(const std::string& text, const std::string& file_name, const std::filesystem::path& folder,
                   const std::filesystem::path& assets) {
  try {
    const std::vector<YAML::Node> documents = load_yaml(text, file_name);
    if (documents.size() > 1)
      throw_user_error_at({file_name, line_of_value(documents[1], 0)}, "expected one YAML document, found {}",
                          documents.size());
    const YAML::Node root = documents.empty() ? YAML::Node() : documents[0];
    return Field(std::make_shared<const Source>(Source{file_name, folder, assets}), root, "",
                 line_of_value(root, 1));
  } catch (const YAML::Exception& error) {
    throw_user_error_at({file_name, line_of(error)}, "expected well-formed YAML, found a fault: {}",
                        error.msg);
  }
}

std::string Field::describe() const {
  if (node_.IsScalar()) return quoted(node_.Scalar());
  if (node_.IsSequence()) return fmt::format("a list of {}", node_.size());
  if (node_.IsMap()) return "a map";
  return "nothing";
}

void Field::fail(const std::string& expected) const { fail(expected, describe()); }

void Field::fail(const std::string& expected, const std::string& found) const {
  throw_user_error_at(where(), "{}expected {}, found {}", path_.empty() ? "" : path_ + ": ", expected, found);
}

bool Field::boolean() const {
  if (const std::optional<bool> value = plain_boolean(node_)) return *value;
  fail("true or false");
}

std::string Field::text() const {
  if (!node_.IsScalar() || node_.Scalar().empty()) fail("a text");
  return node_.Scalar();
}

std::string Field::name() const {
  if (!node_.IsScalar() || !is_name(node_.Scalar()))
    fail("a name of at most 100 letters, digits, '_', '-', '.' that does not begin with '.' or '-'");
  return node_.Scalar();
}

double Field::finite() const {
  const std::optional<double> value = plain_number(node_);
  if (!value) fail("a finite number");
  return *value;
}

double Field::number(double most) const {
  const double value = finite(), size = std::abs(value);
  if (size > most) fail(fmt::format("a number from {:g} to {:g}", -most, most));
  if (size > 0.0 && size < least_number) fail(fmt::format("0, or a number of {:g} or more", least_number));
  return value;
}

double Field::positive(double least, double most) const {
  const double value = finite();
  if (!(value > 0.0)) fail("a number greater than 0");
  if (value < least || value > most) fail(fmt::format("a number from {:g} to {:g}", least, most));
  return value;
}

double Field::non_negative(double most) const {
  const double value = finite();
  if (!(value >= 0.0)) fail("a number of at least 0");
  return number(most);
}

double Field::between(double low, double high) const {
  const double value = finite();
  if (!(value >= low && value <= high)) fail(fmt::format("a number from {} to {}", low, high));
  return number(std::max(std::abs(low), std::abs(high)));
}

uint64_t Field::integer(uint64_t low, uint64_t high) const {
  const std::string expected = fmt::format("an integer from {} to {}", low, high);
  if (!node_.IsScalar() || node_.Tag() == "!") fail(expected);
  const std::string& text = node_.Scalar();
  uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) {
    // "1e6" and "256.0" are integers as well, as in JSON Schema.
    const auto real = parse_number(text);
    if (!real || *real < 0.0 || *real > 0x1p53 || *real != std::floor(*real)) fail(expected);
    value = static_cast<uint64_t>(*real);
  }
  if (value < low || value > high) fail(expected);
  return value;
}

Rational Field::rational(const std::string& expected) const {
  const auto value = node_.IsScalar() ? Rational::parse(node_.Scalar()) : std::nullopt;
  if (!value) fail(expected);
  return *value;
}

TurnRate Field::turn_rate(const std::string& expected) const {
  std::string_view text = node_.IsScalar() ? std::string_view(node_.Scalar()) : std::string_view();
  const bool negative = text.starts_with('-');
  if (negative) text.remove_prefix(1);
  const auto size = Rational::parse(text);
  if (!size) fail(expected);
  return {*size, negative};
}

dvec3 Field::position() const { return vector3(most_position_m); }

dvec3 Field::vector3(double most) const {
  if (!node_.IsSequence() || node_.size() != 3) fail("a list of 3 numbers");
  const std::vector<Field> items = list("numbers");
  return {items[0].number(most), items[1].number(most), items[2].number(most)};
}

dvec3 Field::angles_deg() const {
  if (!node_.IsSequence() || node_.size() != 3) fail("a list of 3 numbers: yaw, pitch, roll in degrees");
  const dvec3 angles = vector3(most_angle_deg);
  return {radians(angles.x), radians(angles.y), radians(angles.z)};
}

size_t Field::choice(std::span<const std::string_view> choices) const {
  if (node_.IsScalar()) {
    const auto found = std::find(choices.begin(), choices.end(), node_.Scalar());
    if (found != choices.end()) return static_cast<size_t>(found - choices.begin());
  }
  fail(fmt::format("{}{}", choices.size() > 1 ? "one of " : "", fmt::join(choices, ", ")));
}

std::vector<Field> Field::list(const std::string& of_what, size_t least) const {
  if (!node_.IsSequence() || node_.size() < least)
    fail(fmt::format("a list of {}{}", least == 0 ? "" : fmt::format("{} or more ", least), of_what));
  std::vector<Field> items;
  for (const YAML::Node& item : node_)
    items.push_back(
        Field(source_, item, fmt::format("{}[{}]", path_, items.size()), line_of_value(item, line_)));
  return items;
}

std::filesystem::path Field::file() const {
  if (!node_.IsScalar() || node_.Scalar().empty()) fail("a file's path");
  std::error_code error;
  auto path = std::filesystem::absolute(source_->folder / node_.Scalar()).lexically_normal();
  if (!source_->assets.empty() && !std::filesystem::exists(path, error))
    path = std::filesystem::absolute(source_->assets / node_.Scalar()).lexically_normal();
  if (!std::filesystem::exists(path, error)) fail("an existing file", fmt::format("no '{}'", path.string()));
  if (!std::filesystem::is_regular_file(path, error))
    fail("a regular file", fmt::format("'{}', which is none", path.string()));
  return path;
}

std::vector<std::pair<std::string, Field>> entries_of(const Field& field) {
  if (!field.node_.IsMap()) field.fail("a map");
  std::vector<std::pair<std::string, Field>> entries;
  std::set<std::string> seen;
  for (const auto& entry : field.node_) {
    const int line = line_of_value(entry.first, field.line_);
    const Field key(field.source_, entry.first, field.path_, line);
    if (!entry.first.IsScalar()) key.fail("a text as key");
    const std::string& text = entry.first.Scalar();
    // yaml-cpp keeps every pair and would answer with the first.
    if (!seen.insert(text).second) key.fail("every key once", fmt::format("a second {}", quoted(text)));
    const std::string path = field.path_.empty() ? text : field.path_ + "." + text;
    // The line is the key's: a value's own may be the next line, or an anchor's.
    entries.emplace_back(text, Field(field.source_, entry.second, path, line));
  }
  return entries;
}

FieldMap::FieldMap(const Field& field, const Keys& keys) : field_(field), entries_(entries_of(field)) {
  for (const auto& [key, value] : entries_) {
    if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
    const std::string hint = suggestion(key, {keys.begin(), keys.end()});
    value.fail(hint.empty() ? fmt::format("one of the keys {}", fmt::join(keys, ", ")) : "a known key",
               fmt::format("unknown key {}{}", quoted(key), hint));
  }
}

std::optional<Field> FieldMap::find(std::string_view key) const {
  for (const auto& [name, value] : entries_)
    if (name == key) return value;
  return std::nullopt;
}

Field FieldMap::require(std::string_view key, const std::string& expected) const {
  if (const auto field = find(key)) return *field;
  const std::string path =
      field_.path().empty() ? std::string(key) : fmt::format("{}.{}", field_.path(), key);
  throw_user_error_at(field_.where(), "{}: expected {}, found nothing", path, expected);
}

void FieldMap::exclude(std::string_view key, std::string_view other) const {
  if (has(key) && has(other)) find(other)->fail(fmt::format("one of '{}' and '{}'", key, other), "both");
}

std::string suggestion(std::string_view word, const std::vector<std::string>& candidates) {
  const std::string* best = nullptr;
  size_t best_distance = std::max<size_t>(2, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    // A key without its unit ("rate" for "rate_hz") is a closer match than its edit distance says.
    const bool prefix = candidate.starts_with(std::string(word) + "_");
    const size_t distance = prefix ? 1 : edit_distance(word, candidate);
    if (distance >= best_distance || distance >= candidate.size()) continue;
    best = &candidate;
    best_distance = distance;
  }
  return best ? fmt::format(" (did you mean '{}'?)", *best) : "";
}

}  // namespace greatx::sim
