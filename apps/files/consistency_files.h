// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What a run found to agree between its sensors, kept beside its data set, and found again from the files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "io/dataset/verify.h"
#include "sim/compare/comparisons.h"

namespace greatx::apps {

/// consistency.csv: a line for each row, numbers exact. Beside the data set, not in its manifest: a run that
/// was interrupted has the lines of its last part alone.
std::string consistency_csv(const std::vector<sim::ConsistencyRow>& rows);
/// The inverse. Throws UserError, file:line.
std::vector<sim::ConsistencyRow> parse_consistency_csv(const std::string& text, const std::string& name);

struct ConsistencyReport {
  struct Figure {
    std::string name;
    uint64_t records = 0, compared = 0;  ///< recomputed
    double largest = 0.0;                ///< relative error
    uint64_t unwritten = 0;              ///< records that cannot be: an array is not kept exactly
    std::string missing;                 ///< which one, of what sensor
  };
  std::vector<Figure> figures;
  std::vector<std::string> notes;  ///< what cannot be recomputed, and why
  std::vector<io::Problem> problems;
};

/// Recomputes each line of consistency.csv from the arrays on disk. A problem for each record that says
/// something else than it did in the run: its files, the figure, what it is held against. Throws UserError if
/// the folder holds no data set.
ConsistencyReport verify_consistency(const std::filesystem::path& folder, uint32_t threads = 0);

}  // namespace greatx::apps
