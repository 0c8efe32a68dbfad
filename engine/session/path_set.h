// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds the paths of all links of a channel at a tick and computes channel quantities from them. Links are
// sorted by receiver, then by transmitter; the paths of a link are in canonical order.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/record.h"
#include "engine/session/path_parameters.h"
#include "engine/session/session.h"
#include "rf/channel/frequency_response.h"
#include "rf/channel/statistics.h"
#include "rf/paths/exact_crossings.h"
#include "sim/channel/link_ends.h"

namespace greatx::engine {

/// Describes the samples of a frequency response. A value that is not given is taken from the channel.
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
  struct Link {
    sim::ChannelSnapshot::Link solved;
    bool near = false;  ///< a run solves every element of this link's arrays separately
  };
  /// `receiver_arrays` holds one array per receiver, or one for all receivers. Throws UserError if the
  /// antennas of one side differ in their numbers of ports.
  PathSet(std::shared_ptr<const sim::Experiment> experiment, uint32_t channel,
          std::vector<rf::AntennaArray> receiver_arrays);

  void add(sim::ChannelSnapshot::Link link);
  /// Must be called after the last link. `snapshot` has solved the links; `before` holds its counters before
  /// it did.
  void finish(const sim::ChannelSnapshot& snapshot, const std::map<std::string, uint64_t>& before);

  size_t receivers() const { return links_.size() / transmitters_.size(); }
  size_t transmitters() const { return transmitters_.size(); }
  /// Returns the channel's name, carrier, tick, grid, notes, counters, ... as JSON.
  const std::string& facts() const { return facts_; }

  /// Returns the arrays of the data set below paths/, [path, ...], and `offsets` int64 [links + 1], the
  /// distances and the positions of the ends. Moves the memory to the caller and must be called only once.
  NamedArrays take_arrays() { return std::move(arrays_); }

  /// Returns complex64 [rx, rx_ant, tx, tx_ant, time, subcarrier]. An empty request gives the bytes of the
  /// data set.
  Array response(const ResponseRequest& request, const GoOn& go_on) const;
  /// Returns `taps` complex64 [rx, rx_ant, tx, tx_ant, time, tap], and `power_outside` and `paths_outside`
  /// [rx, tx].
  NamedArrays taps(const TapsRequest& request, const GoOn& go_on) const;
  /// Returns the statistics of each link, [rx, tx].
  NamedArrays statistics() const;
  /// Returns received powers, voltages and fields, [rx, tx, ...]. Complex values have a last axis of 2.
  NamedArrays received(const ReceivedRequest& request) const;
  /// Returns the parameters by which the paths can be differentiated (engine/session/varied_paths.h). Links
  /// must not be added any more.
  const std::vector<PathParameter>& parameters() const;
  /// Returns the coherence bandwidth and time, [rx, tx], at which the correlation falls to `level`.
  NamedArrays coherence(double level) const;

 private:
  friend class VariedPaths;
  /// Calls of(link, number) for all links on all cores, and `go_on` after each group of links. Returns false
  /// if `go_on` stopped it.
  bool for_links(const GoOn& go_on, const std::function<void(const Link&, size_t)>& of) const;
  /// Returns an array [rx, rx_ant, tx, tx_ant, columns...]. Calls of(link, block) for each link, which must
  /// fill the link's block [rx_ant, tx_ant, columns...].
  Array blocks(std::vector<int64_t> columns, const GoOn& go_on,
               const std::function<void(const Link&, std::span<std::complex<float>>)>& of) const;
  /// Makes an f64 array [rx, tx, width...].
  NamedArray table(const char* name, const char* unit, const char* description,
                   std::vector<int64_t> width = {}) const;
  /// Returns the exact crossings of the channel's scene, which are made when they are needed.
  const rf::ExactCrossings& crossings() const;
  const rf::AntennaArray& receiver_array(const Link& link) const;
  /// Returns the ends of a link for the channel's band or a wider one.
  sim::LinkEnds ends(const Link& link, double half_band_hz = 0.0) const;
  /// Throws UserError if the grid is not valid at this carrier.
  rf::ChannelGrid grid(const ResponseRequest& request, double carrier_hz) const;
  std::vector<double> powers(const Link& link) const;
  void fill_arrays(const sim::ChannelSnapshot& snapshot);
  void describe(const sim::ChannelSnapshot& snapshot, const std::map<std::string, uint64_t>& before);

  std::shared_ptr<const sim::Experiment> experiment_;
  uint32_t channel_;
  sim::ChannelConfig config_;
  std::vector<rf::AntennaArray> transmitters_, receivers_;
  std::shared_ptr<const sim::RadioWorld> radio_;
  std::vector<Link> links_;
  NamedArrays arrays_;
  std::string facts_;
  mutable std::once_flag parameters_made_, crossings_made_;
  mutable std::vector<PathParameter> parameters_;
  mutable std::unique_ptr<const rf::ExactCrossings> crossings_;
};

}  // namespace greatx::engine
