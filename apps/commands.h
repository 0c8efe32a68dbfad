// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The sub-commands of greatx. Each adds its options to the command line; the callback that CLI11 runs does the work
// and throws what goes wrong.
#pragma once

#include <CLI/CLI.hpp>

namespace greatx::apps {

void add_info(CLI::App& app);
void add_generate(CLI::App& app);
void add_inspect(CLI::App& app);
void add_verify(CLI::App& app);
void add_scene(CLI::App& app);
void add_explain(CLI::App& app);
void add_paths(CLI::App& app);
void add_map(CLI::App& app);
void add_bench(CLI::App& app);

/// Exit codes: 0 all well; 1 the input or the data is at fault; 2 the program or the device is; 130, as a shell has it of
/// Ctrl-C: somebody stopped it.
enum ExitCode : int { exit_success = 0, exit_user = 1, exit_internal = 2, exit_interrupted = 130 };

/// A command that ran to its end and found something wrong (verify): its exit code, nothing more to print.
struct Failed {
  int code = exit_user;
};

}  // namespace greatx::apps
