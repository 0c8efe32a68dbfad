// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// `greatx bench --radio`: what the channels of a scenario cost apart from everything else.
#pragma once

#include <nlohmann/json.hpp>

#include "apps/session.h"

namespace greatx::apps {

struct RadioBenchOptions {
  uint32_t receivers = 1000;  ///< of the row that solves many in one call
  int64_t warm_up = 5;
};

/// Rows, ms: first CIR since the start of the command, search without the cache, a tick in steady state (paths, fields,
/// frequency response, nothing written), many receivers in one call, and the same with diffraction, scattering, and both.
nlohmann::json radio_bench(const ScenarioOptions& scenario, const RunOptions& run,
                           const RadioBenchOptions& options);
std::string radio_bench_text(const nlohmann::json& result);

}  // namespace greatx::apps
