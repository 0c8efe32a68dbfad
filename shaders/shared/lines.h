// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The camera's shaders and renderer/camera/thin_lines.h share this description of thin lines.
#ifndef GREATX_SHADERS_SHARED_LINES_H
#define GREATX_SHADERS_SHARED_LINES_H
#include "glsl.h"

GREATX_SHARED_BEGIN

/// A prism that is no wider than this all along is a line, in pixels.
const float line_most_pixels = 2.0f;
/// The words are a header (the number of columns of tiles; the word of the first pixel under lines; the
/// number of these pixels), (first entry, count) of each tile, the entries (quadruples of words where lines
/// begin), the pixels (column | row << 16, each once, tile by tile), and the lines. A tile lists the lines up
/// to `line_margin_pixels` beside it.
const uint line_tile_pixels = 16u;
const uint line_margin_pixels = 4u;
const uint line_header_words = 3u;
const uint line_columns_word = 0u;
const uint line_pixels_word = 1u;
const uint line_pixel_count_word = 2u;
/// The pixels that one group shades.
const uint line_group_pixels = 64u;
/// A line is four quadruples of words:
///   0  floats: the place in the picture where it begins, its unit direction there
///   1  floats: half its width where it begins and ends, pixels; one over its planar depth there
///   2  triangle + 1 of its half to the left of the direction (where x points right and y down: clockwise
///      from it) and of its other half; its first triangle; their number
///   3  a float: its length, pixels
const uint line_record_quads = 4u;
/// Less of a pixel than this shows nothing of a line.
const float line_least_share = 1.0f / 1024.0f;

GREATX_SHARED_END
#endif
