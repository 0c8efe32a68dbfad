// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// YAML from files that nobody vouches for.
#pragma once

#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>

namespace greatx {

/// The documents of `text`; `name` stands for the file in messages. Throws YAML::Exception if it is not well-formed, and
/// UserError "name:line: ..." if it is not UTF-8, an alias stands inside what it names, or the values are more than
/// budget::yaml_values when every alias is written out: whoever walks over them does that.
std::vector<YAML::Node> load_yaml(const std::string& text, const std::string& name);

}  // namespace greatx
