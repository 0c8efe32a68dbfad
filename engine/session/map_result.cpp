// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/session/map_result.h"

#include <nlohmann/json.hpp>

namespace greatx::engine {

MapResult map_result(const sim::RadioMapRun& run, std::span<const sim::MapLink> links,
                     const sim::ChannelConfig& config) {
  const sim::RadioMap map = run.map(links);
  const sim::MapCells& cells = run.cells();
  const int64_t rows = cells.grid.rows, columns = cells.grid.columns;
  MapResult result;
  for (const sim::MapQuantity* quantity : sim::map_quantities_of(run.precoding()))
    result.arrays.push_back(
        {quantity->name, quantity->unit,
         (quantity->per_transmitter ? "[tx, row, column] " : "[row, column] ") + quantity->description,
         sim::map_array(map, *quantity)});
  std::vector<double> x, y, ends;
  for (int64_t column = 0; column < columns; ++column)
    x.push_back(cells.grid.center(static_cast<size_t>(column)).x);
  for (int64_t row = 0; row < rows; ++row)
    y.push_back(cells.grid.center(static_cast<size_t>(row * columns)).y);
  for (const dvec3& end : run.transmitters()) ends.insert(ends.end(), {end.x, end.y, end.z});
  result.arrays.push_back(
      {"x", "m", "[column] of the cells' middles, world", Array::of<double>({columns}, x)});
  result.arrays.push_back({"y", "m", "[row] of the cells' middles, world; row 0 is the southernmost",
                           Array::of<double>({rows}, y)});
  result.arrays.push_back({"z", "m", "[row, column] of the cells' middles, world; NaN: nothing beneath",
                           sim::map_heights(cells)});
  result.arrays.push_back(
      {"placement", "1",
       "[row, column] 0: free, 1: inside a solid, 2: nothing beneath, 3: in foliage, 4: on a surface",
       sim::map_placement(cells)});
  result.arrays.push_back({"transmitter_position", "m", "[tx, xyz] world",
                           Array::of<double>({static_cast<int64_t>(run.transmitters().size()), 3}, ends)});
  result.facts =
      nlohmann::ordered_json{{"channel", config.name},
                             {"carrier_hz", config.carrier_hz},
                             {"transmitters", config.transmitters},
                             {"power_dbm", map.power.transmit_dbm},
                             {"bandwidth_hz", map.power.bandwidth_hz},
                             {"noise_w", map.power.noise_w()},
                             {"precoder", sim::map_precodings[static_cast<size_t>(run.precoding())]},
                             {"cell_m", cells.grid.cell_m},
                             {"height", cells.height_rule}}
          .dump();
  return result;
}

}  // namespace greatx::engine
