// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/channel/notes.h"

#include <fmt/format.h>

#include "sim/channel/channel_paths.h"
#include "sim/channel/channel_search.h"

namespace greatx::sim {

std::vector<std::pair<std::string, std::string>> channel_notes(const Experiment& experiment,
                                                               uint32_t channel) {
  const ChannelConfig& config = experiment.scenario.channels[channel];
  const ChannelEnds ends = channel_ends(experiment, channel, 0);
  // The notes do not depend on edges, and finding edges takes a while, for either effect.
  rf::RadioEffects effects = radio_effects(experiment);
  effects.diffraction = effects.field.finite_reflectors = false;
  const rf::RadioModel model(experiment.scene(), config.carrier_hz, effects);
  auto notes = ChannelSearch(nullptr, model, experiment.plan, config, ends).notes();
  notes.emplace_back(
      "bounds", fmt::format("a search keeps {} sequences, a link {} geometric paths (max_paths); what is "
                            "beyond is counted, and the guarantee of the results says so",
                            rf::BeamSearchOptions{}.capacity, config.limits.max_paths));
  return notes;
}

}  // namespace greatx::sim
