// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <complex>
#include <filesystem>
#include <fstream>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "assets/assets.h"
#include "core/error.h"
#include "core/fields/yaml.h"
#include "sim/experiment/experiment.h"
#include "sim/scenario/parse/load_scenario.h"
#include "view/edit/difference.h"
#include "view/edit/document.h"
#include "view/edit/handles.h"
#include "view/edit/schema.h"

namespace greatx::view {
namespace {

using testing::HasSubstr;
using Kind = YamlChange::Kind;

YamlChange set(const std::string& path, const std::string& value) {
  return {Kind::set, parse_yaml_path(path), value};
}
/// The default scenario with a car on way-points as its fourth node.
std::string city() {
  for (const EmbeddedScenario& scenario : embedded_scenarios())
    if (scenario.name == "city") {
      std::string text(scenario.text);
      return text.insert(text.find("channels:\n"),
                         "  - name: car\n"
                         "    trajectory:\n"
                         "      type: waypoints\n"
                         "      points:\n"
                         "        - {t_s: 0, position_m: [-45, -3.2, 0]}\n"
                         "        - {t_s: 10, position_m: [75, -3.2, 0]}\n");
    }
  return {};
}
sim::Scenario parse(const std::string& text) { return sim::parse_scenario(text, "city.yaml", "."); }
std::string message_of(const std::function<void()>& act) {
  try {
    act();
    return "no error";
  } catch (const UserError& error) {
    return error.what();
  }
}
std::string contents(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

class EditFiles : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("greatx_edit_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_;
};

// ---------------------------------------------------------------------------------------------- the document

TEST(ScenarioDocument, ChangesUndoAndRedo) {
  ScenarioDocument document(parse(city()), parse);
  EXPECT_FALSE(document.is_changed());
  EXPECT_TRUE(document.change(set("environment.sun.elevation_deg", "10")));
  EXPECT_NEAR(document.scenario().environment.sun_elevation, 10.0 * pi / 180.0, 1e-12);
  EXPECT_TRUE(document.is_changed());
  EXPECT_EQ(document.label(), "environment.sun.elevation_deg");
  document.undo();
  EXPECT_EQ(document.text(), city());
  EXPECT_FALSE(document.is_changed());
  document.redo();
  EXPECT_THAT(document.text(), HasSubstr("elevation_deg: 10"));
  EXPECT_FALSE(document.can_redo());
  EXPECT_EQ(document.version(), 3u);
}

TEST(ScenarioDocument, ARefusedChangeLeavesEverything) {
  ScenarioDocument document(parse(city()), parse);
  EXPECT_THAT(message_of([&] { document.change(set("channels[0].max_depth", "99")); }),
              HasSubstr("channels[0].max_depth: expected an integer from 0 to 16, found '99'"));
  EXPECT_THAT(message_of([&] { document.change(set("channels[0].wrong", "1")); }), HasSubstr("wrong"));
  EXPECT_THAT(message_of([&] { document.replace("greatx: 1\n"); }), HasSubstr("city.yaml"));
  EXPECT_EQ(document.text(), city());
  EXPECT_EQ(document.version(), 0u);
  EXPECT_FALSE(document.can_undo());
}

TEST_F(EditFiles, SavesWhatTheParserReads) {
  ScenarioDocument document(parse(city()), parse);
  document.change(set("effects.diffraction", "on"));
  const std::filesystem::path file = folder_ / "below" / "changed.yaml";
  document.save(file);
  EXPECT_FALSE(document.is_changed());
  EXPECT_EQ(document.file(), file);
  const sim::Scenario read = sim::load_scenario(file);
  EXPECT_EQ(read.effects.at("diffraction"), sim::Switch::on);
  EXPECT_EQ(contents(file), document.text());
  EXPECT_THAT(contents(file), HasSubstr("# The pixels of a DAVIS346")) << "comments stay";
}

TEST_F(EditFiles, FilesKeepTheirPlaceInAnotherFolder) {
  std::ofstream(folder_ / "way.csv") << "0, 0, 0, 10\n1, 5, 0, 10\n";
  const std::string text =
      "greatx: 1\nname: flight\nticks: 2\nnodes:\n"
      "  - {name: uav, trajectory: {type: waypoints, csv: way.csv}}\n";
  std::ofstream(folder_ / "flight.yaml") << text;
  const auto here = [&](const std::string& changed) {
    sim::Scenario scenario = sim::parse_scenario(changed, "flight.yaml", folder_);
    scenario.file = folder_ / "flight.yaml";
    return scenario;
  };
  ScenarioDocument document(here(text), here);
  const std::filesystem::path elsewhere = folder_ / "elsewhere" / "flight.yaml";
  document.save(elsewhere);
  EXPECT_NO_THROW(sim::load_scenario(elsewhere));
  EXPECT_THAT(contents(elsewhere), HasSubstr((folder_ / "way.csv").string()));
}

TEST_F(EditFiles, RadioMaterialsAreSavedBesideTheScenario) {
  ScenarioDocument document(parse(city()), parse);
  const YamlPath path{YamlStep("materials"), YamlStep("asphalt")};
  document.change_materials({{Kind::set, path, "{itu: metal}"}});
  const std::filesystem::path unsaved = document.scenario().scene.radio_materials;
  EXPECT_TRUE(std::filesystem::exists(unsaved)) << "a run reads it before it is saved";
  EXPECT_TRUE(document.is_changed());
  document.save(folder_ / "city.yaml");
  const sim::Scenario read = sim::load_scenario(folder_ / "city.yaml");
  EXPECT_EQ(read.scene.radio_materials, folder_ / "city_materials.yaml");
  EXPECT_THAT(contents(read.scene.radio_materials), HasSubstr("asphalt: {itu: metal}"));
  document.undo();
  document.undo();
  EXPECT_TRUE(document.scenario().scene.radio_materials.empty());
}

TEST(SameWorld, DependsOnModelsAndNotOnSensors) {
  const sim::Scenario first = parse(city());
  ScenarioDocument document(first, parse);
  const auto same = [&](const YamlChange& change) {
    document.change(change);
    const bool same_world = sim::same_world(first, document.scenario());
    document.undo();
    return same_world;
  };
  EXPECT_TRUE(same(set("channels[0].max_depth", "1")));
  EXPECT_TRUE(same(set("environment.fog_g_m3", "0.1")));
  EXPECT_TRUE(same(set("nodes[3].trajectory.points[0].position_m", "[-40, -3, 0]")))
      << "the car moves anyway";
  EXPECT_TRUE(same(set("nodes[1].sensors[0].fov_deg", "60")));
  EXPECT_FALSE(same(set("nodes[0].trajectory.position_m", "[14, 13, 0]"))) << "the mast stands in the world";
  EXPECT_FALSE(same(set("scene.generate.seed", "8")));
  EXPECT_FALSE(same(set("scene.georeference", "{latitude_deg: 1, longitude_deg: 2, height_m: 3}")));
  EXPECT_FALSE(same(set("nodes[2].model.parts[0].rpm", "4201")));
  EXPECT_FALSE(same(set("nodes[3].class", "uav")));
}

// ------------------------------------------------------------------------------------------------ the schema

class SchemaTest : public testing::Test {
 protected:
  FormType at(const std::string& text, const std::string& path) const {
    const std::shared_ptr<const FieldValue> root = read_yaml(text, "test");
    SchemaPart part = schema_.root();
    YamlPath here;
    for (const YamlStep& step : parse_yaml_path(path)) {
      const FormType type = schema_.type_of(part, value_at(root, here).get());
      if (std::holds_alternative<size_t>(step)) {
        part = type.items;
      } else {
        const auto member =
            std::ranges::find(type.members, std::get<std::string>(step), &FormType::Member::key);
        part = member == type.members.end() ? SchemaPart() : member->part;
      }
      here.push_back(step);
    }
    return schema_.type_of(part, value_at(root, here).get());
  }
  Schema schema_{scenario_schema()};
};

TEST_F(SchemaTest, KnowsKindsBoundsAndDefaults) {
  const FormType elevation = at(city(), "environment.sun.elevation_deg");
  EXPECT_EQ(elevation.kind, FormType::Kind::number);
  EXPECT_EQ(elevation.least, -90.0);
  EXPECT_EQ(elevation.most, 90.0);
  EXPECT_EQ(at(city(), "seed").kind, FormType::Kind::integer);
  EXPECT_EQ(at(city(), "seed").default_line, "1");
  EXPECT_EQ(at(city(), "effects.diffraction").choices, (std::vector<std::string>{"auto", "on", "off"}));
  EXPECT_EQ(at(city(), "nodes[0].class").kind, FormType::Kind::choice);
  EXPECT_EQ(at(city(), "nodes[1].sensors[0].mount.position_m").kind, FormType::Kind::numbers);
  EXPECT_EQ(at(city(), "nodes[1].sensors[0].outputs").kind, FormType::Kind::choices);
  EXPECT_EQ(at(city(), "nodes").kind, FormType::Kind::list);
}

TEST_F(SchemaTest, ChoosesTheShapeThatTheValueHas) {
  const FormType fixed = at(city(), "nodes[0].trajectory"), curve = at(city(), "nodes[1].trajectory");
  EXPECT_EQ(fixed.shape_key, "type");
  EXPECT_EQ(fixed.shapes, (std::vector<std::string>{"static", "waypoints", "bezier", "corridor", "follow"}));
  const auto has = [](const FormType& type, const char* key) {
    return std::ranges::find(type.members, key, &FormType::Member::key) != type.members.end();
  };
  EXPECT_TRUE(has(fixed, "position_m"));
  EXPECT_FALSE(has(fixed, "control_points_m"));
  EXPECT_TRUE(has(curve, "control_points_m"));
  EXPECT_TRUE(has(at(city(), "nodes[1].sensors[0]"), "fov_deg"));
  EXPECT_TRUE(has(at(city(), "nodes[1].sensors[2]"), "azimuth_steps"));
  EXPECT_FALSE(has(at(city(), "nodes[1].sensors[2]"), "fov_deg"));
  EXPECT_TRUE(has(at(city(), "channels[0]"), "max_depth"));
}

TEST_F(SchemaTest, ANewValueGetsTheFirstOfSeveralKeys) {
  const auto required = [&](const std::string& trajectory) {
    const FormType type = at("nodes: [{name: a, trajectory: {" + trajectory + "}}]", "nodes[0].trajectory");
    std::vector<std::string> keys;
    for (const FormType::Member& member : type.members)
      if (member.required) keys.push_back(member.key);
    return keys;
  };
  using testing::ElementsAre;
  EXPECT_THAT(required("type: static"), ElementsAre("type", "position_m"));
  EXPECT_THAT(required("type: static, position_deg: [52, 4, 1]"), ElementsAre("type"));
  EXPECT_THAT(required("type: corridor"), ElementsAre("type", "center_line_m"));
  EXPECT_EQ(at("nodes: [{trajectory: {type: static}}]", "nodes[0].trajectory.position_deg").kind,
            FormType::Kind::numbers);
}

TEST(MaterialSchema, MaterialsOfAnyNameHaveTheFields) {
  const Schema schema(materials_schema());
  const auto root = read_yaml("materials: {brick: {itu: brick}}", "test");
  const FormType all = schema.type_of(schema.root(), root.get());
  ASSERT_EQ(all.members.size(), 2u);  // beside it: beyond_range
  const auto named = std::ranges::find(all.members, "materials", &FormType::Member::key);
  ASSERT_NE(named, all.members.end());
  const FormType materials = schema.type_of(named->part, value_at(root, {YamlStep("materials")}).get());
  ASSERT_EQ(materials.members.size(), 1u);
  EXPECT_EQ(materials.members[0].key, "brick");
  const FormType brick = schema.type_of(materials.members[0].part, nullptr);
  const auto permittivity = std::ranges::find(brick.members, "relative_permittivity", &FormType::Member::key);
  ASSERT_NE(permittivity, brick.members.end());
  EXPECT_EQ(permittivity->together, std::vector<std::string>{"conductivity"});
  const auto windows = std::ranges::find(brick.members, "windows", &FormType::Member::key);
  ASSERT_NE(windows, brick.members.end());
  const FormType panes = schema.type_of(windows->part, nullptr);
  ASSERT_EQ(panes.members.size(), 2u);
  for (const char* key : {"share", "layers"})
    EXPECT_NE(std::ranges::find(panes.members, key, &FormType::Member::key), panes.members.end()) << key;
}

// ----------------------------------------------------------------------------------------------- the handles

TEST(Handles, AreThePlacesThatAScenarioGives) {
  const auto root = read_yaml(city(), "city");
  const std::vector<Handle> handles = handles_of(root);
  std::vector<std::string> labels;
  for (const Handle& handle : handles) labels.push_back(handle.label);
  EXPECT_THAT(labels, testing::ElementsAre("bs", "uav, control point 0", "uav, control point 1",
                                           "uav, control point 2", "uav, control point 3",
                                           "drone, control point 0", "drone, control point 1",
                                           "drone, control point 2", "drone, control point 3",
                                           "car, way-point 0 at 0 s", "car, way-point 1 at 10 s"));
  EXPECT_EQ(handles[0].position, dvec3(13.0, 13.0, 0.0));
  EXPECT_EQ(handles[0].rotation_deg, dvec3(-135.0, 0.0, 0.0));
  EXPECT_TRUE(handles[1].rotation_path.empty());
  const YamlChange moved = move_handle(handles[9], dvec3(-40.00004, 1.5, 0.0));
  EXPECT_EQ(yaml_path_text(moved.path), "nodes[3].trajectory.points[0].position_m");
  EXPECT_EQ(moved.value, "[-40, 1.5, 0]");
}

TEST(Handles, PlacesInDegreesHaveNone) {
  const auto root = read_yaml(
      "scene: {objects: [{name: a, position_deg: [52, 4, 1]}, {name: b}]}\n"
      "nodes: [{name: n, trajectory: {type: waypoints, points: [{t_s: 0, position_deg: [52, 4, 1]}, "
      "{t_s: 1, position_m: [1, 2, 3]}]}}]\n",
      "places");
  std::vector<std::string> labels;
  for (const Handle& handle : handles_of(root)) labels.push_back(handle.label);
  EXPECT_THAT(labels, testing::ElementsAre("n, way-point 1 at 1 s", "b"));
  EXPECT_FALSE(insert_behind(root, parse_yaml_path("nodes[0].trajectory.points[0]")));
}

TEST(Handles, AWayPointIsInsertedHalfWay) {
  const auto root = read_yaml(city(), "city");
  const std::optional<YamlChange> between =
      insert_behind(root, parse_yaml_path("nodes[3].trajectory.points[0].position_m"));
  ASSERT_TRUE(between);
  EXPECT_EQ(yaml_path_text(between->path), "nodes[3].trajectory.points[1]");
  EXPECT_EQ(between->value, "{t_s: 5, position_m: [15, -3.2, 0]}");
  const std::optional<YamlChange> last =
      insert_behind(root, parse_yaml_path("nodes[3].trajectory.points[1]"));
  ASSERT_TRUE(last);
  EXPECT_EQ(last->value, "{t_s: 20, position_m: [195, -3.2, 0]}");
  EXPECT_NO_THROW(parse(edit_yaml(city(), *last).text));
  EXPECT_FALSE(insert_behind(root, parse_yaml_path("nodes[0].trajectory.position_m")));
}

TEST(Handles, ADragFollowsTheCursorAlongAnAxisAndAroundIt) {
  const dvec3 point(10.0, 0.0, 5.0), x(1.0, 0.0, 0.0), z(0.0, 0.0, 1.0);
  const CursorRay ray{dvec3(13.0, -20.0, 9.0), glm::normalize(dvec3(0.0, 20.0, -4.0))};
  EXPECT_NEAR(*along_axis(ray, point, x), 3.0, 1e-12);
  EXPECT_FALSE(along_axis({dvec3(0.0), x}, point, x)) << "the axis points at the eye";
  const auto down = [](double px, double py) {
    return CursorRay{dvec3(px, py, 50.0), dvec3(0.0, 0.0, -1.0)};
  };
  const double begin = *around_axis(down(12.0, 0.0), point, z), end = *around_axis(down(10.0, 3.0), point, z);
  EXPECT_NEAR(std::remainder(end - begin, 2.0 * pi), 0.5 * pi, 1e-12);
  EXPECT_FALSE(around_axis({dvec3(0.0), x}, point, z)) << "the ray runs along the plane";
  EXPECT_FALSE(around_axis({dvec3(0.0, 0.0, 9.0), z}, point, z)) << "the plane lies behind";
}

TEST(Handles, TurnsAreAboutTheAxesOfYawPitchAndRoll) {
  const dvec3 angles(40.0, 25.0, -60.0);
  const double degree = pi / 180.0, step = 1e-6;
  const auto turned = [&](const dvec3& a) {
    return orientation_from_yaw_pitch_roll(a.x * degree, a.y * degree, a.z * degree);
  };
  const std::vector<dvec3> axes = turn_axes(angles);
  for (int i = 0; i < 3; ++i) {
    dvec3 more = angles;
    more[i] += step / degree;
    // A small turn by `step` about the axis, after the attitude before.
    const dquat way = turned(more) * glm::inverse(turned(angles));
    const dvec3 axis = 2.0 * dvec3(way.x, way.y, way.z) / step * (way.w < 0.0 ? -1.0 : 1.0);
    EXPECT_LT(glm::length(axis - axes[static_cast<size_t>(i)]), 1e-5) << i;
  }
}

// -------------------------------------------------------------------------------------------- the difference

template <typename T>
Array array_of(std::vector<int64_t> shape, const std::vector<T>& values) {
  return Array::of<T>(std::move(shape), values);
}

TEST(Difference, OfComplexArraysIsTheirErrorInDecibels) {
  const ArraySpec spec{"cfr", DType::complex64, {2}, "1", ""};
  const auto a = array_of<std::complex<float>>({2}, {{3.0f, 0.0f}, {0.0f, 4.0f}});
  const auto b = array_of<std::complex<float>>({2}, {{3.0f, 0.5f}, {0.0f, 4.0f}});
  EXPECT_TRUE(difference(spec, a, a).equal);
  const Difference row = difference(spec, a, b);
  EXPECT_FALSE(row.equal);
  EXPECT_NEAR(*row.error_db, 10.0 * std::log10(0.25 / 25.0), 1e-9);
  EXPECT_EQ(row.text, "error -20.0 dB of its power");
}

TEST(Difference, OfNumbersHasMeanLargestAndOneSidedPlaces) {
  const float nothing = std::numeric_limits<float>::infinity();
  const ArraySpec depth{"depth", DType::f32, {4}, "m", ""};
  const auto a = array_of<float>({4}, {1.0f, 2.0f, 3.0f, nothing}),
             b = array_of<float>({4}, {1.0f, 2.5f, nothing, nothing});
  EXPECT_EQ(difference(depth, a, b).text,
            "25 % differ, by 0.25 m on average, 0.5 m at most; 1 have a value on one side alone");
  const ArraySpec rgb{"rgb", DType::u8, {2}, "", ""};
  EXPECT_EQ(difference(rgb, array_of<uint8_t>({2}, {0, 10}), array_of<uint8_t>({2}, {0, 30})).text,
            "50 % differ, by 10 of 255 on average, 20 of 255 at most");
  const ArraySpec ids{"instance", DType::u32, {2}, "", ""};
  EXPECT_EQ(difference(ids, array_of<uint32_t>({2}, {1, 7}), array_of<uint32_t>({2}, {1, 9})).text,
            "50 % differ");
  EXPECT_EQ(difference(depth, a, array_of<float>({3}, {1.0f, 2.0f, 3.0f})).text, "3 instead of 4");
}

TEST(Difference, SensorsAreMatchedByName) {
  io::DatasetInfo before, after;
  before.sensors = {{"a", "camera", "1", {{"x", DType::u8, {1}, "", ""}}, {}, ""},
                    {"gone", "camera", "1", {}, {}, ""}};
  after.sensors = {{"new", "camera", "1", {}, {}, ""},
                   {"a", "camera", "1", {{"x", DType::u8, {1}, "", ""}}, {}, ""}};
  ShownTick x, y;
  x.packet.records = {{0, 0, 0, 0, {array_of<uint8_t>({1}, {1})}}};
  y.packet.records = {{1, 0, 0, 0, {array_of<uint8_t>({1}, {1})}}};
  const std::vector<Difference> rows = differences(before, x, after, y);
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_TRUE(rows[0].equal);
  EXPECT_EQ(rows[1].text, "is gone");
  EXPECT_EQ(rows[2].sensor, "new");
}

}  // namespace
}  // namespace greatx::view
