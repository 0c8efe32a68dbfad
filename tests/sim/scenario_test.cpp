// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/scenario.h"

#include <cmath>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/units.h"
#include "scene/description/scene.h"
#include "scene/generator/generate.h"
#include "sim/scenario/parse/load_scenario.h"

namespace greatx::sim {
namespace {

const std::filesystem::path good_folder = GREATX_SCENARIOS;

template <typename T>
const T& sensor(const Scenario& scenario, size_t node, size_t index) {
  return std::get<T>(scenario.nodes.at(node).sensors.at(index).config);
}

TEST(Scenario, MinimalHasTheDocumentedDefaults) {
  const Scenario s = load_scenario(good_folder / "minimal.yaml");
  EXPECT_EQ(s.name, "minimal");
  EXPECT_EQ(s.file, good_folder / "minimal.yaml");
  EXPECT_EQ(s.text, "greatx: 1\nname: minimal\nticks: 1\n");
  EXPECT_EQ(s.seed, 1u);
  EXPECT_EQ(s.sequences, 1u);
  EXPECT_EQ(s.ticks, 1);
  EXPECT_EQ(s.tick_rate_hz, (Rational{1000, 1}));
  EXPECT_TRUE(s.scene.objects.empty() && s.nodes.empty() && s.channels.empty() && s.effects.empty());
  EXPECT_DOUBLE_EQ(s.environment.sun_azimuth, radians(-45.0));
  EXPECT_DOUBLE_EQ(s.environment.sun_elevation, radians(45.0));
  EXPECT_EQ(s.environment.temperature_k, 288.15);
  EXPECT_EQ(s.environment.pressure_hpa, 1013.25);
  EXPECT_EQ(s.environment.water_vapour_g_m3, 7.5);
  EXPECT_EQ(s.environment.rain_mm_h, 0.0);
  EXPECT_EQ(s.environment.fog_g_m3, 0.0);
  EXPECT_EQ(s.tolerance_db, 0.01);
}

TEST(Scenario, EverythingTop) {
  const Scenario s = load_scenario(good_folder / "everything.yaml");
  EXPECT_EQ(s.seed, 18446744073709551615u);
  EXPECT_EQ(s.sequences, 3u);
  EXPECT_EQ(s.ticks, 2000);
  EXPECT_EQ(s.tick_rate_hz, (Rational{2000, 1}));
  ASSERT_EQ(s.scene.objects.size(), 3u);
  EXPECT_EQ(s.scene.objects[0].name, "");
  EXPECT_EQ(std::get<std::filesystem::path>(s.scene.objects[0].model.source), good_folder / "box.gltf");
  EXPECT_EQ(s.scene.objects[0].model.where.line, 9);
  const StaticObject& house = s.scene.objects[1];
  EXPECT_EQ(house.position_m, dvec3(10, -20, 0.5));
  EXPECT_DOUBLE_EQ(house.rotation.x, pi / 2);
  EXPECT_EQ(house.scale, dvec3(2));
  EXPECT_EQ(house.semantic_class, "building");
  const auto& van = std::get<Generated>(s.scene.objects[2].model.source);
  EXPECT_EQ(van.kind, "car");
  EXPECT_EQ(van.variant, "van");
  EXPECT_EQ(s.scene.objects[2].scale, dvec3(1, -1, 1.5));
  EXPECT_EQ(s.scene.radio_materials, good_folder / "materials.yaml");
  EXPECT_EQ(s.scene.origin_m, dvec3(691000.0, 5335000.0, 500.0));
  EXPECT_DOUBLE_EQ(s.environment.sun_azimuth, radians(-30.0));
  EXPECT_DOUBLE_EQ(s.environment.sun_elevation, radians(60.0));
  EXPECT_EQ(s.environment.sun_illuminance_lux, 90000.0);
  EXPECT_EQ(s.environment.sky_illuminance_lux, 12000.0);
  EXPECT_EQ(s.environment.temperature_k, 293.15);
  EXPECT_EQ(s.environment.pressure_hpa, 1000.0);
  EXPECT_EQ(s.environment.water_vapour_g_m3, 10.0);
  EXPECT_EQ(s.environment.rain_mm_h, 12.5);
  EXPECT_EQ(s.environment.fog_g_m3, 0.05);
  EXPECT_EQ(s.effects.at("static_shadows"), Switch::on);
  EXPECT_EQ(s.effects.at("reflection"), Switch::off);
  EXPECT_EQ(s.effects.at("gas"), Switch::automatic);
  EXPECT_EQ(s.tolerance_db, 0.05);
}

TEST(Scenario, EverythingMoves) {
  const Scenario s = load_scenario(good_folder / "everything.yaml");
  ASSERT_EQ(s.nodes.size(), 6u);
  const auto& fixed = std::get<StaticTrajectory>(s.nodes[0].trajectory);
  EXPECT_EQ(fixed.position_m, dvec3(0, 0, 25));
  EXPECT_DOUBLE_EQ(fixed.rotation.y, radians(10.0));
  EXPECT_EQ(std::get<Generated>(s.nodes[0].model->source).kind, "mast");
  EXPECT_EQ(s.nodes[0].semantic_class, "mast");
  EXPECT_EQ(s.nodes[0].where.line, 32);
  const auto& drawn = std::get<BezierTrajectory>(s.nodes[1].trajectory);
  EXPECT_EQ(drawn.min_m, dvec3(-100, -100, 20));
  EXPECT_EQ(drawn.max_m, dvec3(100, 100, 80));
  EXPECT_EQ(drawn.reference_node, "bs");
  EXPECT_EQ(drawn.min_distance_m, 20.0);
  EXPECT_EQ(drawn.max_distance_m, 120.0);
  EXPECT_EQ(drawn.offset_m, dvec3(30, 30, 10));
  EXPECT_FALSE(drawn.control_points);
  EXPECT_EQ(std::get<BezierTrajectory>(s.nodes[2].trajectory).control_points->at(2), dvec3(2, 1, 1));
  const auto& walk = std::get<WayPointTrajectory>(s.nodes[3].trajectory);
  EXPECT_FALSE(walk.smooth);
  ASSERT_EQ(walk.points.size(), 2u);
  EXPECT_EQ(walk.points[1].time_s, 0.75);
  EXPECT_TRUE(walk.points[1].orientation);
  const auto& flight = std::get<WayPointTrajectory>(s.nodes[4].trajectory);
  EXPECT_TRUE(flight.smooth);
  ASSERT_EQ(flight.points.size(), 3u);
  EXPECT_EQ(flight.points[2].position_m, dvec3(10, 5, 12));
  const auto& bus = std::get<CorridorTrajectory>(s.nodes[5].trajectory);
  EXPECT_EQ(bus.center_line_m.size(), 3u);
  EXPECT_EQ(bus.width_m, 4.0);
  EXPECT_EQ(bus.legs, 8);
  ASSERT_EQ(s.nodes[5].parts.size(), 2u);
  const PartConfig &first = s.nodes[5].parts[0], &second = s.nodes[5].parts[1];
  EXPECT_EQ(first.nodes, (std::vector<std::string>{"rotor_0", "rotor_2"}));
  EXPECT_EQ(first.axis, dvec3(0, 0, 1));
  const auto &first_rate = std::get<TurnRate>(first.motion), &second_rate = std::get<TurnRate>(second.motion);
  EXPECT_EQ(first_rate.hz, (Rational{90, 1}));
  EXPECT_FALSE(first_rate.negative || first.phase);
  EXPECT_EQ(second.nodes, std::vector<std::string>{"rotor_[13]"});
  EXPECT_EQ(second_rate.hz, (Rational{1000, 7}));
  EXPECT_TRUE(second_rate.negative);
  EXPECT_EQ(second.phase, radians(45.0));
}

TEST(Scenario, EverythingSenses) {
  const Scenario s = load_scenario(good_folder / "everything.yaml");
  const auto& panel = sensor<AntennaConfig>(s, 0, 0);
  EXPECT_EQ(panel.pattern.shape, rf::Pattern::isotropic);
  EXPECT_EQ(panel.pattern.model, rf::PolarizationModel::model_2);
  EXPECT_EQ(panel.polarization, rf::Polarization::slant);
  EXPECT_EQ(panel.plane, rf::ArrayPlane::yz);
  EXPECT_EQ(panel.rows, 4u);
  EXPECT_EQ(panel.columns, 8u);
  EXPECT_EQ(panel.row_spacing_wl, 0.7);
  EXPECT_DOUBLE_EQ(s.nodes[0].sensors[0].mount.rotation.y, radians(5.0));
  const auto& camera = sensor<CameraConfig>(s, 1, 0);
  EXPECT_EQ(s.nodes[1].sensors[0].rate_hz, (Rational{30, 1}));
  EXPECT_EQ(camera.width, 320u);
  EXPECT_EQ(camera.fx, 300.5);
  EXPECT_EQ(camera.fy, 301.5);
  EXPECT_EQ(camera.cx, 159.5);
  EXPECT_EQ(camera.cy, 120.25);
  EXPECT_EQ(camera.msaa, 1u);
  EXPECT_FALSE(camera.smooth_edges);
  EXPECT_TRUE(camera.rgb && camera.depth && camera.ids && camera.hdr && camera.depth_png24 &&
              camera.depth_log);
  EXPECT_TRUE(camera.see_own_body);
  const auto& lidar = sensor<LidarConfig>(s, 1, 1);
  const auto& spinning = std::get<render::SpinningScan>(lidar.scan);
  ASSERT_EQ(spinning.elevations.size(), 16u);
  EXPECT_DOUBLE_EQ(spinning.elevations.front(), radians(-15.0));
  EXPECT_DOUBLE_EQ(spinning.elevations[1], radians(-13.0));
  EXPECT_DOUBLE_EQ(spinning.elevations.back(), radians(15.0));
  EXPECT_DOUBLE_EQ(spinning.azimuth_span, -2 * pi);
  EXPECT_EQ(spinning.sweep_s, 0.1);
  EXPECT_EQ(lidar.wavelength_nm, 1550.0);
  const auto& scan = std::get<render::SpinningScan>(sensor<LidarConfig>(s, 4, 0).scan);
  EXPECT_EQ(s.nodes[4].sensors[0].rate_hz, (Rational{25, 2}));
  ASSERT_EQ(scan.elevations.size(), 4u);
  EXPECT_DOUBLE_EQ(scan.elevations[3], radians(-20.0));
  EXPECT_EQ(sensor<AntennaConfig>(s, 1, 2).pattern.shape, rf::Pattern::half_wave_dipole);
  const auto& line = sensor<AntennaConfig>(s, 5, 0);
  EXPECT_EQ(line.pattern.shape, rf::Pattern::tr38901);
  EXPECT_EQ(line.pattern.model, rf::PolarizationModel::model_1);
  EXPECT_EQ(line.polarization, rf::Polarization::single);
  EXPECT_DOUBLE_EQ(line.single_slant, radians(-30.0));
  EXPECT_EQ(line.plane, rf::ArrayPlane::xz);
  const auto& free = sensor<AntennaConfig>(s, 5, 1);
  EXPECT_EQ(free.elements_wl, (std::vector<dvec3>{{0, 0, 0}, {0.5, 0, 0.25}}));
  ASSERT_TRUE(free.pattern.table);
  EXPECT_EQ(free.pattern.table->name(), "dipole.csv");
  EXPECT_NEAR(free.pattern.table->at(pi / 2, 0.0).theta.real(), std::sqrt(1.5), 1e-6);
  ASSERT_EQ(s.channels.size(), 2u);
  const ChannelConfig& csi = s.channels[0];
  EXPECT_EQ(csi.transmitters.at(0), "bs/panel");
  EXPECT_EQ(csi.receivers, (std::vector<std::string>{"uav/antenna", "bs/panel"}));
  EXPECT_EQ(csi.carrier_hz, 28e9);
  EXPECT_EQ(csi.subcarrier_spacing_hz, 100e6 / 64);
  EXPECT_EQ(csi.time_samples, 14u);
  EXPECT_EQ(csi.rays, 100000u);
  EXPECT_EQ(csi.candidates, ChannelConfig::Candidates::rays);
  EXPECT_EQ(csi.search, ChannelConfig::Search::once);
  EXPECT_EQ(s.channels[1].rate_hz, (Rational{30000, 1001}));
  EXPECT_EQ(s.channels[1].subcarrier_spacing_hz, 15e3);
}

TEST(Scenario, FieldOfViewIsHorizontalAndCentred) {
  const Scenario s = load_scenario(good_folder / "uav_city.yaml");
  const auto& camera = sensor<CameraConfig>(s, 1, 0);
  EXPECT_NEAR(camera.fx, 320.0, 1e-12);  // 640 / 2 / tan 45 degrees
  EXPECT_EQ(camera.fx, camera.fy);
  EXPECT_EQ(camera.cx, 320.0);
  EXPECT_EQ(camera.cy, 240.0);
  EXPECT_TRUE(camera.rgb && camera.depth && camera.ids && camera.depth_png24);
  EXPECT_FALSE(camera.hdr || camera.depth_log);
  EXPECT_EQ(s.ticks, 100);
}

TEST(Scenario, ClassesAndModelsAreThoseOfTheSceneAndItsGenerator) {
  const auto parse = [](const std::string& scene) {
    return parse_scenario(
        "greatx: 1\nname: x\nticks: 1\nscene:\n  objects:\n    - {name: a, " + scene + "}\n", "s.yaml",
        good_folder);
  };
  std::ifstream file(GREATX_SCHEMA);
  const auto schema = nlohmann::json::parse(file);
  std::vector<std::string> classes = schema["$defs"]["class"]["enum"];
  EXPECT_EQ(classes, scene::semantic_class_names());
  for (const std::string& name : scene::semantic_class_names())
    EXPECT_EQ(parse("file: box.gltf, class: " + name).scene.objects[0].semantic_class, name);
  for (const std::string& kind : scene::generator_kinds()) {
    const auto generated = [&](const std::string& rest) {
      return std::get<Generated>(
          parse("generate: {kind: " + kind + rest + "}").scene.objects[0].model.source);
    };
    const std::vector<std::string> variants = scene::generator_variants(kind);
    EXPECT_EQ(generated("").variant, variants.empty() ? "" : variants.front());
    const std::string key = kind == "city" || kind == "country" ? ", season: " : ", variant: ";
    for (const std::string& variant : variants) EXPECT_EQ(generated(key + variant).variant, variant);
  }
}

TEST(Scenario, DurationCountsTicksInIt) {
  const auto ticks = [](const std::string& rest) {
    return parse_scenario("greatx: 1\nname: x\n" + rest, "s.yaml", good_folder).ticks;
  };
  EXPECT_EQ(ticks("duration_s: 10\n"), 10000);
  EXPECT_EQ(ticks("duration_s: 0.0001\n"), 1);
  EXPECT_EQ(ticks("duration_s: 0.1\n"), 100);  // 0.1 is not exact in fp64, but the text is
  EXPECT_EQ(ticks("duration_s: 0.1001\n"), 101);
  EXPECT_EQ(ticks("duration_s: 1001\ntick_rate_hz: 30000/1001\n"), 30000);
  EXPECT_EQ(load_scenario(good_folder / "broadcast_rates.yaml").ticks, 90);  // 89.91
}

TEST(Scenario, RatesAreExact) {
  const Scenario s = load_scenario(good_folder / "broadcast_rates.yaml");
  EXPECT_EQ(s.tick_rate_hz.str(), "60000/1001");
  EXPECT_EQ(s.nodes[0].sensors[0].rate_hz.str(), "30000/1001");
  EXPECT_EQ(s.nodes[0].sensors[1].rate_hz.str(), "2997/125");
  EXPECT_EQ(s.nodes[0].sensors[2].rate_hz.str(), "25");
}

}  // namespace
}  // namespace greatx::sim
