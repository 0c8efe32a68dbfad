// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Keeps the engine's log messages for Python's logging, which cannot be called from threads that must not
// wait for the interpreter.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace greatx::python {

/// Begins to keep all messages that the engine logs, in any thread, until take_log() is called.
void keep_log();
/// Returns the kept messages in order, as (level of Python's logging, text), and discards them here.
std::vector<std::pair<int, std::string>> take_log();

}  // namespace greatx::python
