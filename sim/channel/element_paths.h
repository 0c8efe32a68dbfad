// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Solves a link between two arrays for every pair of elements. Search, geometry, crossings and fields are as
// exact as between any two ends. It is used for links so short that one path cannot stand
// for all elements of an array.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "rf/antenna/antenna.h"
#include "sim/channel/blocks.h"
#include "sim/channel/channel_paths.h"

namespace greatx::sim {

/// Describes one end of such a link: the mount of the array, and the array.
struct ArrayEnd {
  ChannelEnd end;
  rf::AntennaArray array;
};

/// Holds the paths between all elements of two arrays.
class ElementPaths {
 public:
  /// Searches nothing before the first record(). The arguments are those of ChannelPaths, and outlive this.
  ElementPaths(scene::GpuScene& gpu_scene, rf::CrossingPass& crossings, const Experiment& experiment,
               const std::shared_ptr<RadioWorld>& radio, uint32_t channel, ArrayEnd transmitter,
               ArrayEnd receiver);

  /// Starts a new sequence.
  void start() { started_ = false; }
  /// Records the link at a tick. The first call in a sequence searches from each element of the transmitter
  /// (or of the receiver, if only the receiver rests).
  void record(gpu::TickSlot& slot, const TickContext& context);
  void collect(const gpu::TickSlot& slot);
  /// Assembles `sum` over the paths between every two elements of the tick collected last into [rx_ant,
  /// tx_ant, per_pair]; rx_ant and tx_ant are the ports of the arrays.
  void assemble(size_t per_pair, const LinkSum& sum, std::span<std::complex<float>> out) const;
  /// Returns the omissions of the tick collected last.
  LinkLeftOut left_out() const;
  /// Adds the counts of all elements of the transmitter.
  void count(std::map<std::string, uint64_t>& counters) const;

 private:
  ArrayEnd transmitter_, receiver_;
  std::vector<std::unique_ptr<ChannelPaths>> paths_;  ///< [elements of the transmitter]
  std::vector<ChannelPaths::Result> results_;         ///< [elements of the transmitter]
  bool started_ = false;
};

}  // namespace greatx::sim
