// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes the command line stricter than CLI11: numbers may not wrap or overflow, and messages show ranges and
// choices in a readable form. parse_error.h puts the other faults into words, and help.h prints --help.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace greatx::apps {

/// Returns a check of an option's range. Its message is, for example, "expected an integer of 1 or more,
/// found '0'".
CLI::Validator integer_of(uint64_t low, uint64_t high = std::numeric_limits<int64_t>::max());
/// Returns the same check for a real number: "expected a number of 0 or more, found '-1'".
CLI::Validator number_of(double low, double high = std::numeric_limits<double>::infinity());

/// Returns a check that the text is one of `names`: "expected one of none, fast, small, found 'gzip'".
CLI::Validator one_of(const std::vector<std::string>& names);
/// Returns a transform of the text into its place among `names`, for an option whose variable is an
/// enumeration in this order. The option shows a default of its own (default_str).
CLI::Validator index_in(const std::vector<std::string>& names);

/// Makes every numeric option of every command accept only finite decimal numbers that its type can hold.
/// CLI11 alone reads -1 as 2^64 - 1, 010 as 8, and a number that is too large as the largest one. Must be
/// called after all commands have been added.
void read_numbers_strictly(CLI::App& app);

/// Parses the option --size: "1280x720". Throws UserError.
std::pair<int, int> parse_window_size(const std::string& text);

/// Throws UserError if the output could not be written to standard output, for example because the disk is
/// full or a size limit is reached.
void check_printed();

}  // namespace greatx::apps
