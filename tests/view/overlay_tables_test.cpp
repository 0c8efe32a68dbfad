// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests what overlays read beside records: tables of the run, metadata, poses, arrays by name.
#include <cmath>
#include <limits>

#include "core/units.h"
#include "tests/view/overlay_support.h"
#include "view/overlay/record_arrays.h"

namespace greatx::view {
namespace {

using testing::expect_user_error;
using ::testing::HasSubstr;
using testing::json_of;
using testing::Made;
using testing::made_poses;
using testing::MadeNode;

const Pose tables_mount{{1.0, 2.0, 0.5}, orientation_from_yaw_pitch_roll(0.4, -0.2, 0.1)};

RecordTables tables_of(const std::string& run, std::vector<SensorSpec> sensors) {
  return RecordTables(run, sensors, "out/dataset.json");
}

SensorSpec csi_spec(const nlohmann::json& end, const nlohmann::json& tables = nlohmann::json::object()) {
  SensorSpec spec;
  spec.name = "csi";
  spec.kind = "csi";
  spec.metadata_json = nlohmann::json{
      {"carrier_hz", 3.5e9},
      {"transmitters", {end}},
      {"receivers", nlohmann::json::array()},
      {"pattern_tables",
       tables}}.dump();
  return spec;
}

TEST(RecordTables, HoldTheTablesOfARun) {
  const Made poses = made_poses({{"uav", {}}, {"van", {}}});
  const RecordTables tables = tables_of(
      R"({"instances": [{"name": "house", "class": "building", "box_m": [[0, 1, 2], [3, 4, 5]]},
                        {"name": "body\u001b[2J", "class": "vehicle", "node": "van"}],
          "materials": ["brick"], "semantic_classes": ["unlabeled", "building", "vehicle"],
          "effects": {"lidar_sweep_motion": false}})",
      {poses.spec});
  EXPECT_THAT(tables.nodes(), ::testing::ElementsAre("uav", "van"));
  EXPECT_EQ(tables.node_called("van"), 1u);
  EXPECT_EQ(tables.node_called("va"), std::nullopt);
  EXPECT_EQ(tables.instance_name(0), "nothing");
  EXPECT_EQ(tables.instance_name(1), "house");
  EXPECT_EQ(tables.instance_name(2), "body\\u001b[2J") << "names are made printable";
  EXPECT_EQ(tables.instance_name(3), "instance 3");
  EXPECT_EQ(tables.material_name(1), "brick");
  EXPECT_EQ(tables.material_name(2), "material 2");
  EXPECT_EQ(tables.class_name(2), "vehicle");
  EXPECT_EQ(tables.class_name(17), "class 17");
  EXPECT_EQ(tables.class_number("vehicle"), 2u);
  EXPECT_EQ(tables.class_number("boat"), 0u);
  EXPECT_FALSE(tables.sweep_motion());
  ASSERT_EQ(tables.instances().size(), 2u);
  EXPECT_TRUE(tables.instances()[0].has_box);
  EXPECT_EQ(tables.instances()[0].high, dvec3(3, 4, 5));
  EXPECT_EQ(tables.instances()[1].node, 1u);
  EXPECT_FALSE(tables.instances()[1].has_box);
}

TEST(RecordTables, AreEmptyForAnEmptyRun) {
  const RecordTables tables = tables_of("", {});
  EXPECT_TRUE(tables.nodes().empty());
  EXPECT_TRUE(tables.instances().empty());
  EXPECT_EQ(tables.pose_sensor(), nullptr);
  EXPECT_TRUE(tables.sweep_motion());
  SensorSpec stranger;
  stranger.name = "stranger";
  expect_user_error([&] { tables.facts(stranger); }, {"stranger"});
  expect_user_error([&] { NodePoses(tables, Record{}); }, {"pose"});
}

