// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What CLI11 leaves loose: numbers that wrap or overflow, ranges in hundreds of digits, commands that do not
// exist.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace greatx::apps {

/// An option's check: "expected an integer of 1 or more, found '0'".
CLI::Validator integer_of(uint64_t low, uint64_t high = std::numeric_limits<int64_t>::max());
/// "expected a number of 0 or more, found '-1'".
CLI::Validator number_of(double low, double high = std::numeric_limits<double>::infinity());

/// Every option of a number, of every command, takes a decimal one that its type can hold, and finite: CLI11
/// takes -1 for 2^64 - 1, 010 for 8 and what is too large for the largest. To be called when all commands are
/// there.
void read_numbers_strictly(CLI::App& app);

/// "no command 'generat', did you mean 'generate'?" if that is what is wrong with `arguments`; empty if it is
/// not.
std::string unknown_command(const CLI::App& app, const std::vector<std::string>& arguments);

/// Throws UserError if what was printed did not reach standard output: a full disk behind it, a size limit.
void check_printed();

}  // namespace greatx::apps
