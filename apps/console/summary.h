// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "gpu/device.h"
#include "sim/run/simulator.h"

namespace greatx::apps {

/// Returns the largest resident set size of this process so far, bytes.
uint64_t peak_rss_bytes();

/// Returns one object: counts of ticks, submits and packets, GPU time of each pass, counts of built pipelines
/// and acceleration structures, consistency, and more. `seconds`: the duration of the run.
nlohmann::json summary_of(const sim::RunStatistics& statistics, const gpu::Device& device, double seconds);

/// Returns the summary as text to read.
std::string summary_text(const nlohmann::json& summary);

}  // namespace greatx::apps