TEST(RecordTables, RefuseWhatIsNotAsTheDocumentsHaveIt) {
  const SensorSpec poses = made_poses({{"van", {}}}).spec;
  const auto refuse = [&](const std::string& run, std::initializer_list<const char*> parts) {
    expect_user_error([&] { tables_of(run, {poses}); }, parts);
  };
  refuse("{", {"out/dataset.json: run"});
  refuse(R"({"instances": 3})", {"out/dataset.json: run", "instances", "list"});
  refuse(R"({"instances": [{"class": "road"}]})", {"instances[0].name"});
  refuse(R"({"instances": [{"name": "a", "node": "bus"}]})", {"instances[0].node", "one of the nodes"});
  refuse(R"({"instances": [{"name": "a", "box_m": [[0, 0, 0]]}]})", {"instances[0].box_m", "a list of 2"});
  refuse(R"({"instances": [{"name": "a", "box_m": [[0, 0, 0], [0, -1, 0]]}]})", {"lower corner"});
  refuse(R"({"instances": [{"name": "a", "box_m": [[0, 0, 0], [0, 1e300, 0]]}]})", {"1e+300"});
  refuse(R"({"materials": [7]})", {"materials[0]", "a string"});
}

TEST(RecordTables, RefuseDamagedMetadata) {
  const SensorSpec poses = made_poses({{"uav", {}}}).spec;
  const auto refuse = [&](const char* kind, const nlohmann::json& metadata,
                          std::initializer_list<const char*> parts) {
    SensorSpec spec;
    spec.name = "uav/sensor";
    spec.kind = kind;
    spec.metadata_json = metadata.dump();
    expect_user_error([&] { tables_of("{}", {poses, spec}); }, parts);
  };
  refuse("camera", {{"width", 0}}, {"uav/sensor: metadata", "width"});
  refuse("camera", {{"width", 64}, {"height", 48}, {"fx", 0.0}}, {"fx"});
  refuse("lidar", {{"body_from_sensor", {{"position_m", {1, 2}}}}}, {"body_from_sensor.position_m"});
  refuse("lidar", {{"body_from_sensor", {{"orientation_wxyz", {0, 0, 0, 0}}}}}, {"a unit quaternion"});
  refuse("radar", {{"azimuth_min_rad", "left"}}, {"azimuth_min_rad"});
  refuse("csi", {{"carrier_hz", -1}}, {"carrier_hz"});
  refuse("csi", {{"carrier_hz", 1e9}, {"transmitters", {{{"pattern", "isotropic"}}}}},
         {"transmitters[0].name"});
  SensorSpec twins = poses;
  twins.metadata_json = R"({"nodes": ["uav", "uav"]})";
  expect_user_error([&] { tables_of("{}", {twins}); }, {"poses: metadata", "nodes"});
}

TEST(RecordTables, KnowWhereThingsAre) {
  const Made poses = made_poses({{"uav", {}}});
  SensorSpec camera;
  camera.name = "uav/camera";
  camera.kind = "camera";
  camera.metadata_json = nlohmann::json{
      {"width", 640},
      {"height", 480},
      {"fx", 500.0},
      {"fy", 510.0},
      {"cx", 321.0},
      {"cy", 239.0},
      {"near_m", 0.1},
      {"body_from_sensor", json_of(tables_mount)},
      {"distortion",
       {{"k1", 0.1}}}}.dump();
  SensorSpec lost = camera;
  lost.name = "ghost/camera";
  const RecordTables tables = tables_of("{}", {poses.spec, camera, lost});
  const SensorFacts& facts = tables.facts(camera);
  EXPECT_TRUE(facts.place.known);
  EXPECT_EQ(facts.place.node, 0u);
  EXPECT_LT(glm::distance(facts.place.mount.position, tables_mount.position), 1e-12);
  ASSERT_TRUE(facts.camera);
  EXPECT_EQ(facts.camera->cy, 239.0);
  EXPECT_TRUE(facts.camera->distorted);
  EXPECT_FALSE(tables.facts(lost).place.known);
  EXPECT_EQ(NodePoses(tables, poses.record).world_from(tables.facts(lost).place), std::nullopt);
}

