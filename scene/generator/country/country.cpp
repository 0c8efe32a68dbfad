// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/country/country.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "scene/generator/mesh/materials.h"

namespace greatx::scene::generator {

bool Country::near_site(const dvec2& point, double margin) const {
  for (const Site& farm : farms_)
    if (glm::length(point - farm.center) < farm.inner_m + margin) return true;
  return glm::length(point - pond_.center) < pond_.outer_m + margin ||
         std::abs(point.y - terrain_.road_y(point.x)) < road_half_width_m + verge_m + margin;
}

dvec2 Country::find_pond() {
  // Of random places the first that is clear of road and farms, or else the one that is clearest.
  const double limit = terrain_.half() - pond_.outer_m - 4.0;
  dvec2 best(0.0);
  double best_room = -1e9;
  for (int attempt = 0; attempt < 100 && best_room < 0.0; ++attempt) {
    const double x = random_.uniform(-limit, limit), y = random_.uniform(-limit, limit);
    const dvec2 center = snap(dvec2(x, y));
    double room = 1e9;
    for (double along = -pond_.outer_m; along <= pond_.outer_m; along += 4.0) {
      const dvec2 road(x + along, terrain_.road_y(x + along));
      room = std::min(room, glm::length(center - road) - pond_.outer_m - road_half_width_m - verge_m);
    }
    for (const Site& farm : farms_)
      room = std::min(room, glm::length(center - farm.center) - pond_.outer_m - farm.inner_m - 4.0);
    if (room > best_room) {
      best_room = room;
      best = center;
    }
  }
  return best;
}

void Country::choose_sites() {
  // A farm on each side of the road, and a pond away from both.
  const double half = terrain_.half();
  const auto beside_road = [&](double x, double distance, double side) {
    const dvec2 along = terrain_.road_direction(x);
    return snap(dvec2(x, terrain_.road_y(x)) + side * distance * dvec2(-along.y, along.x));
  };
  const double side = random_.uniform() < 0.5 ? 1.0 : -1.0;
  const double reach = std::min(0.5 * half, 110.0);
  const double yard = std::min(24.0, 0.3 * half);
  for (const double sign : {-1.0, 1.0}) {
    Site farm;
    farm.center = beside_road(sign * reach * random_.uniform(0.55, 0.75), yard + 10.0, sign * side);
    farm.inner_m = yard;
    farm.outer_m = yard + 16.0;
    farm.level = snap(terrain_.height(farm.center));
    farms_.push_back(farm);
  }
  for (const Site& farm : farms_) terrain_.flatten(farm);
  pond_.inner_m = std::min(9.0, 0.1 * half);
  pond_.outer_m = 3.2 * pond_.inner_m;
  pond_.center = find_pond();
  double shore = 1e9;
  for (const dvec2& p : regular_polygon(24, pond_.outer_m, pond_.center))
    shore = std::min(shore, terrain_.height(p));
  pond_.level = snap(shore - 3.0);  // of the bed; the water stands 1.7 m above it
  terrain_.flatten(pond_);
  for (const double sign : {-1.0, 1.0})
    woods_.emplace_back(random_.uniform(-0.75, 0.75) * half, sign * 0.72 * half);
}

std::vector<Field> Country::reserved(const std::array<int, 2>& band) const {
  std::vector<Field> fields;
  const double step = terrain_.vertex(1, 0).x - terrain_.vertex(0, 0).x;
  const auto reserve = [&](const dvec2& center, double reach, const char* name) {
    const auto row_at = [&](double x) {
      return std::clamp(static_cast<int>(std::lround((x + terrain_.half()) / step)), 0, terrain_.rows() - 1);
    };
    const int middle = row_at(center.x);
    if (center.y < terrain_.vertex(middle, band[0]).y || center.y >= terrain_.vertex(middle, band[1]).y)
      return;
    const Field field{row_at(center.x - reach), row_at(center.x + reach), band[0], band[1], material(name)};
    if (field.row1 > field.row0) fields.push_back(field);
  };
  for (const Site& farm : farms_) reserve(farm.center, farm.inner_m + 5.0, "grass");
  reserve(pond_.center, pond_.outer_m + 5.0, "meadow");
  for (const dvec2& wood : woods_) reserve(wood, 1.2 * wood_radius(), "meadow");
  std::sort(fields.begin(), fields.end(), [](const Field& a, const Field& b) { return a.row0 < b.row0; });
  return fields;
}

void Country::choose_fields() {
  const std::array<const char*, 10> crops{"wheat",      "crop",    "ploughed_soil", "rapeseed", "crop_young",
                                          "wheat_pale", "stubble", "crop_dark",     "crop",     "wheat"};
  const int south = terrain_.road_south() - 1, north = terrain_.road_north() + 1,
            last = terrain_.columns() - 1;
  const std::array<std::array<int, 2>, 4> bands{
      {{0, south / 2}, {south / 2, south}, {north, (north + last) / 2}, {(north + last) / 2, last}}};
  const int rows = terrain_.rows() - 1;
  for (const auto& band : bands) {
    int before = -1, row = 0;
    const auto fill = [&](int until) {  // with crops, no two alike side by side
      while (row < until) {
        int end = std::min(row + 6 + static_cast<int>(random_.below(6)), until);
        if (until - end < 4) end = until;
        size_t pick = random_.below(static_cast<uint32_t>(crops.size()));
        while (material(crops[pick]) == before) pick = (pick + 1) % crops.size();
        before = material(crops[pick]);
        fields_.push_back({row, end, band[0], band[1], before, random_.uniform(0.0, pi),
                           dvec2(random_.uniform(), random_.uniform())});
        row = end;
      }
    };
    // Yards, the pond's banks and woods stand on grass.
    for (const Field& field : reserved(band)) {
      fill(field.row0);
      if (field.row1 <= row) continue;
      fields_.push_back({row, field.row1, band[0], band[1], field.material});
      row = field.row1;
    }
    fill(rows);
  }
}

void Country::add_ground() {
  const int verge = material("verge"), meadow = material("meadow");
  const int south = terrain_.road_south(), north = terrain_.road_north();
  MeshBuilder land, road, water;
  terrain_.add_surface(land, [&](int row, int column) {
    if (column == south) return Terrain::Cover{};
    if (column == south - 1 || column == north) return Terrain::Cover{.material = verge};
    for (const Field& f : fields_)
      if (row >= f.row0 && row < f.row1 && column >= f.column0 && column < f.column1)
        return Terrain::Cover{.material = f.material, .angle = f.angle, .offset = f.offset};
    return Terrain::Cover{.material = meadow};
  });
  terrain_.add_base(land);
  terrain_.add_surface(road, [&](int, int column) {
    return column == south ? Terrain::Cover{.material = material("country_road"), .along_road = true}
                           : Terrain::Cover{};
  });
  // A disc that reaches into the banks all round: the shore is where they meet.
  water.flat_polygon(material("water"), regular_polygon(20, 0.9 * pond_.outer_m, pond_.center),
                     pond_.level + 1.7, true);
  add("terrain", land, SemanticClass::ground);
  add("road", road, SemanticClass::road);
  add("pond", water, SemanticClass::water);
}

void write_country(GlbWriter& writer, double size_m, uint64_t seed) { Country(writer, size_m, seed).write(); }

}  // namespace greatx::scene::generator
