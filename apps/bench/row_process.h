// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <nlohmann/json.hpp>

namespace greatx::apps {

/// Runs `row` in a process of its own, so that its memory, its caches and its threads are no other row's, and
/// returns what it returned, with `cpu_s` (user and system time) and `peak_rss_bytes` of that process. To be
/// called before this process has a device or a thread. A UserError thrown by `row` is thrown again here;
/// whatever else ends it is a runtime_error.
nlohmann::json in_own_process(const std::function<nlohmann::json()>& row);

/// Seconds since this process was started, to 10 ms: loading of libraries and parsing included.
double process_age_s();

}  // namespace greatx::apps
