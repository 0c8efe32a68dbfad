// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/city/city_buildings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "scene/generator/city/city_details.h"
#include "scene/generator/city/city_roofs.h"
#include "scene/generator/mesh/materials.h"

namespace greatx::scene::generator {

namespace {

constexpr double floor_height = 3.2;
constexpr double shop_height = 4.2;
constexpr double parapet_height = 0.8;  // within the plain lowest part of a façade's floor
constexpr double parapet_width = 0.35;
constexpr double foundation = -0.45;  // below the level of the pavement, so that no face ends in its plane

/// A lot in the (u, v) square of the block.
struct Lot {
  double u0, v0, u1, v1;
};

/// A footprint in the unit square of a lot, counter-clockwise, and positions for objects on its roof.
struct Shape {
  std::vector<dvec2> outline;
  std::vector<dvec2> spots;
  bool convex = true;
};

Shape make_shape(uint32_t kind, bool flip_u, bool flip_v) {
  Shape shape;
  switch (kind) {
    case 0:  // L
      shape = {{{0, 0}, {1, 0}, {1, 0.46}, {0.48, 0.46}, {0.48, 1}, {0, 1}},
               {{0.24, 0.23}, {0.72, 0.23}, {0.24, 0.74}},
               false};
      break;
    case 1:  // cut corner
      shape = {{{0.22, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0.22}}, {{0.62, 0.38}, {0.35, 0.7}}, true};
      break;
    case 2:  // U
      shape = {{{0, 0}, {1, 0}, {1, 1}, {0.66, 1}, {0.66, 0.42}, {0.34, 0.42}, {0.34, 1}, {0, 1}},
               {{0.17, 0.2}, {0.83, 0.2}, {0.17, 0.76}, {0.83, 0.72}},
               false};
      break;
    default:  // plain
      shape = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{0.3, 0.34}, {0.66, 0.62}, {0.7, 0.26}}, true};
  }
  const auto flip = [&](dvec2& p) { p = {flip_u ? 1 - p.x : p.x, flip_v ? 1 - p.y : p.y}; };
  for (dvec2& p : shape.outline) flip(p);
  for (dvec2& p : shape.spots) flip(p);
  if (flip_u != flip_v) std::reverse(shape.outline.begin(), shape.outline.end());
  return shape;
}

/// Divides the unit square into lots with alleys of 5 m between them.
std::vector<Lot> make_lots(const dvec2& size_m, RandomStream& random) {
  const double gu = 5.0 / size_m.x, gv = 5.0 / size_m.y;
  const auto spread = [&](double low, double high) { return random.uniform(low, high); };
  std::vector<Lot> lots;
  const auto row = [&](double v0, double v1, int count) {
    double start = 0.0;
    for (int i = 0; i < count; ++i) {
      const double end = i + 1 == count ? 1.0 : (i + 1.0) / count + spread(-0.06, 0.06) - 0.5 * gu;
      lots.push_back({start, v0, end, v1});
      start = end + gu;
    }
  };
  const int along = std::clamp(static_cast<int>(std::lround(size_m.x / 26.0)), 1, 4);
  const double split = spread(0.4, 0.58);
  switch (random.below(4)) {
    case 0:
      row(0.0, split - 0.5 * gv, along);
      row(split + 0.5 * gv, 1.0, along);
      break;
    case 1:
      row(0.0, split - 0.5 * gv, 1);
      row(split + 0.5 * gv, 1.0, along + 1);
      break;
    case 2:
      row(0.0, split - 0.5 * gv, along + 1);
      row(split + 0.5 * gv, 1.0, along);
      break;
    default:
      row(0.0, split - 0.5 * gv, along);
      row(split + 0.5 * gv, 1.0, 1);
  }
  return lots;
}

/// Returns whether only an alley lies between two lots.
bool are_neighbours(const Lot& a, const Lot& b, const dvec2& size_m) {
  const double gu = 5.5 / size_m.x, gv = 5.5 / size_m.y;
  return a.u0 < b.u1 + gu && b.u0 < a.u1 + gu && a.v0 < b.v1 + gv && b.v0 < a.v1 + gv;
}

