// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Paints a radio map into the picture of the main view: each pixel that shows the ground beneath a cell gets
// the cell's colour, and so nothing that stands in front of the ground is painted over.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "draw/map/draw.h"
#include "view/scene/scene_view.h"
#include "view/world/map_job.h"

namespace greatx::view {

struct MapColors {
  std::string quantity = "path_gain";   ///< a name of sim::map_quantities()
  std::optional<uint32_t> transmitter;  ///< none: the best server of each cell
  double opacity = 0.75;
  std::optional<double> low, high;  ///< ends of the colours, in the layer's unit; none: those of the map
};

/// One quantity of a map, ready to be painted. Nobody changes it once it is made.
class MapLayerPaint {
 public:
  /// Throws UserError if there is no such quantity or transmitter. `origin` is the scene's.
  MapLayerPaint(std::shared_ptr<const ShownMap> map, const MapColors& colors, const dvec3& origin);

  const apps::MapLayer& layer() const { return layer_; }
  const apps::MapScale& scale() const { return scale_; }
  const ShownMap& map() const { return *map_; }
  io::Color color_at(double value) const { return apps::color_of_cell(layer_, scale_, value); }

  /// The cell under pixel (x, y) of the picture; none where it shows anything else than the map's ground.
  /// A map on a plane has its cells in the plane itself, where nothing hides it.
  std::optional<size_t> cell_at(const ScenePicture& picture, int x, int y) const;
  /// The picture with the map, u8 [height, width, 3].
  std::vector<uint8_t> painted(const ScenePicture& picture) const;
  /// "-84.3 dB (path gain of the best server)\n(12.5, 3.5, 1.5) m" for a cell.
  std::string text_of(size_t cell) const;

 private:
  std::optional<size_t> cell_of(const dvec3& world) const;
  bool is_ground(size_t cell, double z_m) const;
  void measure_ground();

  std::shared_ptr<const ShownMap> map_;
  double opacity_ = 0.75;
  dvec3 origin_{0.0};
  apps::MapLayer layer_;
  apps::MapScale scale_;
  std::vector<float> ground_m_, slack_m_;  ///< [cells] world height of the ground; how far off it may be
};

}  // namespace greatx::view
