// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Prints --help. CLI11 holds the commands, their options and the checks of the options; this file turns them
// into text of at most 100 columns. An option becomes
//
//   --threads N                 threads that encode and write (0 to 1024) [0]
//
// with the range of its values in parentheses and its default in brackets. A choice among names stands in the
// left column: --tracer auto|driver|tree.
#pragma once

#include <memory>
#include <string>

#include <CLI/CLI.hpp>

namespace greatx::apps {

/// Returns the values that an option takes: "N" for integers, "X" for other numbers, the names with a stroke
/// between them for a choice, else the name of its type, such as "FILE". Returns an empty text for a flag.
std::string value_of(const CLI::Option& option);
/// Returns the range of the option's values, "0 to 1024" or "0 or more"; an empty text if it has none.
std::string range_of(const CLI::Option& option);

/// Gives the texts that options of all commands take names of their own: FILE, DIR, NAME and the like. Must
/// be called after all commands have been added.
void name_values(CLI::App& app);

/// Returns the formatter. Commands inherit it from the program if they are added after it is set.
std::shared_ptr<CLI::FormatterBase> help_formatter();

}  // namespace greatx::apps
