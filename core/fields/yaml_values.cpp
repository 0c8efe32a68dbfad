// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "core/fields/yaml_values.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/fields/yaml.h"
#include "core/text.h"

namespace greatx {
namespace {

using Value = std::shared_ptr<const FieldValue>;
/// The lists and maps of a rewritten document that are this deep, or deeper, stand on one line.
constexpr int deepest_block = 3;

[[noreturn]] void leads_nowhere(const YamlPath& path, const std::string& why) {
  throw_user_error("{}: {}", yaml_path_text(path), why);
}

Value from_text(const YamlChange& change) {
  const Value value = read_yaml(change.value, yaml_path_text(change.path));
  if (change.value.find('\n') != std::string::npos)
    throw_user_error("{}: expected a value on one line", yaml_path_text(change.path));
  return value;
}

/// Returns `value` with the change made at `path[depth..]`.
Value changed(const Value& value, const YamlChange& change, size_t depth, const Value& made) {
  if (depth == change.path.size()) return made;
  const bool ends = depth + 1 == change.path.size();
  FieldValue copy = value != nullptr ? *value : FieldValue{};
  if (const auto* const index = std::get_if<size_t>(&change.path[depth])) {
    if (copy.kind != FieldValue::Kind::list) leads_nowhere(change.path, "expected a list on the way");
    const bool inserts = ends && change.kind == YamlChange::Kind::insert;
    if (*index >= copy.items.size() + (inserts ? 1 : 0))
      leads_nowhere(change.path, fmt::format("expected an index below {}, found {}",
                                             copy.items.size() + (inserts ? 1 : 0), *index));
    const auto at = copy.items.begin() + static_cast<std::ptrdiff_t>(*index);
    if (inserts)
      copy.items.insert(at, made);
    else if (ends && change.kind == YamlChange::Kind::remove)
      copy.items.erase(at);
    else
      *at = changed(*at, change, depth + 1, made);
    return std::make_shared<const FieldValue>(std::move(copy));
  }
  const std::string& key = std::get<std::string>(change.path[depth]);
  if (copy.kind == FieldValue::Kind::nothing) copy.kind = FieldValue::Kind::map;
  if (copy.kind != FieldValue::Kind::map) leads_nowhere(change.path, "expected a map on the way");
  const auto member = std::ranges::find(copy.members, key, &FieldValue::Member::key);
  const bool found = member != copy.members.end();
  if (ends && change.kind == YamlChange::Kind::remove) {
    if (!found) leads_nowhere(change.path, "expected a value to remove, found none");
    copy.members.erase(member);
  } else if (found) {
    member->value = changed(member->value, change, depth + 1, made);
  } else if (change.kind == YamlChange::Kind::set) {
    copy.members.push_back({key, 0, changed(nullptr, change, depth + 1, made)});
  } else {
    leads_nowhere(change.path, "expected a list, found nothing");
  }
  return std::make_shared<const FieldValue>(std::move(copy));
}

/// Whether a text means the same with quotes and without them.
bool is_word(const std::string& text) {
  static constexpr std::string_view others[] = {"",     "~",    "null",  "Null",  "NULL", "true",
                                                "True", "TRUE", "false", "False", "FALSE"};
  return !parse_number(text) && std::ranges::find(others, text) == std::end(others);
}

/// Whether a plain scalar stays one between brackets.
bool fits_brackets(const std::string& text) {
  return text.find_first_of(",[]{}#&*!|>'\"%@`\\\n") == std::string::npos &&
         text.find(": ") == std::string::npos && !text.ends_with(':') && !text.starts_with("- ") &&
         !text.starts_with("? ");
}

void write_block(const FieldValue& value, int depth, const std::string& indent, std::string& out) {
  for (const FieldValue::Member& member : value.members) {
    const bool block = depth < deepest_block &&
                       ((member.value->kind == FieldValue::Kind::map && !member.value->members.empty()) ||
                        (member.value->kind == FieldValue::Kind::list &&
                         std::ranges::any_of(member.value->items, [](const Value& v) {
                           return v->kind == FieldValue::Kind::map;
                         })));
    if (&member != &value.members.front() || !indent.empty()) out += indent;
    out += yaml_text(member.key) + ":";
    if (!block) {
      out += member.value->kind == FieldValue::Kind::nothing ? "\n" : " " + yaml_line(*member.value) + "\n";
      continue;
    }
    out += "\n";
    if (member.value->kind == FieldValue::Kind::map)
      write_block(*member.value, depth + 1, indent + "  ", out);
    else
      for (const Value& item : member.value->items) out += indent + "  - " + yaml_line(*item) + "\n";
  }
}

}  // namespace

YamlPath parse_yaml_path(std::string_view text) {
  YamlPath path;
  const auto fail = [&] {
    throw_user_error("expected a path such as nodes[1].trajectory.position_m, found '{}'",
                     printable(std::string(text)));
  };
  for (size_t at = 0; at < text.size();) {
    if (text[at] == '[') {
      const size_t end = text.find(']', at);
      size_t index = 0;
      if (end == std::string_view::npos) fail();
      const auto [stop, error] = std::from_chars(text.data() + at + 1, text.data() + end, index);
      if (error != std::errc() || stop != text.data() + end) fail();
      path.emplace_back(index);
      at = end + 1;
    } else {
      if (!path.empty()) {
        if (text[at] != '.') fail();
        ++at;
      }
      const size_t end = std::min(text.find_first_of(".[", at), text.size());
      if (end == at) fail();
      path.emplace_back(std::string(text.substr(at, end - at)));
      at = end;
    }
  }
  if (path.empty()) fail();
  return path;
}

std::string yaml_path_text(const YamlPath& path) {
  std::string text;
  for (const YamlStep& step : path) {
    if (const auto* const index = std::get_if<size_t>(&step))
      text += fmt::format("[{}]", *index);
    else
      text += (text.empty() ? "" : ".") + std::get<std::string>(step);
  }
  return text;
}

Value value_at(Value root, const YamlPath& path) {
  for (const YamlStep& step : path) {
    if (root == nullptr) return nullptr;
    if (const auto* const index = std::get_if<size_t>(&step)) {
      if (root->kind != FieldValue::Kind::list || *index >= root->items.size()) return nullptr;
      root = Value(root->items[*index]);
    } else {
      const auto member =
          std::ranges::find(root->members, std::get<std::string>(step), &FieldValue::Member::key);
      if (member == root->members.end()) return nullptr;
      root = Value(member->value);
    }
  }
  return root;
}

bool same_values(const FieldValue& a, const FieldValue& b) {
  if (a.quoted != b.quoted && !is_word(a.text)) return false;
  if (a.kind != b.kind || a.text != b.text || a.items.size() != b.items.size() ||
      a.members.size() != b.members.size())
    return false;
  for (size_t i = 0; i < a.items.size(); ++i)
    if (!same_values(*a.items[i], *b.items[i])) return false;
  for (size_t i = 0; i < a.members.size(); ++i)
    if (a.members[i].key != b.members[i].key || !same_values(*a.members[i].value, *b.members[i].value))
      return false;
  return true;
}

std::string yaml_text(const std::string& text) {
  const bool plain = !text.empty() && std::ranges::all_of(text, [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '/' || c == '.' || c == '-';
  });
  if (plain && std::isalpha(static_cast<unsigned char>(text[0])) != 0 && is_word(text)) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    if (c == '\n')
      quoted += "\\n";
    else if (static_cast<unsigned char>(c) < 0x20)
      quoted += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    else
      quoted += c;
  }
  return quoted + "\"";
}

