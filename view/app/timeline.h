// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <imgui.h>
#include <span>

#include "view/app/steady_text.h"
#include "view/run/run.h"

namespace greatx::view {

float timeline_height();
/// Draws the strip with the controls of time. They act on all runs alike; the first one is shown. `activity`
/// is that of the first run over the last frames.
void draw_timeline(const ImVec2& at, const ImVec2& size, std::span<Run* const> runs, SteadyText& activity);

}  // namespace greatx::view
