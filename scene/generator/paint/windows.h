// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Windows painted into a façade, as they look by day and lit by night.
#pragma once

#include "scene/generator/paint/texture_painter.h"

namespace greatx::scene::generator {

/// Who is behind a window decides when and how it is lit.
enum class Use { home, office, shop };

struct WindowStyle {
  Rgb frame{226, 224, 218};
  int columns = 2, rows = 1;
  int frame_px = 3;
  Use use = Use::home;
};

/// A colour at so many percent.
Rgb dimmed(const Rgb& color, int percent);

/// Whether window (x, y) is lit in `layer`, and its light; black: dark. Offices go out by rooms of three
/// windows.
Rgb night_light(Use use, int layer, int x, int y, uint32_t seed);

/// A lit pane: brighter towards the lamp above, furniture dark against it.
void light_pane(TexturePainter& painter, int layer, int x0, int y0, int x1, int y1, const Rgb& light, Use use,
                uint32_t seed);

/// A window set back in its wall: shadow under the lintel, frame, panes that mirror a paler sky towards the
/// top, perhaps a curtain or a blind. By night some are lit.
void window(TexturePainter& painter, int x0, int y0, int x1, int y1, const WindowStyle& style, uint32_t seed);

/// Soot and rain under a sill.
void streaks(TexturePainter& painter, int x0, int x1, int y, uint32_t seed);

}  // namespace greatx::scene::generator
