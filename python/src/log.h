// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace greatx::python {

/// From now on what the engine logs is kept, from whatever thread, until it is taken: Python's logging cannot
/// be called from threads that may not wait for the interpreter.
void keep_log();
/// (level as Python's logging has it, text), in order; those are forgotten here.
std::vector<std::pair<int, std::string>> take_log();

}  // namespace greatx::python
