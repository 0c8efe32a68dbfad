// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "sim/scenario/scenario.h"

namespace greatx::sim {

/// Reads a scenario. Throws UserError "file:line: field: expected ..., found ..." at the first fault; unknown
/// keys are faults. It checks every rule that needs no scene (rates, names, ranges, references between nodes
/// and sensors). A relative path that does not exist beside the scenario is looked for in `assets`, if that
/// is not empty.
Scenario load_scenario(const std::filesystem::path& file, const std::filesystem::path& assets = {});
/// Does the same from text. Relative paths are taken from `folder`. `name` stands for the file in messages.
Scenario parse_scenario(const std::string& text, const std::string& name, const std::filesystem::path& folder,
                        const std::filesystem::path& assets = {});

}  // namespace greatx::sim
