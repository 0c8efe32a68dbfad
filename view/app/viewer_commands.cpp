// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <imgui.h>
#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "sim/plan/camera_desc.h"
#include "view/app/viewer_window.h"

namespace greatx::view {

namespace {

/// "PATH VALUE" of a script.
std::pair<std::string, std::string> split(const std::string& words) {
  const size_t space = words.find(' ');
  if (space == std::string::npos)
    throw_user_error("expected a path and a value, found '{}'", printable(words));
  return {words.substr(0, space), words.substr(space + 1)};
}

}  // namespace

void Viewer::add_commands() {
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
  add_view_commands();
  recording_.add_commands(commands_);
  settings_.add_commands(commands_);
  add_overlay_commands();
  add_world_commands();
  add_switch(commands_, "help", "Help", "Keys and mouse", "F1", help_open_);
}

void Viewer::add_view_commands() {
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
}

void Viewer::open_tab(const std::string& name) {
  side_open_ = true;
  side_.open_tab(name);
}

void Viewer::add_edit_commands() {
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
  add("reload", "Read the scenario's files again", "ctrl+r", [this](const std::string&) { edit_.reload(); });
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

void Viewer::add_camera_commands(const sim::Experiment& experiment) {
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

void Viewer::jump(const std::string& argument) {
  const auto tick = parse_number(argument.empty() ? "0" : argument);
  if (!tick || *tick < 0.0 || *tick != std::floor(*tick))
    throw_user_error("tick: expected a tick's number, found '{}'", printable(argument));
  for (const std::unique_ptr<ShownRun>& run : runs_)
    run->run().jump(run->run().status().sequence, static_cast<int64_t>(*tick));
}

void Viewer::look_through(const std::string& camera) {
  if (camera.empty())
    main_.look_through({});
  else
    main_.look_through(apps::find_camera(camera, need_experiment().scenario));
}

void Viewer::follow(const std::string& name) {
  if (name.empty()) return main_.follow({});
  const std::vector<sim::NodeConfig>& nodes = need_experiment().scenario.nodes;
  const auto found = std::ranges::find(nodes, name, &sim::NodeConfig::name);
  if (found == nodes.end()) throw_user_error("follow: expected a node, found '{}'", printable(name));
  main_.follow(static_cast<uint32_t>(found - nodes.begin()));
}

const sim::Experiment& Viewer::need_experiment() {
  if (shown().experiment() == nullptr) throw_user_error("the scene is not there yet");
  return *shown().experiment();
}

}  // namespace greatx::view
