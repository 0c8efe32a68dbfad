// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Brings the settings of the last start into the viewer, and those of this one into the file.
#pragma once

#include <filesystem>
#include <memory>
#include <set>
#include <span>
#include <string>

#include "view/app/commands.h"
#include "view/app/main_view.h"
#include "view/app/panel_grid.h"
#include "view/app/shown_run.h"
#include "view/settings/viewer_settings.h"
#include "view/window/window.h"

namespace greatx::view {

/// What the settings are settings of.
struct SettledParts {
  Window& window;
  MainView& main;
  PanelGrid& grid;
  bool& side_open;
  float& side_share;
};

class SettingsKeeper {
 public:
  /// `title` is that of the scenario or data set. `file` is empty: nothing is remembered.
  SettingsKeeper(std::filesystem::path file, std::string title, ViewerSettings settings);

  /// Adds "settings.forget".
  void add_commands(Commands& commands);
  /// Brings the settings of the window into the viewer. To be called once.
  void apply(const SettledParts& parts);
  /// Brings the settings of a run into it as soon as it can take them. To be called in every frame. A run
  /// that takes the place of another one of the same name keeps what it has.
  void apply(ShownRun& run);
  /// Writes the file, unless the settings are to be forgotten. Throws WriteError.
  void save(const SettledParts& parts, ShownRun& run);

 private:
  void forget();

  std::filesystem::path file_;
  std::string title_;
  ViewerSettings settings_;
  std::set<std::string> settled_speeds_, settled_overlays_;  ///< names of runs
  bool forgotten_ = false;
};

}  // namespace greatx::view
