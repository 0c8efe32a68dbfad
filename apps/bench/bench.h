// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The command `greatx bench`: times a scenario, or one of its parts by a benchmark of its own.
#pragma once

#include <CLI/CLI.hpp>

namespace greatx::apps {

/// Adds the command and its options to the command line.
void add_bench(CLI::App& app);

}  // namespace greatx::apps
