// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/console/command_line.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iostream>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "core/text.h"

namespace greatx::apps {

namespace {

/// Returns the number if the whole text is a decimal one; none if it is not, or does not fit into T.
template <typename T>
std::optional<T> read(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  if (text.find_first_not_of("0123456789.eE+-") != std::string_view::npos) return std::nullopt;
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Returns a check that the text is a T. It rewrites integers without leading zeros, so that CLI11 does not
/// read them as octal.
template <typename T>
CLI::Validator strict(const char* expected) {
  return {[expected](std::string& text) {
            const std::optional<T> value = read<T>(text);
            if (!value) return fmt::format("expected {}, found '{}'", expected, text);
            if constexpr (std::is_integral_v<T>) text = fmt::format("{}", *value);
            return std::string();
          },
          ""};
}

template <typename T>
CLI::Validator ranged(T low, T high, T most, const char* kind) {
  const std::string range =
      high == most ? fmt::format("{} or more", low) : fmt::format("{} to {}", low, high);
  return {[=](std::string& text) {
            const std::optional<T> value = read<T>(text);
            if (value && *value >= low && *value <= high) return std::string();
            return fmt::format("expected {} {} {}, found '{}'", kind, high == most ? "of" : "from", range,
                               text);
          },
          range};
}

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

}  // namespace

CLI::Validator integer_of(uint64_t low, uint64_t high) {
  return ranged<uint64_t>(low, high, std::numeric_limits<int64_t>::max(), "an integer");
}

CLI::Validator number_of(double low, double high) {
  return ranged<double>(low, high, std::numeric_limits<double>::infinity(), "a number");
}

void read_numbers_strictly(CLI::App& app) {
  for (CLI::Option* option : app.get_options(std::function<bool(CLI::Option*)>())) {
    const std::string type = option->get_type_name();
    // The transforms run before the option's own checks.
    if (type.starts_with("UINT"))
      option->transform(strict<uint64_t>("an integer from 0 to 18446744073709551615"));
    else if (type.starts_with("INT"))
      option->transform(strict<int64_t>("an integer"));
    else if (type.starts_with("FLOAT"))
      option->transform(strict<double>("a finite number"));
  }
  for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; }))
    read_numbers_strictly(*command);
}

std::string unknown_command(const CLI::App& app, const std::vector<std::string>& arguments) {
  const CLI::App* at = &app;
  for (const std::string& argument : arguments) {
    if (argument.starts_with('-')) continue;
    const std::vector<const CLI::App*> commands = commands_of(*at);
    const auto found = std::find_if(commands.begin(), commands.end(),
                                    [&](const CLI::App* command) { return command->get_name() == argument; });
    if (found != commands.end()) {
      at = *found;
      continue;
    }
    if (commands.empty() || at->get_require_subcommand_min() == 0) return "";
    std::vector<std::string> names;
    for (const CLI::App* command : commands) names.push_back(command->get_name());
    std::string hint = suggestion(argument, names);  // " (did you mean 'x'?)"
    hint = hint.empty() ? fmt::format("; there are {}", fmt::join(names, ", "))
                        : fmt::format(", {}", hint.substr(2, hint.size() - 3));
    return fmt::format("no command '{}{}{}'{}", at == &app ? "" : at->get_name(), at == &app ? "" : " ",
                       argument, hint);
  }
  if (at->get_require_subcommand_min() == 0) return "";
  std::vector<std::string> names;
  for (const CLI::App* command : commands_of(*at)) names.push_back(command->get_name());
  return fmt::format("expected a command ({}), found none", fmt::join(names, ", "));
}

std::pair<int, int> parse_window_size(const std::string& text) {
  const size_t x = text.find('x');
  const auto part = [&](const std::string& digits) {
    const auto value = parse_number(digits);
    if (!value || *value < 64.0 || *value > 16384.0 || *value != static_cast<int>(*value))
      throw_user_error("--size: expected WIDTHxHEIGHT from 64 to 16384, found '{}'", printable(text));
    return static_cast<int>(*value);
  };
  return {part(text.substr(0, x)), part(x == std::string::npos ? "" : text.substr(x + 1))};
}

void check_printed() {
  std::cout.flush();
  if (!std::cout) throw_user_error("standard output: cannot be written");
}

}  // namespace greatx::apps
