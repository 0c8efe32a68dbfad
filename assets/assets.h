// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

namespace greatx {

/// A scenario that is part of the program: assets/scenarios/NAME.yaml, embedded at build time.
struct EmbeddedScenario {
  std::string_view name;
  std::string_view text;
};

std::span<const EmbeddedScenario> embedded_scenarios();

}  // namespace greatx