struct Style {
  std::string facade, blind, roof;
  bool shops = false;
};

Style make_style(int floors, RandomStream& random) {
  struct Option {
    const char *facade, *blind;
    double low_weight, high_weight;  // for up to 6 floors, and for more
  };
  static constexpr std::array<Option, 10> options{{{"facade_brick_red", "blind_brick", 3, 1},
                                                   {"facade_brick_yellow", "", 2, 1},
                                                   {"facade_brick_brown", "", 2, 1},
                                                   {"facade_plaster_cream", "blind_plaster", 2.5, 0.5},
                                                   {"facade_plaster_white", "", 1.5, 0.5},
                                                   {"facade_plaster_ochre", "blind_plaster", 2, 0.3},
                                                   {"facade_concrete_grey", "concrete", 2, 2.5},
                                                   {"facade_concrete_light", "", 1, 3},
                                                   {"facade_glass_blue", "", 1, 4},
                                                   {"facade_metal_silver", "", 1.2, 1}}};
  double total = 0.0;
  const auto weight = [&](const Option& o) { return floors <= 6 ? o.low_weight : o.high_weight; };
  for (const Option& o : options) total += weight(o);
  double pick = random.uniform() * total;
  const Option* chosen = &options.back();
  for (const Option& o : options) {
    pick -= weight(o);
    if (pick < 0.0) {
      chosen = &o;
      break;
    }
  }
  Style style{chosen->facade, chosen->blind, random.uniform() < 0.65 ? "roof_gravel" : "roof_dark", false};
  const bool other_tone = random.uniform() < 0.45;
  if (style.facade == "facade_glass_blue" && other_tone) style.facade = "facade_glass_green";
  if (style.facade == "facade_metal_silver" && other_tone) style.facade = "facade_metal_dark";
  style.shops = style.facade.find("glass") == std::string::npos && random.uniform() < 0.5;
  return style;
}

/// Adds boxes of plant and the head of the stairs, sunk a little into the roof, where they fit within `roof`
/// and keep a distance from each other. Returns the middles of these boxes.
std::vector<dvec2> add_equipment(MeshBuilder& mesh, const std::vector<dvec2>& roof,
                                 const std::vector<dvec2>& spots, const dvec2& along, double roof_z,
                                 RandomStream& random) {
  const int sheet = material("roof_equipment"), concrete = material("concrete");
  const dvec2 across(-along.y, along.x);
  const size_t count = 1 + random.below(static_cast<uint32_t>(spots.size()));
  std::vector<dvec2> taken;
  for (size_t i = 0; i < count; ++i) {
    const dvec2 half{random.uniform(1.1, 1.9), random.uniform(0.9, 1.4)};  // braces evaluate in this order
    const double height = i == 0 ? 2.5 : random.uniform(1.1, 1.9);
    std::vector<dvec2> corners;
    for (const dvec2& c : {dvec2(-1, -1), dvec2(1, -1), dvec2(1, 1), dvec2(-1, 1)})
      corners.push_back(snap(spots[i] + along * (c.x * half.x) + across * (c.y * half.y)));
    const bool fits =
        std::all_of(corners.begin(), corners.end(), [&](const dvec2& c) { return inside(roof, c); });
    const bool apart = std::all_of(taken.begin(), taken.end(),
                                   [&](const dvec2& other) { return glm::length(other - spots[i]) > 5.0; });
    if (!fits || !apart) continue;
    taken.push_back(spots[i]);
    const int side = i == 0 ? concrete : sheet;
    mesh.prism(side, side, corners, roof_z - 0.2, roof_z + height);
  }
  return taken;
}

