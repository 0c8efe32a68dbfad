// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The window of the viewer with its parts: it owns them, passes what one makes to the next in each frame, and
// turns commands into calls. viewer.cpp has the frame, viewer_draw.cpp its windows, viewer_commands.cpp and
// viewer_show_commands.cpp the commands, viewer_script.cpp the answers to scripts.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "view/app/commands.h"
#include "view/app/edit_session.h"
#include "view/app/frame_pace.h"
#include "view/app/gizmo.h"
#include "view/app/main_view.h"
#include "view/app/recording.h"
#include "view/app/script_runner.h"
#include "view/app/settings_keeper.h"
#include "view/app/shown_run.h"
#include "view/app/side_panel.h"
#include "view/app/viewer.h"
#include "view/app/world_overlays.h"

namespace greatx::view {

/// Shows runs of one scenario or of several data sets until the user or a script closes the window.
class Viewer {
 public:
  /// Opens the window and starts the runs. `options` must outlive the viewer.
  Viewer(const ViewerOptions& options, ViewerSettings settings);

  /// Writes the settings.
  void save() { settings_.save(settled_parts(), shown()); }

  /// Draws frames until the window is closed.
  void loop();

 private:
  ShownRun& shown() { return *runs_[main_run_]; }
  SettledParts settled_parts() { return {*window_, main_, side_.grid(), side_open_, side_share_}; }
  size_t chosen_channel() { return shown().overlays() ? shown().overlays()->settings().channel : 0; }

  // viewer.cpp: one frame after another.
  /// Whether the run plays, and nobody holds a key or a button.
  bool plays_untouched() const;
  /// Whether ticks may be left out, because the run has no time to spare.
  bool spares_frames() const;
  /// Whether there is a tick or a picture that no frame has shown yet. What else changes may wait.
  /// A tick of a run that plays is shown together with its picture, so that it takes one frame and not two.
  bool has_news();
  void see_news();
  FrameWait frame_wait();
  void check_validation();
  void update();
  void show_scene(const std::shared_ptr<const sim::Experiment>& experiment);
  void frame();
  std::vector<Run*> timeline_runs();

  // viewer_draw.cpp: the parts of a frame.
  void draw_main(const ImVec2& at, const ImVec2& size);
  void draw_side(const ImVec2& at, const ImVec2& size);
  void draw_progress();
  void draw_errors();
  void draw_status();
  void draw_help();
  /// What the experiment gives, and the tube of the pinned path.
  const Shapes& world_shapes(const ShownTick& tick);
  /// "node/sensor" of the camera that the main view looks through; empty: none.
  std::string camera_name();
  std::optional<PathStory> pinned_story(const ShownTick& tick);

  // viewer_commands.cpp: commands for the run, the view and the scenario.
  void add_commands();
  void add_view_commands();
  void add_edit_commands();
  /// Menu entries for each camera and each node that moves.
  void add_camera_commands(const sim::Experiment& experiment);
  void open_tab(const std::string& name);
  void jump(const std::string& argument);
  void look_through(const std::string& camera);
  void follow(const std::string& name);
  const sim::Experiment& need_experiment();

  // viewer_show_commands.cpp: commands for the overlays.
  void add_overlay_commands();
  /// Overlays of the experiment.
  void add_world_commands();
  /// Colours by name; without a name, the next ones.
  void add_choices();
  void switch_overlay(const std::string& name, bool OverlaySettings::*value, const std::string& argument);
  void compute_map(const std::string& words);
  void pin_path(const std::string& rank);

  // viewer_script.cpp: what scripts and programs ask for.
  ScriptHost script_host();
  void write_screenshot(const std::filesystem::path& file);
  void print(const std::string& fact);
  void print_path();
  void print_comparison();

  static constexpr float usual_side_share = 0.42f;  ///< of the window's width

  const ViewerOptions& options_;
  std::unique_ptr<Window> window_;
  std::vector<std::unique_ptr<ShownRun>> runs_;
  size_t main_run_ = 0;
  EditSession edit_;
  Gizmo gizmo_;
  std::shared_ptr<const ShownTick> drawn_;     ///< in the last frame
  std::shared_ptr<const ShownTick> overlaid_;  ///< of the overlays
  MainView main_;
  WorldOverlays world_;
  Shapes with_tube_;
  SidePanel side_;
  Recording recording_;
  SettingsKeeper settings_;
  Commands commands_;
  SteadyText activity_;
  FramePace pace_;
  float side_share_ = usual_side_share;
  bool side_open_ = true, help_open_ = false, quit_ = false;
  bool every_tick_ = false;                                   ///< is shown, however long it takes
  std::vector<std::shared_ptr<const ShownTick>> seen_ticks_;  ///< [runs]
  uint64_t seen_picture_ = 0;
  std::string command_error_;
};

}  // namespace greatx::view
