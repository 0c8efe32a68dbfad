// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Fits the materials of a scenario to measurements, from the description to the files of the result.
#pragma once

#include <string>

#include "apps/console/session.h"

namespace greatx::apps {

struct FitOptions {
  ScenarioOptions scenario;  ///< SCENARIO is the description of the fit; the others change its scenario
  RunOptions run;
  std::string output;
  bool resume = false, no_pictures = false, json = false, quiet = false;
};

/// Runs the fit. Throws Interrupted if it is stopped before the last iteration; what is done is kept then.
void run_fit(const FitOptions& options);

}  // namespace greatx::apps
