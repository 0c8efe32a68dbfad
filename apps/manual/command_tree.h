// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The command line as data, from which the manual page and the completions of the shells are written:
//
//   CLI::App ─► CommandTree { options, positionals, commands } ─► manual_page(), completion(shell)
//
// CLI11's own description is the only source. A new command or option is therefore in all of them.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace greatx::apps {

/// Describes an option or a positional argument.
struct CommandArgument {
  std::vector<std::string> names;  ///< "-o", "--output"; of a positional: its name, "SCENARIO"
  std::string type;     ///< "FILE", "NAME", "N" (an integer), "X" (a number), …; empty for a flag
  std::string range;    ///< "1 to 1000", or empty
  std::string initial;  ///< the value without the option, or empty
  std::vector<std::string> choices;  ///< the values that are allowed, or that are known by name
  std::string words;                 ///< what it means
  bool files = false;                ///< whether a name of a file or folder may stand here
  bool required = false, repeats = false;
  bool takes_value() const { return !type.empty(); }
};

struct CommandTree {
  std::vector<std::string> path;  ///< "greatx", "scene", "city"
  std::string words, footer;
  std::vector<CommandArgument> options, positionals;
  std::vector<CommandTree> commands;
  const std::string& name() const { return path.back(); }
};

/// Returns the commands, options and arguments that --help shows. `scenarios` are the names that a SCENARIO
/// may have besides those of files.
CommandTree command_tree(const CLI::App& app, const std::vector<std::string>& scenarios);

/// Returns the words of a path, separated: "greatx scene city" for ' '.
std::string joined(const std::vector<std::string>& path, char separator);

/// Returns the tree's commands one below the other, each before its own commands.
std::vector<const CommandTree*> all_commands(const CommandTree& root);

}  // namespace greatx::apps
