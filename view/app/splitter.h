// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <imgui.h>

namespace greatx::view {

/// Returns the width of the strip between the main view and the side panel.
float splitter_width();
/// Draws the strip at `at`, as high as `height`. Dragging changes `share`, the side panel's part of the
/// window's width; a double click makes it `usual` again.
void draw_splitter(const ImVec2& at, float height, float usual, float& share);

}  // namespace greatx::view
