// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes the results of the comparisons between the sensors of a run to a file beside its data set, and
// recomputes them from the data set.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "io/dataset/verify.h"
#include "sim/compare/comparisons.h"

namespace greatx::apps {

/// Returns the text of consistency.csv: a line for each row, with exact numbers. The file is beside the data
/// set and not in its manifest, because a run that was interrupted and resumed has only the rows of its last
/// part.
std::string consistency_csv(const std::vector<sim::ConsistencyRow>& rows);
/// Parses the text of consistency.csv, the file `name`. Throws UserError with "name:line" if it is malformed.
std::vector<sim::ConsistencyRow> parse_consistency_csv(const std::string& text, const std::string& name);

/// Holds the result of verify_consistency().
struct ConsistencyReport {
  struct Figure {
    std::string name;
    uint64_t records = 0, compared = 0;  ///< recomputed records, and the values compared in them
    double largest = 0.0;                ///< largest relative error
    uint64_t unwritten = 0;              ///< records not recomputed, because no file keeps an array exactly
    std::string missing;                 ///< that array and its sensor
  };
  std::vector<Figure> figures;
  std::vector<std::string> notes;  ///< figures that are not recomputed, with the reasons
  std::vector<io::Problem> problems;
};

/// Recomputes each line of consistency.csv from the arrays on disk. Reports a problem for each record whose
/// result differs from that of the run; the problem names the record, the figure and the sensor it is
/// compared with. `threads`: 0 for all cores. Throws UserError if the folder holds no data set.
ConsistencyReport verify_consistency(const std::filesystem::path& folder, uint32_t threads = 0);

}  // namespace greatx::apps
