// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace greatx {

/// Returns the commit from which the program was built, as Git abbreviates it, with "+changes" if files had
/// changed since; "unknown" in a build outside of a repository and in programs that do not say it.
const std::string& commit();
/// Called once, by main(), so that a new commit links the program again and nothing else.
void set_commit(std::string commit);

}  // namespace greatx
