// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace greatx::apps {

/// Exit codes: 0 all well; 1 the input or the data is at fault; 2 the program or the device is; 130, as a
/// shell has it of Ctrl-C: somebody stopped it.
enum ExitCode : int { exit_success = 0, exit_user = 1, exit_internal = 2, exit_interrupted = 130 };

/// A command that ran to its end and found something wrong (verify): its exit code, nothing more to print.
struct Failed {
  int code = exit_user;
};

}  // namespace greatx::apps
