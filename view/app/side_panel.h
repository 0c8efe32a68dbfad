// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The column beside the main view: what the sensors measured, what the user picked, the paths of a link, the
// plan of effects, and times.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "view/app/edit_panel.h"
#include "view/app/main_view.h"
#include "view/app/panel_grid.h"
#include "view/app/shown_run.h"
#include "view/app/times_panel.h"
#include "view/app/world_overlays.h"

namespace greatx::view {

class SidePanel {
 public:
  explicit SidePanel(Window& window) : grid_(window) {}
  /// Draws into the current ImGui window. `main` is the run that the main view shows.
  void draw(std::span<ShownRun* const> runs, ShownRun& main, MainView& view, EditSession& session,
            WorldOverlays& world);
  PanelGrid& grid() { return grid_; }
  /// Brings a tab to the front in the next frame. Throws UserError if there is none of this name.
  void open_tab(const std::string& name);
  /// Returns the carrier of the chosen channel, or of the first one; 3.5 GHz if there is none.
  double carrier_hz(ShownRun& run) const;

 private:
  void draw_picked(ShownRun& run, MainView& view, EditSession& session);
  void draw_edit(ShownRun& run, EditSession& session);
  void draw_paths(ShownRun& run, MainView& view, WorldOverlays& world);
  void draw_pinned(ShownRun& run, MainView& view, WorldOverlays& world);
  void draw_filter(ShownRun& run);
  void draw_effects(ShownRun& run, EditSession& session);

  PanelGrid grid_;
  EditPanel edit_;
  TimesPanel times_;
  std::string wanted_tab_;  ///< empty: the one in front stays
};

}  // namespace greatx::view
