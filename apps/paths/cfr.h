// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes the frequency responses of `greatx paths --cfr`.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "io/files/file.h"
#include "rf/channel/dispersion.h"
#include "rf/channel/frequency_response.h"
#include "sim/channel/channel_snapshot.h"

namespace greatx::apps {

/// Writes the frequency responses of any number of receivers for one transmitter to one .npy file, complex64
/// [receivers, rx_ant, 1, tx_ant, time, subcarrier]. The responses are written receiver by receiver, so that
/// the memory does not grow with their number. A file that is not finished is removed.
class CfrFile {
 public:
  /// `points`: the number of points at rest that replace the channel's receivers, each with one vertical
  /// isotropic antenna; none: the channel's receivers. `snapshot` outlives this. The file is named `file` +
  /// ".part" until finish(). Throws UserError if the receivers differ in their numbers of ports.
  CfrFile(const std::filesystem::path& file, const sim::ChannelSnapshot& snapshot, uint32_t transmitter,
          std::optional<size_t> points);
  ~CfrFile();
  CfrFile(const CfrFile&) = delete;
  CfrFile& operator=(const CfrFile&) = delete;
  /// Writes the response of one link at the place of its receiver.
  void add(const sim::ChannelSnapshot::Link& link);
  /// Closes the file and gives it its name. Warns of receivers for which a run would solve every element of
  /// the arrays, because the file takes one path for all elements. Throws UserError if receivers are missing.
  void finish();

 private:
  std::filesystem::path path_;
  const sim::Scenario& scenario_;
  const sim::ChannelConfig& config_;
  io::File file_;
  rf::AntennaArray transmitter_;
  std::vector<rf::AntennaArray> receivers_;  ///< a single one for all points
  size_t count_ = 0, added_ = 0, near_ = 0;
  bool finished_ = false;
  rf::ChannelGrid grid_;
  std::optional<rf::Dispersion> dispersion_;
  std::vector<std::complex<float>> response_;
};

}  // namespace greatx::apps
