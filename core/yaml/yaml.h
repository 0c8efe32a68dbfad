// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads YAML from files that may be faulty or hostile.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>

namespace greatx {

/// Returns the documents of `text`; `name` stands for the file in messages. Throws YAML::Exception if the
/// text is not well-formed. Throws UserError "name:line: ..." if the text is not UTF-8, if an alias stands
/// inside the node that it names, or if the values are more than budget::yaml_values when every alias is
/// written out, as any walk over the documents does.
std::vector<YAML::Node> load_yaml(const std::string& text, const std::string& name);

/// Returns the line on which a value begins, from 1, or `fallback` if the library has no position for it.
int line_of(const YAML::Node& node, int fallback = 0);
/// Returns the line of a fault, or 0 if the library has no position for it.
int line_of(const YAML::Exception& error);

/// Read a plain scalar by YAML 1.2's core schema. A quoted scalar is a text, never a number or a boolean. The
/// result is empty for anything else.
std::optional<double> plain_number(const YAML::Node& node);
std::optional<bool> plain_boolean(const YAML::Node& node);

}  // namespace greatx
