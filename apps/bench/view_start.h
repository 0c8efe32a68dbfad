// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "apps/bench/measure.h"

namespace greatx::apps {

/// Starts this program anew with `arguments`. Returns for each line that it prints the time from its start
/// until the line was there, s. Throws runtime_error if it cannot be started or fails.
std::vector<double> times_of_lines(const std::vector<std::string>& arguments);

}  // namespace greatx::apps
