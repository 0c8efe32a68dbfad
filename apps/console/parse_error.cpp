// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/console/parse_error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/text.h"

namespace greatx::apps {

namespace {

/// Returns the innermost command that the line names.
const CLI::App& innermost(const CLI::App& app) {
  const CLI::App* at = &app;
  while (!at->get_subcommands().empty()) at = at->get_subcommands().front();
  return *at;
}

/// Returns "greatx scene city".
std::string full_name(const CLI::App& command) {
  return command.get_parent() == nullptr ? command.get_name()
                                         : full_name(*command.get_parent()) + ' ' + command.get_name();
}

std::vector<std::string> commands_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* below : command.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(below->get_name());
  return names;
}

std::string unknown_command(const CLI::App& command, const std::string& name) {
  const std::vector<std::string> names = commands_of(command);
  const std::string parent = command.get_parent() == nullptr ? "" : fmt::format("{} ", command.get_name());
  std::string hint = suggestion(name, names);  // " (did you mean 'x'?)"
  hint = hint.empty() ? fmt::format("; there are {}", fmt::join(names, ", "))
                      : fmt::format(", {}", hint.substr(2, hint.size() - 3));
  return fmt::format("no command '{}{}'{}", parent, printable(name), hint);
}

std::string unknown_option(const CLI::App& command, const std::string& argument) {
  const std::string name = argument.substr(0, argument.find('='));
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options([](const CLI::Option*) { return true; })) {
    for (const std::string& text : option->get_lnames()) names.push_back("--" + text);
    // A short name with a second hyphen (--o) is not worth a guess by letters.
    for (const std::string& text : option->get_snames())
      if (name == "--" + text)
        return fmt::format("{} has no option '{}' (did you mean '-{}'?)", full_name(command), printable(name),
                           text);
  }
  return fmt::format("{} has no option '{}'{}", full_name(command), printable(name), suggestion(name, names));
}

/// Describes an argument that no positional takes.
std::string left_over(const CLI::App& command, const std::string& argument) {
  for (const CLI::Option* option : command.get_options([](const CLI::Option*) { return true; }))
    if (option->get_positional() && option->count() > 0)
      return fmt::format("{} takes no '{}' beside '{}'", full_name(command), printable(argument),
                         printable(option->results().front()));
  return fmt::format("{} takes no argument, found '{}'", full_name(command), printable(argument));
}

/// Describes the first option or positional that must be there and is not; returns an empty text if all are.
std::string missing_option(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options([](const CLI::Option*) { return true; })) {
    if (!option->get_required() || option->count() > 0) continue;
    return fmt::format("{}: expected {} ({}), found none", full_name(command), option->get_name(),
                       option->get_description());
  }
  return "";
}

/// Returns the words of CLI11 in those of greatx. `message` begins with the name of the option.
std::string plain_words(const CLI::ParseError& error) {
  const std::string message = error.what(), name = error.get_name();
  const auto between = [&](const std::string& before, const std::string& after) {
    const size_t begin = message.find(before);
    if (begin == std::string::npos) return std::string();
    const size_t from = begin + before.size();
    return message.substr(from, after.empty() ? std::string::npos : message.find(after, from) - from);
  };
  const std::string option = message.substr(0, message.find_first_of(": "));
  if (name == "ArgumentMismatch") {
    const std::string found = between("but received ", "");
    if (message.ends_with("missing")) return option + ": expected a value, found none";
    if (const std::string most = between("At Most ", " required"); !most.empty())
      return fmt::format("{}: expected {} value{}, found {}", option, most, most == "1" ? "" : "s", found);
    if (const std::string least = between("At least ", " required"); !least.empty())
      return fmt::format("{}: expected {} values, found {}", option, least, found);
  }
  if (name == "ConversionError")
    if (const std::string what = between("Could not convert: ", " = "); !what.empty())
      return fmt::format("{}: expected a number, found '{}'", what, printable(between(" = ", "")));
  if (name == "RequiresError")
    return fmt::format("{}: expected {} with it, found none", option, between(" requires ", ""));
  if (name == "ExcludesError")
    return fmt::format("{}: expected no {} beside it", option, between(" excludes ", ""));
  return message;
}

std::string words(const CLI::App& app, const CLI::App& command, const CLI::ParseError& error) {
  const std::vector<std::string> left = app.remaining(true);
  const bool needs_command = command.get_require_subcommand_min() > 0;
  if (!left.empty()) {
    const std::string& first = left.front();
    const bool option = first.size() > 1 && first.front() == '-';
    if (option) return unknown_option(command, first);
    return needs_command ? unknown_command(command, first) : left_over(command, first);
  }
  if (error.get_name() == "RequiredError") {
    if (needs_command && command.get_subcommands().empty())
      return fmt::format("expected a command ({}), found none", fmt::join(commands_of(command), ", "));
    if (const std::string missing = missing_option(command); !missing.empty()) return missing;
  }
  return plain_words(error);
}

}  // namespace

std::string parse_error_words(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& command = innermost(app);
  return fmt::format("{}\n`{} --help` tells what there is.", words(app, command, error), full_name(command));
}

}  // namespace greatx::apps
