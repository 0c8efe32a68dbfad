// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// `greatx bench --recall --scattering`: holds the scattered paths of several budgets (scattering_budget)
// against those of all patches.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "apps/bench/recall.h"
#include "gpu/device.h"

namespace greatx::apps {

/// Measures the scenarios of `options`: error of the scattered power, of its profile in bins of 10 ns and of
/// its angles, the chains that are traced, and the time. Prints a table for each scene, or appends an object
/// to `results` if the options ask for JSON. Throws UserError if nothing scatters in a scene.
void measure_scattering(gpu::Device& device, const RecallOptions& options,
                        const std::vector<std::string>& scenes, nlohmann::json& results);

}  // namespace greatx::apps
