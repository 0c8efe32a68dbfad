// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/app/commands.h"

#include <algorithm>
#include <imgui.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "core/expected.h"
#include "core/text.h"
#include "view/script/script.h"

namespace greatx::view {

namespace {

bool is_possible(const Command& command) { return !command.enabled || command.enabled(); }

/// The key without modifiers, and whether the modifiers that are held are those that it names.
struct Key {
  int code = 0;
  bool control = false, shift = false, alt = false;
};

Key parse_key(std::string name) {
  Key key;
  for (size_t plus; (plus = name.find('+')) != std::string::npos && plus + 1 < name.size();) {
    const std::string modifier = name.substr(0, plus);
    key.control |= modifier == "ctrl";
    key.shift |= modifier == "shift";
    key.alt |= modifier == "alt";
    name.erase(0, plus + 1);
  }
  key.code = key_of(name);
  return key;
}

bool is_pressed(const std::string& name) {
  const Key key = parse_key(name);
  const ImGuiIO& io = ImGui::GetIO();
  return key.code > 0 && io.KeyCtrl == key.control && io.KeyShift == key.shift && io.KeyAlt == key.alt &&
         ImGui::IsKeyPressed(key.code, false);
}

}  // namespace

void Commands::add(Command command) { commands_.push_back(std::move(command)); }

void Commands::remove(const std::string& prefix) {
  std::erase_if(commands_, [&](const Command& command) { return command.name.starts_with(prefix); });
}

void Commands::run(const std::string& name, const std::string& argument) const {
  const auto found = std::ranges::find(commands_, name, &Command::name);
  if (found == commands_.end()) {
    std::vector<std::string> names;
    for (const Command& command : commands_) names.push_back(command.name);
    throw_user_error("expected a command of the viewer, found '{}'{}", printable(name),
                     suggestion(name, names));
  }
  if (!is_possible(*found)) throw_user_error("the command '{}' is not possible now", name);
  found->run(argument);
}

void Commands::draw_menus() const {
  std::vector<std::string_view> menus;
  for (const Command& command : commands_)
    if (std::ranges::find(menus, command.menu) == menus.end()) menus.push_back(command.menu);
  for (const std::string_view menu : menus) {
    if (!ImGui::BeginMenu(std::string(menu).c_str())) continue;
    for (const Command& command : commands_) {
      if (command.menu != menu) continue;
      const bool on = command.on && command.on();
      if (ImGui::MenuItem(command.label.c_str(), command.key.empty() ? nullptr : command.key.c_str(), on,
                          is_possible(command)))
        command.run("");
    }
    ImGui::EndMenu();
  }
}

void Commands::run_keys() const {
  if (ImGui::GetIO().WantTextInput) return;
  for (const Command& command : commands_)
    if (!command.key.empty() && is_possible(command) && is_pressed(command.key)) command.run("");
}

void Commands::draw_help() const {
  if (!ImGui::BeginTable("keys", 3, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingFixedFit)) return;
  for (const Command& command : commands_) {
    if (command.key.empty()) continue;
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(command.key.c_str());
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(command.label.c_str());
    ImGui::TableNextColumn();
    ImGui::TextDisabled("%s", command.menu.c_str());
  }
  ImGui::EndTable();
}

void add_switch(Commands& commands, const std::string& name, const std::string& menu,
                const std::string& label, const std::string& key, bool& value) {
  commands.add({name,
                menu,
                label,
                key,
                [name, &value](const std::string& argument) {
                  if (!argument.empty() && argument != "on" && argument != "off")
                    throw_user_error("{}: expected on or off, found '{}'", name, printable(argument));
                  value = argument.empty() ? !value : argument == "on";
                },
                [&value] { return value; },
                {}});
}

size_t chosen_place(const char* command, const std::string& name, const std::vector<std::string>& names,
                    size_t now) {
  if (name.empty()) return (now + 1) % names.size();
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) throw_user_error("{}: {}", command, expected_one_of(names, name));
  return static_cast<size_t>(found - names.begin());
}

void count_changes(Commands& commands, uint64_t& version) {
  Command& command = commands.last();
  command.run = [run = command.run, &version](const std::string& argument) {
    run(argument);
    ++version;
  };
}

}  // namespace greatx::view
