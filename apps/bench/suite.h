// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// `greatx bench --suite`: how the passes grow with triangles, bodies, lamps and receivers, in scenes that are
// the same on every machine, with every tracer of the device and beside Embree (docs/benchmarks.md).
#pragma once

#include <cstdint>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "apps/console/session.h"

namespace greatx::apps {

struct SuiteOptions {
  std::filesystem::path folder;
  bool quick = false;                    ///< 1 k to 100 k triangles instead of 1 k to 10 M
  uint64_t most_triangles = 10'000'000;  ///< larger scenes are not asked for
  uint32_t repeats = 7;                  ///< measured runs of each row; at least 3 count as a measurement
};

/// Measures and writes suite.json, suite.md, device.json and a PNG for each axis into the folder. They are
/// written again after every scene, so that an interrupted suite leaves what it has measured. Returns the
/// JSON. Throws Interrupted after Ctrl-C.
nlohmann::json run_suite(const RunOptions& run, const SuiteOptions& options, bool quiet);

/// Returns the words for the terminal: the table, and where the files are.
std::string suite_text(const nlohmann::json& result);

}  // namespace greatx::apps
