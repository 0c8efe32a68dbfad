// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What a channel writes for every pair of ports: sums over a link's paths, such as the frequency response.
// Which ones, the scenario says; what a row here does not name is not computed.
#pragma once

#include <complex>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "rf/channel/dispersion.h"
#include "rf/channel/frequency_response.h"
#include "rf/channel/taps.h"
#include "sim/scenario/scenario.h"

namespace greatx::sim {

/// A sum over paths between two arrays, into [rx_ant, tx_ant, time, ...]. `world`: the facets that the paths
/// were solved among. Thread-safe.
using LinkSum = std::function<void(std::span<const rf::Path>, const rf::FacetWorld& world,
                                   const rf::ArrayPose& transmitter, const rf::ArrayPose& receiver,
                                   std::span<std::complex<float>> out)>;

/// An array [rx, rx_ant, tx, tx_ant, time, last] of complex64.
struct PortBlock {
  std::string name, description;
  int64_t time = 1, last = 1;
  LinkSum sum;
  size_t per_pair() const { return static_cast<size_t>(time * last); }
};

/// `dispersion`: null if materials are as at the carrier; outlives the blocks.
std::vector<PortBlock> port_blocks(const ChannelConfig& config, const rf::ChannelGrid& grid,
                                   const rf::Dispersion* dispersion);

/// The window of a channel's taps; it must have one.
rf::TapGrid tap_grid(const ChannelConfig& config, const rf::ChannelGrid& grid);

}  // namespace greatx::sim
