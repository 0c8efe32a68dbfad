// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the targets of a channel, as the user wrote them (docs/targets.md).
#pragma once

#include <cstdint>
#include <memory>
#include <variant>
#include <vector>

#include "core/error.h"
#include "rf/targets/rcs_table.h"
#include "rf/targets/tr38901_target.h"

namespace greatx::sim {

/// Describes a target that is computed from its surfaces (rf::TubeOptions).
struct TargetTubes {
  double tube_m = 0.03;
  uint32_t budget = 16384, max_bounces = 3;
};

/// Describes one node whose model is a target.
struct TargetConfig {
  uint32_t node = 0;  ///< index into Scenario::nodes; it has a model
  std::variant<rf::Tr38901Kind, std::shared_ptr<const rf::RcsTable>, TargetTubes> model;
  SourceLocation where;
};

/// Limits the paths between an end and a target, as rf::PathLimits.
struct TargetLegs {
  uint32_t max_depth = 1;
  uint32_t max_transmissions = 1;  ///< walls passed, as a part of max_depth
};

}  // namespace greatx::sim
