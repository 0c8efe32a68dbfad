// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "apps/console/exit_code.h"

namespace greatx::apps {

/// Says on stderr why a command ended, and returns the exit code of the program. Call it in a catch block.
/// `program` begins the message.
int report_exception(const std::string& program);

/// Directs all messages to stderr. Only results go to stdout, so that --json prints one object and nothing
/// else there.
void set_up_logging(const std::string& program);

}  // namespace greatx::apps
