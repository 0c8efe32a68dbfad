// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What a calibration may change, and how its changes fit the whole scenario. Inside of
// sim/tradeoff/calibration.
#pragma once

#include <span>

#include "sim/tradeoff/calibration/calibration.h"

namespace greatx::sim {

/// Returns the scenario of one modality alone, without wishes and without the radar's noise, which would hide
/// differences. Throws UserError if there is no such sensor.
Scenario scenario_to_calibrate(const Experiment& whole, Modality modality,
                               const std::filesystem::path& assets);

/// Returns why a knob takes no part; empty: it does.
std::string why_kept(const Knob& knob, const Experiment& base, const Scenario& whole, Modality modality);

/// Throws UserError if the records lack what a target speaks of.
void check_figures(const SettingResult& reference, std::span<const AccuracyTarget> targets,
                   const Scenario& scenario);

/// Turns changes of a scenario that alone() has made into those of the whole one: sensors have other indices.
std::vector<YamlChange> for_whole(std::vector<YamlChange> changes, const Scenario& alone,
                                  const Scenario& whole);

/// Changes that take `accuracy` and `time_budget_ms_per_tick` away.
std::vector<YamlChange> without_wishes(const Scenario& scenario);

}  // namespace greatx::sim
