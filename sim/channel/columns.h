// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Declares the tables that a channel writes of its paths and links. One column here is one array of the data
// set; its declaration and the function that fills it stand together.
#pragma once

#include <complex>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/record.h"
#include "rf/channel/statistics.h"
#include "rf/geometry/path.h"
#include "rf/paths/radio_model.h"
#include "sim/scenario/scenario.h"

namespace greatx::sim {

/// Holds a link with everything that its columns need.
struct LinkView {
  int32_t receiver = 0, transmitter = 0;  ///< indices in the channel
  const rf::LinkStatistics* statistics = nullptr;
  /// The frequency response comes from every pair of elements, not from paths of the whole arrays.
  bool every_element = false;
  double coherence_bandwidth_hz = 0.0, coherence_time_s = 0.0;  ///< set if they are asked for
  double taps_power_outside = 0.0;                              ///< rf::TapCoverage, if there are taps
  uint64_t sequences_left_out = 0, paths_left_out = 0;          ///< LinkLeftOut
};

/// Holds a path of a link.
struct PathView {
  const LinkView* link = nullptr;
  const rf::Path* path = nullptr;
  std::span<const std::complex<float>> amplitude;  ///< [rx_ant, tx_ant]
  std::span<const std::complex<float>> field;      ///< [tx_ant, 2] V/m; set if a power is given
};

/// Describes an array with one row of `row` elements for each path or link.
template <typename View>
struct Column {
  std::string name;
  DType dtype = DType::f64;
  std::vector<int64_t> row;  ///< shape of one row; empty: a number
  std::string unit, description;
  std::function<void(const View&, std::byte*)> fill;  ///< writes one row

  size_t row_bytes() const;
};
using PathColumn = Column<PathView>;
using LinkColumn = Column<LinkView>;

/// Holds the sizes and tables to which columns refer. It outlives the columns.
struct ColumnContext {
  const scene::Scene* scene = nullptr;
  const rf::RadioModel* model = nullptr;
  const ChannelConfig* config = nullptr;
  int64_t rx_ports = 1, tx_ports = 1;
};
/// Returns the most interactions that a path of the channel can have, echoes of targets included.
uint32_t most_interactions(const ChannelConfig& config);
/// Return the columns of paths and of links that the channel writes.
std::vector<PathColumn> path_columns(const ColumnContext& context);
std::vector<LinkColumn> link_columns(const ColumnContext& context);

}  // namespace greatx::sim
