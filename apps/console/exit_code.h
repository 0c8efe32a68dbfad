// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace greatx::apps {

/// Exit codes: 0 success; 1 faulty input or data; 2 failure of the program or the device; 130 interrupted, as
/// shells report Ctrl-C.
enum ExitCode : int { exit_success = 0, exit_user = 1, exit_internal = 2, exit_interrupted = 130 };

/// Thrown by a command that ran to its end and found a fault (verify). It carries the exit code; nothing more
/// is printed.
struct Failed {
  int code = exit_user;
};

}  // namespace greatx::apps
