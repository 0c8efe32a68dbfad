// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws radio maps: coloured cells over the scene seen from above.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "draw/canvas/plot.h"
#include "draw/map/view.h"
#include "sim/channel/radio_map_values.h"

namespace greatx::apps {

/// Holds a picture of the scene from straight above.
struct MapBackground {
  MapPixels pixels;
  std::vector<uint8_t> rgb;  ///< [height, width, 3]
  std::vector<float> z_m;    ///< [height, width] world height of the visible surface; -inf: none
};

/// Describes the marker of a transmitter.
struct MapMarker {
  std::string name;
  dvec2 position_m{0.0};  ///< world x, y
};

/// Holds the data that all pictures of a map share.
struct MapStage {
  const sim::MapCells* cells = nullptr;
  MapBackground background;
  std::vector<MapMarker> transmitters;
  std::string title;     ///< e.g. "etoile, csi"
  std::string subtitle;  ///< e.g. "1.5 m above ground, 3.5 GHz, ..."
};

/// Maps values to colours. If the lowest or the highest 1 % of the cells would widen the range of the others
/// by more than a third, the range excludes them. Values beyond the range have the colours of its ends, and
/// the picture says so.
struct MapScale {
  io::Scale scale;
  bool clipped_low = false, clipped_high = false;
};
MapScale map_scale(std::span<const double> values);

/// Holds one quantity to draw. Each cell has a value on a scale, or the index of a class.
struct MapLayer {
  std::string title;                 ///< e.g. "path gain of the best server"
  std::string unit;                  ///< e.g. "dB"
  std::vector<double> values;        ///< [cells]; NaN or -inf: no value
  std::vector<std::string> classes;  ///< names of the values 0, 1, ...; empty: a scale is used
  std::string nothing = "no path";   ///< legend for solved cells without a value
};
/// Returns the layer of a quantity, for one transmitter or, if `transmitter` is empty, for the best server of
/// each cell.
MapLayer map_layer(const sim::RadioMap& map, const sim::MapQuantity& quantity,
                   std::optional<size_t> transmitter, const std::vector<MapMarker>& transmitters);

/// Returns the colour of a cell with this value. A value that is NaN or -inf has the colour of "nothing".
io::Color color_of_cell(const MapLayer& layer, const MapScale& scale, double value);

/// Returns a picture of a layer, u8 [height, width, 3]. Solved cells have the colours of Viridis or of their
/// classes. Other cells, such as those in buildings, show the subdued scene. The picture also has outlines
/// where the height of the scene jumps, markers of the transmitters, a title, axes in world metres, a legend
/// of the colours, a scale bar and a north arrow.
Array draw_map(const MapStage& stage, const MapLayer& layer);
/// Returns a picture of several layers side by side, without axes, u8 [height, width, 3].
Array draw_maps(const MapStage& stage, std::span<const MapLayer> layers);

}  // namespace greatx::apps
