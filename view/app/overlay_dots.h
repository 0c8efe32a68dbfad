// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws the dots of overlays, which are many, into the picture itself. A sweep of a LiDAR has 65536 of them;
// as triangles of the user interface they cost more than the picture of the scene.
#pragma once

#include <cstdint>

#include "core/record.h"
#include "view/app/overlay_draw.h"

namespace greatx::view {

/// Draws the dots of `shapes` that the scene does not hide into `rgb`, u8 [height, width, 3], the picture of
/// `frame`. Those of the row whose id is `highlighted` (0: none) are larger.
void paint_dots(const Shapes& shapes, const OverlayFrame& frame, uint64_t highlighted, Array& rgb);

}  // namespace greatx::view
