// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs the rows of a benchmark in processes of their own.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace greatx::apps {

/// Runs `row` in a process of its own, so that rows share no memory, caches or threads. Returns the result of
/// `row` with `cpu_s` (user and system time) and `peak_rss_bytes` of that process. Must be called before this
/// process has a device or a thread. Throws UserError if `row` throws one, and runtime_error if the process
/// fails in any other way.
nlohmann::json in_own_process(const std::function<nlohmann::json()>& row);

/// Runs a program with arguments, `command[0]` being the program, and returns what it prints to the standard
/// output. Throws UserError naming the program if it cannot be started or fails.
std::string output_of(const std::vector<std::string>& command);

/// Returns the seconds since this process was started, to 10 ms. They include the loading of libraries and
/// the parsing of the command line.
double process_age_s();

}  // namespace greatx::apps