TEST(RecordTables, ReadAntennasWithTheirPatterns) {
  const SensorSpec poses = made_poses({{"mast", {}}}).spec;
  const nlohmann::json panel{{"name", "mast/panel"},
                             {"pattern", "tr38901"},
                             {"polarization", "slant"},
                             {"polarization_model", 2},
                             {"plane", "yz"},
                             {"rows", 2},
                             {"columns", 3},
                             {"row_spacing_m", 0.1},
                             {"column_spacing_m", 0.2},
                             {"body_from_antenna", json_of(tables_mount)}};
  const RecordTables tables = tables_of("{}", {poses, csi_spec(panel)});
  const AntennaFacts& antenna = tables.facts(csi_spec(panel)).channel->transmitters.at(0);
  EXPECT_EQ(antenna.array.element_count(), 6u);
  EXPECT_EQ(antenna.array.port_count(), 12u);
  EXPECT_LT(glm::distance(antenna.array.element_position(0), dvec3(0.0, -0.2, -0.05)), 1e-15);
  EXPECT_EQ(antenna.array.pattern.shape, rf::Pattern::tr38901);
  EXPECT_EQ(antenna.place.node, 0u);

  const nlohmann::json horn{{"name", "point 3"},
                            {"pattern", "imported"},
                            {"pattern_table", "abc"},
                            {"elements_m", {{0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}}},
                            {"body_from_antenna", json_of(tables_mount)}};
  nlohmann::json table{{"zeniths", 3},
                       {"azimuths", 4},
                       {"first_azimuth_deg", -180.0},
                       {"f_theta_re", "1 1 1 1 0.5 0.5 2 0.5 1 1 1 1"}};
  const RecordTables with_horn = tables_of("{}", {poses, csi_spec(horn, {{"abc", table}})});
  const AntennaFacts& imported = with_horn.facts(csi_spec(horn)).channel->transmitters.at(0);
  EXPECT_TRUE(imported.place.known) << "a point rests in the world";
  EXPECT_FALSE(imported.place.node);
  EXPECT_EQ(imported.array.element_position(1), dvec3(0, 1, 0));
  EXPECT_NEAR(rf::element_field(imported.array.pattern, 0.0, {1, 0, 0}).theta.real(), 2.0, 1e-12);

  const auto refuse = [&](const nlohmann::json& end, const nlohmann::json& of_end,
                          std::initializer_list<const char*> parts) {
    expect_user_error([&] { tables_of("{}", {poses, csi_spec(end, {{"abc", of_end}})}); }, parts);
  };
  nlohmann::json bad = horn;
  bad["pattern_table"] = "abd";
  refuse(bad, table, {"csi: metadata", "pattern_table"});
  for (const char* numbers : {"1 1 1", "1 1 1 1 0.5 0.5 2 0.5 1 1 1 1 1", "1 1 1 1 0.5 x 2 0.5 1 1 1 1", "",
                              "1  1 1 1 0.5 0.5 2 0.5 1 1 1 1"}) {
    table["f_theta_re"] = numbers;
    refuse(horn, table, {"f_theta_re", "12 numbers"});
  }
  table["zeniths"] = 1 << 20;
  refuse(horn, table, {"zeniths"});
  bad = panel;
  bad["rows"] = 65536;
  bad["columns"] = 65536;
  refuse(bad, table, {"columns"});
  bad = panel;
  bad["pattern"] = "dish";
  refuse(bad, table, {"pattern", "one of isotropic"});
}

