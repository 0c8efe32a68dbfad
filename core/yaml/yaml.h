// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads YAML from files that may be faulty or hostile.
#pragma once

#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>

namespace greatx {

/// Returns the documents of `text`; `name` stands for the file in messages. Throws YAML::Exception if the
/// text is not well-formed. Throws UserError "name:line: ..." if the text is not UTF-8, if an alias stands
/// inside the node that it names, or if the values are more than budget::yaml_values when every alias is
/// written out, as any walk over the documents does.
std::vector<YAML::Node> load_yaml(const std::string& text, const std::string& name);

}  // namespace greatx
