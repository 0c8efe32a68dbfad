// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Radio maps as pictures: coloured cells over the scene seen from above.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "draw/canvas/plot.h"
#include "draw/map/view.h"
#include "sim/channel/radio_map_values.h"

namespace greatx::apps {

/// The scene, straight from above.
struct MapBackground {
  MapPixels pixels;
  std::vector<uint8_t> rgb;  ///< [height, width, 3]
  std::vector<float> z_m;    ///< [height, width] world height of what is seen; -inf: nothing
};

struct MapMarker {
  std::string name;
  dvec2 position_m{0.0};  ///< world
};

/// What all pictures of a map share.
struct MapStage {
  const sim::MapCells* cells = nullptr;
  MapBackground background;
  std::vector<MapMarker> transmitters;
  std::string title;     ///< "etoile, csi"
  std::string subtitle;  ///< "1.5 m above ground, 3.5 GHz, ..."
};

/// From values to colours. Where a hundredth of the cells at either end spreads the range by a third or more,
/// the range is that of the rest, and what lies beyond has the colours of the ends; the picture says so.
struct MapScale {
  io::Scale scale;
  bool clipped_low = false, clipped_high = false;
};
MapScale map_scale(std::span<const double> values);

/// One quantity, ready to be drawn: a value a cell, or a class a cell.
struct MapLayer {
  std::string title;                 ///< "path gain of the best server"
  std::string unit;                  ///< "dB"
  std::vector<double> values;        ///< [cells]; NaN or -inf: `nothing`
  std::vector<std::string> classes;  ///< names of the values 0, 1, ...; empty: a scale
  std::string nothing = "no path";   ///< what cells are that have a place but no value
};
/// `transmitter`: none for the best server of each cell.
MapLayer map_layer(const sim::RadioMap& map, const sim::MapQuantity& quantity,
                   std::optional<size_t> transmitter, const std::vector<MapMarker>& transmitters);

/// u8 [height, width, 3]: title, cells in Viridis over the subdued scene (where a cell has no place, as in
/// buildings, the scene itself), outlines where the scene's height jumps, transmitters, axes in world metres,
/// colours, lengths, north.
Array draw_map(const MapStage& stage, const MapLayer& layer);
/// Several of them side by side, without axes.
Array draw_maps(const MapStage& stage, std::span<const MapLayer> layers);

}  // namespace greatx::apps
