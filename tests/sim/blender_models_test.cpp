// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests the way from Blender (docs/models.md) on files that Blender 3.4.1 wrote (tests/scene/blender).
#include <algorithm>
#include <cmath>
#include <complex>
#include <filesystem>
#include <set>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "scene/check/check.h"
#include "sim/scenario/parse/load_scenario.h"
#include "tests/support/kept_run.h"

namespace greatx::sim {
namespace {

using test::keep_run;
using test::KeptRun;

std::filesystem::path file_of(const std::string& name) {
  return std::filesystem::path(GREATX_BLENDER_FOLDER) / name;
}

const scene::Material& material_of(const scene::Model& model, const std::string& name) {
  for (const scene::Material& material : model.materials)
    if (material.name == name) return material;
  throw std::runtime_error("no material " + name);
}

/// Expects one layer of constant permittivity and conductivity.
void expect_layer(const scene::Model& model, const std::string& name, double permittivity,
                  double conductivity, double thickness_m) {
  const scene::Material& material = material_of(model, name);
  ASSERT_TRUE(material.radio.has_value()) << name;
  ASSERT_EQ(material.radio->layers.size(), 1u) << name;
  const scene::RadioLayer& layer = material.radio->layers.front();
  EXPECT_DOUBLE_EQ(layer.thickness_m, thickness_m) << name;
  const std::complex<double> eta = scene::relative_permittivity(layer.medium, 10e9, name);
  constexpr double epsilon_0 = 8.8541878128e-12;
  EXPECT_NEAR(eta.real(), permittivity, 1e-12) << name;
  EXPECT_NEAR(-eta.imag() * 2.0 * pi * 10e9 * epsilon_0, conductivity, 1e-6 * conductivity) << name;
}

TEST(BlenderModels, RadioPropertiesComeFromCustomPropertiesAndNames) {
  const scene::Model drone = scene::load_model(file_of("drone.glb"), {});
  EXPECT_EQ(drone.materials.size(), 8u);
  expect_layer(drone, "drone_shell", 2.8, 0.005, 0.002);  // a text without braces
  expect_layer(drone, "drone_dark", 2.8, 0.005, 0.002);   // a text with braces
  expect_layer(drone, "carbon_fibre", 10.0, 1e4, 0.002);  // a dictionary
  EXPECT_THAT(material_of(drone, "motor").radio->layers.front().medium.source,
              testing::HasSubstr("aluminium"));
  EXPECT_THAT(material_of(drone, "itu_metal").radio->layers.front().medium.source,
              testing::HasSubstr("metal"));
  EXPECT_DOUBLE_EQ(material_of(drone, "lens").radio->layers.front().thickness_m, 0.003);
  EXPECT_GT(material_of(drone, "light_red").pbr.emissive.r, 0.9f);
}

TEST(BlenderModels, NodesKeepTheirNamesClassesAndAxes) {
  const scene::Model drone = scene::load_model(file_of("drone.glb"), {});
  const scene::Model car = scene::load_model(file_of("car.glb"), {});
  std::set<std::string> names;
  for (const scene::ModelInstance& instance : drone.instances) {
    names.insert(instance.name);
    EXPECT_EQ(instance.semantic_class, scene::SemanticClass::uav);
  }
  EXPECT_EQ(names, (std::set<std::string>{"drone", "rotor_0", "rotor_1", "rotor_2", "rotor_3"}));
  // Blender's x, y and z are greatx's: the first rotor is in front and to the left, above the origin.
  for (const scene::ModelNode& node : drone.nodes)
    if (node.name == "rotor_0") {
      EXPECT_NEAR(node.model_from_node[3].x, 0.225 * std::sqrt(0.5), 1e-6);
      EXPECT_NEAR(node.model_from_node[3].y, 0.225 * std::sqrt(0.5), 1e-6);
      EXPECT_NEAR(node.model_from_node[3].z, 0.0455, 1e-6);
    }
  names.clear();
  for (const scene::ModelInstance& instance : car.instances) {
    names.insert(instance.name);
    EXPECT_EQ(instance.semantic_class, scene::SemanticClass::vehicle);
  }
  EXPECT_EQ(names, (std::set<std::string>{"car", "wheel_front_left", "wheel_front_right", "wheel_rear_left",
                                          "wheel_rear_right"}));
}

TEST(BlenderModels, HaveNoFaults) {
  for (const char* name : {"drone.glb", "car.glb"}) {
    const scene::SceneFaults faults = scene::check_scene(scene::load_model(file_of(name), {}));
    EXPECT_EQ(faults.count(scene::FaultSeverity::fault), 0u) << name;
    EXPECT_EQ(faults.figures.sheets, 0u) << name;
    EXPECT_EQ(faults.figures.nearly_closed_parts, 0u) << name;
    EXPECT_GT(faults.figures.closed_parts, 40u) << name;
    // Sizes of blades are no doubt of a model of this size.
    for (const scene::SceneFault& fault : faults.faults)
      EXPECT_TRUE(fault.kind == "sliver" || fault.kind == "tiny_facet") << name << ": " << fault.kind;
  }
}

TEST(BlenderModels, AllModalitiesSeeThem) {
  Scenario scenario = load_scenario(file_of("models.yaml"));
  scenario.ticks = 3;
  scenario.trajectory_ticks = 10;
  const Experiment experiment = make_experiment(scenario);
  const World& world = *experiment.world;
  // Rotors turn about the body's z axis, wheels about its y axis.
  const auto joint_of = [&](const std::string& body) {
    return *world.scene.bodies[world.scene.body_index(body)].joint;
  };
  EXPECT_LT(glm::distance(joint_of("leader/rotor_2").axis, dvec3(0, 0, 1)), 1e-6);
  EXPECT_LT(glm::distance(joint_of("car/wheel_front_left").axis, dvec3(0, 1, 0)), 1e-6);
  EXPECT_LT(glm::distance(joint_of("car/wheel_front_left").position, dvec3(1.19, 0.735, 0.305)), 1e-6);

  const KeptRun run = keep_run(experiment);
  ASSERT_EQ(run.packets.size(), 3u);
  std::set<std::string> seen;
  for (size_t tick = 0; tick < 3; ++tick)
    for (const uint16_t id : run.array<uint16_t>(tick, "follower/front", "instance"))
      if (id > 0) seen.insert(run.instances[id - 1].name);
  EXPECT_TRUE(seen.count("leader/drone") && seen.count("leader/rotor_0") && seen.count("car/car"));
  EXPECT_TRUE(seen.count("car/wheel_front_right") || seen.count("car/wheel_rear_right"));
  for (const std::string& name : seen) EXPECT_FALSE(name.starts_with("follower/")) << name;

  std::set<std::string> touched;
  for (const uint32_t id : run.joined<uint32_t>("follower/lidar", "instance"))
    if (id > 0) touched.insert(run.instances[id - 1].name);
  EXPECT_TRUE(touched.count("car/car"));
  EXPECT_TRUE(touched.count("leader/drone"));

  EXPECT_GT(run.joined<uint16_t>("follower/events", "x").size(), 100u);
  for (size_t tick = 0; tick < 3; ++tick) {
    const auto depth = run.array<float>(tick, "follower/front", "depth");
    EXPECT_LT(*std::ranges::min_element(depth), 4.0f);
    const auto echoes = run.array<float>(tick, "follower/radar", "range_doppler");
    EXPECT_TRUE(std::ranges::all_of(echoes, [](float power) { return std::isfinite(power); }));
    EXPECT_GT(*std::ranges::max_element(echoes), *std::ranges::min_element(echoes));
    double power = 0.0;
    for (const std::complex<float>& h : run.array<std::complex<float>>(tick, "csi", "cfr"))
      power += std::norm(h);
    EXPECT_TRUE(std::isfinite(power) && power > 0.0);
  }
  EXPECT_FALSE(run.array(0, "follower/front", "rgb").bytes == run.array(1, "follower/front", "rgb").bytes);
  const auto position = run.array<double>(0, "poses", "position");
  EXPECT_EQ(position.size() % 3, 0u);
  EXPECT_FALSE(run.array(0, "poses", "position").bytes == run.array(2, "poses", "position").bytes);
}

}  // namespace
}  // namespace greatx::sim
