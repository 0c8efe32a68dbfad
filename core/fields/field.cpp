// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "core/fields/field.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/expected.h"
#include "core/fields/yaml.h"
#include "core/text.h"

namespace greatx {
namespace {

std::string quoted(const std::string& text) {
  constexpr size_t longest = 60;
  std::string shown = text.substr(0, longest);
  if (const auto cut = find_bad_utf8(shown)) shown.resize(*cut);  // the cut was in the middle of a character
  return fmt::format("'{}'{}", printable(shown), text.size() > longest ? " ..." : "");
}

bool is_name(const std::string& text) {
  constexpr std::string_view allowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.";
  return !text.empty() && text.size() <= 100 && text[0] != '.' && text[0] != '-' &&
         text.find_first_not_of(allowed) == std::string::npos;
}

}  // namespace

Field::Field(std::shared_ptr<const FieldValue> root, FieldSource source, std::string path)
    : source_(std::make_shared<const FieldSource>(std::move(source))),
      value_(std::move(root)),
      path_(std::move(path)),
      line_(value_->line) {}

Field::Field(const Field& parent, std::shared_ptr<const FieldValue> value, std::string path, int line)
    : source_(parent.source_),
      value_(std::move(value)),
      path_(std::move(path)),
      line_(line > 0 ? line : parent.line_) {}

Field Field::parse_yaml(const std::string& text, FieldSource source) {
  std::shared_ptr<const FieldValue> value = read_yaml(text, source.name);
  Field root(std::move(value), std::move(source));
  if (root.line_ == 0) root.line_ = 1;
  return root;
}

std::string Field::describe() const {
  switch (value_->kind) {
    case FieldValue::Kind::scalar:
      return quoted(value_->text);
    case FieldValue::Kind::list:
      return fmt::format("a list of {}", value_->items.size());
    case FieldValue::Kind::map:
      return "a map";
    case FieldValue::Kind::nothing:
      break;
  }
  return "nothing";
}

void Field::fail(const std::string& expected) const { fail(expected, describe()); }

void Field::fail(const std::string& expected, const std::string& found) const {
  refuse(fmt::format("expected {}, found {}", expected, found));
}

void Field::refuse(const std::string& message) const {
  throw_user_error_at(where(), "{}{}", path_.empty() ? "" : path_ + ": ", message);
}

bool Field::boolean() const {
  if (is_scalar() && !value_->quoted) {
    const std::string& text = value_->text;
    if (text == "true" || text == "True" || text == "TRUE") return true;
    if (text == "false" || text == "False" || text == "FALSE") return false;
  }
  fail("true or false");
}

std::string Field::text() const {
  if (!is_scalar() || value_->text.empty()) fail("a text");
  return value_->text;
}

std::string Field::name() const {
  if (!is_scalar() || !is_name(value_->text))
    fail("a name of at most 100 letters, digits, '_', '-', '.' that does not begin with '.' or '-'");
  return value_->text;
}

double Field::finite(const std::string& expected) const {
  const auto value = is_scalar() && !value_->quoted ? parse_number(value_->text) : std::nullopt;
  if (!value) fail(expected);
  return *value;
}

double Field::number(double most) const {
  const double value = finite(), size = std::abs(value);
  if (size > most) fail(number_range(-most, most));
  if (size > 0.0 && size < least_number)
    fail(fmt::format("0, or a number of {} or more", number_words(least_number)));
  return value;
}

double Field::positive(double least, double most) const {
  const double value = finite();
  if (!(value > 0.0)) fail("a number greater than 0");
  if (value < least || value > most) fail(number_range(least, most));
  return value;
}

double Field::non_negative(double most) const {
  const double value = finite();
  if (!(value >= 0.0)) fail("a number of at least 0");
  return number(most);
}

double Field::between(double low, double high) const {
  const double value = finite();
  if (!(value >= low && value <= high)) fail(number_range(low, high));
  return number(std::max(std::abs(low), std::abs(high)));
}

uint64_t Field::integer(uint64_t low, uint64_t high) const {
  const std::string expected = integer_range(low, high);
  if (!is_scalar() || value_->quoted) fail(expected);
  const std::string& text = value_->text;
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

dvec3 Field::vector3(double most) const {
  if (!is_list() || value_->items.size() != 3) fail("a list of 3 numbers");
  const std::vector<Field> items = list("numbers");
  return {items[0].number(most), items[1].number(most), items[2].number(most)};
}

size_t Field::choice(std::span<const std::string_view> choices) const {
  if (is_scalar()) {
    const auto found = std::find(choices.begin(), choices.end(), value_->text);
    if (found != choices.end()) return static_cast<size_t>(found - choices.begin());
  }
  const std::string expected =
      fmt::format("{}{}", choices.size() > 1 ? "one of " : "", fmt::join(choices, ", "));
  fail(expected,
       describe() + (is_scalar() ? suggestion(value_->text, {choices.begin(), choices.end()}) : ""));
}

std::vector<Field> Field::list(const std::string& of_what, size_t least) const {
  if (!is_list() || value_->items.size() < least)
    fail(fmt::format("a list of {}{}", least == 0 ? "" : fmt::format("{} or more ", least), of_what));
  std::vector<Field> items;
  for (const std::shared_ptr<const FieldValue>& item : value_->items)
    items.push_back(Field(*this, item, fmt::format("{}[{}]", path_, items.size()), item->line));
  return items;
}

std::filesystem::path Field::file() const {
  if (!is_scalar() || value_->text.empty()) fail("a file's path");
  std::error_code error;
  auto path = std::filesystem::absolute(source_->folder / value_->text).lexically_normal();
  if (!source_->assets.empty() && !std::filesystem::exists(path, error))
    path = std::filesystem::absolute(source_->assets / value_->text).lexically_normal();
  if (!std::filesystem::exists(path, error)) fail("an existing file", fmt::format("no '{}'", path.string()));
  if (!std::filesystem::is_regular_file(path, error))
    fail("a regular file", fmt::format("'{}', which is none", path.string()));
  return path;
}

std::vector<std::pair<std::string, Field>> Field::entries() const {
  if (!is_map()) fail("a map");
  std::vector<std::pair<std::string, Field>> entries;
  std::set<std::string_view> seen;
  for (const FieldValue::Member& member : value_->members) {
    if (!seen.insert(member.key).second)
      Field(*this, member.value, path_, member.line)
          .fail("every key once", fmt::format("a second {}", quoted(member.key)));
    // The line is the key's: a value's own may be the next line, or an anchor's.
    entries.emplace_back(
        member.key,
        Field(*this, member.value, path_.empty() ? member.key : path_ + "." + member.key, member.line));
  }
  return entries;
}

FieldMap::FieldMap(const Field& field, const Keys& keys) : field_(field), entries_(field.entries()) {
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

}  // namespace greatx
