// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/objects/saloon.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/generator/mesh/materials.h"

namespace greatx::scene::generator {

namespace {

constexpr double bench_m = 0.62, back_m = 0.24;  ///< of a bench's back: height above the floor, depth there
constexpr double door_m = 0.8;                   ///< no benches are nearer to the middle of a door

/// Adds a level rectangle that faces up.
void add_level(MeshBuilder& mesh, int of, const dvec2& low, const dvec2& high, double z) {
  mesh.quad(of, {low.x, low.y, z}, {high.x, low.y, z}, {high.x, high.y, z}, {low.x, high.y, z});
}

/// Adds the back of a bench from side to side: a wedge, upright behind, that leans in front.
void add_back(MeshBuilder& mesh, int of, double x, double half, double low, double high) {
  const double rear = x - back_m;
  mesh.quad(of, {x, -half, low}, {x, half, low}, {rear, half, high}, {rear, -half, high});
  mesh.quad(of, {rear, half, low}, {rear, -half, low}, {rear, -half, high}, {rear, half, high});
  for (const double side : {-1.0, 1.0}) {
    const dvec3 a(rear, side * half, low), b(x, side * half, low), c(rear, side * half, high);
    const std::array<dvec2, 3> uvs{dvec2(0.0), dvec2(1.0, 0.0), dvec2(0.0, 1.0)};
    if (side < 0.0)
      mesh.triangle(of, {a, b, c}, uvs);
    else
      mesh.triangle(of, {b, a, c}, uvs);
  }
}

/// Adds an upright pole of three sides, whose ends nobody sees.
void add_pole(MeshBuilder& mesh, const dvec2& at, double low, double high) {
  const std::vector<dvec2> rim = regular_polygon(3, 0.025, at);
  for (size_t i = 0; i < 3; ++i) {
    const dvec2 a = rim[i], b = rim[(i + 1) % 3];
    mesh.quad(material("bus_pole"), {a, low}, {b, low}, {b, high}, {a, high});
  }
}

}  // namespace

void add_saloon(MeshBuilder& mesh, const Saloon& saloon) {
  const double y = saloon.half_width;
  add_level(mesh, material("bus_floor"), {saloon.rear, -y}, {saloon.front, y}, saloon.floor);
  mesh.quad(material("bus_ceiling"), {saloon.front, -y, saloon.ceiling}, {saloon.rear, -y, saloon.ceiling},
            {saloon.rear, y, saloon.ceiling}, {saloon.front, y, saloon.ceiling});
  for (double x = saloon.front - 0.3; x - back_m > saloon.rear + 0.2; x -= saloon.step) {
    const bool door = std::ranges::any_of(
        saloon.doors, [&](double at) { return std::abs(x - 0.5 * back_m - at) < door_m; });
    const bool gap =
        std::ranges::any_of(saloon.gaps, [&](const dvec2& g) { return x > g.x && x - back_m < g.y; });
    if (!door && !gap)
      add_back(mesh, material("bus_seat"), x, y - 0.02, saloon.floor, saloon.floor + bench_m);
  }
  for (const double door : saloon.doors)
    if (door < saloon.front && door > saloon.rear)
      for (const double side : {-0.55, 0.55})
        add_pole(mesh, {door + side, -0.45 * y}, saloon.floor, saloon.ceiling);
}

void add_drivers_cab(MeshBuilder& mesh, const DriversCab& cab) {
  const int trim = material("cabin"), seat = material("seat");
  const double y = cab.half_width - 0.1, floor = cab.belt - 0.25, dash = cab.front - 0.55;
  add_level(mesh, trim, {cab.rear + 0.05, -y}, {dash, y}, floor);
  add_level(mesh, trim, {dash, -y}, {cab.front - 0.12, y}, cab.belt - 0.04);
  mesh.quad(trim, {dash, y, floor}, {dash, -y, floor}, {dash, -y, cab.belt - 0.04},
            {dash, y, cab.belt - 0.04});
  const double back = std::max(cab.rear + 0.25, dash - 0.95);
  for (const double side : {-1.0, 1.0}) {
    if (side < 0.0 && cab.alone) continue;  // traffic keeps to the right: the driver sits on the left
    const double from = side * 0.52 * y - 0.26, to = from + 0.52;
    mesh.box(seat, {back - 0.14, from, floor - 0.012}, {back, to, cab.belt + 0.22});
    mesh.box(seat, {back - 0.12, from + 0.12, cab.belt + 0.25}, {back - 0.03, to - 0.12, cab.belt + 0.42});
  }
}

}  // namespace greatx::scene::generator
