// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The tab that says where the time of a tick and the memory go.
#pragma once

#include <memory>

#include "view/app/main_view.h"
#include "view/app/shown_run.h"
#include "view/times/time_history.h"

namespace greatx::view {

class TimesPanel {
 public:
  /// Takes the tick that is shown. To be called in every frame, drawn or not.
  void keep(ShownRun& run);
  /// Draws into the current ImGui window. `panels_ms` is the time of the tiles of the sensors.
  void draw(ShownRun& run, const MainView& view, double panels_ms, double world_ms);

 private:
  void draw_lines();
  void draw_line(const TimeLine& line);
  void draw_run(ShownRun& run, const MainView& view, double panels_ms, double world_ms);
  void draw_memory(ShownRun& run);

  TimeHistory history_;
  std::shared_ptr<const io::DatasetInfo> info_;  ///< of the run that history_ is of
  std::shared_ptr<const ShownTick> kept_;
  bool all_lines_ = false;
};

}  // namespace greatx::view
