// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the targets of a channel, as the user wrote them (docs/targets.md).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/error.h"
#include "core/vec.h"
#include "rf/targets/rcs_table.h"
#include "rf/targets/tr38901_target.h"

namespace greatx::sim {

/// Describes a target that is computed from its surfaces (rf::TubeOptions).
struct TargetTubes {
  double tube_m = 0.03;
  uint32_t budget = 16384, max_bounces = 3;
};

/// Describes an end that a panel is steered to: an antenna, or a direction.
struct SurfaceEnd {
  std::string antenna;             ///< node/sensor; empty: a direction
  dvec3 direction{1.0, 0.0, 0.0};  ///< unit vector in the panel's frame
};

/// Describes a panel of phase-shifting elements (rf::SurfaceTarget). Lengths are in wavelengths at the
/// carrier.
struct TargetSurface {
  uint32_t rows = 16, columns = 16;
  double row_spacing_wl = 0.5, column_spacing_wl = 0.5;
  double amplitude = 1.0;
  double phase = 0.0;          ///< rad, of all elements
  std::vector<double> phases;  ///< rad, [elements], instead of `phase`; empty: none
  std::optional<std::pair<SurfaceEnd, SurfaceEnd>> steer;  ///< from and to, instead of both
  uint32_t bits = 0;                                       ///< 0: phases are not rounded
};

/// Describes one node whose model is a target.
struct TargetConfig {
  uint32_t node = 0;  ///< index into Scenario::nodes; it has a model
  std::variant<rf::Tr38901Kind, std::shared_ptr<const rf::RcsTable>, TargetTubes, TargetSurface> model;
  SourceLocation where;
};

/// Limits the paths between an end and a target, as rf::PathLimits.
struct TargetLegs {
  uint32_t max_depth = 1;
  uint32_t max_transmissions = 1;  ///< walls passed, as a part of max_depth
};

}  // namespace greatx::sim
