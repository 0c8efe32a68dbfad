// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads files with heights. Data flow: pixels of the area ─► HeightTile of each file ─► tiles with the same
// lattice of pixels joined to one, so that no gap of a pixel lies between them ─► HeightSamples, whose places
// are degrees ─► HeightGrid in the frame ─► voids filled from neighbours.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "scene/place/config/place_config.h"
#include "scene/place/source/crs.h"
#include "scene/place/source/map_contents.h"
#include "scene/place/source/placement.h"

namespace greatx::scene::place {

/// The pixels of one file, or of several joined, in the area and around it.
struct HeightTile {
  std::string source;
  std::shared_ptr<const Projection> projection;
  std::array<double, 6> transform{};  ///< of the window's pixels, as GDAL's
  uint32_t columns = 0, rows = 0;     ///< 0 if file and area do not meet
  std::vector<double> heights_m;      ///< [rows, columns], above the vertical datum, NaN where no data
  Box extent;                         ///< degrees, of the whole file
  std::string licence;
};

/// Reads the pixels of a box and two around it. Counts values outside `valid_m` as a finding. Throws
/// UserError if the file cannot be read, or if its unit is another than that of the source.
HeightTile read_heights(const HeightSource& source, const Box& degrees, Notes& notes);

/// Joins tiles of the same CRS whose pixels have the same size and lie on one lattice to 1 % of a pixel.
/// Where two have data, the earlier one counts.
std::vector<HeightTile> join_tiles(std::vector<HeightTile> tiles);

/// Samples at the centres of pixels.
struct HeightSamples {
  std::string source;
  uint32_t columns = 0, rows = 0;
  std::vector<dvec3> samples;  ///< [rows, columns]: longitude, latitude in degrees; m, NaN where no data
};
HeightSamples samples_of(const HeightTile& tile);

/// Puts samples into the frame.
HeightGrid grid_in_frame(const HeightSamples& samples, const LocalFrame& frame);

/// Puts all samples into the frame. Counts the samples within `area` at which no grid has data and, if
/// `fill`, gives them heights: GDAL's interpolation by inverse distances (GDALFillNodata) from the data
/// around the void in the same file. Says so as findings, whose topics `what` begins.
HeightField join_samples(std::vector<HeightSamples> samples, const LocalFrame& frame, const AreaTest& area,
                         bool fill, const std::string& what, std::vector<Finding>& findings);

}  // namespace greatx::scene::place
