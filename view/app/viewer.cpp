// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/app/viewer.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <imgui.h>
#include <iostream>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"
#include "io/files/file.h"
#include "io/formats/png.h"
#include "sim/plan/camera_desc.h"
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
#include "view/app/splitter.h"
#include "view/app/timeline.h"
#include "view/app/world_overlays.h"
#include "view/overlay/tube_shapes.h"
#include "view/window/style.h"

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
constexpr float usual_side_share = 0.42f;  ///< of the window's width

class Viewer {
 public:
  Viewer(const ViewerOptions& options, ViewerSettings settings)
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

  /// Writes the settings.
  void save() { settings_.save(settled_parts(), shown()); }

  void loop() {
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

 private:
  ShownRun& shown() { return *runs_[main_run_]; }
  SettledParts settled_parts() { return {*window_, main_, side_.grid(), side_open_, side_share_}; }

  /// Whether the run plays, and nobody holds a key or a button.
  bool plays_untouched() const {
    const RunStatus status = runs_[main_run_]->run().status();
    if (!status.playing || status.phase != RunStatus::Phase::ready) return false;
    const ImGuiIO& io = ImGui::GetIO();
    return std::ranges::none_of(io.MouseDown, std::identity()) &&
           std::ranges::none_of(io.KeysDown, std::identity());
  }

  /// Whether ticks may be left out, because the run has no time to spare.
  bool spares_frames() const {
    const RunStatus status = runs_[main_run_]->run().status();
    const bool behind = status.speed <= 0.0 || status.reached < least_reached * status.speed;
    return behind && !every_tick_ && options_.datasets.empty() && options_.script.empty() &&
           !recording_.active();
  }

  /// Whether there is a tick or a picture that no frame has shown yet. What else changes may wait.
  /// A tick of a run that plays is shown together with its picture, so that it takes one frame and not two.
  bool has_news() {
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
  void see_news() {
    seen_ticks_.resize(runs_.size());
    for (size_t i = 0; i < runs_.size(); ++i) seen_ticks_[i] = runs_[i]->run().shown();
    seen_picture_ = main_.version();
  }

  FrameWait frame_wait() {
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

  void check_validation() {
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

  void update() {
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

  void show_scene(const std::shared_ptr<const sim::Experiment>& experiment) {
    auto scene = std::make_unique<SceneView>(experiment, options_.device);
    edit_.disposer().drop(main_.set_scene(experiment, std::move(scene)));
    world_.set(experiment);
    commands_.remove("camera ");
    commands_.remove("follow ");
    add_camera_commands(*experiment);
  }

  void frame() {
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

  std::vector<Run*> timeline_runs() {
    std::vector<Run*> runs;
    for (const std::unique_ptr<ShownRun>& run : runs_) runs.push_back(&run->run());
    return runs;
  }

  static void place(const ImVec2& at, const ImVec2& size) {
    ImGui::SetNextWindowPos(at);
    ImGui::SetNextWindowSize(size);
  }

  void draw_main(const ImVec2& at, const ImVec2& size) {
    place(at, size);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.0f, 0.0f});
    ImGui::Begin("scene", nullptr, fixed_window | ImGuiWindowFlags_NoScrollWithMouse);
    ImGui::PopStyleVar();
    const std::shared_ptr<const ShownTick> tick = drawn_ = shown().run().shown();
    recording_.before_tick(tick);
    static const Shapes none;
    Overlays* const overlays = shown().overlays();
    // Overlays follow with the picture of their tick: both fit, and the scene is drawn once for each tick.
    if (tick == nullptr || main_.has_picture_of(*tick)) overlaid_ = tick;
    if (overlays != nullptr) overlays->look_through(camera_name());
    const Shapes& shapes = overlays != nullptr ? overlays->shapes(overlaid_) : none;
    static const ShownTick start;  // so that the scene is there before its first tick
    if (main_.has_scene())
      main_.draw(tick != nullptr ? *tick : start, shapes, overlays != nullptr ? overlays->made() : 0,
                 overlaid_ != nullptr ? world_shapes(*overlaid_) : none, world_.paint(),
                 shown().run().status().playing);
    if (tick == nullptr) draw_progress();
    draw_errors();
    ImGui::End();
  }

  size_t chosen_channel() { return shown().overlays() ? shown().overlays()->settings().channel : 0; }

  /// "node/sensor" of the camera that the main view looks through; empty: none.
  std::string camera_name() {
    if (!main_.camera() || shown().experiment() == nullptr) return {};
    const sim::NodeConfig& node = shown().experiment()->scenario.nodes[main_.camera()->node];
    return node.name + "/" + node.sensors[main_.camera()->sensor].name;
  }

  std::optional<PathStory> pinned_story(const ShownTick& tick) {
    if (main_.pinned_id() == 0 || shown().overlays() == nullptr) return {};
    std::optional<PathStory> story = shown().overlays()->story(tick, main_.pinned_id());
    if (story) world_.explain(*story, tick, chosen_channel());
    return story;
  }

  /// What the experiment gives, and the tube of the pinned path.
  const Shapes& world_shapes(const ShownTick& tick) {
    const Shapes& world = world_.shapes(tick, main_.focus(), chosen_channel());
    if (!world_.settings().tubes) return world;
    const std::optional<PathStory> story = pinned_story(tick);
    if (!story) return world;
    with_tube_ = world;
    with_tube_.append(fresnel_shapes(*story));
    return with_tube_;
  }

  void draw_progress() {
    const RunStatus status = shown().run().status();
    ImGui::SetCursorPos({scaled(20.0f), scaled(20.0f)});
    if (status.phase == RunStatus::Phase::failed) return;
    ImGui::BeginGroup();
    ImGui::TextUnformatted(status.activity.empty() ? "loading" : printable(status.activity).c_str());
    if (status.progress >= 0.0)
      ImGui::ProgressBar(static_cast<float>(status.progress), {scaled(300.0f), 0.0f});
    else
      ImGui::TextDisabled("%s",
                          std::string(1 + static_cast<size_t>(ImGui::GetTime() * 3.0) % 3, '.').c_str());
    ImGui::EndGroup();
  }

  void draw_errors() {
    std::vector<std::string> errors{shown().run().status().error, shown().scene_error(), main_.error()};
    if (const Overlays* const overlays = shown().overlays()) errors.push_back(overlays->error());
    errors.push_back(world_.error());
    errors.push_back(command_error_);
    errors.push_back(edit_.error());
    errors.push_back(gizmo_.error());
    errors.push_back(recording_.error());
    std::string text;
    for (const std::string& error : errors)
      if (!error.empty()) text += (text.empty() ? "" : "\n") + printable_lines(error);
    if (text.empty()) return;
    // At the bottom, where no legend is, on a ground of its own.
    const float margin = 12.0f, width = ImGui::GetWindowWidth() - 2.0f * margin;
    const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, width);
    const ImVec2 window = ImGui::GetWindowPos();
    const ImVec2 at(window.x + margin, window.y + ImGui::GetWindowHeight() - size.y - margin);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled({at.x - 6.0f, at.y - 5.0f}, {at.x + size.x + 6.0f, at.y + size.y + 5.0f},
                       IM_COL32(30, 10, 10, 225), 4.0f);
    list.AddText(nullptr, 0.0f, at, IM_COL32(255, 130, 115, 255), text.c_str(), nullptr, width);
  }

  void draw_side(const ImVec2& at, const ImVec2& size) {
    place(at, size);
    ImGui::Begin("side", nullptr, fixed_window);
    std::vector<ShownRun*> runs;
    for (const std::unique_ptr<ShownRun>& run : runs_) runs.push_back(run.get());
    side_.draw(runs, shown(), main_, edit_, world_);
    ImGui::End();
  }

  void draw_status() {
    const std::string text = fmt::format("{}   {:.0f} frames/s   picture {:.0f} ms", recording_.status_text(),
                                         ImGui::GetIO().Framerate, main_.picture_ms());
    ImGui::SameLine(ImGui::GetWindowWidth() - ImGui::CalcTextSize(text.c_str()).x - scaled(12.0f));
    ImGui::TextDisabled("%s", text.c_str());
  }

  void draw_help() {
    ImGui::SetNextWindowPos({80.0f, 60.0f}, ImGuiCond_Appearing);
    if (ImGui::Begin("Keys and mouse", &help_open_, ImGuiWindowFlags_AlwaysAutoResize)) {
      ImGui::TextUnformatted(
          "In the scene: drag left to orbit, right to look around, middle (or shift and left) to move;\n"
          "the wheel comes nearer; W A S D fly, E and Q rise and sink, shift is four times as fast;\n"
          "a click says what is there; the cursor over a path shows its row.");
      ImGui::Separator();
      commands_.draw_help();
    }
    ImGui::End();
  }

  void add_commands() {
    const auto all = [this](auto act) {
      return [this, act](const std::string&) {
        for (const std::unique_ptr<ShownRun>& run : runs_) act(run->run());
      };
    };
    commands_.add({"quit", "Run", "Quit", "ctrl+q", [this](const std::string&) { quit_ = true; }, {}, {}});
    commands_.add({"play",
                   "Run",
                   "Play or pause",
                   "space",
                   all([](Run& run) { run.play(!run.status().playing); }),
                   [this] { return shown().run().status().playing; },
                   {}});
    commands_.add({"step", "Run", "Next tick", "right", all([](Run& run) { run.step(1); }), {}, {}});
    commands_.add({"back", "Run", "Previous tick", "left", all([](Run& run) { run.step(-1); }), {}, {}});
    commands_.add({"first",
                   "Run",
                   "First tick",
                   "home",
                   all([](Run& run) { run.jump(run.status().sequence, 0); }),
                   {},
                   {}});
    commands_.add(
        {"tick", "Run", "Go to tick 0", "", [this](const std::string& argument) { jump(argument); }, {}, {}});
    commands_.add({"outside",
                   "View",
                   "See all of the scene",
                   "f",
                   [this](const std::string&) { main_.look_from_outside(); },
                   {},
                   [this] { return main_.has_scene(); }});
    commands_.add({"camera",
                   "View",
                   "Fly freely",
                   "escape",
                   [this](const std::string& argument) { look_through(argument); },
                   [this] { return !main_.camera(); },
                   {}});
    commands_.add({"follow",
                   "View",
                   "Follow nothing",
                   "",
                   [this](const std::string& argument) { follow(argument); },
                   [this] { return !main_.followed(); },
                   {}});
    commands_.add({"panel",
                   "View",
                   "Panels: choose in their tab",
                   "",
                   [this](const std::string& title) { side_.grid().toggle(title); },
                   {},
                   [this] { return shown().info() != nullptr; }});
    commands_.add({"tab",
                   "View",
                   "Tabs: click them",
                   "",
                   [this](const std::string& name) { side_.open_tab(name); },
                   {},
                   [this] { return shown().info() != nullptr; }});
    commands_.add({"panels.close",
                   "View",
                   "Close all panels",
                   "",
                   [this](const std::string&) { side_.grid().close(); },
                   {},
                   {}});
    add_switch(commands_, "side", "View", "Panels", "tab", side_open_);
    commands_.add({"times",
                   "View",
                   "Where the time goes",
                   "F3",
                   [this](const std::string&) { open_tab("Times"); },
                   {},
                   {}});
    add_switch(commands_, "every-tick", "Run", "Show every tick of a slow run", "", every_tick_);
    add_switch(commands_, "legend", "Show", "Legend", "l", main_.show_legend());
    recording_.add_commands(commands_);
    settings_.add_commands(commands_);
    add_overlay_commands();
    add_world_commands();
    add_switch(commands_, "help", "Help", "Keys and mouse", "F1", help_open_);
  }

  void open_tab(const std::string& name) {
    side_open_ = true;
    side_.open_tab(name);
  }

  void add_edit_commands() {
    const auto possible = [this] { return edit_.document() != nullptr; };
    const auto add = [&](const char* name, const char* label, const char* key,
                         std::function<void(const std::string&)> act) {
      commands_.add({name, "Edit", label, key, std::move(act), {}, possible});
    };
    add("undo", "Undo", "ctrl+z", [this](const std::string&) { edit_.undo(); });
    add("redo", "Redo", "ctrl+y", [this](const std::string&) { edit_.redo(); });
    add("save", "Save the scenario", "ctrl+s", [this](const std::string& file) { edit_.save(file); });
    add("copy-command", "Copy the command line", "",
        [this](const std::string&) { ImGui::SetClipboardText(edit_.command().c_str()); });
    add("reload", "Read the scenario's files again", "ctrl+r",
        [this](const std::string&) { edit_.reload(); });
    add("set", "Set a value: in the tab Edit", "", [this](const std::string& words) {
      const auto [path, value] = split(words);
      edit_.change({YamlChange::Kind::set, parse_yaml_path(path), value});
    });
    add("insert", "Insert an item: in the tab Edit", "", [this](const std::string& words) {
      const auto [path, value] = split(words);
      edit_.change({YamlChange::Kind::insert, parse_yaml_path(path), value});
    });
    add("unset", "Use a default: in the tab Edit", "", [this](const std::string& path) {
      edit_.change({YamlChange::Kind::remove, parse_yaml_path(path), ""});
    });
    add("set-material", "Set a radio material: in the tab Edit", "", [this](const std::string& words) {
      const auto [name, value] = split(words);
      edit_.change_materials({{YamlChange::Kind::set, {YamlStep("materials"), YamlStep(name)}, value}});
    });
    add("select", "Select a node to move: click its handle", "",
        [this](const std::string& node) { gizmo_.select(edit_, node); });
    add_switch(commands_, "gizmo", "Edit", "Handles to move and turn", "g", gizmo_.on);
  }

  /// "PATH VALUE" of a script.
  static std::pair<std::string, std::string> split(const std::string& words) {
    const size_t space = words.find(' ');
    if (space == std::string::npos)
      throw_user_error("expected a path and a value, found '{}'", printable(words));
    return {words.substr(0, space), words.substr(space + 1)};
  }

  void add_overlay_commands() {
    struct Switch {
      const char *name, *label, *key;
      bool OverlaySettings::*value;
    };
    static constexpr Switch switches[] = {
        {"show.paths", "Radio paths", "1", &OverlaySettings::paths},
        {"show.lidar", "LiDAR points", "2", &OverlaySettings::lidar},
        {"show.radar", "Radar detections", "3", &OverlaySettings::radar},
        {"show.boxes", "Boxes of objects", "4", &OverlaySettings::boxes},
        {"show.trajectories", "Trajectories", "5", &OverlaySettings::trajectories},
        {"show.sensors", "Sensors and antennas", "6", &OverlaySettings::sensors},
        {"show.events", "Events of a camera", "7", &OverlaySettings::events}};
    for (const Switch& s : switches)
      commands_.add({s.name, "Show", s.label, s.key,
                     [this, s](const std::string& argument) { switch_overlay(s.name, s.value, argument); },
                     [this, s] { return shown().overlays() && shown().overlays()->settings().*s.value; },
                     [this] { return shown().overlays() != nullptr; }});
  }

  /// Overlays of the experiment.
  void add_world_commands() {
    WorldSettings& s = world_.settings();
    const auto add = [&](const char* name, const char* label, const char* key, bool& value) {
      add_switch(commands_, name, "Show", label, key, value);
      count_changes(commands_, s.version);
    };
    add("show.ways", "Whole ways of the nodes", "8", s.courses);
    add("show.facets", "Facets of radio", "9", s.facets);
    add("show.wedges", "Wedges that diffract", "0", s.wedges);
    add("show.map", "Radio map", "", s.map);
    add("show.tubes", "Fresnel zone of the pinned path", "", s.tubes);
    add_choices();
    const auto is_there = [this] { return shown().experiment() != nullptr && shown().run().shown(); };
    commands_.add({"map",
                   "Run",
                   "Compute a radio map of this tick",
                   "",
                   [this](const std::string& argument) { compute_map(argument); },
                   {},
                   is_there});
    commands_.add({"pin",
                   "View",
                   "Pin the strongest path",
                   "",
                   [this](const std::string& rank) { pin_path(rank); },
                   {},
                   is_there});
  }

  /// Colours by name; without a name, the next ones.
  void add_choices() {
    commands_.add(
        {"lidar.colors",
         "Show",
         "LiDAR points: other colours",
         "",
         [this](const std::string& name) {
           if (shown().overlays() == nullptr) return;
           OverlaySettings& s = shown().overlays()->settings();
           choose("lidar.colors", name, {"height", "intensity", "ring", "instance"}, s.cloud.colors);
           ++s.version;
         },
         {},
         {}});
    commands_.add({"facets.colors",
                   "Show",
                   "Facets: other colours",
                   "",
                   [this](const std::string& name) {
                     WorldSettings& s = world_.settings();
                     choose("facets.colors", name, {"kind", "material"}, s.radio.colors);
                     ++s.version;
                   },
                   {},
                   {}});
    commands_.add({"show.cells",
                   "Show",
                   "Resolution cells of detections",
                   "",
                   [this](const std::string& argument) {
                     if (!argument.empty() && argument != "on" && argument != "off")
                       throw_user_error("show.cells: expected on or off, found '{}'", printable(argument));
                     if (shown().overlays() == nullptr) return;
                     OverlaySettings& s = shown().overlays()->settings();
                     s.detections.cells = argument.empty() ? !s.detections.cells : argument == "on";
                     ++s.version;
                   },
                   [this] { return shown().overlays() && shown().overlays()->settings().detections.cells; },
                   {}});
  }

  void compute_map(const std::string& words) {
    parse_map_words(words, world_.settings());
    world_.compute_map(*shown().run().shown(), chosen_channel());
  }
  void pin_path(const std::string& rank) {
    if (rank == "off") return main_.pin(0);
    const auto number = parse_number(rank.empty() ? "1" : rank);
    if (!number || *number < 1.0 || *number != std::floor(*number))
      throw_user_error("pin: expected 1 for the strongest path, 2 for the next, or off, found '{}'",
                       printable(rank));
    if (shown().overlays() == nullptr) return;
    main_.pin(shown().overlays()->path_of_rank(shown().run().shown(), static_cast<size_t>(*number)));
  }

  void switch_overlay(const std::string& name, bool OverlaySettings::*value, const std::string& argument) {
    if (!argument.empty() && argument != "on" && argument != "off")
      throw_user_error("{}: expected on or off, found '{}'", name, printable(argument));
    for (const std::unique_ptr<ShownRun>& run : runs_) {
      if (run->overlays() == nullptr) continue;
      OverlaySettings& settings = run->overlays()->settings();
      settings.*value = argument.empty() ? !(settings.*value) : argument == "on";
      ++settings.version;
    }
  }

  /// Menu entries for each camera and each node that moves.
  void add_camera_commands(const sim::Experiment& experiment) {
    for (uint32_t n = 0; n < experiment.scenario.nodes.size(); ++n) {
      const sim::NodeConfig& node = experiment.scenario.nodes[n];
      for (const sim::SensorConfig& sensor : node.sensors) {
        const std::string name = node.name + "/" + sensor.name;
        if (apps::can_look_through(sensor))
          commands_.add({"camera " + name,
                         "View",
                         "Through " + name,
                         "",
                         [this, name](const std::string&) { look_through(name); },
                         {},
                         {}});
      }
      if (experiment.world->body_of_node[n] != 0)
        commands_.add({"follow " + node.name,
                       "View",
                       "Follow " + node.name,
                       "",
                       [this, name = node.name](const std::string&) { follow(name); },
                       [this, n] { return main_.followed() == n; },
                       {}});
    }
  }

  void jump(const std::string& argument) {
    const auto tick = parse_number(argument.empty() ? "0" : argument);
    if (!tick || *tick < 0.0 || *tick != std::floor(*tick))
      throw_user_error("tick: expected a tick's number, found '{}'", printable(argument));
    for (const std::unique_ptr<ShownRun>& run : runs_)
      run->run().jump(run->run().status().sequence, static_cast<int64_t>(*tick));
  }
  void look_through(const std::string& camera) {
    if (camera.empty())
      main_.look_through({});
    else
      main_.look_through(apps::find_camera(camera, need_experiment().scenario));
  }
  void follow(const std::string& name) {
    if (name.empty()) return main_.follow({});
    const std::vector<sim::NodeConfig>& nodes = need_experiment().scenario.nodes;
    const auto found = std::ranges::find(nodes, name, &sim::NodeConfig::name);
    if (found == nodes.end()) throw_user_error("follow: expected a node, found '{}'", printable(name));
    main_.follow(static_cast<uint32_t>(found - nodes.begin()));
  }
  const sim::Experiment& need_experiment() {
    if (shown().experiment() == nullptr) throw_user_error("the scene is not there yet");
    return *shown().experiment();
  }

  ScriptHost script_host() {
    return {
        [this] {
          const RunStatus status = shown().run().status();
          if (edit_.busy()) return false;
          return status.phase == RunStatus::Phase::failed ||
                 (status.phase == RunStatus::Phase::ready && shown().run().shown() != nullptr);
        },
        [this] {
          return main_.settled() && world_.idle() && drawn_ != nullptr && drawn_ == shown().run().shown();
        },
        [this] { return shown().run().status().tick; },
        [this](const InputEvent& event) { window_->inject(event); },
        [this](const std::string& command, const std::string& argument) { commands_.run(command, argument); },
        [this](const std::string& file) { write_screenshot(options_.script_folder / file); },
        [this](const std::string& fact) { print(fact); },
        [this] {
          return FrameContent{drawn_, main_.picture(), main_.asked()};
        },
        [this] { window_->finish(); },
        [this]() -> Run& { return shown().run(); }};
  }

  void write_screenshot(const std::filesystem::path& file) {
    io::write_file_atomically(file, io::encode_png(window_->screenshot()));
  }

  void print(const std::string& fact) {
    const RunStatus status = shown().run().status();
    if (fact == "tick") {
      std::cout << status.tick << '\n';
    } else if (fact == "error") {
      const std::string& error = status.error.empty() ? edit_.error() : status.error;
      std::cout << (error.empty() ? "none" : error) << '\n';
    } else if (fact == "picked") {
      for (const auto& [name, value] : main_.picked_facts(side_.carrier_hz(shown())))
        std::cout << name << ": " << value << '\n';
      if (!main_.picked()) std::cout << "nothing\n";
    } else if (fact == "hovered") {
      std::cout << fmt::format("{:016x}\n", main_.hovered_id());
    } else if (fact == "path") {
      print_path();
    } else if (fact == "scenario") {
      std::cout << (edit_.document() != nullptr ? edit_.document()->text() : "none\n");
    } else if (fact == "command") {
      std::cout << edit_.command() << '\n';
    } else if (fact == "handle") {
      std::cout << gizmo_.arrows();
    } else if (fact == "comparison") {
      print_comparison();
    } else {
      throw_user_error(
          "print: expected tick, error, picked, hovered, path, scenario, command, handle or comparison, "
          "found "
          "'{}'",
          printable(fact));
    }
    std::cout.flush();
  }

  void print_path() {
    const std::shared_ptr<const ShownTick> tick = shown().run().shown();
    const std::optional<PathStory> story = tick ? pinned_story(*tick) : std::nullopt;
    if (!story) std::cout << "nothing\n";
    if (story)
      for (const std::string& line : words_of(*story)) std::cout << line << '\n';
  }

  void print_comparison() {
    if (!edit_.comparison()) {
      std::cout << "none\n";
      return;
    }
    std::cout << edit_.comparison()->label << ", tick " << edit_.comparison()->tick << '\n';
    for (const Difference& row : edit_.comparison()->rows)
      std::cout << row.sensor << ' ' << row.array << ": " << (row.equal ? "equal" : row.text) << '\n';
  }

  static constexpr ImGuiWindowFlags fixed_window =
      ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
      ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus;

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

}  // namespace

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
