// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// YAML from files that nobody vouches for, and the rules that every reader of it shares.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>

namespace greatx {

/// The documents of `text`; `name` stands for the file in messages. Throws YAML::Exception if it is not
/// well-formed, and UserError "name:line: ..." if it is not UTF-8, an alias stands inside what it names, or
/// the values are more than budget::yaml_values when every alias is written out: whoever walks over them does
/// that.
std::vector<YAML::Node> load_yaml(const std::string& text, const std::string& name);

/// The line on which a value begins, from 1; `fallback` if the library has no place for it.
int line_of(const YAML::Node& node, int fallback = 0);
/// The line of a fault; 0 if the library has no place for it.
int line_of(const YAML::Exception& error);

/// Plain scalars by YAML 1.2's core schema: a quoted one is a text, never a number or a boolean. Empty for
/// anything else.
std::optional<double> plain_number(const YAML::Node& node);
std::optional<bool> plain_boolean(const YAML::Node& node);

}  // namespace greatx
