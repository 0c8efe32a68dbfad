// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes the completions of shells from the tree of commands. Each script completes commands, nested
// commands, options, the values of options that allow only some, names of embedded scenarios, and names of
// files where a file or folder may stand. After an option that takes a number it offers nothing.
#pragma once

#include <string>

#include "apps/manual/command_tree.h"

namespace greatx::apps {

/// Returns a script for bash 4.4 or newer. It needs no bash-completion.
std::string bash_completion(const CommandTree& root);
/// Returns a function for zsh's completion system: a file _greatx in a folder of $fpath, or sourced.
std::string zsh_completion(const CommandTree& root);
/// Returns a script for fish 3 or newer.
std::string fish_completion(const CommandTree& root);

}  // namespace greatx::apps
