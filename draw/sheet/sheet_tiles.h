// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What the contact sheet and the animation share: how they choose sensors and moments, make the panels of
// these sensors at these moments, and draw the panels into tiles.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "draw/sheet/panels.h"
#include "draw/sheet/sheet_layout.h"
#include "io/dataset/dataset_reader.h"

namespace greatx::io {

/// How a data set is drawn.
struct SheetOptions {
  const Theme* theme = &dark_theme();
  int factor = 1;  ///< pixels along a side for one: 1 to Canvas::most_factor
  /// Names of the sensors and channels to show, or of nodes: all of their sensors; empty: all there are.
  std::vector<std::string> sensors;
  PanelOptions panels;
};

struct SheetMoment {
  int64_t tick, time_ns;
};

/// Returns the sensors to show, ascending. Throws UserError if a name fits none.
std::vector<size_t> shown_sensors(const DatasetReader& reader, const std::vector<std::string>& names);

/// Returns at most `count` (1 or more) moments, equally spaced from the first to the last record of one of
/// the sensors: the first with records and frame panels or, if there is none, the first with records. If any
/// of the sensors is_about_intervals(), the moments begin at the second record, because the first one of that
/// sensor is empty.
std::vector<SheetMoment> choose_moments(const DatasetReader& reader, uint32_t sequence,
                                        const std::vector<size_t>& sensors, size_t count);

/// Returns the panels of each of the sensors. Their row i is the record nearest to moments[i]. Throws
/// UserError if the options name a link that no channel has.
std::vector<Panels> panels_by_sensor(const DatasetReader& reader, uint32_t sequence,
                                     const std::vector<size_t>& sensors,
                                     const std::vector<SheetMoment>& moments, const PanelOptions& options);

/// Throws UserError if the sequence does not exist or has no records.
void check_has_records(const DatasetReader& reader, uint32_t sequence);

/// Draws record `row` of the panel in the middle of the tile, a frame around the tile, and the legend.
void draw_tile(Canvas& canvas, FramePanel& panel, const Rect& tile, const Rect& legend, size_t row);
/// Draws the title of a panel above its tile, shortened in its middle if it is too long.
void draw_title(Canvas& canvas, const Rect& area, const std::string& title);

}  // namespace greatx::io
