// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace greatx::apps {

/// Returns the text of the job script with the value of each place, which is a word of capitals between two
/// @: HEADER, NAME, GREATX, CAMPAIGN, LOGS, TASKS, RESTARTS, COMMON, RUN, MERGE, THREADS, SETUP. Values go in
/// as they are. Each place has a value.
std::string filled_slurm_script(const std::map<std::string_view, std::string>& values);

}  // namespace greatx::apps
