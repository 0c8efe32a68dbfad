// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes capitals and digits into textures. A glyph is a few straight strokes on a grid of 5 by 7 points.
// Their ends are round, so that it is legible at any size.
#pragma once

#include <functional>
#include <string_view>

namespace greatx::scene::generator {

/// Called for each pixel that a stroke touches, with the share of it that the stroke covers (1 to 16, of 16).
using InkPixel = std::function<void(int x, int y, int share)>;

/// Returns the width of `text` in pixels. Letters are `height` pixels high, from the middle of their highest
/// stroke to that of their lowest one.
int text_width(std::string_view text, int height);

/// Writes `text` with the upper left corner of its first letter at (x, y). Strokes are `thick` pixels wide.
/// `text` has capitals, the digits and spaces. Throws ContractError for any other character.
void write_text(std::string_view text, int x, int y, int height, int thick, const InkPixel& ink);

}  // namespace greatx::scene::generator
