// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// `greatx bench --recall --scattering=2`: says what paths with a scattering and another bend add, and holds
// the draws of several budgets (scattering_budget) against the mean of many draws with other seeds.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "apps/bench/recall.h"
#include "gpu/device.h"

namespace greatx::apps {

/// Measures the scenarios of `options`. Prints two tables for each scene, or appends an object to `results`
/// if the options ask for JSON. Throws UserError if nothing scatters in a scene.
void measure_two_bends(gpu::Device& device, const RecallOptions& options,
                       const std::vector<std::string>& scenes, nlohmann::json& results);

}  // namespace greatx::apps
