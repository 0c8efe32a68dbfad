// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "apps/place/command/build_command.h"

namespace greatx::apps {

/// Builds the place and writes scene and report.
void build_scene(const BuildCommand& command);

}  // namespace greatx::apps
