// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Compares vehicles and people with their tables: sizes, wheels, joints, limits of triangles, lights.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "scene/build/build.h"
#include "scene/generator/objects/vehicles.h"
#include "scene/generator/shapes.h"
#include "tests/scene/generator/soup.h"

namespace greatx::scene {
namespace {

Bounds bounds_of(const std::vector<SoupTriangle>& triangles) {
  Bounds bounds;
  for (const SoupTriangle& t : triangles)
    for (const dvec3& corner : t.corners) bounds.add(corner);
  return bounds;
}

bool is_part(const std::string& node) { return node.starts_with("wheel_"); }

class Vehicle : public ::testing::TestWithParam<VehicleShape> {
 protected:
  Vehicle() : soup_(load_soup({.kind = "vehicle", .seed = 5, .variant = GetParam().variant})) {}
  const VehicleShape& shape() const { return GetParam(); }
  Soup soup_;
};

TEST_P(Vehicle, HasTheSizeOfItsTable) {
  const Bounds all = bounds_of(soup_.triangles);
  EXPECT_NEAR(all.max.z, shape().height_m, 0.01);
  EXPECT_NEAR(all.min.z, 0.0, 0.001) << "the wheels touch the ground";
  EXPECT_NEAR(all.max.y, -all.min.y, 0.015);
  // Plates and lamps are up to 1 cm proud of the ends; the mirrors of buses hang in front.
  const double ahead =
      shape().variant == "city_bus" || shape().variant == "coach" || shape().variant == "double_decker"
          ? 0.25
          : 0.02;
  EXPECT_NEAR(all.min.x, -0.5 * shape().length_m, 0.02);
  EXPECT_LT(all.max.x, 0.5 * shape().length_m + ahead);
  EXPECT_GT(all.max.x, 0.5 * shape().length_m - 0.01);
  if (shape().two_wheeler) {
    EXPECT_NEAR(all.size().y, shape().width_m, 0.01);
    return;
  }
  // The mirrors and the doors of buses reach beyond the width.
  std::vector<SoupTriangle> body;
  for (const SoupTriangle& t : soup_.triangles)
    if (std::max({std::abs(t.corners[0].y), std::abs(t.corners[1].y), std::abs(t.corners[2].y)}) <
        0.5 * shape().width_m + 0.015)
      body.push_back(t);
  EXPECT_NEAR(bounds_of(body).size().y, shape().width_m, 0.03);
}

TEST_P(Vehicle, WheelsTurnAboutTheirHubsAndTouchTheGround) {
  size_t wheels = 0;
  for (const ModelInstance& instance : soup_.model.instances) wheels += is_part(instance.name);
  EXPECT_EQ(wheels, shape().wheels.size());
  double rear = 0.0;
  for (const VehicleShape::Wheel& wheel : shape().wheels) {
    const uint32_t index = soup_.instance(wheel.node);
    const ModelInstance& instance = soup_.model.instances[index];
    EXPECT_EQ(instance.semantic_class, SemanticClass::vehicle);
    EXPECT_LT(glm::length(dvec3(instance.model_from_mesh[3]) - wheel.hub_m), 1e-6);
    EXPECT_NEAR(wheel.hub_m.z, wheel.radius_m, 1e-9);
    double farthest = 0.0, low = 1.0;
    for (const SoupTriangle& t : soup_.of_instance(index))
      for (size_t k = 0; k < 3; ++k) {
        farthest = std::max(farthest, glm::length(dvec2(t.local[k].x, t.local[k].y)));
        low = std::min(low, t.corners[k].z);
      }
    EXPECT_NEAR(farthest, wheel.radius_m, 0.001) << wheel.node;
    EXPECT_NEAR(low, 0.0, 0.001) << wheel.node;
    rear = std::min(rear, wheel.hub_m.x);
  }
  EXPECT_GE(shape().rear_axle_x_m, rear - 1e-9);
  EXPECT_GT(shape().wheelbase_m, 0.5 * (shape().wheels.front().hub_m.x - rear));
}

TEST_P(Vehicle, KeepsToItsLimitOfTriangles) {
  const std::string& variant = shape().variant;
  const bool benches = variant == "city_bus" || variant == "double_decker" || variant == "tram";
  const size_t limit = shape().two_wheeler                              ? 870
                       : benches                                        ? 1150
                       : variant == "articulated_lorry"                 ? 1050
                       : shape().length_m > 7.0 || variant == "minibus" ? 980
                                                                        : 850;
  EXPECT_LE(soup_.triangles.size(), limit);
  EXPECT_GE(soup_.triangles.size(), 300u);
}

TEST_P(Vehicle, ShinesForwardsAndBackwards) {
  size_t heads = 0, tails = 0;
  for (const PunctualLight& light : soup_.model.lights) {
    const bool head = light.name.starts_with("head_lamp");
    (head ? heads : tails) += 1;
    if (head) {
      EXPECT_GT(light.direction.x, 0.99);
      EXPECT_GT(light.position.x, 0.0);
    } else {
      EXPECT_TRUE(light.name.starts_with("tail_lamp")) << light.name;
      EXPECT_LT(light.position.x, 0.0);
    }
  }
  EXPECT_EQ(heads, shape().two_wheeler ? 1u : 2u);
  EXPECT_EQ(tails, heads);
}

TEST_P(Vehicle, TheSeedPicksThePaintAndNothingElse) {
  const GenerateOptions five{.kind = "vehicle", .seed = 5, .variant = shape().variant};
  EXPECT_EQ(generate_glb(five), generate_glb(five));
  std::set<std::string> paints;
  for (const uint64_t seed : {1u, 2u, 3u, 4u, 5u, 6u, 7u, 8u}) {
    const Soup other = load_soup({.kind = "vehicle", .seed = seed, .variant = shape().variant});
    ASSERT_EQ(other.triangles.size(), soup_.triangles.size());
    for (const Material& material : other.model.materials)
      if (material.name.starts_with("car_paint_")) paints.insert(material.name);
  }
  const bool one =
      shape().variant == "taxi" || shape().variant == "fire_engine" || shape().variant == "double_decker";
  EXPECT_GE(paints.size(), one ? 1u : 2u);
}

std::vector<VehicleShape> all_vehicles() { return vehicle_shapes(); }

INSTANTIATE_TEST_SUITE_P(Shapes, Vehicle, ::testing::ValuesIn(all_vehicles()),
                         [](const auto& instance) { return instance.param.variant; });

TEST(Vehicles, AreTwentyAndMoreAndDiffer) {
  EXPECT_GE(vehicle_shapes().size(), 20u);
  std::set<std::vector<std::byte>> files;
  std::set<std::string> names;
  for (const VehicleShape& shape : vehicle_shapes()) {
    files.insert(generate_glb({.kind = "vehicle", .seed = 1, .variant = shape.variant}));
    names.insert(shape.variant);
  }
  EXPECT_EQ(files.size(), vehicle_shapes().size());
  EXPECT_EQ(names.size(), vehicle_shapes().size());
  EXPECT_EQ(generator_variants("vehicle").size(), vehicle_shapes().size());
}

TEST(Vehicles, UnknownVariantsNameTheKnownOnes) {
  using ::testing::HasSubstr;
  EXPECT_THROW(generate_glb({.kind = "vehicle", .variant = "tank"}), UserError);
  EXPECT_THROW(generate_glb({.kind = "person", .variant = "giant"}), UserError);
  try {
    person_shape("giant");
    ADD_FAILURE();
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(), HasSubstr("man, woman, tall"));
  }
  try {
    vehicle_shape("saloons");
    ADD_FAILURE();
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(), HasSubstr("did you mean 'saloon'"));
  }
}

