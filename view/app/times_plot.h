// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <imgui.h>

#include "view/times/time_history.h"

namespace greatx::view {

/// Returns the colour of a part of TimeHistory::parts(). `alpha` is of 255.
ImU32 part_color(size_t part, uint32_t alpha = 255);

/// Draws the work of the last ticks, stacked by part, with wall times and real time, and a legend below.
void draw_times_plot(const TimeHistory& history);

}  // namespace greatx::view
