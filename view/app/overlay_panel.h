// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The tabs that belong to overlays: their settings, and the story of the pinned path.
#pragma once

#include <imgui.h>

#include "view/app/overlays.h"
#include "view/app/world_overlays.h"

namespace greatx::view {

/// Draws the settings of all overlays into the current ImGui window. `overlays` and `tick` may be null.
void draw_overlay_settings(Overlays* overlays, WorldOverlays& world, const ShownTick* tick);

/// Draws a path's interactions as a table, and in words.
void draw_story(const PathStory& story);

/// Draws the colour bar of a map with its lower right corner at `corner`, pixels.
void draw_map_legend(ImDrawList& list, const MapLayerPaint& paint, const ImVec2& corner);

}  // namespace greatx::view
