// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds what a finished fit says of each position, and writes it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "sim/fit/assess.h"
#include "sim/fit/split.h"

namespace greatx::apps {

/// One position of a set.
struct FitPlace {
  uint32_t set = 0, position = 0, block = 0;
  dvec3 at{0.0};
  bool held_out = false;
  bool usable = false;  ///< paths reach it, and something was measured
  /// Single values in the unit of the set; NaN for cir and cfr.
  double measured = 0.0, modelled_before = 0.0, modelled = 0.0;
  /// modelled - measured; of cir and cfr the rms over the position.
  double error_before = 0.0, error = 0.0;
};

struct FitResult {
  const sim::FitModel* model = nullptr;
  sim::FitState state;
  sim::FitAssessment assessment;
  std::vector<FitPlace> places;  ///< in the order of the model's links
  size_t fitted = 0, held_out = 0;
};

/// Errors of some positions: of single values, or rms values of cir and cfr.
struct FitErrors {
  size_t positions = 0;
  double rms = 0.0, mean = 0.0, median = 0.0;  ///< median: of the magnitudes
};
enum class FitPart { fitted, held_out };
FitErrors errors_of(const FitResult& result, uint32_t set, FitPart part, bool before);

/// Computes the places of a finished fit. `blocks`: of the model's links.
std::vector<FitPlace> places_of(const sim::FitModel& model, const sim::FitState& state,
                                const sim::FitBlocks& blocks);

/// Returns the unit of a set's errors.
const char* error_unit(const sim::FitSet& set);
/// Returns the members of fit.json after `request` (docs/fit.md).
nlohmann::ordered_json fit_json(const FitResult& result);
/// Returns the summary that people read.
std::string fit_words(const FitResult& result);
/// Returns the table of all positions (CSV).
std::string places_csv(const FitResult& result);

}  // namespace greatx::apps
