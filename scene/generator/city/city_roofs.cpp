// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/city/city_roofs.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/units.h"
#include "scene/generator/mesh/materials.h"

namespace greatx::scene::generator {

namespace {

constexpr double sunk = 0.06;

/// Makes a dormer whose front faces +x from the origin: 1.5 m wide, 1.6 m high, `depth` deep.
MeshBuilder make_dormer(double depth, bool lit) {
  MeshBuilder mesh;
  const int sheet = material("roof_zinc"), front = material(lit ? "dormer" : "dormer_dark");
  const double w = 0.75, h = 1.6;
  mesh.quad(front, {dvec3(0, -w, 0), dvec3(0, w, 0), dvec3(0, w, h), dvec3(0, -w, h)},
            {dvec2(0, 1), dvec2(1, 1), dvec2(1, 0), dvec2(0, 0)});
  mesh.quad(sheet, {-depth, w, 0}, {-depth, -w, 0}, {-depth, -w, h}, {-depth, w, h});
  mesh.quad(sheet, {-depth, -w, 0}, {0, -w, 0}, {0, -w, h}, {-depth, -w, h});
  mesh.quad(sheet, {0, w, 0}, {-depth, w, 0}, {-depth, w, h}, {0, w, h});
  mesh.quad(sheet, {-depth, -w, h}, {0, -w, h}, {0, w, h}, {-depth, w, h});
  mesh.quad(sheet, {-depth, w, 0}, {0, w, 0}, {0, -w, 0}, {-depth, -w, 0});
  return mesh;
}

}  // namespace

bool inside(const std::vector<dvec2>& polygon, const dvec2& p) {
  bool odd = false;
  for (size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const dvec2 a = polygon[i], b = polygon[j];
    if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x) odd = !odd;
  }
  return odd;
}

double add_hip_roof(MeshBuilder& mesh, const dvec2& half, double eaves, int tiles) {
  // The roof has its own axes: a along the ridge, b across.
  const bool turned = half.y > half.x;
  const double overhang = 0.4, long_half = std::max(half.x, half.y) + overhang,
               short_half = std::min(half.x, half.y) + overhang;
  const double ridge = long_half - short_half;
  const double z0 = eaves - sunk, z1 = eaves + 0.16, top = snap(z1 + std::min(0.7 * short_half, 4.4));
  const auto point = [&](double a, double b, double z) { return turned ? dvec3(-b, a, z) : dvec3(a, b, z); };
  const std::array<dvec2, 4> rim{dvec2(-long_half, -short_half), dvec2(long_half, -short_half),
                                 dvec2(long_half, short_half), dvec2(-long_half, short_half)};
  const int fascia = material("door_boards");
  std::array<dvec3, 4> low, high;
  for (size_t i = 0; i < 4; ++i) {
    low[i] = point(rim[i].x, rim[i].y, z0);
    high[i] = point(rim[i].x, rim[i].y, z1);
  }
  mesh.quad(fascia, low[3], low[2], low[1], low[0]);
  for (size_t i = 0; i < 4; ++i) mesh.quad(fascia, low[i], low[(i + 1) % 4], high[(i + 1) % 4], high[i]);
  const bool pyramid = ridge < 0.3;
  const dvec3 west = point(pyramid ? 0.0 : -ridge, 0.0, top), east = point(pyramid ? 0.0 : ridge, 0.0, top);
  if (pyramid) {
    mesh.polygon(tiles, std::array{high[0], high[1], west});
    mesh.polygon(tiles, std::array{high[2], high[3], west});
  } else {
    mesh.quad(tiles, high[0], high[1], east, west);
    mesh.quad(tiles, high[2], high[3], west, east);
  }
  mesh.polygon(tiles, std::array{high[1], high[2], east});
  mesh.polygon(tiles, std::array{high[3], high[0], west});
  return top;
}

