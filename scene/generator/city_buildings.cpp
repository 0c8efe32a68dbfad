// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/city_buildings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "scene/generator/materials.h"

namespace greatx::scene::generator {

namespace {

constexpr double floor_height = 3.2;
constexpr double shop_height = 4.2;
constexpr double parapet_height = 0.8;  // stays within the plain foot of a façade's floor
constexpr double parapet_width = 0.35;
constexpr double foundation = -0.45;  // below the pavement's level, so that nothing ends in its plane

/// A lot in the block's (u, v) square.
struct Lot {
  double u0, v0, u1, v1;
};

/// A footprint in a lot's unit square, counter-clockwise, and spots for things on its roof.
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

/// Divides the unit square; `gap` is an alley's width as fractions.
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

struct Style {
  std::string facade, blind, roof;
  bool shops = false;
};

Style make_style(int floors, RandomStream& random) {
  struct Option {
    const char *facade, *blind;
    double low_weight, high_weight;  // for up to 6 floors, for more
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

bool inside(const std::vector<dvec2>& polygon, const dvec2& p) {
  bool odd = false;
  for (size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const dvec2 a = polygon[i], b = polygon[j];
    if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x) odd = !odd;
  }
  return odd;
}

/// Boxes of plant and the head of the stairs, sunk a little into the roof: where they fit within `roof` and apart.
void add_equipment(MeshBuilder& mesh, const std::vector<dvec2>& roof, const std::vector<dvec2>& spots,
                   const dvec2& along, double roof_z, RandomStream& random) {
  const int sheet = material("roof_equipment"), concrete = material("concrete");
  const dvec2 across(-along.y, along.x);
  const size_t count = 1 + random.below(static_cast<uint32_t>(spots.size()));
  std::vector<dvec2> taken;
  for (size_t i = 0; i < count; ++i) {
    const dvec2 half{random.uniform(1.1, 1.9), random.uniform(0.9, 1.4)};  // braces: in this order
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
}

struct Site {
  std::vector<dvec2> footprint;  ///< about the building's origin
  std::vector<dvec2> spots;
  std::vector<bool> alley;  ///< whether edge i looks at a neighbour
  dvec2 along;
};

MeshBuilder make_building(const Site& site, int floors, bool tower, RandomStream& random) {
  const Style style = make_style(floors, random);
  const int facade = material(style.facade), roof = material(style.roof), stone = material("concrete");
  const bool shops = style.shops;
  const bool blind_alleys = !style.blind.empty() && random.uniform() < 0.7;
  const int blind = blind_alleys ? material(style.blind) : 0;

  RingSolid solid;
  solid.footprint = site.footprint;
  solid.bottom = stone;
  const double street_level = shops ? shop_height : 0.0;
  if (shops) solid.rings.push_back({0.0, foundation, material("shopfront"), true, 0.0});
  const double lower = tower ? 2 : floors;
  double top = street_level + floor_height * lower;
  solid.rings.push_back({0.0, shops ? street_level : foundation, facade, true, street_level});
  solid.rings.push_back({0.0, top + parapet_height, stone});
  solid.rings.push_back({parapet_width, top + parapet_height, stone});
  if (tower) {
    const double setback = parapet_width + random.uniform(2.2, 3.6);
    solid.rings.push_back({parapet_width, top, roof});
    solid.rings.push_back({setback, top, facade, true, top});
    top += floor_height * (floors - lower);
    solid.rings.push_back({setback, top + parapet_height, stone});
    solid.rings.push_back({setback + parapet_width, top + parapet_height, stone});
  }
  // Parapets are as wide as the wall is thick: fall back to the roof inside them.
  solid.rings.push_back({solid.rings.back().inset_m, top, roof});
  solid.override_wall = [&](size_t ring, size_t edge, int usual) {
    return blind_alleys && !tower && ring <= (shops ? 1u : 0u) && site.alley[edge] ? blind : usual;
  };
  MeshBuilder mesh;
  add_ring_solid(mesh, solid);
  std::vector<dvec2> spots = site.spots;
  if (tower)
    for (dvec2& spot : spots) spot *= 0.6;  // towards the middle of its smaller roof
  const std::vector<dvec2> roof_edge = inset(site.footprint, solid.rings.back().inset_m + 0.3);
  add_equipment(mesh, roof_edge, spots, site.along, top, random);
  return mesh;
}

}  // namespace

std::vector<Building> make_buildings(const CityPlan& plan, const Block& block, RandomStream& random) {
  // The block inside its pavements and a strip in front of the walls.
  std::array<double, 4> insets{};
  for (size_t i = 0; i < 4; ++i) insets[i] = block.pavement_m[i] + 0.9;
  const std::vector<dvec2> quad = inset(block.sharp, insets);
  const auto at = [&](double u, double v) {
    return glm::mix(glm::mix(quad[0], quad[1], u), glm::mix(quad[3], quad[2], u), v);
  };
  const dvec2 size(0.5 * (glm::length(quad[1] - quad[0]) + glm::length(quad[2] - quad[3])),
                   0.5 * (glm::length(quad[3] - quad[0]) + glm::length(quad[2] - quad[1])));
  std::vector<Building> buildings;
  for (const Lot& lot : make_lots(size, random)) {
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
    buildings.push_back({make_building(site, floors, tower, random), dvec3(center, 0.15)});
  }
  return buildings;
}

}  // namespace greatx::scene::generator
