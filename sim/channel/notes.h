// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "sim/experiment/experiment.h"

namespace greatx::sim {

/// Returns (name, text) pairs, as in the summary of a run, that say how the candidates of a channel will be
/// found and what is guaranteed. It searches nothing and needs no device. Throws UserError like
/// ChannelSearch.
std::vector<std::pair<std::string, std::string>> channel_notes(const Experiment& experiment,
                                                               uint32_t channel);

}  // namespace greatx::sim
