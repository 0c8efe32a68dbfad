// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <imgui.h>
#include <iostream>
#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "view/app/splitter.h"
#include "view/app/timeline.h"
#include "view/app/viewer_window.h"

namespace greatx::view {

namespace {

constexpr double scripted_wait_s = 0.008;  ///< as ViewerOptions::longest_wait_s, while there is a script
/// While a picture is being drawn, input alone begins a frame so long after the last one: after so many times
/// what the picture before it took, but not later than this. The picture begins the next frame anyway, and a
/// frame before it would slow it down.
constexpr double awaiting_input_factor = 1.6, most_awaiting_input_s = 0.1;
/// So much longer is ViewerOptions::longest_wait_s while a run plays that nobody touches. Each tick begins a
/// frame, and the run needs the cores.
constexpr double playing_wait_factor = 10.0;
/// Of the wanted speed, below which a run is behind.
constexpr double least_reached = 0.95;

}  // namespace

Viewer::Viewer(const ViewerOptions& options, ViewerSettings settings)
    : options_(options),
      window_(Window::open(options.window)),
      edit_(options),
      main_(*window_),
      world_(options.device),
      side_(*window_),
      recording_(*window_, options.script_folder, !options.script.empty()),
      settings_(options.settings_file, options.title, std::move(settings)) {
  if (options.datasets.empty())
    runs_.push_back(ShownRun::live(options));
  else
    for (const std::filesystem::path& dataset : options.datasets)
      runs_.push_back(ShownRun::replay(options, dataset));
  window_->set_title("greatx: " + options.title);
  settings_.apply(settled_parts());
  add_commands();
  add_edit_commands();
  main_.set_tool(
      [this](const OverlayFrame& frame, bool hovered) { return gizmo_.draw(edit_, frame, hovered); });
}

void Viewer::loop() {
  see_news();
  ScriptRunner script(options_.script);
  while (!quit_ && window_->begin_frame(frame_wait())) {
    pace_.frame_begins();
    see_news();
    frame();
    window_->end_frame();
    pace_.frame_ended(main_.picture_ms());
    check_validation();
    recording_.frame_drawn();
    if (!options_.script.empty() && !script.advance(script_host())) return;
    if (options_.driver && !options_.driver(script_host())) return;
  }
}

bool Viewer::plays_untouched() const {
  const RunStatus status = runs_[main_run_]->run().status();
  if (!status.playing || status.phase != RunStatus::Phase::ready) return false;
  const ImGuiIO& io = ImGui::GetIO();
  return std::ranges::none_of(io.MouseDown, std::identity()) &&
         std::ranges::none_of(io.KeysDown, std::identity());
}

bool Viewer::spares_frames() const {
  const RunStatus status = runs_[main_run_]->run().status();
  const bool behind = status.speed <= 0.0 || status.reached < least_reached * status.speed;
  return behind && !every_tick_ && options_.datasets.empty() && options_.script.empty() &&
         !recording_.active();
}

bool Viewer::has_news() {
  if (main_.version() != seen_picture_) return true;
  const bool plays = plays_untouched();
  for (size_t i = 0; i < runs_.size(); ++i) {
    const std::shared_ptr<const ShownTick> tick = runs_[i]->run().shown();
    if (tick == seen_ticks_[i]) continue;
    if (i != main_run_ || !plays || seen_ticks_[i] == nullptr) return true;
    if (spares_frames() && !pace_.due()) continue;
    main_.look_ahead(*tick);
    if (main_.has_picture_of(*tick)) return true;
  }
  return false;
}

void Viewer::see_news() {
  seen_ticks_.resize(runs_.size());
  for (size_t i = 0; i < runs_.size(); ++i) seen_ticks_[i] = runs_[i]->run().shown();
  seen_picture_ = main_.version();
}

FrameWait Viewer::frame_wait() {
  FrameWait wait;
  wait.most_s = options_.longest_wait_s;
  if (plays_untouched()) wait.most_s *= playing_wait_factor;
  if (!options_.script.empty()) wait.most_s = std::min(wait.most_s, scripted_wait_s);
  if (main_.awaits())
    wait.input_after_s = std::min(most_awaiting_input_s, 1e-3 * awaiting_input_factor * main_.picture_ms());
  if (!world_.idle() || recording_.active()) wait.most_s = std::min(wait.most_s, scripted_wait_s);
  wait.news = [this] { return has_news(); };
  return wait;
}

void Viewer::check_validation() {
  const std::vector<std::string> messages = window_->validation_messages();
  if (!messages.empty())
    throw std::runtime_error("the validation layer on the window's device: " + messages.front());
  // Errors are shown and not thrown, but those of the validation layer are faults of the program.
  if (!options_.window.validation) return;
  std::vector<std::string> errors{main_.error()};
  for (const std::unique_ptr<ShownRun>& run : runs_) errors.push_back(run->run().status().error);
  for (const std::string& error : errors)
    if (error.find("validation") != std::string::npos) throw std::runtime_error(error);
}

void Viewer::update() {
  for (size_t i = 0; i < runs_.size(); ++i) {
    const std::shared_ptr<const sim::Experiment> loaded = runs_[i]->update();
    settings_.apply(*runs_[i]);
    if (loaded != nullptr && i == main_run_) show_scene(loaded);
  }
  std::unique_ptr<ShownRun> fresh = edit_.update(shown());
  if (fresh == nullptr) return;
  if (fresh->overlays() != nullptr && shown().overlays() != nullptr)
    fresh->overlays()->settings() = shown().overlays()->settings();
  edit_.retire(std::exchange(runs_[main_run_], std::move(fresh)));
  side_.grid().replaced(shown().name());
  show_scene(shown().experiment());
}

void Viewer::show_scene(const std::shared_ptr<const sim::Experiment>& experiment) {
  auto scene = std::make_unique<SceneView>(experiment, options_.device);
  edit_.disposer().drop(main_.set_scene(experiment, std::move(scene)));
  world_.set(experiment);
  commands_.remove("camera ");
  commands_.remove("follow ");
  add_camera_commands(*experiment);
}

void Viewer::frame() {
  update();
  commands_.run_keys();
  if (ImGui::BeginMainMenuBar()) {
    commands_.draw_menus();
    draw_status();
    ImGui::EndMainMenuBar();
  }
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  const float top = ImGui::GetFrameHeight(), bottom = timeline_height();
  const float side = side_open_ ? std::round(side_share_ * display.x) : 0.0f;
  const float height = display.y - top - bottom, gap = side_open_ ? splitter_width() : 0.0f;
  draw_main({0.0f, top}, {display.x - side - gap, height});
  if (side_open_) {
    draw_splitter({display.x - side - gap, top}, height, usual_side_share, side_share_);
    draw_side({display.x - side, top}, {side, height});
  }
  draw_timeline({0.0f, display.y - bottom}, {display.x, bottom}, timeline_runs(), activity_);
  if (help_open_) draw_help();
  recording_.draw();
}

std::vector<Run*> Viewer::timeline_runs() {
  std::vector<Run*> runs;
  for (const std::unique_ptr<ShownRun>& run : runs_) runs.push_back(&run->run());
  return runs;
}

void run_viewer(const ViewerOptions& given) {
  ViewerOptions options = given;
  ViewerSettings settings;
  if (!options.settings_file.empty()) {
    std::string message;
    settings = load_settings(options.settings_file, message);
    if (!message.empty()) std::cerr << "warning: " << printable_lines(message) << '\n';
    if (!options.chosen_size && settings.width > 0) {
      options.window.width = settings.width;
      options.window.height = settings.height;
    }
  }
  Viewer viewer(options, std::move(settings));
  viewer.loop();
  try {
    viewer.save();
  } catch (const UserError& error) {
    std::cerr << "warning: the viewer's settings are not kept: " << printable_lines(error.what()) << '\n';
  }
}

}  // namespace greatx::view
