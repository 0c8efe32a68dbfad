// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/objects/box_body.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/units.h"
#include "scene/generator/mesh/materials.h"
#include "scene/generator/objects/box_shell.h"
#include "scene/generator/objects/saloon.h"
#include "scene/generator/objects/smooth_mesh.h"

namespace greatx::scene::generator {

namespace {

/// Adds a pair of head lamps and of tail lamps at the heights z.x and z.y, slightly proud of the body.
void add_lamps(VehicleBody& body, double front, double rear, double y, const dvec2& z) {
  const dvec3 head(front, y, z.x), tail(rear, y, z.y);
  add_boxes(body.mesh, material("lamp_cover"), head - dvec3(0.3, 0.20, 0.09), head + dvec3(0.01, 0.14, 0.09));
  add_boxes(body.mesh, material("headlight"), head - dvec3(0.1, 0.08, 0.05), head + dvec3(0.02, 0.06, 0.05));
  add_boxes(body.mesh, material("switched_stop"), tail - dvec3(0.015, 0.07, 0.16),
            tail + dvec3(0.2, 0.07, 0.16));
  add_indicators(body.mesh, head + dvec3(-0.1, 0.07, -0.05), head + dvec3(0.02, 0.13, 0.05));
  add_indicators(body.mesh, tail + dvec3(-0.015, -0.07, -0.26), tail + dvec3(0.2, 0.07, -0.165));
  body.head_lamps = {head};
  body.tail_lamps = {tail};
}

/// Adds mirrors on arms ahead of the front edge of the roof, as buses have them.
void add_bus_mirrors(MeshBuilder& mesh, double front, double w, double z) {
  const int dark = material("bumper");
  add_boxes(mesh, dark, {front - 0.08, w - 0.35, z + 0.1}, {front + 0.20, w - 0.3, z + 0.16});
  add_boxes(mesh, dark, {front + 0.10, w - 0.42, z - 0.42}, {front + 0.22, w - 0.2, z + 0.12});
}

/// Describes a bus by its levels.
struct BusStyle {
  const char* variant;
  double floor;
  std::vector<double> window_low, window_top;  ///< z of the lower and upper edge of each band of windows
  double corner, rake;                         ///< the windscreen leans back by `rake` up to the roof
  double pillar_step;                          ///< between the pillars of the side windows
};

const std::vector<BusStyle>& bus_styles() {
  static const std::vector<BusStyle> list{
      {"city_bus", 0.30, {1.05}, {2.55}, 0.28, 0.10, 1.8},
      {"double_decker", 0.30, {1.05, 2.72}, {2.15, 3.80}, 0.30, 0.12, 2.2},
      {"coach", 0.34, {1.72}, {3.05}, 0.34, 0.35, 1.9}};
  return list;
}

/// Adds the doors on the right side: glass leaves slightly proud of the body.
void add_doors(MeshBuilder& mesh, double w, const std::vector<double>& middles, double low, double top) {
  for (const double x : middles)
    mesh.box(material("lit_window"), {x - 0.62, -w - 0.012, low}, {x + 0.62, -w + 0.05, top});
}

VehicleBody make_bus(const VehicleShape& shape, const BusStyle& style, int paint) {
  const double front = 0.5 * shape.length_m, w = 0.5 * shape.width_m;
  const double top = shape.height_m - (shape.variant == "city_bus" ? 0.2 : 0.0);
  const int glass = material("lit_pane_bus"), trim = material("car_trim");
  const double rear_axle = shape.rear_axle_x_m, front_axle = shape.wheels.front().hub_m.x;
  BoxShell shell;
  shell.front_x = front;
  shell.rear_x = -front;
  shell.half_width = w;
  shell.corner = style.corner;
  shell.levels = {{style.floor, 0.0, 0.02, 0.03}};
  std::vector<bool> glazed{false};
  for (size_t i = 0; i < style.window_low.size(); ++i)
    for (const double z : {style.window_low[i], style.window_top[i]}) {
      const double share = (z - style.window_low[0]) / (top - style.window_low[0]);
      shell.levels.push_back({z, 0.0, style.rake * share * share, 0.04 * share});
      glazed.push_back(z == style.window_low[i]);
    }
  shell.levels.push_back({top - 0.10, 0.02, style.rake + 0.02, 0.06});
  shell.levels.push_back({top, 0.22, style.rake + 0.25, 0.25});
  glazed.insert(glazed.end(), {false, false});
  for (double x = front - 1.5; x > -front + 1.2; x -= style.pillar_step) {
    // not within a wheel arch
    const double clear = std::min(std::abs(x - rear_axle), std::abs(x - front_axle));
    if (clear > 0.75) shell.stations.insert(shell.stations.end(), {x + 0.04, x - 0.04});
  }
  shell.arches = {front_axle, rear_axle};
  shell.wheel_radius = shape.wheels[0].radius_m;
  shell.arch_radius = shell.wheel_radius + 0.05;
  shell.bottom = material("bumper");
  shell.roof = paint;
  shell.cell = [&](size_t level, ShellZone zone, double x) {
    if (!glazed[level]) return level == 0 && zone == ShellZone::rear ? material("bumper") : paint;
    const std::vector<double>& s = shell.stations;
    for (size_t i = 0; i + 1 < s.size(); i += 2)
      if (zone == ShellZone::side && x < s[i] && x > s[i + 1]) return trim;
    if (zone == ShellZone::rear_corner) return paint;
    return zone == ShellZone::front_corner || zone == ShellZone::front ? material("car_glass") : glass;
  };
  VehicleBody body;
  add_box_shell(body.mesh, shell);
  body.mesh.box(material("bumper"), {-front + 0.4, -w + 0.4, style.floor + 0.02},
                {front - 0.6, w - 0.4, style.floor + 0.6});
  add_lamps(body, front, -front + 0.01, w - 0.42, {0.62, 1.0});
  add_plate(body.mesh, front + 0.01, 0.42, true);
  add_plate(body.mesh, -front, 0.72, false);
  const double sign = style.window_top.back() + 0.03;
  if (shape.variant != "coach")
    body.mesh.box(material("destination"), {front - style.rake - 0.25, -0.75, sign},
                  {front - 0.55 * style.rake + 0.02, 0.75, std::min(sign + 0.28, top - 0.12)});
  std::vector<double> doors{front - 0.85};
  if (shape.variant == "city_bus") doors.insert(doors.end(), {0.35, -front + 2.0});
  add_doors(body.mesh, w, doors, style.floor + 0.06, std::min(2.35, style.window_top[0]));
  for (size_t i = 0; i < style.window_low.size(); ++i)
    add_saloon(body.inside, {.front = front - (i == 0 ? 1.7 : 0.6),
                             .rear = -front + 0.15,
                             .half_width = w - 0.12,
                             .floor = style.window_low[i] - (i == 0 ? 0.03 : 0.1),  // above the wheel arches
                             .ceiling = std::min(style.window_top[i] + 0.06, top - 0.12),
                             .doors = i == 0 ? doors : std::vector<double>{}});
  add_drivers_cab(body.inside, {.front = front - style.rake,
                                .rear = front - 1.7,
                                .half_width = w - 0.1,
                                .belt = style.window_low[0],
                                .alone = true});
  add_bus_mirrors(body.mesh, front, w, style.window_top[0] - 0.1);
  if (shape.variant == "city_bus")
    body.mesh.box(material("car_paint_white"), {-1.6, -0.85, top - 0.05}, {1.4, 0.85, shape.height_m});
  return body;
}

VehicleBody make_tram(const VehicleShape& shape, int paint) {
  const double front = 0.5 * shape.length_m, w = 0.5 * shape.width_m, roof = shape.height_m - 0.42;
  const int glass = material("lit_pane_bus"), trim = material("car_trim"), bellows = material("bumper");
  BoxShell shell;
  shell.front_x = front;
  shell.rear_x = -front;
  shell.half_width = w;
  shell.corner = 0.62;
  shell.levels = {{0.26, 0.06, 0.30, 0.30},
                  {0.95, 0.0, 0.0, 0.0},
                  {2.35, 0.03, 0.55, 0.55},
                  {roof - 0.1, 0.10, 0.75, 0.75},
                  {roof, 0.35, 1.0, 1.0}};
  const std::vector<double> joints{3.45, -3.45};
  for (const double joint : joints) shell.stations.insert(shell.stations.end(), {joint + 0.28, joint - 0.28});
  for (const double x : {7.9, 5.6, 1.9, -1.9, -5.6, -7.9})
    shell.stations.insert(shell.stations.end(), {x + 0.04, x - 0.04});
  shell.bottom = bellows;
  shell.roof = material("truck_box");
  shell.cell = [&](size_t level, ShellZone zone, double x) {
    if (zone == ShellZone::side)
      for (const double joint : joints)
        if (std::abs(x - joint) < 0.27) return bellows;
    if (level == 1) {
      if (zone != ShellZone::side) return material("car_glass");
      for (const double s : shell.stations)
        if (std::abs(std::abs(x - s) - 0.04) < 1e-6 && std::abs(s - x) < 0.05) return trim;
      return glass;
    }
    return level >= 3 ? material("truck_box") : level == 2 ? trim : paint;
  };
  VehicleBody body;
  add_box_shell(body.mesh, shell);
  add_lamps(body, front - 0.06, -front + 0.06, 0.55, {0.72, 0.72});
  for (const double side : {-1.0, 1.0})
    body.mesh.box(material("destination"), {side * (front - 0.80) - 0.12, -0.6, 2.42},
                  {side * (front - 0.80) + 0.12, 0.6, 2.66});
  for (const double x : {-6.3, 6.3})
    body.mesh.box(material("truck_box"), {x - 1.1, -0.7, roof - 0.03}, {x + 1.1, 0.7, roof + 0.24});
  add_doors(body.mesh, w - 0.015, {4.5, 0.9, -0.9, -4.5}, 0.34, 2.25);
  MeshBuilder other;  // the doors on the left side
  add_doors(other, w - 0.015, {4.5, 0.9, -0.9, -4.5}, 0.34, 2.25);
  body.mesh.append(other, dvec3(0.0), pi);
  add_saloon(body.inside, {.front = front - 1.9,
                           .rear = -front + 1.9,
                           .half_width = w - 0.12,
                           .floor = 0.86,
                           .ceiling = 2.40,
                           .doors = {4.5, 0.9, -0.9, -4.5},
                           .gaps = {{3.0, 3.9}, {-3.9, -3.0}}});
  // the pantograph: an arm with an elbow, and the bow that touches the wire
  SmoothMesh arm;
  const dvec3 knee(-0.9, 0.0, roof + 0.25);
  add_tube(arm, material("chassis"), std::vector<dvec3>{{0.2, 0.0, roof - 0.02}, knee}, 0.035, 4);
  add_tube(arm, material("chassis"), std::vector<dvec3>{knee, {0.1, 0.0, shape.height_m - 0.03}}, 0.025, 4);
  arm.add_to(body.mesh, 0.8);
  body.mesh.box(material("chassis"), {0.06, -0.75, shape.height_m - 0.04}, {0.14, 0.75, shape.height_m});
  return body;
}

/// Adds a driver's cab whose rear is at `rear` and whose roof is at `top`.
void add_cab(VehicleBody& body, const VehicleShape& shape, double rear, double top, int paint) {
  const double front = 0.5 * shape.length_m, w = std::min(0.5 * shape.width_m, 1.24);
  const double radius = shape.wheels[0].radius_m, belt = std::max(2.0 * radius + 0.62, 0.56 * top);
  BoxShell shell;
  shell.front_x = front;
  shell.rear_x = rear;
  shell.half_width = w;
  shell.corner = 0.22;
  shell.levels = {{0.34, 0.02, 0.03, 0.0},        {2.0 * radius + 0.12, 0.0, 0.0, 0.0},
                  {belt, 0.0, 0.03, 0.0},         {top - 0.28, 0.05, 0.20, 0.0},
                  {top - 0.06, 0.09, 0.32, 0.02}, {top, 0.28, 0.60, 0.1}};
  const double axle = shape.wheels[0].hub_m.x;
  const double door = axle - rear > 1.3 ? rear + 0.35 : axle - radius - 0.10;  // rear edge of its window
  shell.stations = {door};
  shell.arches = {axle};
  shell.wheel_radius = radius;
  shell.arch_radius = radius + 0.07;
  shell.bottom = material("chassis");
  shell.roof = paint;
  shell.cell = [&](size_t level, ShellZone zone, double x) {
    if (level == 0) return zone == ShellZone::side || zone == ShellZone::rear ? paint : material("bumper");
    if (level == 1 && zone == ShellZone::front) return material("car_trim");  // grille
    if (level == 2 && zone != ShellZone::rear && zone != ShellZone::rear_corner)
      return zone == ShellZone::front_corner && x < front - 0.1 ? paint
             : zone == ShellZone::side && x < door              ? paint
                                                                : material("car_glass");
    return paint;
  };
  add_box_shell(body.mesh, shell);
  add_drivers_cab(body.inside, {.front = front - 0.05, .rear = rear, .half_width = w, .belt = belt});
  add_boxes(body.mesh, material("bumper"), {front - 0.12, w + 0.02, belt + 0.08},
            {front - 0.02, w + 0.22, belt + 0.62});
  add_boxes(body.mesh, material("bumper"), {front - 0.2, w - 0.1, belt + 0.55},
            {front - 0.05, w + 0.1, belt + 0.6});
}

/// Adds the frame below a load from x = low to high, with mudguards over the rear axles and side guards.
void add_frame(MeshBuilder& mesh, const VehicleShape& shape, double low, double high, double z) {
  const int dark = material("chassis");
  const double radius = shape.wheels[0].radius_m, w = 0.5 * shape.width_m;
  mesh.box(dark, {low, -0.45, z - 0.28}, {high, 0.45, z + 0.02});
  const double guard_front = shape.wheels[0].hub_m.x - radius - 0.45;
  double first_rear = shape.rear_axle_x_m;
  for (const VehicleShape::Wheel& wheel : shape.wheels)
    if (wheel.hub_m.x < guard_front - 0.5) first_rear = std::max(first_rear, wheel.hub_m.x);
  if (guard_front - first_rear > 1.6)
    add_boxes(mesh, dark, {first_rear + radius + 0.25, w - 0.12, 0.45}, {guard_front - 0.2, w - 0.06, 0.85});
  mesh.box(dark, {low - 0.02, -w + 0.12, 0.45}, {low + 0.08, w - 0.12, 0.62});
}

VehicleBody make_lorry(const VehicleShape& shape, int paint) {
  const double front = 0.5 * shape.length_m, w = 0.5 * shape.width_m, top = shape.height_m;
  const bool articulated = shape.variant == "articulated_lorry", small = shape.variant == "box_truck";
  const double cab_rear = std::min(front - (small         ? 1.75
                                            : articulated ? 2.25
                                                          : 2.0),
                                   shape.wheels[0].hub_m.x - shape.wheels[0].radius_m - 0.50);
  const double deck = small ? 0.98 : 1.12, cab_top = small ? 2.45 : articulated ? 3.65 : 3.0;
  VehicleBody body;
  add_cab(body, shape, cab_rear, cab_top, paint);
  const double load_front = cab_rear - (articulated ? 0.65 : 0.12);
  if (shape.variant == "tipper") {
    const std::vector<dvec2> footprint{{-front + 0.05, -w + 0.03},
                                       {load_front, -w + 0.03},
                                       {load_front, w - 0.03},
                                       {-front + 0.05, w - 0.03}};
    const int side = material("car_paint_grey");
    add_ring_solid(body.mesh, {footprint,
                               {{0.0, deck + 0.05, side},
                                {0.0, 2.45, side},
                                {0.07, 2.45, side},
                                {0.07, 2.2, material("roof_gravel")}},
                               side,
                               {}});
    body.mesh.box(side, {load_front - 0.05, -w + 0.2, 2.4}, {load_front + 0.06, w - 0.2, top});
  } else {
    const int load = articulated ? material("tarpaulin") : material("truck_box");
    body.mesh.box(load, {-front + 0.02, -w, deck}, {load_front, w, top});
    const int frame = material("galvanised_metal");  // the frame of the doors
    for (const double z : {deck - 0.06, top - 0.05})
      body.mesh.box(frame, {-front, -w + 0.05, z}, {-front + 0.1, w - 0.05, z + 0.04});
    if (!articulated && !small)
      body.mesh.box(paint, {cab_rear + 0.15, -0.95, cab_top - 0.05}, {cab_rear + 1.1, 0.95, top - 0.25});
  }
  add_frame(body.mesh, shape, -front + 0.04, front - 0.6, deck);
  add_lamps(body, front - 0.01, -front + 0.03, w - 0.35, {0.72, 0.86});
  add_plate(body.mesh, front + 0.0, 0.46, true);
  add_plate(body.mesh, -front + 0.02, 0.70, false);
  return body;
}

VehicleBody make_fire_engine(const VehicleShape& shape, int paint) {
  const double front = 0.5 * shape.length_m, w = 0.5 * shape.width_m, top = shape.height_m - 0.12;
  VehicleBody body;
  const double cab_rear = front - 3.0;
  add_cab(body, shape, cab_rear, top - 0.1, paint);
  body.mesh.box(paint, {-front, -w, 0.64}, {cab_rear + 0.02, w, top});
  const int shutter = material("galvanised_metal");
  const double axle = shape.rear_axle_x_m;
  for (const double x : {axle + 1.35, axle - 1.35})
    add_boxes(body.mesh, shutter, {x - 0.62, w - 0.05, 0.75}, {x + 0.62, w + 0.012, top - 0.35});
  add_boxes(body.mesh, shutter, {axle - 0.62, w - 0.05, 1.35}, {axle + 0.62, w + 0.012, top - 0.35});
  add_boxes(body.mesh, material("car_paint_white"), {-front + 0.1, w - 0.05, top - 0.28},
            {cab_rear - 0.05, w + 0.008, top - 0.12});
  body.mesh.box(material("blue_beacon"), {front - 0.85, -0.9, top - 0.14}, {front - 0.6, 0.9, top + 0.12});
  for (const double y : {-0.3, 0.24})
    body.mesh.box(shutter, {-front + 0.1, y, top - 0.02}, {cab_rear + 0.2, y + 0.06, top + 0.11});
  for (double x = -front + 0.4; x < cab_rear; x += 0.55)
    body.mesh.box(shutter, {x, -0.26, top + 0.03}, {x + 0.04, 0.26, top + 0.07});
  add_frame(body.mesh, shape, -front + 0.04, front - 0.6, 0.75);
  add_lamps(body, front - 0.01, -front, w - 0.35, {0.72, 1.0});
  add_plate(body.mesh, front + 0.0, 0.46, true);
  add_plate(body.mesh, -front - 0.005, 0.80, false);
  return body;
}

}  // namespace

VehicleBody make_box_body(const VehicleShape& shape, int paint) {
  for (const BusStyle& style : bus_styles())
    if (shape.variant == style.variant) return make_bus(shape, style, paint);
  if (shape.variant == "tram") return make_tram(shape, paint);
  if (shape.variant == "fire_engine") return make_fire_engine(shape, paint);
  return make_lorry(shape, paint);
}

}  // namespace greatx::scene::generator
