// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace greatx::view {

/// Sets ImGui's colours, spaces and font. `scale`: pixels for each screen coordinate.
void set_style(float scale);

}  // namespace greatx::view
