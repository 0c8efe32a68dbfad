// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads pictures of the ground. Data flow: pixels of the area ─► RGB and a mask ─► an affine map from the
// frame if it fits to a quarter of a pixel, or else pixels resampled to a grid along x and y.
#pragma once

#include <optional>
#include <string>

#include "scene/place/config/place_config.h"
#include "scene/place/source/map_contents.h"
#include "scene/place/source/placement.h"

namespace greatx::scene::place {

struct PictureRead {
  std::optional<GroundPicture> picture;  ///< nothing if file and area do not meet
  Box extent;                            ///< degrees, of the whole file
  std::string licence;
  std::string missing_grid, outside_use;  ///< see Projection
};

/// Reads the part of a picture that covers the box. `spent` counts the bytes of all pictures. Throws
/// UserError if the file is no picture of 8 bits: grey, palette, RGB, each with alpha or without.
PictureRead read_picture(const PictureSource& source, const Box& degrees, const Placement& placement,
                         Spending& spent);

/// Returns the extent of a raster in degrees.
Box raster_extent(const std::filesystem::path& file, const std::string& crs);

/// Returns the share of the area that pixels with data cover, from points on a grid of 100 x 100 over its
/// box.
double covered_share(const std::vector<GroundPicture>& pictures, const AreaTest& area);

}  // namespace greatx::scene::place
