// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Changes one value of a YAML text and leaves the rest as somebody wrote it, with its comments.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/fields/field_value.h"

namespace greatx {

/// A way from the root of a document to a value: keys of maps and indices of lists.
using YamlStep = std::variant<std::string, size_t>;
using YamlPath = std::vector<YamlStep>;

/// Parses "nodes[1].trajectory.position_m", the form that messages of Field have. Throws UserError.
YamlPath parse_yaml_path(std::string_view text);
std::string yaml_path_text(const YamlPath& path);

/// Describes one change.
struct YamlChange {
  enum class Kind : uint8_t {
    set,     ///< gives the place a value; maps and the last key on the way are made if they are missing
    remove,  ///< takes an entry of a map, or an item of a list, away
    insert,  ///< puts an item into a list before the index that ends the path, which may be the list's size
  };
  Kind kind = Kind::set;
  YamlPath path;      ///< not empty
  std::string value;  ///< YAML on one line, e.g. "[1, 2, 3]" or "{type: static}"; not used by `remove`
};

struct EditedYaml {
  std::string text;
  /// False if the place could not be changed alone (an alias, a text over several lines). The whole document
  /// is then written anew, without its comments.
  bool kept_comments = true;
};

/// Returns the text with the change. The result is read again: it holds exactly the changed values. Throws
/// UserError if the text or the value is not well-formed, or if the path leads nowhere.
EditedYaml edit_yaml(const std::string& text, const YamlChange& change);

/// Returns the value at a place; null if there is none.
std::shared_ptr<const FieldValue> value_at(std::shared_ptr<const FieldValue> root, const YamlPath& path);
/// Returns a value as YAML on one line.
std::string yaml_line(const FieldValue& value);
/// Whether two values are the same, wherever they stand.
bool same_values(const FieldValue& a, const FieldValue& b);
/// Returns a text as a YAML scalar that is never a number: it has quotes if it needs them.
std::string yaml_text(const std::string& text);

}  // namespace greatx