/// Returns the area of the largest facet that faces to the side (|n.y| > 0.99).
double largest_side(const std::string& variant) {
  const Model model = load_model("v.glb", generate_glb({.kind = "vehicle", .variant = variant}), {});
  const Scene scene = build_scene({{.name = "", .model = &model, .pose = {}}}, {.name = "v"});
  double largest = 0.0;
  for (const Facet& facet : scene.facets) {
    if (std::abs(facet.normal.y) < 0.99) continue;
    double area = 0.0;
    for (uint32_t i = 0; i < facet.triangle_count; ++i) {
      const dvec3* c = scene.facet_triangles[facet.first_triangle + i].corners;
      area += 0.5 * glm::length(glm::cross(c[1] - c[0], c[2] - c[0]));
    }
    largest = std::max(largest, area);
  }
  return largest;
}

TEST(Vehicles, SidesOfVansBusesAndLorriesAreOneFacet) {
  // the panel above the wheels; the box; the panel below the windows
  EXPECT_GT(largest_side("panel_van"), 2.4);
  EXPECT_GT(largest_side("lorry"), 19.0);
  EXPECT_GT(largest_side("articulated_lorry"), 35.0);
  EXPECT_GT(largest_side("city_bus"), 5.0);
  EXPECT_GT(largest_side("fire_engine"), 10.0);
}

TEST(ParkedCars, HaveNoLightsAndFewTriangles) {
  for (const VehicleShape& shape : vehicle_shapes()) {
    if (shape.two_wheeler || shape.length_m > 7.0) continue;
    const generator::MeshBuilder mesh = generator::make_parked_car(shape.variant, "car_paint_red");
    size_t indices = 0;
    Bounds bounds;
    for (const generator::PrimitiveData& primitive : mesh.primitives()) {
      indices += primitive.indices.size();
      for (const vec3& p : primitive.positions) bounds.add(dvec3(p));
    }
    EXPECT_LE(indices / 3, 185u) << shape.variant;
    EXPECT_NEAR(bounds.size().x, shape.length_m, 0.12) << shape.variant;
    EXPECT_NEAR(bounds.min.z, 0.0, 0.001) << shape.variant;
    EXPECT_LT(bounds.size().y, shape.width_m + 0.03) << shape.variant;
  }
}

