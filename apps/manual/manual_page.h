// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes the manual page greatx(1) from the tree of commands.
#pragma once

#include <string>

#include "apps/manual/command_tree.h"

namespace greatx::apps {

/// Returns the page in man(7), with every command. It has no date, so that a version has one page.
std::string manual_page(const CommandTree& root, const std::string& version);

}  // namespace greatx::apps
