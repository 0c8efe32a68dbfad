// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "core/fields/named_path.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "core/fields/yaml.h"
#include "core/text.h"

namespace greatx {
namespace {

/// Returns the `name` of an item; empty if it has none.
std::string name_of_item(const FieldValue& item) {
  for (const FieldValue::Member& member : item.members)
    if (member.key == "name" && member.value) return member.value->text;
  return {};
}

size_t item_named(const FieldValue& list, std::string_view name, std::string_view path) {
  std::vector<std::string> names;
  for (size_t i = 0; i < list.items.size(); ++i) {
    names.push_back(name_of_item(*list.items[i]));
    if (names.back() == name) return i;
  }
  throw_user_error(
      "{}: expected a number or one of the names {}, found '{}'{}", path,
      names.empty() ? std::string("(the list is empty)") : fmt::format("{}", fmt::join(names, ", ")), name,
      suggestion(name, names));
}

}  // namespace

YamlPath named_yaml_path(std::string_view text, const std::shared_ptr<const FieldValue>& root) {
  std::string numbered;
  for (size_t at = 0; at < text.size();) {
    const size_t open = text.find('[', at), close = text.find(']', open);
    if (open == std::string_view::npos || close == std::string_view::npos) {
      numbered += text.substr(at);
      break;
    }
    numbered += text.substr(at, open - at);
    const std::string_view inside = text.substr(open + 1, close - open - 1);
    const bool number =
        !inside.empty() && std::ranges::all_of(inside, [](char c) { return c >= '0' && c <= '9'; });
    if (number) {
      numbered += fmt::format("[{}]", inside);
    } else {
      const auto list = value_at(root, parse_yaml_path(numbered));
      if (!list || list->kind != FieldValue::Kind::list)
        throw_user_error("{}: expected a list at '{}', found none", text, numbered);
      numbered += fmt::format("[{}]", item_named(*list, inside, text));
    }
    at = close + 1;
  }
  return parse_yaml_path(numbered);
}

std::string set_yaml_value(const std::string& text, const std::string& path, const std::string& value,
                           const std::string& where) {
  try {
    const YamlPath place = named_yaml_path(path, read_yaml(text, where));
    return edit_yaml(text, {value.empty() ? YamlChange::Kind::remove : YamlChange::Kind::set, place, value})
        .text;
  } catch (const UserError& error) {
    // A fault of the path names it already.
    const std::string message = error.what();
    throw_user_error("{}: {}{}", where, message.starts_with(path + ":") ? "" : path + ": ", message);
  }
}

}  // namespace greatx