class Person : public ::testing::TestWithParam<PersonShape> {
 protected:
  Person() : soup_(load_soup({.kind = "person", .seed = 2, .variant = GetParam().variant})) {}
  const PersonShape& shape() const { return GetParam(); }
  /// Returns where the joint of a limb is.
  dvec3 joint(const std::string& node) {
    return dvec3(soup_.model.instances[soup_.instance(node)].model_from_mesh[3]);
  }
  Soup soup_;
};

TEST_P(Person, HasTheStatureOfItsTableAndStandsOnTheGround) {
  const Bounds all = bounds_of(soup_.triangles);
  EXPECT_NEAR(all.max.z, shape().height_m, 0.01);
  EXPECT_NEAR(all.min.z, 0.0, 0.001);
  EXPECT_NEAR(all.max.y, -all.min.y, 0.001);
  EXPECT_NEAR(all.size().y, 0.29 * shape().height_m, 0.035 * shape().height_m) << "across the arms";
  EXPECT_GE(soup_.triangles.size(), 250u);
  EXPECT_LE(soup_.triangles.size(), 520u);
}

TEST_P(Person, JointsLieAtTheHeightsOfTheTable) {
  EXPECT_NEAR(shape().hip_m, shape().thigh_m + shape().shank_m, 1e-9);
  EXPECT_EQ(soup_.model.instances.size(), 9u);
  for (const ModelInstance& instance : soup_.model.instances)
    EXPECT_EQ(instance.semantic_class, SemanticClass::person) << instance.name;
  for (const char* side : {"left", "right"}) {
    const std::string suffix = std::string("_") + side;
    const double sign = side == std::string("left") ? 1.0 : -1.0;
    EXPECT_NEAR(joint("thigh" + suffix).z, shape().hip_m, 1e-6);
    EXPECT_NEAR(joint("shank" + suffix).z, shape().shank_m, 1e-6);
    EXPECT_NEAR(joint("upper_arm" + suffix).z, shape().shoulder_m, 1e-6);
    EXPECT_NEAR(joint("forearm" + suffix).z, shape().shoulder_m - shape().upper_arm_m, 1e-6);
    for (const char* limb : {"thigh", "shank", "upper_arm", "forearm"})
      EXPECT_GT(sign * joint(limb + suffix).y, 0.03 * shape().height_m) << limb << suffix;
  }
}

TEST_P(Person, LimbsReachBeyondTheirJointsSoThatNoGapOpens) {
  for (const auto& [upper, lower] :
       {std::pair("thigh_left", "shank_left"), std::pair("upper_arm_right", "forearm_right")}) {
    const double knee = joint(lower).z;
    EXPECT_LT(bounds_of(soup_.of_instance(soup_.instance(upper))).min.z, knee - 0.002) << upper;
    EXPECT_GT(bounds_of(soup_.of_instance(soup_.instance(lower))).max.z, knee + 0.005) << lower;
  }
}

TEST_P(Person, TheSeedPicksTheClothes) {
  const GenerateOptions two{.kind = "person", .seed = 2, .variant = shape().variant};
  EXPECT_EQ(generate_glb(two), generate_glb(two));
  std::set<std::string> jackets;
  for (const uint64_t seed : {1u, 2u, 3u, 4u, 5u, 6u, 7u, 8u}) {
    const Soup other = load_soup({.kind = "person", .seed = seed, .variant = shape().variant});
    for (const SoupTriangle& t : other.of_instance(other.instance("upper_arm_left")))
      jackets.insert(other.model.materials[t.material].name);
  }
  EXPECT_GE(jackets.size(), 4u);
}

std::vector<PersonShape> all_people() { return person_shapes(); }

INSTANTIATE_TEST_SUITE_P(Shapes, Person, ::testing::ValuesIn(all_people()),
                         [](const auto& instance) { return instance.param.variant; });

TEST(Riders, ArePeopleWhoseFeetAndHandsAreAtTheirPlaces) {
  for (const VehicleShape& shape : vehicle_shapes()) {
    if (!shape.two_wheeler) continue;
    const Soup soup = load_soup({.kind = "vehicle", .variant = shape.variant});
    for (const char* node : {"rider", "thigh_left", "thigh_right", "shank_left", "shank_right"})
      EXPECT_EQ(soup.model.instances[soup.instance(node)].semantic_class, SemanticClass::person);
    EXPECT_EQ(soup.model.instances[soup.instance(shape.variant)].semantic_class, SemanticClass::vehicle);
    for (const char* node : {"shank_left", "shank_right"}) {
      const double low = bounds_of(soup.of_instance(soup.instance(node))).min.z;
      EXPECT_GT(low, 0.05) << shape.variant;
      EXPECT_LT(low, 0.50) << shape.variant;
    }
  }
}

}  // namespace
}  // namespace greatx::scene
