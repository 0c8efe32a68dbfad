// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A small run that has every file format. Each value is a function of (sequence, tick, sensor), so that tests
// get the packets of a run without a simulator.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "io/dataset/dataset_writer.h"

namespace greatx::io {

/// Describes a camera at 30 Hz, a LiDAR at 20 Hz, CSI at 100 Hz, poses at every tick of 1 kHz and a sensor
/// with packed arrays at 50 Hz, in 2 sequences of 70 ticks.
DatasetInfo sample_info();
Packet sample_packet(const DatasetInfo& info, uint32_t sequence, int64_t tick);
/// Returns element i of the CSI record `sample`: (sequence + sample, -i).
std::complex<float> sample_cfr(uint32_t sequence, int64_t sample, size_t element);

/// Writes the packets from the writer's position to the end of the run. If `packets` is not 0, stops after
/// that many packets. Returns whether the run is complete.
bool write_sample_run(DatasetWriter& writer, const DatasetInfo& info, int64_t packets = 0);

/// Returns the content of every file below `folder` by its relative path.
std::map<std::string, std::string> contents(const std::filesystem::path& folder);

}  // namespace greatx::io
