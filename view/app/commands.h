// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The commands of the viewer: each has a name, a place in the menus and perhaps a key. Menus, keys and
// scripts run the same table, so that whatever a person can do, a script can do too.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace greatx::view {

struct Command {
  std::string name;   ///< for scripts: "play", "show.paths"
  std::string menu;   ///< "Run", "View", "Show", "Help"
  std::string label;  ///< in the menu
  std::string key;    ///< as scripts write it ("space", "ctrl+s"); empty: none
  /// Runs the command. `argument` comes from a script and is empty from menus and keys. Throws UserError if
  /// the argument is not as expected.
  std::function<void(const std::string& argument)> run;
  /// Whether the menu shows a tick; empty: the command is no switch.
  std::function<bool()> on;
  std::function<bool()> enabled;  ///< empty: always
};

class Commands {
 public:
  void add(Command command);
  /// Takes away the commands of a menu whose names begin with `prefix`.
  void remove(const std::string& prefix);
  const std::vector<Command>& all() const { return commands_; }
  /// Runs a command by its name. Throws UserError if there is none, or if it is not possible now.
  void run(const std::string& name, const std::string& argument) const;
  /// Draws the menu bar's menus, in the order in which their first commands were added.
  void draw_menus() const;
  /// Runs the commands whose keys were pressed in this frame.
  void run_keys() const;
  /// Draws the table of keys.
  void draw_help() const;

 private:
  std::vector<Command> commands_;
};

/// Adds a command that switches `value`. Its argument may be "on" or "off".
void add_switch(Commands& commands, const std::string& name, const std::string& menu,
                const std::string& label, const std::string& key, bool& value);

}  // namespace greatx::view
