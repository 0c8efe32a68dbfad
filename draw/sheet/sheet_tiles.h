// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What the contact sheet and the animation have in common: which moments they show, the panels of all sensors
// at them, and the tiles that the panels are drawn into.
#pragma once

#include <cstdint>
#include <vector>

#include "draw/sheet/panels.h"
#include "io/dataset/dataset_reader.h"

namespace greatx::io {

/// Lengths in pixels.
namespace sheet {
inline constexpr int margin = 28, gap = 14;
inline constexpr int tile_width = 400, legend_height = 24, title_height = 30, row_gap = 10;
}  // namespace sheet

struct SheetMoment {
  int64_t tick, time_ns;
};

/// At most `count` (1 or more) moments evenly from the first record to the last of the sensor that rows
/// follow: the first one drawn moment by moment, else the first one with records. With a sensor that
/// is_about_intervals() the second record stands for the first, which is empty.
std::vector<SheetMoment> choose_moments(const DatasetReader& reader, uint32_t sequence, size_t count);

/// The panels of each sensor, row i of them its record nearest to moments[i]; of the kinds that are drawn
/// over time only the first sensor gets some.
std::vector<Panels> panels_by_sensor(const DatasetReader& reader, uint32_t sequence,
                                     const std::vector<SheetMoment>& moments);

/// Throws UserError if the sequence is not there or has no records.
void check_has_records(const DatasetReader& reader, uint32_t sequence);

/// Frame panels that stand side by side, and the height of their pictures.
struct Band {
  size_t first, count;
  int picture_height;
};
std::vector<Band> make_bands(const std::vector<std::unique_ptr<FramePanel>>& panels, size_t per_band);

/// The largest rectangle of the aspect (height over width) in the middle of the tile.
Rect fit(const Rect& tile, double aspect);
/// Of a tile for pictures up to this aspect, kept within reason.
int tile_height(double tallest_aspect);
/// The panel's record `row` in the middle of the tile, framed, and its legend below: sheet::legend_height
/// more.
void draw_tile(Canvas& canvas, FramePanel& panel, const Rect& tile, size_t row);
/// A panel's title above its tile; takes sheet::title_height.
void draw_title(Canvas& canvas, int x, int y, const std::string& title);

}  // namespace greatx::io
