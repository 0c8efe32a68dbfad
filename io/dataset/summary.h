// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Summarises a data set as `greatx inspect` reports it, as text or as JSON.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/dataset/dataset_reader.h"

namespace greatx::io {

/// Holds the facts that `greatx inspect` reports about a data set.
struct Summary {
  struct Sensor {
    std::string name, kind, rate_hz;
    int64_t records = 0;
    uint64_t bytes = 0;                ///< size on disk; 0 if the data set is unfinished
    std::vector<std::string> outputs;  ///< "rgb: png |u1 [480, 640, 3]"
  };
  std::string folder;
  std::string title;  ///< name of the run's scenario, or of the folder if the run states none
  bool finished = false;
  uint32_t sequences = 0, sequences_present = 0;
  int64_t ticks_per_sequence = 0;
  std::string tick_rate_hz;
  double duration_s = 0.0;  ///< duration of one sequence
  int64_t records = 0;
  int64_t files = 0;   ///< number of files in the manifest; 0 if the data set is unfinished
  uint64_t bytes = 0;  ///< size of these files
  std::vector<Sensor> sensors;
};

Summary summarize(const DatasetReader& reader);
std::string to_text(const Summary& summary);
/// Returns one JSON object with the fields of Summary.
std::string to_json(const Summary& summary);

}  // namespace greatx::io
