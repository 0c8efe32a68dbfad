// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Replaces a scenario's own values by values given from outside (the command line).
#pragma once

#include <cstdint>
#include <optional>

#include "sim/scenario/scenario.h"

namespace greatx::sim {

struct ScenarioOverrides {
  std::optional<uint64_t> seed;
  std::optional<int64_t> ticks;
  std::optional<uint32_t> sequences;
};

/// Puts the values into the scenario and into its text, which is then complete: parsed again it gives the
/// same run. The text keeps its comments, and stays as it is where the scenario already has the value.
/// Everything that moves keeps its course (override_ticks). The text has been parsed before.
void override_scenario(Scenario& scenario, const ScenarioOverrides& overrides);

/// Changes only the length of the run. Bezier curves and corridors last as long as before, so that ticks that
/// both runs have are the same.
void override_ticks(Scenario& scenario, int64_t ticks);

}  // namespace greatx::sim
