// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <imgui.h>

namespace greatx::view {

inline constexpr float font_px = 15.0f;  ///< at scale 1

/// Sets ImGui's colours, spaces and font, whatever they were. `scale`: pixels for each screen coordinate.
void set_style(float scale);

/// Returns the pixels of a length that is `px` at scale 1. The font says what the scale is.
inline float scaled(float px) { return px * ImGui::GetFontSize() / font_px; }

}  // namespace greatx::view
