// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A link between two arrays, element by element: paths between every two elements by the same exact search,
// geometry, crossings and fields as between any two ends. For links so short that no plane wave passes an
// array.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "rf/antenna/antenna.h"
#include "sim/channel/blocks.h"
#include "sim/channel/channel_paths.h"

namespace greatx::sim {

/// One end of such a link: where the array is mounted, and the array.
struct ArrayEnd {
  ChannelEnd end;
  rf::AntennaArray array;
};

class ElementPaths {
 public:
  /// Nothing is searched before the first record(). Arguments are as ChannelPaths', and outlive this.
  ElementPaths(scene::GpuScene& gpu_scene, rf::CrossingPass& crossings, const Experiment& experiment,
               const std::shared_ptr<RadioWorld>& radio, uint32_t channel, ArrayEnd transmitter,
               ArrayEnd receiver);

  /// A new sequence.
  void start() { started_ = false; }
  /// The first one of a sequence searches from each element of the transmitter (or receiver, if that one
  /// rests).
  void record(gpu::TickSlot& slot, const TickContext& context);
  void collect(const gpu::TickSlot& slot);
  /// `sum` over the paths between every two elements of what was collected last, [rx_ant, tx_ant, per_pair],
  /// rx_ant and tx_ant the ports of the arrays.
  void assemble(size_t per_pair, const LinkSum& sum, std::span<std::complex<float>> out) const;
  /// Of what was collected last.
  LinkLeftOut left_out() const;
  /// Summed over the elements of the transmitter.
  void count(std::map<std::string, uint64_t>& counters) const;

 private:
  ArrayEnd transmitter_, receiver_;
  std::vector<std::unique_ptr<ChannelPaths>> paths_;  ///< [elements of the transmitter]
  std::vector<ChannelPaths::Result> results_;         ///< the same
  bool started_ = false;
};

}  // namespace greatx::sim