/// Replaces some façades by others of the same kind of wall, for more variety.
void vary(Style& style, RandomStream& looks) {
  const double pick = looks.uniform();
  if (style.facade == "facade_concrete_grey" && pick < 0.55)
    style.facade = pick < 0.3 ? "facade_balcony_white" : "facade_balcony_sand";
  if (style.facade == "facade_concrete_light" && pick < 0.2) style.facade = "facade_balcony_white";
  if (style.facade == "facade_plaster_cream" && pick < 0.5)
    style.facade = pick < 0.25 ? "facade_stone_light" : "facade_plaster_rose";
  if (style.facade == "facade_plaster_ochre" && pick < 0.4) style.facade = "facade_stone_grey";
  if (style.facade == "facade_brick_brown" && pick < 0.3) style.facade = "facade_stone_light";
}

/// Changes a façade that a neighbour has as well to another one of its kind.
void differ(Style& style, const std::vector<std::string>& beside, RandomStream& extras) {
  static const std::vector<std::string> old_ones{
      "facade_brick_red",    "facade_plaster_cream", "facade_stone_light",
      "facade_brick_yellow", "facade_plaster_ochre", "facade_stone_grey",
      "facade_brick_brown",  "facade_plaster_white", "facade_plaster_rose"};
  static const std::vector<std::string> new_ones{
      "facade_concrete_grey",  "facade_glass_blue",   "facade_balcony_white", "facade_metal_silver",
      "facade_concrete_light", "facade_balcony_sand", "facade_metal_dark",    "facade_glass_green"};
  const bool old = std::ranges::find(old_ones, style.facade) != old_ones.end();
  const std::vector<std::string>& choices = old ? old_ones : new_ones;
  size_t pick = extras.below(static_cast<uint32_t>(choices.size()));
  while (std::ranges::find(beside, style.facade) != beside.end())
    style.facade = choices[pick++ % choices.size()];
}

bool old_town(const Style& style) {
  return style.facade.find("brick") != std::string::npos ||
         style.facade.find("plaster") != std::string::npos || style.facade.find("stone") != std::string::npos;
}

struct Site {
  std::vector<dvec2> footprint;  ///< about the building's origin
  std::vector<dvec2> spots;
  std::vector<bool> alley;  ///< whether edge i faces a neighbour
  dvec2 along;
};

constexpr double scaffold_odds = 0.04;  ///< of a house without shops
constexpr double ledge_m = 0.2;         ///< height of the ledge above shops
constexpr double plinth_m = 0.75;       ///< height of the plinth, below the windows

/// Adds the rings of a ledge above shops, or of a plinth, which stands a little out of the wall.
void add_foot(RingSolid& solid, const Style& style, double street_level, RandomStream& extras) {
  const int stone = material("concrete"),
            plinth = material(extras.uniform() < 0.5 ? "plinth_grey" : "plinth_brown");
  if (style.shops) {
    const double out = -0.16;
    solid.rings.push_back({0.0, street_level, stone});
    solid.rings.push_back({out, street_level, stone});
    solid.rings.push_back({out, street_level + ledge_m, stone});
  } else {
    solid.rings.push_back({-0.05, foundation, plinth});
    solid.rings.push_back({-0.05, plinth_m, plinth});
  }
}

/// Adds the rings of a cornice at height z.
void add_cornice(RingSolid& solid, double z, double out, double tall) {
  const int stone = material("concrete");
  solid.rings.push_back({0.0, z, stone});
  solid.rings.push_back({-out, z, stone});
  solid.rings.push_back({-out, z + tall, stone});
}

/// Adds the rings of a façade from `bottom` to `top`. There is one ring for every two floors, and each starts
/// at another bay, so that no two walls show the same lit windows.
void add_facade(RingSolid& solid, double inset, double bottom, double base, double top, int facade,
                RandomStream& looks) {
  for (double z = base; z < top - 0.01; z += 2.0 * floor_height)
    solid.rings.push_back({inset, z == base ? bottom : z, facade, true, z, 1u + looks.below(0x7fffffffu)});
}

