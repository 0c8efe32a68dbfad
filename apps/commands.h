// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The sub-commands of greatx. Each function adds a command and its options to the command line. The callback
// that CLI11 runs does the work and throws on errors.
#pragma once

#include <CLI/CLI.hpp>

namespace greatx::apps {

void add_info(CLI::App& app);
void add_generate(CLI::App& app);
void add_campaign(CLI::App& app);
void add_cache(CLI::App& app);
void add_check(CLI::App& app);
void add_inspect(CLI::App& app);
void add_verify(CLI::App& app);
void add_scene(CLI::App& app);
void add_explain(CLI::App& app);
void add_paths(CLI::App& app);
void add_map(CLI::App& app);
void add_tradeoff(CLI::App& app);
void add_calibrate(CLI::App& app);
void add_view(CLI::App& app);
void add_selftest(CLI::App& app);
void add_rcs(CLI::App& app);
void add_manual(CLI::App& app);

}  // namespace greatx::apps
