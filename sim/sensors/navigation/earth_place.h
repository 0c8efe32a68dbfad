// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/geodesy.h"
#include "sim/experiment/experiment.h"

namespace greatx::sim {

/// Says where the scene is on the Earth, and when.
struct EarthPlace {
  LocalFrame frame;
  std::optional<double> unix_s;  ///< of tick 0; none: the scenario does not say it
};

/// Returns the place of the scene's georeference or else that of the environment, whose height above the sea
/// counts as that above the ellipsoid. The time is that of the environment. Nothing, if neither says a place.
std::optional<EarthPlace> earth_place(const Experiment& experiment);

/// Returns the same; throws UserError that says what `who` needs it for.
EarthPlace require_earth_place(const Experiment& experiment, const char* who);

}  // namespace greatx::sim