/// Adds a sign, lit by night, that stands out of the wall from a to b at height z.
void add_neon(MeshBuilder& mesh, const dvec2& a, const dvec2& b, double z, RandomStream& looks) {
  static constexpr std::array<const char*, 4> colors{"neon_red", "neon_blue", "neon_green", "neon_amber"};
  const double length = glm::length(b - a);
  if (length < 9.0) return;
  const dvec2 along = (b - a) / length, out(along.y, -along.x);
  const dvec2 foot = glm::mix(a, b, looks.uniform(0.25, 0.75));
  const double half = 0.09, reach = looks.uniform(0.7, 1.0), height = looks.uniform(1.4, 3.6);
  const std::vector<dvec2> corners{
      snap(foot - half * along - 0.1 * out), snap(foot - half * along + reach * out),
      snap(foot + half * along + reach * out), snap(foot + half * along - 0.1 * out)};
  std::vector<dvec2> ccw(corners.rbegin(), corners.rend());
  const double area = (corners[1].x - corners[0].x) * (corners[2].y - corners[0].y) -
                      (corners[1].y - corners[0].y) * (corners[2].x - corners[0].x);
  const int glow = material(colors[looks.below(4)]);
  mesh.prism(glow, glow, area > 0.0 ? corners : ccw, z, z + height);
}

