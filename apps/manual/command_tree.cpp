// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/manual/command_tree.h"

#include <algorithm>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace greatx::apps {

namespace {

/// Returns the values of a choice, whose type is, for example, "TEXT:auto|driver|tree".
std::vector<std::string> choices_of(const std::string& type) {
  std::vector<std::string> choices;
  const size_t colon = type.find(':');
  if (colon == std::string::npos || type.find('|', colon) == std::string::npos) return choices;
  for (size_t at = colon + 1; at <= type.size();) {
    const size_t end = std::min(type.find('|', at), type.size());
    choices.push_back(type.substr(at, end - at));
    at = end + 1;
  }
  return choices;
}

CommandArgument argument_of(const CLI::Option& option, const std::vector<std::string>& scenarios) {
  CommandArgument argument;
  for (const std::string& name : option.get_snames()) argument.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) argument.names.push_back("--" + name);
  const bool positional = argument.names.empty();
  if (positional) argument.names.push_back(option.get_name(true));
  argument.words = option.get_description();
  argument.required = option.get_required();
  if (option.get_expected_max() == 0 && !positional) return argument;  // a flag
  const std::string type = option.get_type_name();
  const size_t colon = type.find(':');
  argument.type = type.substr(0, colon);
  if (argument.type == "UINT" || argument.type == "INT") argument.type = "N";
  if (argument.type == "FLOAT") argument.type = "X";
  argument.choices = choices_of(type);
  if (argument.choices.empty() && colon != std::string::npos) argument.range = type.substr(colon + 1);
  argument.initial = option.get_default_str();
  argument.repeats = option.get_items_expected_max() > option.get_type_size_max();
  // name_values() of apps/console/help.h tells files and folders from other texts.
  const bool file = argument.type == "FILE" || argument.type == "DIR" || argument.type == "TEXT";
  argument.files = file && argument.choices.empty();
  if (positional && argument.names[0] == "SCENARIO") argument.choices = scenarios;
  return argument;
}

CommandTree tree_of(const CLI::App& app, std::vector<std::string> path,
                    const std::vector<std::string>& scenarios) {
  CommandTree tree;
  tree.path = std::move(path);
  tree.words = app.get_description();
  tree.footer = app.get_footer();
  for (const CLI::Option* option : app.get_options([](const CLI::Option*) { return true; })) {
    if (option->get_group().empty()) continue;  // hidden
    (option->nonpositional() ? tree.options : tree.positionals).push_back(argument_of(*option, scenarios));
  }
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_group().empty() || command->get_name().empty()) continue;
    std::vector<std::string> below = tree.path;
    below.push_back(command->get_name());
    tree.commands.push_back(tree_of(*command, std::move(below), scenarios));
  }
  return tree;
}

void collect(const CommandTree& tree, std::vector<const CommandTree*>& into) {
  into.push_back(&tree);
  for (const CommandTree& command : tree.commands) collect(command, into);
}

}  // namespace

CommandTree command_tree(const CLI::App& app, const std::vector<std::string>& scenarios) {
  return tree_of(app, {"greatx"}, scenarios);
}

std::string joined(const std::vector<std::string>& path, char separator) {
  return fmt::format("{}", fmt::join(path, std::string(1, separator)));
}

std::vector<const CommandTree*> all_commands(const CommandTree& root) {
  std::vector<const CommandTree*> all;
  collect(root, all);
  return all;
}

}  // namespace greatx::apps
