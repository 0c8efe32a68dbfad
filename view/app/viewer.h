// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The interactive viewer: it puts window, run, scene view, overlays and panels together. Data flows one way
// in each frame: the run publishes a tick, overlays and panels draw it, the user's commands go back to the
// run.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gpu/device.h"
#include "sim/scenario/scenario.h"
#include "view/script/script.h"
#include "view/window/window.h"

namespace greatx::view {

struct ScriptHost;

struct ViewerOptions {
  std::string title;  ///< of the scenario or data set, for the window
  /// Returns the scenario of a live run; empty for data sets. It is called on the run's thread.
  std::function<sim::Scenario()> scenario;
  /// Data sets to replay, side by side; empty for a live run.
  std::vector<std::filesystem::path> datasets;
  /// Returns the scenario that a data set was made of, from the text that it holds. It is called on a thread
  /// of its own, and what it throws is shown where the scene would be.
  std::function<sim::Scenario(const std::string& text, const std::filesystem::path& dataset)> scenario_of;
  /// Parses a changed text of a live run's scenario. Empty: the scenario cannot be edited.
  std::function<sim::Scenario(const sim::Scenario& before, const std::string& text)> reparse;
  std::filesystem::path assets;  ///< where the scenario's files are looked for besides its own folder
  gpu::DeviceOptions device;
  WindowOptions window;
  std::vector<ScriptStep> script;       ///< empty: a person drives
  std::filesystem::path script_folder;  ///< where the script's screenshots go
  bool paused = false;
  double longest_wait_s = 0.05;  ///< of a frame for input or news
  /// Drives the viewer from a program, beside a script or a person: it is called after each frame, and the
  /// viewer ends when it returns false. Empty: nothing does.
  std::function<bool(const ScriptHost&)> driver;
  /// Where the viewer remembers its settings; empty: nowhere.
  std::filesystem::path settings_file;
  bool chosen_size = false;  ///< the window's size was asked for, so the remembered one does not count
};

/// Opens the viewer and returns when the user closes it or the script ends. Throws UserError if the window
/// cannot be opened, or if a step of the script fails.
void run_viewer(const ViewerOptions& options);

}  // namespace greatx::view