Building make_building(const Site& site, int floors, bool tower, const std::vector<std::string>& beside,
                       RandomStream& random, RandomStream& looks, RandomStream& extras) {
  Building building;
  Style style = make_style(floors, random);
  const bool blind_alleys = !style.blind.empty() && random.uniform() < 0.7;
  vary(style, looks);
  differ(style, beside, extras);
  building.facade = style.facade;
  const int facade = material(style.facade), roof = material(style.roof), stone = material("concrete");
  const int shop = material(looks.uniform() < 0.6 ? "shopfront" : "shopfront_late");
  const bool shops = style.shops;
  const int blind = blind_alleys ? material(style.blind) : 0;
  const double street_level = shops ? shop_height : 0.0,
               setback = parapet_width + (tower ? random.uniform(2.2, 3.6) : 0.0);
  const double lower = tower ? 2 : floors;
  const bool pitched =
      !tower && floors <= 6 && site.footprint.size() == 4 && old_town(style) && looks.uniform() < 0.8;
  double top = street_level + floor_height * lower;

  // A pitched roof needs right angles. It covers the largest rectangle along the street, in the rectangle's
  // own axes.
  std::vector<dvec2> footprint = site.footprint;
  std::vector<bool> alley = site.alley;
  dvec2 half(0.0);
  if (pitched) {
    const dvec2 across(-site.along.y, site.along.x);
    dvec2 low(-1e9), high(1e9);
    for (const dvec2& p : footprint) {
      const dvec2 q(glm::dot(p, site.along), glm::dot(p, across));
      for (int k = 0; k < 2; ++k)
        (q[k] < 0.0 ? low[k] = std::max(low[k], q[k]) : high[k] = std::min(high[k], q[k]));
    }
    for (int k = 0; k < 2; ++k) half[k] = std::floor(100.0 * std::min(-low[k], high[k])) / 100.0;
    footprint = {-half, dvec2(half.x, -half.y), half, dvec2(-half.x, half.y)};
    building.yaw = std::atan2(site.along.y, site.along.x);
    // The edges of the rectangle face south, east, north and west. An edge has a neighbour if the footprint's
    // edge on that side has one.
    const std::array<dvec2, 4> outwards{-across, site.along, across, -site.along};
    for (size_t i = 0; i < 4; ++i)
      for (size_t k = 0; k < 4; ++k)
        if (glm::dot(glm::normalize(site.footprint[k] + site.footprint[(k + 1) % 4]), outwards[i]) > 0.8)
          alley[i] = site.alley[k];
  }

  RingSolid solid;
  solid.footprint = footprint;
  solid.bottom = stone;
  if (shops) solid.rings.push_back({0.0, foundation, shop, true, 0.0, 1u + looks.below(0x7fffffffu)});
  add_foot(solid, style, street_level, extras);
  add_facade(solid, 0.0, shops ? street_level + ledge_m : plinth_m, street_level, top, facade, looks);
  const size_t wall_rings = solid.rings.size();
  MeshBuilder& mesh = building.mesh;
  solid.override_wall = [&](size_t ring, size_t edge, int usual) {
    const bool wall = usual == facade || usual == shop;
    return blind_alleys && !tower && wall && ring < wall_rings && alley[edge] ? blind : usual;
  };
  std::vector<dvec2> spots = site.spots;
  if (pitched) {
    solid.rings.push_back({0.0, top, stone});
    add_ring_solid(mesh, solid);
    const bool mansard = floors >= 3 && looks.uniform() < 0.5;
    const char* const tiles = looks.uniform() < 0.6   ? "roof_tiles"
                              : looks.uniform() < 0.5 ? "roof_tiles_old"
                                                      : "roof_slate";
    const double ridge =
        mansard ? add_mansard(mesh, half, top, looks) : add_hip_roof(mesh, half, top, material(tiles));
    const double x = snap(0.4 * half.x), y = snap(0.15 * half.y);
    for (const double side : {-1.0, 1.0})
      mesh.box(material("blind_brick"), {side * x - 0.35, side * y - 0.5, top + 0.1},
               {side * x + 0.35, side * y + 0.5, ridge + 0.8});
    // Draws the random numbers that a flat roof would draw, so that the next building does not change.
    MeshBuilder unused;
    add_equipment(unused, inset(site.footprint, parapet_width + 0.3), spots, site.along, top, random);
  } else {
    if (old_town(style))
      add_cornice(solid, top + 0.3, 0.3, parapet_height - 0.3);
    else
      solid.rings.push_back({0.0, top + parapet_height, stone});
    solid.rings.push_back({parapet_width, top + parapet_height, stone});
    if (tower) {
      solid.rings.push_back({parapet_width, top, roof});
      const double base = top;
      top += floor_height * (floors - lower);
      add_facade(solid, setback, base, base, top, facade, looks);
      solid.rings.push_back({setback, top + parapet_height, stone});
      solid.rings.push_back({setback + parapet_width, top + parapet_height, stone});
    }
    // Parapets are as wide as the wall is thick. Inside them the solid goes down to the roof.
    solid.rings.push_back({solid.rings.back().inset_m, top, roof});
    add_ring_solid(mesh, solid);
    if (tower)
      for (dvec2& spot : spots) spot *= 0.6;  // towards the middle of the smaller roof
    const std::vector<dvec2> roof_edge = inset(site.footprint, solid.rings.back().inset_m + 0.3);
    const std::vector<dvec2> taken = add_equipment(mesh, roof_edge, spots, site.along, top, random);
    add_roof_details(mesh, roof_edge, taken, site.along, top, looks);
    add_roof_clutter(mesh, roof_edge, taken, site.along, top, floors <= 9, extras);
  }
  if (shops) {
    const size_t edge = looks.below(static_cast<uint32_t>(footprint.size()));
    if (!alley[edge])
      add_neon(mesh, footprint[edge], footprint[(edge + 1) % footprint.size()], street_level + 0.3, looks);
  }
  const Walls walls{footprint, alley, street_level, floor_height, static_cast<int>(lower), 3.0};
  if (shops)
    for (const auto& [place, out] : add_shop_fronts(mesh, walls, extras))
      building.cafes.push_back({place, out});
  else
    add_entrance(mesh, walls, extras);
  const bool homes =
      style.facade.find("plaster") != std::string::npos || style.facade.find("brick") != std::string::npos;
  if (homes && extras.uniform() < 0.4) add_balconies(mesh, walls, extras);
  if (old_town(style)) add_downpipes(mesh, walls, top, extras);
  if (!shops && !tower && extras.uniform() < scaffold_odds)
    for (const auto& [place, out] : add_scaffold(building.scaffold, walls, top))
      building.fences.push_back({place, out});
  return building;
}

}  // namespace

