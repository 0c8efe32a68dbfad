// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// `greatx bench --view`: measures the viewer as somebody feels it: how fluently the view moves, how late a
// drag is seen, what the window costs a live run, how long it takes to open, how fast a data set is scrubbed.
#pragma once

#include <cstdint>
#include <string>

#include <nlohmann/json.hpp>

#include "apps/console/session.h"

namespace greatx::apps {

struct ViewBenchOptions {
  int64_t warm_up = 5;            ///< first ticks of each turn of a live run, not measured
  std::string size = "1280x720";  ///< of the window, pixels
  double seconds = 5.0;           ///< how long the view orbits
  uint32_t drags = 20;            ///< measured from rest to the picture
  uint32_t rounds = 3;            ///< of a live run with and without the window
  int64_t block = 60;             ///< ticks of a live run that are measured in each turn
  uint32_t starts = 3;            ///< of the program
  int64_t scrub_ticks = 30;       ///< of the data set that is scrubbed
};

/// Returns one JSON object with scenario, device, driver, cores of the host, width, height and `rows`. A row
/// has a name, a value and its unit. Where there is a target, it has `least` or `most`, and `met`.
///
/// All rows but those of the start run the loop of `greatx view` in this process, with a window in memory
/// whose clock is the wall's. The start is that of a process of its own. A time ends when the frame's pixels
/// are there. Rows:
///  - While the view orbits with all overlays: new pictures of the scene a second, and frames of the window.
///  - From a drag to the frame that shows its picture, from rest and in motion: median, 95th percentile and
///    worst.
///  - A tick of a live run as fast as it can, without a window, with one that follows it, and with one that
///    shows every tick, and the ratios less one. The turns alternate, and all count the same ticks.
///  - From the start of the program to the first picture of the scene, and to the one at full quality.
///  - Ticks a second of a data set with four panels, at the first visit of each tick.
/// Throws UserError if the scenario has fewer ticks than the warm-up and two.
nlohmann::json view_bench(const ScenarioOptions& scenario, const RunOptions& run,
                          const ViewBenchOptions& options);
/// Returns the result as a table.
std::string view_bench_text(const nlohmann::json& result);

}  // namespace greatx::apps
