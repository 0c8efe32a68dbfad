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
#include "core/expected.h"
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
CLI::Validator strict(const std::string& expected) {
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
  const auto words_of = [](T value) {
    if constexpr (std::is_integral_v<T>)
      return integer_words(value);
    else
      return number_words(value);
  };
  const std::string range = high == most ? fmt::format("{} or more", words_of(low))
                                         : fmt::format("{} to {}", words_of(low), words_of(high));
  return {[=](std::string& text) {
            const std::optional<T> value = read<T>(text);
            if (value && *value >= low && *value <= high) return std::string();
            return fmt::format("expected {} {} {}, found '{}'", kind, high == most ? "of" : "from", range,
                               text);
          },
          range};
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
      option->transform(strict<uint64_t>(integer_range(0, std::numeric_limits<uint64_t>::max())));
    else if (type.starts_with("INT"))
      option->transform(strict<int64_t>("an integer"));
    else if (type.starts_with("FLOAT"))
      option->transform(strict<double>("a finite number"));
  }
  for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; }))
    read_numbers_strictly(*command);
}

CLI::Validator one_of(const std::vector<std::string>& names) {
  return {[names](std::string& text) {
            if (std::ranges::find(names, text) != names.end()) return std::string();
            return expected_one_of(names, text);
          },
          fmt::format("{}", fmt::join(names, "|"))};
}

CLI::Validator index_in(const std::vector<std::string>& names) {
  return {[names](std::string& text) {
            const auto found = std::ranges::find(names, text);
            if (found == names.end()) return expected_one_of(names, text);
            text = fmt::format("{}", found - names.begin());
            return std::string();
          },
          fmt::format("{}", fmt::join(names, "|"))};
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
