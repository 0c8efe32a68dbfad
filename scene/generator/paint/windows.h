// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Paints windows into a façade, as they look by day and lit by night.
#pragma once

#include "scene/generator/paint/texture_painter.h"

namespace greatx::scene::generator {

/// Names the use of the room behind a window, which determines when and how the window is lit.
enum class Use { home, office, shop };

struct WindowStyle {
  Rgb frame{226, 224, 218};
  int columns = 2, rows = 1;
  int frame_px = 3;
  Use use = Use::home;
};

/// Returns the colour multiplied by `percent` / 100.
Rgb dimmed(const Rgb& color, int percent);

/// Returns the light of window (x, y) in the lit map `layer`; black if the window is dark. Offices are lit or
/// dark by rooms of three windows.
Rgb night_light(Use use, int layer, int x, int y, uint32_t seed);

/// Paints a lit pane: brighter towards the lamp at the top, with dark furniture in front of the light.
void light_pane(TexturePainter& painter, int layer, int x0, int y0, int x1, int y1, const Rgb& light, Use use,
                uint32_t seed);

/// Paints a window set back in its wall: the shadow under the lintel, the frame, panes that mirror a paler
/// sky towards the top, and perhaps a curtain or a blind. Some windows are lit by night.
void window(TexturePainter& painter, int x0, int y0, int x1, int y1, const WindowStyle& style, uint32_t seed);

/// Paints soot and rain streaks under a sill.
void streaks(TexturePainter& painter, int x0, int x1, int y, uint32_t seed);

}  // namespace greatx::scene::generator
