// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/objects/vehicles.h"

#include <array>
#include <cmath>
#include <vector>

#include "core/random.h"
#include "scene/generator/mesh/materials.h"
#include "scene/generator/objects/box_body.h"
#include "scene/generator/objects/car_body.h"
#include "scene/generator/objects/two_wheelers.h"

namespace greatx::scene::generator {

namespace {

constexpr uint32_t paint_stream = 80;

/// Returns the paints of a variant. A paint that occurs twice is twice as frequent. The shares of cars are
/// about those of new cars in Europe: half of them white, grey or black.
std::vector<const char*> paints_of(const std::string& variant) {
  if (variant == "taxi") return {"ivory"};
  if (variant == "fire_engine") return {"red"};
  if (variant == "ambulance") return {"white", "yellow"};
  if (variant == "panel_van" || variant == "box_truck" || variant == "minibus" || variant == "van")
    return {"white", "white", "white", "silver", "grey", "navy", "red", "yellow"};
  if (variant == "city_bus" || variant == "tram") return {"red", "yellow", "white", "green", "blue"};
  if (variant == "double_decker") return {"red"};
  if (variant == "coach") return {"white", "silver", "bronze", "blue"};
  if (variant == "lorry" || variant == "articulated_lorry" || variant == "tipper")
    return {"white", "red", "blue", "orange", "silver"};
  return {"white", "silver", "grey", "black", "grey",   "silver", "white", "black",
          "blue",  "red",    "navy", "grey",  "bronze", "green",  "sand",  "orange"};
}

int paint_of(const std::string& variant, uint64_t seed) {
  const std::vector<const char*> paints = paints_of(variant);
  const VehicleShape& shape = vehicle_shape(variant);
  // Variants of one seed do not all get the same paint.
  RandomStream random(seed, paint_stream, static_cast<uint32_t>(&shape - vehicle_shapes().data()));
  return material(std::string("car_paint_") + paints[random.below(static_cast<uint32_t>(paints.size()))]);
}

double tyre_width(const VehicleShape& shape) {
  const double radius = shape.wheels.front().radius_m;
  if (shape.variant == "tram") return 0.12;
  return radius > 0.45 ? 0.30 : radius > 0.4 ? 0.24 : 0.205;
}

/// Returns the material of the outer face of a vehicle's wheels.
int wheel_face(const VehicleShape& shape) {
  const bool steel = !is_car(shape.variant) && shape.variant != "pickup";
  return material(steel ? "wheel_steel" : "wheel_alloy");
}

VehicleBody make_body(const VehicleShape& shape, int paint) {
  return is_car(shape.variant) ? make_car_body(shape, paint, true) : make_box_body(shape, paint);
}

}  // namespace

MeshBuilder make_parked_car(const std::string& variant, const std::string& paint) {
  const VehicleShape& shape = vehicle_shape(variant);
  VehicleBody body = make_car_body(shape, material(paint), false);
  for (size_t i = 0; i < shape.wheels.size(); i += 2)
    add_axle(body.mesh, shape.wheels[i].hub_m, shape.wheels[i].radius_m, tyre_width(shape),
             wheel_face(shape));
  body.mesh.append(body.inside, dvec3(0.0));
  return std::move(body.mesh);
}

void write_vehicle(SceneWriter& writer, const std::string& variant, uint64_t seed) {
  const VehicleShape& shape = vehicle_shape(variant);
  if (shape.two_wheeler) return write_two_wheeler(writer, shape, seed);
  VehicleBody body = make_body(shape, paint_of(variant, seed));
  body.mesh.append(body.inside, dvec3(0.0));
  const int root = writer.add_node({.name = variant,
                                    .mesh = writer.add_mesh(variant, body.mesh),
                                    .semantic_class = SemanticClass::vehicle});
  std::array<int, 2> meshes{-1, -1};  // left, right
  for (size_t i = 0; i < shape.wheels.size(); ++i) {
    const VehicleShape::Wheel& wheel = shape.wheels[i];
    int& mesh = meshes[i % 2];
    if (mesh < 0)
      mesh = writer.add_mesh(i % 2 == 0 ? "wheel_left" : "wheel_right",
                             make_wheel(wheel.radius_m, tyre_width(shape), wheel_face(shape), i % 2 == 0));
    writer.add_node({.name = wheel.node,
                     .mesh = mesh,
                     .position = wheel.hub_m,
                     .semantic_class = SemanticClass::vehicle,
                     .parent = root});
  }
  add_vehicle_lights(writer, body, root);
}

void write_car(SceneWriter& writer, const std::string& variant) {
  const VehicleShape& shape = vehicle_shape(variant);
  VehicleBody body = make_body(shape, material(variant == "van" ? "car_paint_white" : "car_paint_red"));
  for (size_t i = 0; i < shape.wheels.size(); ++i)
    body.mesh.append(make_wheel(shape.wheels[i].radius_m, tyre_width(shape), wheel_face(shape), i % 2 == 0),
                     shape.wheels[i].hub_m);
  body.mesh.append(body.inside, dvec3(0.0));
  const int root = writer.add_node(
      {.name = "car", .mesh = writer.add_mesh(variant, body.mesh), .semantic_class = SemanticClass::vehicle});
  add_vehicle_lights(writer, body, root);
}

}  // namespace greatx::scene::generator