double add_mansard(MeshBuilder& mesh, const dvec2& half, double eaves, RandomStream& looks) {
  const double cornice = 0.3, rise = 2.7, run = 1.3;
  const dvec2 h = half + cornice;
  RingSolid solid;
  solid.footprint = {{-h.x, -h.y}, {h.x, -h.y}, {h.x, h.y}, {-h.x, h.y}};
  solid.bottom = material("concrete");
  solid.rings = {{0.0, eaves - sunk, material("concrete")},
                 {0.0, eaves + 0.24, material("roof_slate")},
                 {run, eaves + 0.24 + rise, material("roof_zinc")}};
  add_ring_solid(mesh, solid);
  for (int side = half.x > half.y ? 1 : 0; side < 4; side += 2) {  // the long sides
    const double yaw = 0.5 * pi * side;
    const double out = side % 2 == 0 ? h.x : h.y, width = 2.0 * (side % 2 == 0 ? h.y : h.x);
    const int count = static_cast<int>((width - 4.0) / 4.0);
    for (int i = 0; i < count; ++i) {
      const double t = snap((i + 0.5 - 0.5 * count) * 4.0);
      const dvec3 at(out - 0.32, t, eaves + 0.6);
      const dvec3 turned(std::round(std::cos(yaw)) * at.x - std::round(std::sin(yaw)) * at.y,
                         std::round(std::sin(yaw)) * at.x + std::round(std::cos(yaw)) * at.y, at.z);
      mesh.append(make_dormer(1.3, looks.uniform() < 0.3), turned, yaw);
    }
  }
  return eaves + 0.24 + rise;
}

void add_roof_details(MeshBuilder& mesh, const std::vector<dvec2>& roof, std::vector<dvec2> taken,
                      const dvec2& along, double roof_z, RandomStream& looks) {
  const dvec2 across(-along.y, along.x);
  dvec2 low(1e9), high(-1e9);
  for (const dvec2& p : roof) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  const bool solar = looks.uniform() < 0.3;
  const int wanted = solar ? 2 : 1 + static_cast<int>(looks.below(2));
  int placed = 0;
  for (int attempt = 0; attempt < 14 && placed < wanted; ++attempt) {
    const dvec2 spot = snap(dvec2(looks.uniform(low.x, high.x), looks.uniform(low.y, high.y)));
    const uint32_t kind = looks.below(3);
    const dvec2 half = solar ? dvec2(2.4, 0.5) : kind == 0 ? dvec2(0.9, 0.6) : dvec2(0.35, 0.35);
    const double height = solar ? 0.0 : kind == 0 ? 0.35 : kind == 1 ? 0.9 : 0.6;
    std::vector<dvec2> corners;
    for (const dvec2& c : {dvec2(-1, -1), dvec2(1, -1), dvec2(1, 1), dvec2(-1, 1)})
      corners.push_back(snap(spot + along * (c.x * half.x) + across * (c.y * half.y)));
    const double clear = solar ? 5.3 : 3.4;
    const bool fits =
        std::all_of(corners.begin(), corners.end(), [&](const dvec2& c) { return inside(roof, c); }) &&
        std::all_of(taken.begin(), taken.end(),
                    [&](const dvec2& other) { return glm::length(other - spot) > clear; });
    if (!fits) continue;
    taken.push_back(spot);
    ++placed;
    if (solar) {
      // A wedge that leans towards the lower edge carries the panel on its long slope.
      const int panel = material("solar_panel"), frame = material("roof_equipment");
      const dvec3 a(corners[0], roof_z - 0.1), b(corners[1], roof_z - 0.1), c(corners[2], roof_z - 0.1),
          d(corners[3], roof_z - 0.1);
      const dvec3 up(0.0, 0.0, 0.75);
      mesh.quad(panel, a, b, c + up, d + up);
      mesh.quad(frame, c, d, d + up, c + up);
      mesh.quad(frame, d, c, b, a);
      mesh.polygon(frame, std::array{b, c, c + up});
      mesh.polygon(frame, std::array{d, a, d + up});
      continue;
    }
    const int side = kind == 0 ? material("concrete") : material("roof_equipment");
    mesh.prism(side, kind == 0 ? material("skylight") : side, corners, roof_z - 0.15, roof_z + height);
  }
}

}  // namespace greatx::scene::generator
