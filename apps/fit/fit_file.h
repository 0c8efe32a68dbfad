// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads the description of a fit of materials (docs/fit.md, docs/fit.schema.json) and its measurements.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/fields/field.h"
#include "sim/fit/problem.h"
#include "sim/scenario/scenario.h"

namespace greatx::apps {

/// A fit as written, before its scenario is known.
struct FitFile {
  std::string file, text;
  Field root;
  std::string scenario;  ///< path, or the name of an embedded scenario
  std::string channel;   ///< empty: the first one
};

/// Whether the YAML file describes a fit: its root has `greatx_fit` or `measurements`. False if the file
/// cannot be read or is not YAML; the reader of scenarios says so.
bool is_fit_file(const std::filesystem::path& file);

/// Reads the description. Throws UserError "file:line: field: expected ..., found ..." for a missing or
/// unknown key. A scenario that is a file beside the description is meant before an embedded one.
FitFile read_fit_file(const std::filesystem::path& file);

/// A file of measurements, for the request that decides the bytes of a fit.
struct FitData {
  std::string name, sha256;
};

struct FitInput {
  sim::FitProblem problem;
  std::vector<FitData> data;
};

/// Reads everything that belongs to a channel of the scenario: measurements with their files, unknowns,
/// parameters, loss and split. Throws UserError like read_fit_file().
FitInput read_fit_input(const FitFile& fit, const sim::Scenario& scenario, uint32_t channel);

}  // namespace greatx::apps
