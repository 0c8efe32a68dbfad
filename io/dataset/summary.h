// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/dataset/dataset_reader.h"

namespace greatx::io {

/// What `greatx inspect` says about a data set.
struct Summary {
  struct Sensor {
    std::string name, kind, rate_hz;
    int64_t records = 0;
    uint64_t bytes = 0;                ///< on disk; 0 if unfinished
    std::vector<std::string> outputs;  ///< "rgb: png |u1 [480, 640, 3]"
  };
  std::string folder;
  std::string title;  ///< the run's "scenario" (or its "name"), else the folder's name
  bool finished = false;
  uint32_t sequences = 0, sequences_present = 0;
  int64_t ticks_per_sequence = 0;
  std::string tick_rate_hz;
  double duration_s = 0.0;  ///< of one sequence
  int64_t records = 0;
  int64_t files = 0;   ///< of the manifest; 0 if unfinished
  uint64_t bytes = 0;  ///< likewise
  std::vector<Sensor> sensors;
};

Summary summarize(const DatasetReader& reader);
std::string to_text(const Summary& summary);
/// One JSON object with the fields of Summary.
std::string to_json(const Summary& summary);

}  // namespace greatx::io
