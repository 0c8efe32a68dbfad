// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Functions that the contact sheet and the animation share: they choose the moments, make the panels of all
// sensors at these moments, and draw the panels into tiles.
#pragma once

#include <cstdint>
#include <vector>

#include "draw/sheet/panels.h"
#include "io/dataset/dataset_reader.h"

namespace greatx::io {

/// Lengths of the layout, pixels.
namespace sheet {
inline constexpr int margin = 28, gap = 14;
inline constexpr int tile_width = 400, legend_height = 24, title_height = 30, row_gap = 10;
}  // namespace sheet

struct SheetMoment {
  int64_t tick, time_ns;
};

/// Returns at most `count` (1 or more) moments, equally spaced from the first to the last record of one
/// sensor: the first sensor with records and frame panels or, if there is none, the first sensor with
/// records. If any sensor of the data set is_about_intervals(), the moments begin at the second record,
/// because the first one of that sensor is empty.
std::vector<SheetMoment> choose_moments(const DatasetReader& reader, uint32_t sequence, size_t count);

/// Returns the panels of each sensor. Their row i is the record nearest to moments[i]. For kinds of sensors
/// with series panels, only the first sensor of the kind gets panels.
std::vector<Panels> panels_by_sensor(const DatasetReader& reader, uint32_t sequence,
                                     const std::vector<SheetMoment>& moments);

/// Throws UserError if the sequence does not exist or has no records.
void check_has_records(const DatasetReader& reader, uint32_t sequence);

/// Describes frame panels that are side by side, and the height of their pictures in pixels.
struct Band {
  size_t first, count;
  int picture_height;
};
/// Divides the panels into bands of at most `per_band` panels.
std::vector<Band> make_bands(const std::vector<std::unique_ptr<FramePanel>>& panels, size_t per_band);

/// The largest rectangle of the aspect (height over width) in the middle of the tile.
Rect fit(const Rect& tile, double aspect);
/// Of a tile for pictures up to this aspect, kept within reason.
int tile_height(double tallest_aspect);
/// Draws record `row` of the panel in the middle of the tile, a frame around the tile, and the legend below
/// the tile. The legend takes sheet::legend_height more.
void draw_tile(Canvas& canvas, FramePanel& panel, const Rect& tile, size_t row);
/// Draws the title of a panel above its tile. The title takes sheet::title_height.
void draw_title(Canvas& canvas, int x, int y, const std::string& title);

}  // namespace greatx::io