std::string yaml_line(const FieldValue& value) {
  std::string out;
  switch (value.kind) {
    case FieldValue::Kind::nothing:
      return "null";
    case FieldValue::Kind::scalar: {
      if (!value.quoted && fits_brackets(value.text)) return value.text;
      const std::string text = yaml_text(value.text);
      return text.starts_with('"') ? text : '"' + text + '"';
    }
    case FieldValue::Kind::list:
      for (const Value& item : value.items) out += (out.empty() ? "" : ", ") + yaml_line(*item);
      return "[" + out + "]";
    case FieldValue::Kind::map:
      for (const FieldValue::Member& member : value.members)
        out += (out.empty() ? "" : ", ") + yaml_text(member.key) + ": " + yaml_line(*member.value);
      return "{" + out + "}";
  }
  return out;
}

std::string yaml_block(const FieldValue& root) {
  std::string out;
  if (root.kind == FieldValue::Kind::map && !root.members.empty())
    write_block(root, 0, "", out);
  else
    out = yaml_line(root) + "\n";
  return out;
}

Value changed_value(const Value& root, const YamlChange& change) {
  GREATX_CHECK(!change.path.empty(), "a change of nothing");
  const Value made = change.kind == YamlChange::Kind::remove ? nullptr : from_text(change);
  return changed(root, change, 0, made);
}

}  // namespace greatx
