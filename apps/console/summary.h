// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "gpu/device.h"
#include "sim/run/simulator.h"

namespace greatx::apps {

/// Highest resident set size of this process so far, bytes.
uint64_t peak_rss_bytes();

/// One object: ticks, submits, packets, passes with their GPU time, what was built, consistency.
nlohmann::json summary_of(const sim::RunStatistics& statistics, const gpu::Device& device, double seconds);

/// The same for people.
std::string summary_text(const nlohmann::json& summary);

}  // namespace greatx::apps
