// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/objects/shapes.h"

#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/expected.h"
#include "scene/generator/mesh/mesh_builder.h"

namespace greatx::scene {

namespace {

/// One row of the table of vehicles with two wheels per axle.
struct Row {
  const char* variant;
  double length, width, height;
  std::vector<double> axles;  ///< x from the front to the rear
  size_t front_axles;
  double radius, half_track;  ///< of the middle of the tyre
};

// Lengths, widths, heights and wheelbases are typical of the classes, from memory of data sheets of common
// vehicles of about 2015 to 2025.
const std::vector<Row>& rows() {
  static const std::vector<Row> list{
      {"saloon", 4.76, 1.84, 1.45, {1.51, -1.31}, 1, 0.325, 0.79},
      {"hatchback", 4.05, 1.75, 1.46, {1.235, -1.315}, 1, 0.31, 0.755},
      {"compact", 4.28, 1.79, 1.47, {1.30, -1.33}, 1, 0.316, 0.77},
      {"estate", 4.77, 1.83, 1.48, {1.515, -1.275}, 1, 0.325, 0.785},
      {"suv", 4.50, 1.84, 1.65, {1.37, -1.31}, 1, 0.35, 0.79},
      {"coupe", 4.64, 1.83, 1.38, {1.52, -1.29}, 1, 0.33, 0.785},
      {"cabriolet", 3.92, 1.74, 1.24, {1.20, -1.11}, 1, 0.31, 0.75},
      {"mini", 3.60, 1.65, 1.49, {1.215, -1.205}, 1, 0.29, 0.715},
      {"taxi", 4.88, 1.85, 1.60, {1.57, -1.30}, 1, 0.33, 0.795},
      {"mpv", 4.53, 1.83, 1.67, {1.375, -1.415}, 1, 0.325, 0.785},
      {"pickup", 5.33, 1.86, 1.82, {1.665, -1.425}, 1, 0.385, 0.78},
      {"van", 5.29, 1.90, 2.18, {1.755, -1.645}, 1, 0.34, 0.815},
      {"panel_van", 5.93, 2.02, 2.63, {1.965, -1.70}, 1, 0.345, 0.87},
      {"minibus", 6.95, 2.02, 2.66, {2.475, -1.85}, 1, 0.345, 0.87},
      {"ambulance", 6.10, 2.02, 2.85, {2.05, -1.615}, 1, 0.345, 0.87},
      {"box_truck", 7.50, 2.45, 3.35, {2.47, -1.75}, 1, 0.43, 1.03},
      {"lorry", 9.50, 2.55, 3.90, {3.30, -2.10}, 1, 0.51, 1.08},
      {"tipper", 8.00, 2.50, 3.15, {2.56, -1.34, -2.69}, 1, 0.51, 1.05},
      {"articulated_lorry", 16.50, 2.55, 4.00, {6.85, 3.25, -4.20, -5.51, -6.82}, 2, 0.51, 1.08},
      {"fire_engine", 7.60, 2.50, 3.30, {2.40, -1.80}, 1, 0.51, 1.05},
      {"city_bus", 12.00, 2.55, 3.10, {3.28, -2.62}, 1, 0.48, 1.09},
      {"double_decker", 10.90, 2.55, 4.30, {2.80, -2.72}, 1, 0.48, 1.09},
      {"coach", 12.20, 2.55, 3.62, {3.35, -2.73}, 1, 0.50, 1.09},
      {"tram", 20.00, 2.40, 3.45, {7.50, 5.70, -5.70, -7.50}, 2, 0.30, 0.72}};
  return list;
}

VehicleShape four_wheeler(const Row& row) {
  VehicleShape shape{row.variant, row.length, row.width, row.height, 0.0, 0.0, {}, false};
  for (size_t i = 0; i < row.axles.size(); ++i)
    for (const double side : {1.0, -1.0})
      shape.wheels.push_back({fmt::format("wheel_{}", shape.wheels.size()), row.radius,
                              dvec3(row.axles[i], side * row.half_track, row.radius)});
  // The front of a bogie vehicle, and of a lorry with a trailer, is its first axle or bogie.
  const bool tram = row.variant == std::string("tram");
  double rear = 0.0;
  for (size_t i = row.front_axles; i < row.axles.size(); ++i) rear += row.axles[i];
  shape.rear_axle_x_m = generator::snap(rear / static_cast<double>(row.axles.size() - row.front_axles));
  const double front = tram ? 0.5 * (row.axles[0] + row.axles[1]) : row.axles[0];
  shape.wheelbase_m = generator::snap(front - shape.rear_axle_x_m);
  return shape;
}

VehicleShape two_wheeler(const char* variant, const dvec3& size, const dvec2& axles, const dvec2& radii) {
  VehicleShape shape{variant, size.x, size.y, size.z, axles.x - axles.y, axles.y, {}, true};
  shape.wheels = {{"wheel_0", radii.x, dvec3(axles.x, 0.0, radii.x)},
                  {"wheel_1", radii.y, dvec3(axles.y, 0.0, radii.y)}};
  return shape;
}

std::vector<VehicleShape> make_vehicle_shapes() {
  std::vector<VehicleShape> shapes;
  for (const Row& row : rows()) shapes.push_back(four_wheeler(row));
  shapes.push_back(two_wheeler("motorcycle", {2.10, 0.74, 1.74}, {0.74, -0.74}, {0.31, 0.31}));
  shapes.push_back(two_wheeler("scooter", {1.87, 0.72, 1.71}, {0.70, -0.64}, {0.24, 0.24}));
  shapes.push_back(two_wheeler("bicycle", {1.78, 0.64, 1.77}, {0.545, -0.545}, {0.345, 0.345}));
  shapes.push_back(two_wheeler("cargo_bicycle", {2.50, 0.64, 1.77}, {1.00, -0.92}, {0.25, 0.33}));
  return shapes;
}

PersonShape adult(const char* variant, double height) {
  const auto share = [&](double part) { return generator::snap(part * height); };
  PersonShape shape{variant, height, 0, share(0.245), share(0.285), share(0.186), share(0.146), share(0.818)};
  shape.hip_m = shape.thigh_m + shape.shank_m;
  return shape;
}

PersonShape child(const char* variant, double height) {
  const auto share = [&](double part) { return generator::snap(part * height); };
  PersonShape shape{variant, height, 0, share(0.225), share(0.270), share(0.178), share(0.140), share(0.795)};
  shape.hip_m = shape.thigh_m + shape.shank_m;
  return shape;
}

template <typename Shape>
const Shape& find_shape(const std::vector<Shape>& shapes, const std::string& kind, const std::string& name) {
  std::vector<std::string> names;
  for (const Shape& shape : shapes) {
    if (shape.variant == name) return shape;
    names.push_back(shape.variant);
  }
  throw_user_error("scene generator: variant of {}: {}", kind, expected_one_of(names, name));
}

}  // namespace

const std::vector<VehicleShape>& vehicle_shapes() {
  static const std::vector<VehicleShape> shapes = make_vehicle_shapes();
  return shapes;
}

const std::vector<PersonShape>& person_shapes() {
  static const std::vector<PersonShape> shapes{
      adult("man", 1.78),      adult("woman", 1.66), adult("tall", 1.92),
      adult("broad", 1.76),    adult("slim", 1.74),  adult("dress", 1.68),
      adult("teenager", 1.58), adult("elder", 1.68), child("child", 1.18)};
  return shapes;
}

const VehicleShape& vehicle_shape(const std::string& variant) {
  return find_shape(vehicle_shapes(), "vehicle", variant);
}

const PersonShape& person_shape(const std::string& variant) {
  return find_shape(person_shapes(), "person", variant);
}

PersonShape rider_shape(double stature_m) {
  PersonShape shape = person_shape("man");
  const double scale = stature_m / shape.height_m;
  for (double* length : {&shape.height_m, &shape.hip_m, &shape.thigh_m, &shape.shank_m, &shape.upper_arm_m,
                         &shape.forearm_m, &shape.shoulder_m})
    *length = generator::snap(*length * scale);
  return shape;
}

std::optional<BicycleShape> bicycle_shape(const std::string& variant) {
  const bool cargo = variant == "cargo_bicycle";
  if (!cargo && variant != "bicycle") return std::nullopt;
  constexpr double stature_m = 1.72;
  const PersonShape rider = rider_shape(stature_m);
  const VehicleShape::Wheel& rear = vehicle_shape(variant).wheels[1];
  const double shift = rear.hub_m.x + 0.545;
  BicycleShape shape;
  shape.thigh_m = rider.thigh_m;
  shape.shank_m = rider.shank_m;
  shape.hip_m = {-0.30 + shift, 0.0, 0.985};
  shape.bracket_m = {-0.115 + shift, 0.0, 0.285};
  shape.rest = std::atan2(0.8, 0.6);               // forward and down
  shape.gear = cargo ? 38.0 / 18.0 : 44.0 / 18.0;  // teeth
  shape.wheel_m = rear.radius_m;
  return shape;
}

}  // namespace greatx::scene
