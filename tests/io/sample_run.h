// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A small run with every file format in it, whose every value is a function of (sequence, tick, sensor): what
// a simulator would deliver, without one.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "io/dataset/dataset_writer.h"

namespace greatx::io {

/// Camera at 30 Hz, LiDAR at 20 Hz, CSI at 100 Hz, poses at every tick of 1 kHz; 2 sequences of 70 ticks.
DatasetInfo sample_info();
Packet sample_packet(const DatasetInfo& info, uint32_t sequence, int64_t tick);
/// Element i of the CSI record `sample`: (sequence + sample, -i).
std::complex<float> sample_cfr(uint32_t sequence, int64_t sample, size_t element);

/// Writes from the writer's position to the end; stops in the middle after `packets` of them (0: never).
/// Returns whether it finished.
bool write_sample_run(DatasetWriter& writer, const DatasetInfo& info, int64_t packets = 0);

/// Every file below the folder: its content by relative path.
std::map<std::string, std::string> contents(const std::filesystem::path& folder);

}  // namespace greatx::io
