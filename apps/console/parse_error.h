// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Says what is wrong with a command line that CLI11 refuses, and what was probably meant. CLI11 knows the
// commands, the options and what is left over; its own words say neither what was expected nor what is near.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace greatx::apps {

/// Returns the message for `error`, which came from parsing a command line with `app`:
///   no command 'generat', did you mean 'generate'?
///   greatx generate has no option '--tikcs' (did you mean '--ticks'?)
///   greatx generate takes no 'canyon' beside 'city'
///   greatx inspect: expected DIR, folder of the data set; found none
/// and, in a second line, how to see what there is.
std::string parse_error_words(const CLI::App& app, const CLI::ParseError& error);

}  // namespace greatx::apps
