// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "sim/experiment/experiment.h"

namespace greatx::sim {

/// How the candidates of a channel will be found and what that guarantees: (name, text), as in a run's
/// summary. Nothing is searched and no device is needed. Throws UserError like ChannelSearch.
std::vector<std::pair<std::string, std::string>> channel_notes(const Experiment& experiment,
                                                               uint32_t channel);

}  // namespace greatx::sim
