// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

namespace greatx::apps {

/// Adds `greatx scene check`.
void add_scene_check(CLI::App& scene_command);

}  // namespace greatx::apps
