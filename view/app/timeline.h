// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <imgui.h>
#include <span>

#include "view/run/run.h"

namespace greatx::view {

float timeline_height();
/// Draws the strip with the controls of time. They act on all runs alike; the first one is shown.
void draw_timeline(const ImVec2& at, const ImVec2& size, std::span<Run* const> runs);

}  // namespace greatx::view
