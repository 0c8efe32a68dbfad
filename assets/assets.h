// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Gives access to the scenarios, to their schema, and to the campaigns that are embedded in the program at
// build time.
#pragma once

#include <span>
#include <string_view>

namespace greatx {

/// Holds the name and the YAML text of assets/scenarios/NAME.yaml.
struct EmbeddedScenario {
  std::string_view name;
  std::string_view text;
};

/// Returns all embedded scenarios.
std::span<const EmbeddedScenario> embedded_scenarios();

/// Returns the files of assets/campaigns: campaigns, and the scenarios that they change.
std::span<const EmbeddedScenario> embedded_campaigns();

/// Returns docs/scenario.schema.json.
std::string_view scenario_schema();
/// Returns docs/radio_materials.schema.json.
std::string_view materials_schema();

}  // namespace greatx
