// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/objects/car_cabin.h"

#include <algorithm>

#include "scene/generator/mesh/materials.h"

namespace greatx::scene::generator {

namespace {

/// Half the width of a person's seat and of a headrest, and the place of a seat's middle over the half width.
constexpr double seat_half_m = 0.235, rest_half_m = 0.13, seat_middle = 0.43;
/// From the back of one row of seats to that of the next.
constexpr double row_step_m = 0.86;

/// Returns the highest place under the rear window and the roof at x.
double ceiling(const CabinRoom& room, double x) {
  const double share = std::clamp((room.rear_roof - x) / (room.rear_roof - room.rear), 0.0, 1.0);
  return glm::mix(room.roof - 0.08, room.belt, share);
}

/// Adds the headrest of a seat, where there is room for it.
void add_headrest(MeshBuilder& mesh, const CabinRoom& room, double x, double y, double low) {
  const double top = low + 0.17;
  if (top > std::min(ceiling(room, x - 0.05), room.roof - 0.1)) return;
  mesh.box(material("seat"), {x - 0.05, y - rest_half_m, low}, {x + 0.04, y + rest_half_m, top});
}

/// Adds a bench over the whole width whose back stands at x.
void add_bench(MeshBuilder& mesh, const CabinRoom& room, double x) {
  const double y = room.half_width - 0.12, top = std::min(room.belt + 0.03, ceiling(room, x - 0.12));
  mesh.box(material("seat"), {x - 0.12, -y, room.floor - 0.012}, {x, y, top});
  for (const double side : {-1.0, 1.0})
    add_headrest(mesh, room, x - 0.07, side * seat_middle * room.half_width, top + 0.02);
}

/// Adds a box without its underside.
void add_stump(MeshBuilder& mesh, int of, const dvec3& a, const dvec3& b) {
  mesh.quad(of, {a.x, a.y, b.z}, {b.x, a.y, b.z}, {b.x, b.y, b.z}, {a.x, b.y, b.z});
  mesh.quad(of, {a.x, a.y, a.z}, {b.x, a.y, a.z}, {b.x, a.y, b.z}, {a.x, a.y, b.z});
  mesh.quad(of, {b.x, b.y, a.z}, {a.x, b.y, a.z}, {a.x, b.y, b.z}, {b.x, b.y, b.z});
  mesh.quad(of, {b.x, a.y, a.z}, {b.x, b.y, a.z}, {b.x, b.y, b.z}, {b.x, a.y, b.z});
  mesh.quad(of, {a.x, b.y, a.z}, {a.x, a.y, a.z}, {a.x, a.y, b.z}, {a.x, b.y, b.z});
}

/// Adds the seats of a parked car: those in front, which show above the belt line, and a bench.
void add_plain_seats(MeshBuilder& mesh, const CabinRoom& room) {
  const int seat = material("seat");
  const double front_row = room.seats - 0.12, top = room.belt + 0.16;
  for (const double side : {-1.0, 1.0}) {
    const double middle = side * seat_middle * room.half_width;
    add_stump(mesh, seat, {front_row - 0.13, middle - seat_half_m, room.floor},
              {front_row, middle + seat_half_m, top});
  }
  const double y = room.half_width - 0.12;
  if (room.load) {
    const double wall = front_row - 0.22;
    mesh.quad(material("cabin"), {wall, -y, room.floor}, {wall, y, room.floor}, {wall, y, room.roof - 0.18},
              {wall, -y, room.roof - 0.18});
    return;
  }
  const double x = front_row - row_step_m, back = std::min(room.belt + 0.03, ceiling(room, x - 0.12));
  if (x - 0.12 < room.rear + 0.05) return;
  mesh.quad(seat, {x, -y, room.floor}, {x, y, room.floor}, {x, y, back}, {x, -y, back});
  mesh.quad(seat, {x - 0.12, -y, back}, {x, -y, back}, {x, y, back}, {x - 0.12, y, back});
}

}  // namespace

void add_cabin(MeshBuilder& mesh, const CabinRoom& room) {
  const int trim = material("cabin");
  const double y = room.half_width - 0.06, dash = room.front - 0.40, low = room.floor;
  const double front_row = room.seats - 0.12, rear = room.load ? front_row - 0.25 : room.rear;
  // The floor is larger than the walls on it, so that no corner stands on its edge.
  const double over = 0.01;
  mesh.quad(trim, {rear - over, -y - over, low}, {room.front, -y - over, low}, {room.front, y + over, low},
            {rear - over, y + over, low});
  for (const double side : {-1.0, 1.0}) {  // the inside of the doors
    const double high = room.belt - 0.03;
    const dvec3 a(rear, side * y, low), b(dash, side * y, low), c(dash, side * y, high),
        d(rear, side * y, high);
    if (side < 0.0)
      mesh.quad(trim, d, c, b, a);
    else
      mesh.quad(trim, a, b, c, d);
  }
  if (room.plain) {
    const double top = room.belt - 0.05, reach = y - 0.04;
    mesh.quad(trim, {dash, -reach, top}, {room.front - 0.06, -reach, top}, {room.front - 0.06, reach, top},
              {dash, reach, top});
    mesh.quad(trim, {dash, reach, low}, {dash, -reach, low}, {dash, -reach, top}, {dash, reach, top});
    return add_plain_seats(mesh, room);
  }
  mesh.box(trim, {dash, -y + 0.04, low - 0.012}, {room.front - 0.12, y - 0.04, room.belt - 0.05});
  for (const double side : {-1.0, 1.0}) {
    const double middle = side * seat_middle * room.half_width, top = room.belt + 0.10;
    mesh.box(material("seat"), {front_row - 0.13, middle - seat_half_m, low - 0.012},
             {front_row, middle + seat_half_m, top});
    add_headrest(mesh, room, front_row - 0.07, middle, top + 0.03);
  }
  if (room.load) {
    const double wall = front_row - 0.22;
    mesh.box(trim, {wall - 0.03, -room.roof_y + 0.08, low - 0.012},
             {wall, room.roof_y - 0.08, room.roof - 0.14});
    return;
  }
  for (double x = front_row - row_step_m; x - 0.12 > room.rear + 0.05; x -= row_step_m)
    add_bench(mesh, room, x);
}

}  // namespace greatx::scene::generator
