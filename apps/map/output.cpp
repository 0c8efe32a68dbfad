// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/map/output.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/units.h"
#include "io/formats/npy.h"
#include "io/formats/png.h"

namespace greatx::apps {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json write_array(const fs::path& folder, const std::string& name, const std::string& unit,
                 const std::string& description, const Array& array) {
  const std::string file = name + ".npy";
  io::write_file_atomically(folder / file, io::encode_npy(array));
  return {{"name", name},
          {"file", file},
          {"dtype", std::string(numpy_name(array.dtype))},
          {"shape", array.shape},
          {"axes", array.shape.size() == 3 ? Json{"tx", "row", "column"} : Json{"row", "column"}},
          {"unit", unit},
          {"description", description}};
}

Json write_picture(const fs::path& folder, const std::string& name, const Array& image,
                   const std::string& shows) {
  const std::string file = name + ".png";
  io::write_file_atomically(folder / file, io::encode_png(image));
  return {{"file", file}, {"shows", shows}};
}

std::vector<const sim::MapQuantity*> chosen(const sim::RadioMap& map, const MapFiles& files) {
  std::vector<const sim::MapQuantity*> quantities;
  for (const sim::MapQuantity* quantity : sim::map_quantities_of(map.precoding))
    if (files.quantities.empty() ||
        std::find(files.quantities.begin(), files.quantities.end(), quantity->name) != files.quantities.end())
      quantities.push_back(quantity);
  return quantities;
}

/// Returns the quantities of the overview picture, in this order. Those that are not written are left out.
std::vector<std::string> overview(size_t transmitters) {
  return {"path_gain",    "sinr",     transmitters > 1 ? "best_server" : "line_of_sight",
          "delay_spread", "k_factor", "arrival_azimuth_spread"};
}

Json write_pictures(const fs::path& folder, const sim::RadioMap& map, const MapStage& stage,
                    const MapFiles& files) {
  Json pictures = Json::array();
  std::vector<MapLayer> layers;
  const std::vector<std::string> shown = overview(map.transmitters());
  for (const sim::MapQuantity* quantity : chosen(map, files)) {
    const MapLayer layer = map_layer(map, *quantity, {}, stage.transmitters);
    pictures.push_back(write_picture(folder, quantity->name, draw_map(stage, layer), layer.title));
    if (std::find(shown.begin(), shown.end(), quantity->name) != shown.end()) layers.push_back(layer);
    if (!files.each_transmitter || !quantity->per_transmitter) continue;
    for (size_t t = 0; t < map.transmitters(); ++t) {
      const MapLayer own = map_layer(map, *quantity, t, stage.transmitters);
      pictures.push_back(
          write_picture(folder, fmt::format("{}_tx{}", quantity->name, t), draw_map(stage, own), own.title));
    }
  }
  if (!layers.empty()) pictures.push_back(write_picture(folder, "map", draw_maps(stage, layers), "overview"));
  return pictures;
}

}  // namespace

MapTotals map_totals(const sim::RadioMap& map) {
  MapTotals totals;
  const sim::MapCells& cells = *map.cells;
  totals.cells = cells.grid.cells();
  for (const sim::CellPlacement placement : cells.placement) {
    totals.inside += placement == sim::CellPlacement::solid;
    totals.nothing_beneath += placement == sim::CellPlacement::nothing_beneath;
  }
  totals.served.resize(map.transmitters());
  const std::vector<double> servers = sim::map_at_best_server(map, sim::map_quantity("best_server"));
  std::vector<double> gains = sim::map_at_best_server(map, sim::map_quantity("path_gain"));
  for (size_t cell = 0; cell < servers.size(); ++cell) {
    if (!std::isnan(servers[cell]))
      ++totals.served[static_cast<size_t>(servers[cell])];
    else if (cells.solved(cell))
      ++totals.without_path;
  }
  std::erase_if(gains, [](double gain) { return std::isnan(gain); });
  totals.median_path_gain_db = NAN;
  if (!gains.empty()) {
    const auto middle = gains.begin() + static_cast<ptrdiff_t>(gains.size() / 2);
    std::nth_element(gains.begin(), middle, gains.end());
    totals.median_path_gain_db = decibels(*middle);
  }
  return totals;
}

Json MapTotals::json() const {
  Json json{{"cells", cells},
            {"inside_solids", inside},
            {"nothing_beneath", nothing_beneath},
            {"without_path", without_path},
            {"served", served}};
  json["median_path_gain_db"] = std::isnan(median_path_gain_db) ? Json() : Json(median_path_gain_db);
  return json;
}

std::string MapTotals::text(const std::vector<MapMarker>& transmitters) const {
  std::string text = fmt::format(
      "{} cells: {} inside solids, {} with nothing beneath, {} without a path, {} with one", cells, inside,
      nothing_beneath, without_path, std::accumulate(served.begin(), served.end(), size_t{0}));
  if (!std::isnan(median_path_gain_db))
    text += fmt::format(", median path gain {:.1f} dB", median_path_gain_db);
  text += '\n';
  for (size_t t = 0; t < served.size() && served.size() > 1; ++t)
    text += fmt::format("  {} serves {} cells best\n", transmitters[t].name, served[t]);
  return text;
}

Json write_map_files(const fs::path& folder, const sim::RadioMap& map, const MapStage& stage,
                     const MapFiles& files) {
  Json arrays = Json::array();
  for (const sim::MapQuantity* quantity : chosen(map, files))
    arrays.push_back(write_array(folder, quantity->name, quantity->unit, quantity->description,
                                 sim::map_array(map, *quantity)));
  arrays.push_back(write_array(folder, "z", "m",
                               "world height of the cell's middle; NaN: nothing lies beneath it",
                               sim::map_heights(*map.cells)));
  arrays.push_back(
      write_array(folder, "placement", "1",
                  "0 free, 1 inside a solid, 2 nothing beneath, 3 inside foliage, 4 on a surface, "
                  "5 beneath an open surface",
                  sim::map_placement(*map.cells)));
  Json json{{"arrays", std::move(arrays)}};
  json["pictures"] = files.pictures ? write_pictures(folder, map, stage, files) : Json::array();
  return json;
}

}  // namespace greatx::apps
