// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "io/files/file.h"
#include "rf/channel/dispersion.h"
#include "rf/channel/frequency_response.h"
#include "sim/channel/channel_snapshot.h"

namespace greatx::apps {

/// Frequency responses of any number of receivers as one .npy, complex64 [receivers, rx_ant, tx, tx_ant,
/// time, subcarrier], written receiver by receiver, and removed if it is not finished: the memory does not
/// grow with their number.
class CfrFile {
 public:
  /// `points`: how many points at rest take the place of the channel's receivers, each with one vertical
  /// isotropic antenna; none: its own. `snapshot` outlives this. The file is `file` + ".part" until finish().
  CfrFile(const std::filesystem::path& file, const sim::ChannelSnapshot& snapshot, uint32_t transmitter,
          std::optional<size_t> points);
  ~CfrFile();
  CfrFile(const CfrFile&) = delete;
  CfrFile& operator=(const CfrFile&) = delete;
  /// In the order of the receivers.
  void add(const sim::ChannelSnapshot::Link& link);
  /// Throws UserError if receivers are missing.
  void finish();

 private:
  std::filesystem::path path_;
  const sim::Scenario& scenario_;
  const sim::ChannelConfig& config_;
  io::File file_;
  rf::AntennaArray transmitter_;
  std::vector<rf::AntennaArray> receivers_;  ///< one for all points
  size_t count_ = 0, added_ = 0, near_ = 0;
  bool finished_ = false;
  rf::ChannelGrid grid_;
  std::optional<rf::Dispersion> dispersion_;
  std::vector<std::complex<float>> response_;
};

}  // namespace greatx::apps
