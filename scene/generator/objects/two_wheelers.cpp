// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/objects/two_wheelers.h"

#include <array>
#include <cmath>
#include <optional>

#include "core/random.h"
#include "core/units.h"
#include "scene/generator/mesh/materials.h"
#include "scene/generator/objects/people.h"
#include "scene/generator/objects/smooth_mesh.h"
#include "scene/generator/objects/vehicle_parts.h"

namespace greatx::scene::generator {

namespace {

using Line = std::vector<dvec3>;

/// The middles of the cranks lie this far from the middle of a bicycle.
constexpr double crank_y = 0.072;

/// Where a rider sits on a two-wheeler, and what holds hands and feet.
struct Seat {
  dvec3 hip;                    ///< middle of the hip joints
  double lean;                  ///< of the trunk, rad
  dvec3 grip;                   ///< of the left hand
  dvec3 foot_left, foot_right;  ///< where the soles rest, or the axles of pedals
  double stature;               ///< m
};

/// Returns the joint between two links of lengths `first` and `second` that lead from `a` to `b`. It lies on
/// the side of `towards`. If the links are too short to reach `b`, they point at it.
dvec3 joint_between(const dvec3& a, const dvec3& b, double first, double second, const dvec3& towards) {
  const double reach = std::min(glm::length(b - a), first + second - 1e-3);
  const dvec3 along = glm::normalize(b - a);
  const double x = (first * first - second * second + reach * reach) / (2.0 * reach);
  const double off = std::sqrt(std::max(0.0, first * first - x * x));
  const dvec3 aside = glm::normalize(towards - glm::dot(towards, along) * along);
  return a + x * along + off * aside;
}

/// Returns the turn about y that points a limb, which hangs down, along `direction`.
double swing(const dvec3& direction) { return std::atan2(-direction.x, -direction.z); }

/// Returns the distance from the knee of a rider to the axle of the pedal.
double to_pedal(const BicycleShape& bicycle) {
  return std::hypot(bicycle.shank_m + bicycle.pedal_m, bicycle.ball_m);
}

/// Makes a shank with its pedal, which turns with the foot: the axle below the ball of the foot leads inwards
/// to the crank.
MeshBuilder pedalling_shank(const PersonShape& shape, const PersonLook& look, const BicycleShape& bicycle,
                            double side) {
  MeshBuilder mesh = make_shank(shape, look);
  const double sole = -bicycle.shank_m, half = bicycle.pedal_m, ahead = bicycle.ball_m;
  mesh.box(material("bumper"), {ahead - 0.045, -0.042, sole - 2.0 * half},
           {ahead + 0.045, 0.042, sole - 0.001});
  const double crank = side * (crank_y - hip_y(shape));  // from the middle of the foot
  mesh.box(material("chrome"), {ahead - 0.006, std::min(crank, 0.0), sole - half - 0.006},
           {ahead + 0.006, std::max(crank, 0.0), sole - half + 0.006});
  return mesh;
}

/// Makes the cranks about their axle as they stand at rest.
MeshBuilder make_cranks(const BicycleShape& bicycle) {
  SmoothMesh tubes;
  const dvec3 crank = bicycle.crank_m * dvec3(std::cos(bicycle.rest), 0.0, -std::sin(bicycle.rest));
  for (const double side : {1.0, -1.0}) {
    const dvec3 aside(0.0, side * crank_y, 0.0);
    add_tube(tubes, material("chrome"), Line{aside, aside + side * crank}, 0.011, 3);
  }
  MeshBuilder mesh;
  tubes.add_to(mesh, 1.3);
  const std::vector<dvec2> ring = regular_polygon(10, 0.09);  // the chainring, on the right
  mesh.prism_along_y(material("bumper"), ring, -0.056, -0.05);
  return mesh;
}

/// Adds the rider's trunk and arms to the node `rider`, and his legs as nodes below it.
void add_rider(SceneWriter& writer, const Seat& seat, const PersonLook& look, int root,
               const std::optional<BicycleShape>& bicycle) {
  const PersonShape shape = rider_shape(seat.stature);
  SmoothMesh figure;
  add_trunk(figure, shape, look, seat.hip, seat.lean);
  const double h = shape.height_m, trunk = shape.shoulder_m - shape.hip_m;
  for (const double side : {1.0, -1.0}) {
    const dvec3 shoulder = seat.hip + dvec3(trunk * std::sin(seat.lean), side * shoulder_y(shape, look),
                                            trunk * std::cos(seat.lean));
    const dvec3 hand(seat.grip.x, side * seat.grip.y, seat.grip.z);
    const dvec3 elbow =
        joint_between(shoulder, hand, shape.upper_arm_m, shape.forearm_m, dvec3(-0.4, 0.5 * side, -1.0));
    add_limb(figure, look.jacket, shoulder, elbow, {{-0.05, 0.029 * h}, {1.04, 0.022 * h}}, 4);
    add_limb(figure, look.jacket, elbow, hand, {{-0.05, 0.022 * h}, {0.85, 0.017 * h}}, 4);
    add_limb(figure, look.skin, elbow, hand, {{0.83, 0.014 * h}, {1.12, 0.02 * h}}, 4);
  }
  MeshBuilder body;
  finish_figure(body, figure, shape, seat.hip, seat.lean);
  const int rider = writer.add_node({.name = "rider",
                                     .mesh = writer.add_mesh("rider", body),
                                     .semantic_class = SemanticClass::person,
                                     .parent = root});
  const int thigh = writer.add_mesh("thigh", make_thigh(shape, look)),
            shank = bicycle ? -1 : writer.add_mesh("shank", make_shank(shape, look));
  for (const double side : {1.0, -1.0}) {
    const std::string suffix = side > 0.0 ? "_left" : "_right";
    const dvec3 hip = seat.hip + dvec3(0.0, side * hip_y(shape), 0.0);
    dvec3 foot = side > 0.0 ? seat.foot_left : seat.foot_right;
    foot.y = hip.y;
    const double shank_m = bicycle ? to_pedal(*bicycle) : shape.shank_m;
    const dvec3 knee = joint_between(hip, foot, shape.thigh_m, shank_m, dvec3(1.0, 0.0, 0.3));
    const double ahead = bicycle ? std::atan2(bicycle->ball_m, bicycle->shank_m + bicycle->pedal_m) : 0.0;
    const double upper = swing(knee - hip), lower = swing(foot - knee) + ahead;
    const int node = writer.add_node({.name = "thigh" + suffix,
                                      .mesh = thigh,
                                      .position = hip,
                                      .pitch = upper,
                                      .semantic_class = SemanticClass::person,
                                      .parent = rider});
    writer.add_node(
        {.name = "shank" + suffix,
         .mesh = bicycle ? writer.add_mesh("shank" + suffix, pedalling_shank(shape, look, *bicycle, side))
                         : shank,
         .position = {0.0, 0.0, -shape.thigh_m},
         .pitch = lower - upper,
         .semantic_class = SemanticClass::person,
         .parent = node});
  }
}

/// Makes a bicycle's wheel about its hub: a tyre and spokes.
MeshBuilder make_spoked_wheel(double radius) {
  SmoothMesh mesh;
  const int count = 16;
  const double r = radius - 0.03;
  for (int i = 0; i < count; ++i) {
    const auto corner = [&](int k, int at) {
      const double angle = 2.0 * pi * at / count - pi / 2, across = k == 0 ? radius : r;
      const double y = k == 0 ? 0.0 : k == 1 ? 0.018 : -0.018;
      return dvec3(across * std::cos(angle), y, across * std::sin(angle));
    };
    const int j = (i + 1) % count;
    mesh.quad(material("tyre"), corner(0, i), corner(1, i), corner(1, j), corner(0, j));
    mesh.quad(material("chrome"), corner(1, i), corner(2, i), corner(2, j), corner(1, j));
    mesh.quad(material("tyre"), corner(2, i), corner(0, i), corner(0, j), corner(2, j));
  }
  for (int i = 0; i < 3; ++i) {
    const double angle = pi * i / 3.0 + 0.1;
    const dvec3 end = (r - 0.002) * dvec3(std::cos(angle), 0.0, std::sin(angle));
    add_tube(mesh, material("chrome"), Line{end, -end}, 0.004, 3);
  }
  MeshBuilder wheel;
  mesh.add_to(wheel, 0.9);
  return wheel;
}

struct TwoWheeler {
  VehicleBody body;
  Seat seat;
};

TwoWheeler make_bicycle(const VehicleShape& shape, int paint) {
  TwoWheeler made;
  const bool cargo = shape.variant == "cargo_bicycle";
  const dvec3 front = shape.wheels[0].hub_m, rear = shape.wheels[1].hub_m;
  const double shift = rear.x + 0.545;
  const dvec3 bracket(-0.115 + shift, 0.0, 0.285), seat_top(-0.27 + shift, 0.0, 0.80),
      head_top(0.31 + shift, 0.0, 0.88), head_low(0.36 + shift, 0.0, 0.68), saddle(-0.30 + shift, 0.0, 0.94);
  SmoothMesh tubes;
  const auto tube = [&](const dvec3& a, const dvec3& b, double radius, int material_) {
    add_tube(tubes, material_, Line{a, b}, radius, 3);
  };
  const int dark = material("bumper");
  tube(bracket, seat_top, 0.019, paint);
  tube(seat_top, saddle - dvec3(0, 0, 0.03), 0.014, material("chrome"));
  tube(bracket, head_low + dvec3(-0.01, 0, 0.02), 0.021, paint);
  if (!cargo) tube(seat_top - dvec3(0, 0, 0.02), head_top - dvec3(0, 0, 0.05), 0.018, paint);
  tube(head_top, head_low, 0.022, paint);
  for (const double y : {0.055, -0.055}) {
    const dvec3 aside(0.0, y, 0.0);
    tube(rear + aside, bracket + 0.5 * aside, 0.012, paint);
    tube(rear + aside, seat_top + 0.3 * aside, 0.010, paint);
    tube((cargo ? front + dvec3(-0.09, 0.0, 0.28) : head_low) + 0.7 * aside, front + aside, 0.013, paint);
  }
  const dvec3 grip(0.215 + shift, 0.28, 1.08), stem = head_top + dvec3(-0.03, 0.0, 0.16);
  tube(head_top, stem, 0.016, material("chrome"));
  add_tube(tubes, dark, Line{stem + dvec3(0, -0.08, 0.01), stem + dvec3(0, 0.08, 0.01)}, 0.013, 3);
  for (const double side : {1.0, -1.0})
    tube(stem + dvec3(0, 0.07 * side, 0.01), dvec3(grip.x, side * 0.30, grip.z), 0.013, dark);
  MeshBuilder& mesh = made.body.mesh;
  const dvec3 lamp = cargo ? dvec3(front.x - 0.02, 0.0, front.z + 0.36) : head_top + dvec3(0.09, 0.0, 0.02);
  mesh.box(dark, saddle + dvec3(-0.13, -0.08, -0.05), saddle + dvec3(0.12, 0.08, 0.0));
  tube(bracket - dvec3(0.0, crank_y, 0.0), bracket + dvec3(0.0, crank_y, 0.0), 0.014, material("chrome"));
  const BicycleShape drive = *bicycle_shape(shape.variant);
  const dvec3 crank = drive.crank_m * dvec3(std::cos(drive.rest), 0.0, -std::sin(drive.rest));
  made.seat = {drive.hip_m, 0.30, grip, drive.bracket_m + crank, drive.bracket_m - crank, 1.72};
  if (cargo) {
    const double low = 0.26, back = head_low.x + 0.06, fore = front.x - 0.30;
    tube(head_low, dvec3(back, 0.0, low - 0.03), 0.025, paint);
    tube(dvec3(back - 0.02, 0.0, low - 0.03), dvec3(fore + 0.02, 0.0, low - 0.03), 0.025, paint);
    tube(dvec3(fore, 0.0, low - 0.02), front + dvec3(-0.07, 0.0, 0.30), 0.025, paint);
    const std::vector<dvec2> box{{back, -0.30}, {fore, -0.27}, {fore, 0.27}, {back, 0.30}};
    const int wood = material("bench_wood");
    add_ring_solid(
        mesh,
        {box,
         {{0.0, low, wood}, {0.0, low + 0.36, wood}, {0.02, low + 0.36, wood}, {0.02, low + 0.06, dark}},
         wood,
         {}});
  }
  tubes.add_to(mesh, 1.3);
  mesh.box(material("headlight"), lamp - dvec3(0.04, 0.03, 0.03), lamp + dvec3(0.02, 0.03, 0.03));
  const dvec3 tail = seat_top + dvec3(-0.05, 0.0, 0.03);
  mesh.box(material("tail_light"), tail - dvec3(0.02, 0.03, 0.025), tail + dvec3(0.03, 0.03, 0.025));
  made.body.head_lamps = {lamp};
  made.body.tail_lamps = {tail};
  made.body.beam_cd = 1000.0;
  return made;
}

/// Adds a closed body over ellipses across x. Each has (x, z of the middle, half width, half height).
void add_hull(SmoothMesh& mesh, int material, const std::vector<dvec4>& contours, int count) {
  std::vector<std::vector<dvec3>> rings;
  for (const dvec4& c : contours)
    rings.push_back(ring(dvec3(c.x, 0.0, c.y), dvec3(0.0, c.z, 0.0), dvec3(0.0, 0.0, c.w), count));
  add_rings(mesh, rings, [&](size_t, size_t) { return material; });
}

/// Adds the direction indicators of a motorcycle, on stalks beside its lamps.
void add_stalked_indicators(MeshBuilder& mesh, const dvec3& lamp, const dvec3& tail) {
  for (const dvec3& at : {lamp + dvec3(-0.06, 0.0, -0.05), tail + dvec3(0.05, 0.0, -0.05)}) {
    add_boxes(mesh, material("bumper"), at + dvec3(-0.01, 0.01, -0.01), at + dvec3(0.01, 0.125, 0.01));
    add_indicators(mesh, at + dvec3(-0.025, 0.12, -0.022), at + dvec3(0.025, 0.165, 0.022));
  }
}

TwoWheeler make_motorcycle(const VehicleShape& shape, int paint) {
  TwoWheeler made;
  const dvec3 front = shape.wheels[0].hub_m, rear = shape.wheels[1].hub_m;
  SmoothMesh parts;
  const int dark = material("bumper"), metal = material("engine_metal");
  add_hull(parts, paint,
           {{-0.12, 0.86, 0.06, 0.07},
            {0.08, 0.90, 0.14, 0.12},
            {0.30, 0.90, 0.15, 0.13},
            {0.42, 0.88, 0.07, 0.08}},
           6);  // tank
  add_hull(parts, dark, {{-0.84, 0.93, 0.05, 0.03}, {-0.50, 0.86, 0.13, 0.07}, {-0.08, 0.80, 0.11, 0.06}}, 6);
  add_hull(parts, paint, {{-0.90, 0.90, 0.04, 0.03}, {-0.62, 0.78, 0.11, 0.07}, {-0.20, 0.72, 0.10, 0.08}},
           6);
  add_hull(parts, metal, {{-0.26, 0.48, 0.15, 0.16}, {0.10, 0.52, 0.19, 0.22}, {0.32, 0.56, 0.12, 0.16}}, 6);
  add_hull(parts, paint, {{0.34, 0.94, 0.14, 0.14}, {0.52, 0.96, 0.15, 0.17}, {0.66, 0.90, 0.08, 0.08}}, 6);
  for (const double y : {0.085, -0.085}) {
    const dvec3 aside(0.0, y, 0.0);
    add_tube(parts, metal, Line{front + aside, dvec3(0.45, 0.8 * y, 0.92)}, 0.028, 4);
    add_tube(parts, dark, Line{rear + aside, dvec3(-0.18, y, 0.42)}, 0.03, 4);
    add_tube(parts, dark, Line{dvec3(0.40, 0.5 * y, 1.0), dvec3(0.30, 4.2 * y, 1.04)}, 0.016, 4);
  }
  add_tube(parts, material("chrome"),
           Line{dvec3(0.25, -0.17, 0.36), dvec3(-0.25, -0.19, 0.34), dvec3(-0.75, -0.2, 0.46)}, 0.05, 5);
  MeshBuilder& mesh = made.body.mesh;
  parts.add_to(mesh, 1.0);
  mesh.box(dark, {front.x - 0.2, -0.07, front.z + 0.32}, {front.x + 0.2, 0.07, front.z + 0.345});
  const dvec3 lamp(0.645, 0.0, 0.93), tail(-0.92, 0.0, 0.88);
  mesh.box(material("headlight"), lamp - dvec3(0.1, 0.07, 0.05), lamp + dvec3(0.03, 0.07, 0.05));
  mesh.box(material("switched_stop"), tail - dvec3(0.02, 0.07, 0.025), tail + dvec3(0.06, 0.07, 0.025));
  mesh.box(material("number_plate"), {-0.99, -0.1, 0.58}, {-0.97, 0.1, 0.72});
  mesh.box(dark, {-0.975, -0.02, 0.66}, {-0.85, 0.02, 0.88});
  add_stalked_indicators(made.body.mesh, lamp, tail);
  made.body.head_lamps = {lamp};
  made.body.tail_lamps = {tail};
  made.seat = {{-0.36, 0.0, 0.97}, 0.42, {0.30, 0.33, 1.06}, {-0.12, 0.0, 0.36}, {-0.12, 0.0, 0.36}, 1.76};
  return made;
}

TwoWheeler make_scooter(const VehicleShape& shape, int paint) {
  TwoWheeler made;
  const dvec3 front = shape.wheels[0].hub_m, rear = shape.wheels[1].hub_m;
  SmoothMesh parts;
  const int dark = material("bumper");
  add_hull(parts, paint,
           {{-0.90, 0.68, 0.10, 0.06},
            {-0.62, 0.60, 0.19, 0.16},
            {-0.18, 0.50, 0.17, 0.18},
            {-0.10, 0.42, 0.10, 0.08}},
           6);
  add_hull(parts, dark, {{-0.82, 0.77, 0.09, 0.04}, {-0.5, 0.79, 0.15, 0.05}, {-0.12, 0.76, 0.12, 0.04}}, 6);
  // the shield before the rider's legs, and the floor behind it
  std::vector<std::vector<dvec3>> shield;
  for (const dvec4& c : {dvec4(0.36, 0.26, 0.12, 0.05), dvec4(0.40, 0.50, 0.22, 0.06),
                         dvec4(0.36, 0.78, 0.19, 0.07), dvec4(0.30, 0.96, 0.11, 0.06)})
    shield.push_back(ring(dvec3(c.x, 0.0, c.y), dvec3(c.w, 0.0, 0.0), dvec3(0.0, c.z, 0.0), 6));
  add_rings(parts, shield, [&](size_t, size_t) { return paint; });
  add_hull(parts, paint,
           {{front.x - 0.24, front.z + 0.20, 0.05, 0.03},
            {front.x, front.z + 0.27, 0.08, 0.04},
            {front.x + 0.22, front.z + 0.16, 0.04, 0.02}},
           6);
  for (const double y : {0.07, -0.07})
    add_tube(parts, dark, Line{front + dvec3(0.0, y, 0.0), dvec3(0.42, 0.6 * y, 0.60)}, 0.025, 4);
  for (const double side : {1.0, -1.0})
    add_tube(parts, dark, Line{dvec3(0.28, 0.05 * side, 0.97), dvec3(0.22, 0.34 * side, 1.0)}, 0.016, 4);
  MeshBuilder& mesh = made.body.mesh;
  parts.add_to(mesh, 1.0);
  mesh.box(dark, {-0.2, -0.17, 0.27}, {0.4, 0.17, 0.32});
  mesh.box(dark, {rear.x - 0.12, -0.11, rear.z - 0.06}, {rear.x + 0.35, -0.07, rear.z + 0.1});
  const dvec3 lamp(0.36, 0.0, 0.95), tail(-0.90, 0.0, 0.66);
  mesh.box(material("headlight"), lamp - dvec3(0.1, 0.06, 0.045), lamp + dvec3(0.03, 0.06, 0.045));
  mesh.box(material("switched_stop"), tail - dvec3(0.02, 0.07, 0.03), tail + dvec3(0.1, 0.07, 0.03));
  mesh.box(material("number_plate"), {-0.925, -0.1, 0.46}, {-0.90, 0.1, 0.59});
  mesh.box(dark, {-0.905, -0.02, 0.5}, {-0.7, 0.02, 0.605});
  add_stalked_indicators(made.body.mesh, lamp, tail);
  made.body.head_lamps = {lamp};
  made.body.tail_lamps = {tail};
  made.seat = {{-0.46, 0.0, 0.91}, 0.10, {0.22, 0.32, 1.02}, {0.14, 0.0, 0.32}, {0.14, 0.0, 0.32}, 1.70};
  return made;
}

}  // namespace

void write_two_wheeler(SceneWriter& writer, const VehicleShape& shape, uint64_t seed) {
  RandomStream random(seed, 82, static_cast<uint32_t>(shape.variant.size()));
  constexpr std::array paints{"black", "red", "blue", "white", "green", "orange", "grey"};
  const int paint = material(std::string("car_paint_") + paints[random.below(paints.size())]);
  const bool motor = shape.variant == "motorcycle", scooter = shape.variant == "scooter";
  PersonLook look = person_look(motor || scooter ? "man" : "slim", seed + 7 * shape.variant.size());
  look.coarse = true;
  look.girth = 1.0;
  TwoWheeler made = motor     ? make_motorcycle(shape, paint)
                    : scooter ? make_scooter(shape, paint)
                              : make_bicycle(shape, paint);
  if (motor || scooter || random.below(2) == 0) look.hair = material("helmet");
  if (motor) {
    look.face = material("car_glass_dark");  // the visor
    look.jacket = look.trousers = look.skin = material("cloth_black");
  }
  const int root = writer.add_node({.name = shape.variant,
                                    .mesh = writer.add_mesh(shape.variant, made.body.mesh),
                                    .semantic_class = SemanticClass::vehicle});
  for (const VehicleShape::Wheel& wheel : shape.wheels)
    writer.add_node({.name = wheel.node,
                     .mesh = writer.add_mesh(
                         wheel.node, motor || scooter ? make_motor_wheel(wheel.radius_m, motor ? 0.14 : 0.11)
                                                      : make_spoked_wheel(wheel.radius_m)),
                     .position = wheel.hub_m,
                     .semantic_class = SemanticClass::vehicle,
                     .parent = root});
  const std::optional<BicycleShape> bicycle = bicycle_shape(shape.variant);
  if (bicycle)
    writer.add_node({.name = "crank",
                     .mesh = writer.add_mesh("crank", make_cranks(*bicycle)),
                     .position = bicycle->bracket_m,
                     .semantic_class = SemanticClass::vehicle,
                     .parent = root});
  add_rider(writer, made.seat, look, root, bicycle);
  add_vehicle_lights(writer, made.body, root);
}

}  // namespace greatx::scene::generator
