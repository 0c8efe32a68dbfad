// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/files/untrusted_json.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "core/expected.h"
#include "core/text.h"

namespace greatx::io {

using Json = nlohmann::ordered_json;

namespace {

constexpr size_t longest_excerpt = 60;

/// Calls visit(line, depth) at the beginning of each value in the order of the text, until `visit` returns
/// false. Keys are not values. The text need not be valid JSON.
template <typename Visit>
void scan(std::string_view text, Visit visit) {
  int line = 0, depth = 0;
  for (size_t at = 0; at < text.size();) {
    const char c = text[at];
    if (c == '\n') ++line;
    if (c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ',' || c == ':') {
      ++at;
    } else if (c == '}' || c == ']') {
      --depth;
      ++at;
    } else if (c == '{' || c == '[') {
      if (!visit(line, ++depth)) return;
      ++at;
    } else if (c == '"') {
      for (++at; at < text.size() && text[at] != '"' && text[at] != '\n'; ++at)
        if (text[at] == '\\') ++at;
      at = std::min(at + 1, text.size());
      const size_t next = std::min(text.find_first_not_of(" \t\r\n", at), text.size());
      const bool key = next < text.size() && text[next] == ':';
      if (!key && !visit(line, depth)) return;
    } else {
      if (!visit(line, depth)) return;
      at = std::min(text.find_first_of(" \t\r\n,:{}[]\"", at), text.size());
    }
  }
}

/// Searches `wanted` below `value` and returns whether it was found. `number` then counts the values before
/// it in the order of the text, and `name` is its path, e.g. "sensors[0].name".
bool locate(const Json& value, const Json* wanted, uint64_t& number, std::string& name) {
  if (&value == wanted) return true;
  if (!value.is_structured()) return false;
  const size_t length = name.size();
  size_t index = 0;
  for (auto member = value.begin(); member != value.end(); ++member, ++index) {
    ++number;
    if (value.is_object())
      name += (length > 0 ? "." : "") + member.key();
    else
      name += fmt::format("[{}]", index);
    if (locate(*member, wanted, number, name)) return true;
    name.resize(length);
  }
  return false;
}

std::string excerpt(const Json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array()) return fmt::format("a list of {}", value.size());
  if (value.is_string()) {
    const auto& text = value.get_ref<const std::string&>();
    const size_t length = std::min(text.size(), longest_excerpt);
    std::string shown = Json(text.substr(0, length)).dump(-1, ' ', false, Json::error_handler_t::replace);
    return length < text.size() ? shown + "..." : shown;
  }
  return value.dump();
}

}  // namespace

JsonDocument::JsonDocument(std::string text, const SourceLocation& where, const JsonLimits& limits)
    : text_(std::move(text)), where_(where) {
  const auto line = [&](int below) { return where_.line > 0 ? where_.line + below : 0; };
  if (text_.size() > limits.bytes)
    throw_user_error_at(where_, "expected at most {} bytes of JSON, found {}", limits.bytes, text_.size());
  uint64_t values = 0;
  scan(text_, [&](int below, int depth) {
    if (depth > limits.depth)
      throw_user_error_at({where_.file, line(below)}, "expected JSON nested at most {} deep, found more",
                          limits.depth);
    if (++values > limits.values)
      throw_user_error_at({where_.file, line(below)}, "expected at most {} values of JSON, found more",
                          limits.values);
    return true;
  });
  try {
    root_ = std::make_unique<Json>(Json::parse(text_));
  } catch (const Json::exception& error) {
    const auto* const parse_error = dynamic_cast<const Json::parse_error*>(&error);
    const size_t byte = parse_error ? std::min(parse_error->byte, text_.size()) : 0;
    const auto below = std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(byte), '\n');
    // The message has the form "[json.exception...] parse error at line 1, column 2: REASON".
    std::string reason = error.what();
    if (const size_t colon = reason.find(": "); colon != reason.npos) reason = reason.substr(colon + 2);
    throw_user_error_at({where_.file, line(static_cast<int>(below))}, "is no JSON: {}",
                        printable(std::string_view(reason).substr(0, 200)));
  }
}
JsonDocument::~JsonDocument() = default;

int JsonDocument::line_of_value(uint64_t number) const {
  uint64_t count = 0;
  int found = 0;
  scan(text_, [&](int line, int) {
    found = line;
    return count++ < number;
  });
  return found;
}

void JsonDocument::fail(const Json* value, std::string_view member, std::string_view expected,
                        const std::string& found) const {
  uint64_t number = 0;
  std::string name;
  locate(*root_, value, number, name);
  if (!member.empty()) {
    if (!name.empty()) name += '.';
    name += member;
  }
  const SourceLocation place{where_.file, where_.line > 0 ? where_.line + line_of_value(number) : 0};
  throw_user_error_at(place, "{}{}expected {}, found {}", printable(name), name.empty() ? "" : ": ", expected,
                      found);
}

void JsonValue::fail(std::string_view expected) const {
  document_->fail(json_, "", expected, excerpt(*json_));
}

bool JsonValue::is_object() const { return json_->is_object(); }
bool JsonValue::has(std::string_view key) const {
  return json_->is_object() && json_->find(std::string(key)) != json_->end();
}

JsonValue JsonValue::at(std::string_view key) const {
  if (!json_->is_object()) fail("an object");
  const auto found = json_->find(std::string(key));
  if (found == json_->end()) document_->fail(json_, key, "a value", "none");
  return {*document_, *found};
}

std::vector<JsonValue> JsonValue::list(size_t most) const {
  if (!json_->is_array() || json_->size() > most) fail(fmt::format("a list of at most {}", most));
  std::vector<JsonValue> values;
  values.reserve(json_->size());
  for (const Json& value : *json_) values.push_back({*document_, value});
  return values;
}

std::vector<JsonValue> JsonValue::tuple(size_t count) const {
  if (!json_->is_array() || json_->size() != count) fail(fmt::format("a list of {}", count));
  return list(count);
}

std::string JsonValue::text() const {
  if (!json_->is_string()) fail("a string");
  return json_->get<std::string>();
}

bool JsonValue::boolean() const {
  if (!json_->is_boolean()) fail("true or false");
  return json_->get<bool>();
}

int64_t JsonValue::integer(int64_t least, int64_t most) const {
  // The library stores a number beyond int64 as an unsigned or a floating-point number.
  const bool fits = json_->is_number_integer() &&
                    (!json_->is_number_unsigned() || json_->get<uint64_t>() <= uint64_t{INT64_MAX});
  if (!fits || json_->get<int64_t>() < least || json_->get<int64_t>() > most)
    fail(least < 0 ? fmt::format("an integer from {} to {}", least, most)
                   : integer_range(static_cast<uint64_t>(least), static_cast<uint64_t>(most)));
  return json_->get<int64_t>();
}

double JsonValue::number(double least, double most) const {
  const double value = json_->is_number() ? json_->get<double>() : std::nan("");
  if (!(value >= least && value <= most)) fail(number_range(least, most));
  return value;
}

std::string JsonValue::dump() const { return json_->dump(); }

}  // namespace greatx::io