std::vector<Building> make_buildings(const CityPlan& plan, const Block& block, uint64_t seed, int first,
                                     RandomStream& random) {
  // The buildings keep clear of the pavements and of a strip in front of the walls.
  std::array<double, 4> insets{};
  for (size_t i = 0; i < 4; ++i) insets[i] = block.pavement_m[i] + 0.9;
  const std::vector<dvec2> quad = inset(block.sharp, insets);
  const auto at = [&](double u, double v) {
    return glm::mix(glm::mix(quad[0], quad[1], u), glm::mix(quad[3], quad[2], u), v);
  };
  const dvec2 size(0.5 * (glm::length(quad[1] - quad[0]) + glm::length(quad[2] - quad[3])),
                   0.5 * (glm::length(quad[3] - quad[0]) + glm::length(quad[2] - quad[1])));
  std::vector<Building> buildings;
  const std::vector<Lot> lots = make_lots(size, random);
  for (const Lot& lot : lots) {
    const dvec2 extent((lot.u1 - lot.u0) * size.x, (lot.v1 - lot.v0) * size.y);
    const bool roomy = std::min(extent.x, extent.y) > 20.0;
    const uint32_t kind = roomy ? random.below(6) : 1 + 2 * random.below(2);
    const Shape shape = make_shape(kind, lot.u0 > 0.5, lot.v0 > 0.3);
    const dvec2 center = snap(at(0.5 * (lot.u0 + lot.u1), 0.5 * (lot.v0 + lot.v1)));
    const auto place = [&](const dvec2& p) {
      return snap(at(glm::mix(lot.u0, lot.u1, p.x), glm::mix(lot.v0, lot.v1, p.y)) - center);
    };
    Site site;
    for (size_t i = 0; i < shape.outline.size(); ++i) {
      const dvec2 p = shape.outline[i], q = shape.outline[(i + 1) % shape.outline.size()];
      site.footprint.push_back(place(p));
      const auto inner = [](double a, double b, double lot_low, double lot_high) {
        return a == b && ((a == 0.0 && lot_low > 0.01) || (a == 1.0 && lot_high < 0.99));
      };
      site.alley.push_back(inner(p.x, q.x, lot.u0, lot.u1) || inner(p.y, q.y, lot.v0, lot.v1));
    }
    for (const dvec2& p : shape.spots) site.spots.push_back(place(p));
    site.along = glm::normalize(at(1, lot.v0) - at(0, lot.v0));

    const double nearness = 1.0 - std::min(1.0, glm::length(center) / std::max(plan.half_m, 150.0));
    const bool tower = roomy && shape.convex && random.uniform() < 0.2 + 0.45 * nearness;
    const int floors = tower ? 8 + static_cast<int>(random.below(5))
                             : std::clamp(static_cast<int>(random.uniform(2.6, 6.5) + 3.0 * nearness), 2, 9);
    // The looks have their own random stream, so that the looks of one building do not change another one.
    RandomStream looks(seed, 64, static_cast<uint32_t>(first + static_cast<int>(buildings.size())));
    RandomStream extras(seed, 65, static_cast<uint32_t>(first + static_cast<int>(buildings.size())));
    std::vector<std::string> beside;
    for (size_t i = 0; i < buildings.size(); ++i)
      if (are_neighbours(lots[i], lot, size)) beside.push_back(buildings[i].facade);
    Building building = make_building(site, floors, tower, beside, random, looks, extras);
    building.position = dvec3(center, 0.15);
    const double c = std::cos(building.yaw), s = std::sin(building.yaw);
    const auto turned = [&](const dvec2& p) { return dvec2(c * p.x - s * p.y, s * p.x + c * p.y); };
    // The tables stand 0.65 m in front of the wall.
    for (CafePlace& cafe : building.cafes)
      cafe = {snap(center + turned(cafe.where + 0.65 * cafe.out)), turned(cafe.out)};
    for (CafePlace& fence : building.fences) fence = {snap(center + turned(fence.where)), turned(fence.out)};
    buildings.push_back(std::move(building));
  }
  return buildings;
}

}  // namespace greatx::scene::generator
