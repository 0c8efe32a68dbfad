// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Solves the links from the transmitter of a scenario to many receivers, and measures the time, for
// `greatx bench --recall --scattering`.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "gpu/device.h"
#include "sim/channel/channel_paths.h"
#include "sim/experiment/experiment.h"

namespace greatx::apps {

struct ScatterRun {
  double cpu_ms = 0.0, wall_ms = 0.0;  ///< of all receivers, without the search from the transmitter
  double search_ms = 0.0;              ///< processor time of that search and of what it prepares
  uint64_t chains = 0;                 ///< of all receivers
};

/// Solves the first channel of `scenario` in the world of `base` to `receivers`, `at_once` in a call, and
/// passes the paths of each to `of_link`, in order. Throws UserError if paths lie beyond max_paths.
ScatterRun run_receivers(gpu::Device& device, const sim::Experiment& base, sim::Scenario scenario,
                         std::span<const dvec3> receivers, size_t at_once,
                         const std::function<void(const std::vector<rf::Path>&)>& of_link);

}  // namespace greatx::apps
