// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Declares the arrays that a channel writes for every pair of ports. Each is a sum over the paths of a link,
// such as the frequency response. The scenario selects the arrays; an array that it does not select is not
// computed.
#pragma once

#include <complex>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "rf/channel/dispersion.h"
#include "rf/channel/frequency_response.h"
#include "rf/channel/taps.h"
#include "sim/plan/effect_plan.h"
#include "sim/scenario/scenario.h"

namespace greatx::sim {

/// Adds up the paths between two antenna arrays into [rx_ant, tx_ant, time, ...]. `world` holds the facets
/// for which the paths were solved. Uses `threads` threads. Thread-safe.
using LinkSum = std::function<void(std::span<const rf::Path>, const rf::FacetWorld& world,
                                   const rf::ArrayPose& transmitter, const rf::ArrayPose& receiver,
                                   std::span<std::complex<float>> out, uint32_t threads)>;

/// Describes an array [rx, rx_ant, tx, tx_ant, time, last] of complex64.
struct PortBlock {
  std::string name, description;
  int64_t time = 1, last = 1;
  LinkSum sum;
  size_t per_pair() const { return static_cast<size_t>(time * last); }
};

/// Returns the frequency response `cfr`. `dispersion` is as below.
PortBlock cfr_block(const rf::ChannelGrid& grid, const rf::Dispersion* dispersion);

/// Returns the arrays of a channel. `dispersion` outlives the blocks; null: materials and air have their
/// values at the carrier.
std::vector<PortBlock> port_blocks(const ChannelConfig& config, const rf::ChannelGrid& grid,
                                   const rf::Dispersion* dispersion);

/// Returns the subcarriers and times of a channel, with what the plan says of them.
rf::ChannelGrid channel_grid(const ChannelConfig& config, const EffectPlan& plan);

/// Returns the window of a channel's taps. The channel must have taps.
rf::TapGrid tap_grid(const ChannelConfig& config, const rf::ChannelGrid& grid);

}  // namespace greatx::sim