TEST(NodePoses, AreThoseOfTheRecord) {
  const Pose at{{500000.25, 4000000.5, 30.0}, orientation_from_yaw_pitch_roll(1.0, 0.2, -0.3)};
  const Made made = made_poses({{"a", {}}, {"b", at, {3.0, 0.0, 0.0}, {0.0, 0.0, 0.5}}}, 7, 70);
  const RecordTables tables = tables_of("{}", {made.spec});
  const NodePoses poses(tables, made.record);
  EXPECT_EQ(poses.tick(), 7);
  EXPECT_EQ(poses.pose(1).position, at.position);
  const Pose later = poses.after(1, 2.0);
  EXPECT_LT(glm::distance(later.position, at.position + dvec3(6, 0, 0)), 1e-9);
  EXPECT_LT(
      glm::distance(later.rotate({1, 0, 0}), glm::angleAxis(1.0, dvec3(0, 0, 1)) * at.rotate({1, 0, 0})),
      1e-12);
  Made accelerated = made;
  accelerated.array("acceleration").as<double>()[4] = -2.0;  // of b along y
  EXPECT_LT(glm::distance(NodePoses(tables, accelerated.record).after(1, 3.0).position,
                          at.position + dvec3(9, -9, 0)),
            1e-9);
  const Pose by_name = pose_of(tables, "b", made.record);
  EXPECT_EQ(by_name.position, at.position);
  expect_user_error([&] { pose_of(tables, "c", made.record); }, {"'c'"});
}

TEST(NodePoses, RefuseDamagedArrays) {
  const Made good = made_poses({{"a", {}}, {"b", {}}});
  const RecordTables tables = tables_of("{}", {good.spec});
  const auto refuse = [&](Made made, std::initializer_list<const char*> parts) {
    expect_user_error([&] { NodePoses(tables, made.record); }, parts);
  };
  Made bad = good;
  bad.array("position") = Array(DType::f32, {2, 3});
  refuse(bad, {"poses: position", "<f8 [2, 3]", "<f4 [2, 3]"});
  bad = good;
  bad.array("orientation") = Array(DType::f64, {2, 4});
  refuse(bad, {"poses: orientation", "unit"});
  bad = good;
  bad.array("velocity") = Array(DType::f64, {3, 3});
  refuse(bad, {"velocity", "[3, 3]"});
  bad = good;
  bad.array("position").as<double>()[4] = std::numeric_limits<double>::quiet_NaN();
  refuse(bad, {"position", "finite", "element 4"});
  bad = good;
  bad.record.arrays.pop_back();
  refuse(bad, {"poses", "5 arrays, found 4"});
}

TEST(RecordArrays, AreCheckedByTypeShapeAndBytes) {
  Made made;
  made.spec.name = "uav/lidar";
  made.add<float>("points", {2, 4}, std::vector<float>(8, 1.0f));
  made.record.tick = 12;
  const RecordArrays arrays(made.spec, made.record);
  EXPECT_TRUE(arrays.has("points"));
  EXPECT_FALSE(arrays.has("ring"));
  EXPECT_EQ(arrays.get<float>("points", {-1, 4}).size(), 8u);
  EXPECT_EQ(arrays.rows("points"), 2);
  expect_user_error(
      [&] {
        arrays.get<float>("points", {-1, 3});
      },
      {"uav/lidar: points, tick 12: expected <f4 [n, 3], found <f4 [2, 4]"});
  expect_user_error([&] { arrays.get<float>("points", {-1}); }, {"<f4 [n]"});
  expect_user_error([&] { arrays.get<double>("points", {-1, 4}); }, {"<f8 [n, 4]"});
  expect_user_error([&] { arrays.get<float>("ring", {-1}); }, {"ring", "found none"});
  Made short_of = made;
  short_of.array("points").bytes.resize(31);
  expect_user_error(
      [&] {
        RecordArrays(short_of.spec, short_of.record).get<float>("points", {-1, 4});
      },
      {"points", "31 bytes"});
  Made huge = made;
  huge.array("points").shape = {int64_t{1} << 62, 4};
  expect_user_error(
      [&] {
        RecordArrays(huge.spec, huge.record).get<float>("points", {-1, 4});
      },
      {"points", "32 bytes"});
  Made negative = made;
  negative.array("points").shape = {-2, 4};
  expect_user_error(
      [&] {
        RecordArrays(negative.spec, negative.record).get<float>("points", {-1, 4});
      },
      {"points"});
  Made left_out = made;
  left_out.array("points") = Array();
  EXPECT_FALSE(RecordArrays(left_out.spec, left_out.record).has("points"));
}

}  // namespace
}  // namespace greatx::view
