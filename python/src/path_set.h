// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The paths of all links of a channel at a tick, and what is made of them. Links are in the order of
// receivers, then transmitters; paths of a link in canonical order.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/record.h"
#include "python/src/session.h"
#include "rf/channel/frequency_response.h"
#include "rf/channel/statistics.h"

namespace greatx::python {

/// Where the frequency response is sampled; what is not given is the channel's.
struct ResponseRequest {
  std::optional<double> subcarrier_spacing_hz;
  std::optional<uint32_t> subcarriers, time_samples;
  std::optional<double> time_spacing_s;
  rf::PathSelection selection = rf::PathSelection::all;
};
struct TapsRequest {
  double bandwidth_hz = 0.0;
  int32_t first = 0;
  uint32_t taps = 0, time_samples = 1;
  double time_spacing_s = 1e-3;
};
struct ReceivedRequest {
  double transmit_power_w = 1.0, resistance_ohm = 50.0;
  uint32_t transmit_port = 0, receive_port = 0;
};

class PathSet {
 public:
  /// `receiver_arrays`: one for each receiver, or one for all.
  PathSet(std::shared_ptr<const sim::Experiment> experiment, uint32_t channel,
          std::vector<rf::AntennaArray> receiver_arrays);

  void add(sim::ChannelSnapshot::Link link);
  /// After the last link; `snapshot` is the one they come from, `before` what it had counted until then.
  void finish(const sim::ChannelSnapshot& snapshot, const std::map<std::string, uint64_t>& before);

  size_t receivers() const { return links_.size() / transmitters_.size(); }
  size_t transmitters() const { return transmitters_.size(); }
  /// Number, carrier, tick, grid, notes, counters, ... as JSON.
  const std::string& facts() const { return facts_; }

  /// As the data set has them below paths/, [path, ...], and `offsets` int64 [links + 1]. Theirs is the
  /// memory: once.
  NamedArrays take_arrays() { return std::move(arrays_); }

  /// complex64 [rx, rx_ant, tx, tx_ant, time, subcarrier]. Without a request of its own the bytes of the data
  /// set.
  Array response(const ResponseRequest& request, const GoOn& go_on) const;
  /// `taps` complex64 [rx, rx_ant, tx, tx_ant, time, tap]; `power_outside`, `paths_outside` [rx, tx].
  NamedArrays taps(const TapsRequest& request, const GoOn& go_on) const;
  /// Numbers of links, [rx, tx].
  NamedArrays statistics() const;
  /// [rx, tx], complex as a last axis of 2.
  NamedArrays received(const ReceivedRequest& request) const;
  NamedArrays coherence(double level) const;

 private:
  struct Link {
    sim::ChannelSnapshot::Link solved;
    bool near = false;  ///< a run solves every element
  };
  /// of(link, its number) for all of them, on all cores, some at a time; false: stopped.
  bool for_links(const GoOn& go_on, const std::function<void(const Link&, size_t)>& of) const;
  /// The same where each link has a block [rx_ant, tx_ant, columns] of an array [rx, rx_ant, tx, tx_ant,
  /// columns...].
  Array blocks(std::vector<int64_t> columns, const GoOn& go_on,
               const std::function<void(const Link&, std::span<std::complex<float>>)>& of) const;
  /// An f64 array [rx, tx, width...] of one row a link.
  NamedArray table(const char* name, const char* unit, const char* description,
                   std::vector<int64_t> width = {}) const;
  rf::ArrayPose transmitter(const Link& link) const;
  rf::ArrayPose receiver(const Link& link) const;
  std::vector<double> powers(const Link& link) const;
  void fill_arrays(const sim::ChannelSnapshot& snapshot);
  void describe(const sim::ChannelSnapshot& snapshot, const std::map<std::string, uint64_t>& before);

  std::shared_ptr<const sim::Experiment> experiment_;
  uint32_t channel_;
  sim::ChannelConfig config_;
  std::vector<rf::AntennaArray> transmitters_, receivers_;
  std::shared_ptr<const sim::RadioWorld> radio_;  ///< only with dispersion
  std::vector<Link> links_;
  NamedArrays arrays_;
  std::string facts_;
};

}  // namespace greatx::python
