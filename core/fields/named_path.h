// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds places of a document by the names of its items: "nodes[uav].sensors[front].rate_hz".
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "core/fields/edit_yaml.h"

namespace greatx {

/// Parses a path whose steps in brackets are numbers of items, or names: the item is the one whose `name` is
/// this. Throws UserError if the text is no path, or if a list has no such item; the message lists the names.
YamlPath named_yaml_path(std::string_view text, const std::shared_ptr<const FieldValue>& root);

/// Returns the text with the value at such a path; an empty value removes it. `where` begins messages. Throws
/// UserError as edit_yaml() does.
std::string set_yaml_value(const std::string& text, const std::string& path, const std::string& value,
                           const std::string& where);

}  // namespace greatx
