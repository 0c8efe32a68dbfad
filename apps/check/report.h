// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Puts into words and JSON what a check has found.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "sim/check/course_check.h"
#include "sim/check/finding.h"
#include "sim/check/look.h"

namespace greatx::apps {

/// All that was found in one scenario.
struct CheckedScenario {
  std::string name;
  std::vector<sim::Finding> findings;
  sim::CourseFigures courses;
  sim::LookFigures looks;
};

nlohmann::json json_of(const CheckedScenario& checked);
/// Returns a line for each finding and, if `figures` is set, for each figure.
std::string text_of(const CheckedScenario& checked, bool figures);
/// Counts the findings that are faults.
size_t faults_of(const CheckedScenario& checked);

}  // namespace greatx::apps
