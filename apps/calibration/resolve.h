// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Turns a scenario that gives errors or a time budget into one with settings: from the data set that a run
// goes on with, from the cache, or by a calibration on the device.
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "gpu/device.h"
#include "sim/experiment/experiment.h"

namespace greatx::apps {

/// A calibration as it is kept and shown. The fields of `json`:
///
/// - `fingerprint`: version, device, driver, processors, and the SHA-256 of scenario and scene;
/// - `wish`: a map of the allowed errors by name, and `time_budget_ms_per_tick`;
/// - `scenario`: the text with the choice; `minutes`: of the calibration;
/// - `tick_ms`: of the whole scenario, if there is a budget;
/// - `parts`: for each modality `modality`, `reference` (words), `finest` (whether the choice is it),
///   `chosen` (`knob`, `own`, `chosen`), `kept` (`knob`, `why`), `errors` (`name`, `unit`, `asked`,
///   `allowed`, `calibrated`, `checked`, `own`), `figures` (`sensor`, `name`, `unit`, `value`), `tick_ms`
///   of `chosen`, `own` and `reference` (`median`, `low`, `high`), `checked_ticks`, `met_ticks`,
///   `least_share`. An error of null is minus infinity (equal records) or one without anything to compare.
struct Resolved {
  sim::Scenario scenario;
  nlohmann::json json;
  std::string source;  ///< "calibrated", "cache", or the file
};

/// Resolves the wishes of a scenario. `kept` is a file with an earlier calibration, which may be missing; if
/// it is one of this scenario, it decides. `again` calibrates in any case. Progress goes to stderr unless
/// `quiet`. Throws UserError like sim::calibrate(), and Interrupted.
Resolved resolve(const sim::Experiment& experiment, gpu::Device& device, const std::filesystem::path& assets,
                 const std::filesystem::path& kept, bool again, bool quiet);

/// Returns the choice in words, several lines.
std::string calibration_words(const nlohmann::json& calibration);

}  // namespace greatx::apps
