// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Positions in latitude and longitude are those in metres, wherever a scenario or a table takes them. Faults
// within a scenario's text are in scenarios/bad_scenarios.json.
#include <filesystem>
#include <fstream>
#include <unistd.h>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/formats/glb_writer.h"
#include "scene/georeference/georeference.h"
#include "sim/scenario/parse/load_scenario.h"
#include "sim/scenario/parse/receiver_list.h"
#include "sim/scenario/parse/trajectory_csv.h"
#include "sim/scenario/parse/trajectory_gpx.h"

namespace greatx::sim {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr Geodetic delft{52.0116, 4.3571, 45.0};
const Georeference over_nap{delft, 43.4, "NAP"};

/// Positions by PROJ 9.1.1 (tests/core/geodesy_test.cpp), with heights above the ellipsoid.
const dvec3 east_of_delft(9803.232578, 4282.363689, 6.043678);  // 52.05, 4.5, 60 m

constexpr const char* delft_map =
    "{latitude_deg: 52.0116, longitude_deg: 4.3571, height_m: 45, undulation_m: 43.4, vertical_datum: NAP}";

EarthPositions earth_at(const Georeference& reference, HeightOf heights = HeightOf::ellipsoid) {
  SceneConfig scene;
  scene.georeference = reference;
  scene.heights = heights;
  return EarthPositions(scene);
}

template <typename Act>
std::string refusal(const Act& act) {
  try {
    act();
  } catch (const UserError& error) {
    return error.what();
  }
  return "accepted";
}

Scenario scenario_of(const std::string& rest, const std::string& scene = "") {
  return parse_scenario("greatx: 1\nname: x\nticks: 1\n" + rest, "s.yaml", scene.empty() ? "." : scene);
}

std::string node_of(const std::string& trajectory, const std::string& scene = "") {
  return fmt::format("scene: {{georeference: {}{}}}\nnodes: [{{name: a, trajectory: {{{}}}}}]\n", delft_map,
                     scene, trajectory);
}

template <typename T>
T trajectory_of(const std::string& trajectory, const std::string& scene = "") {
  return std::get<T>(scenario_of(node_of(trajectory, scene)).nodes[0].trajectory);
}

double apart_m(const dvec3& a, const dvec3& b) { return glm::distance(a, b); }

/// A folder that is removed with its files.
class EarthFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              fmt::format("greatx_earth_{}_{}", getpid(),
                          ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  /// Writes a .glb with one triangle and the extras.
  void write_glb(const std::string& name, const std::string& extras) const {
    io::GlbWriter writer;
    writer.add_material({.name = "concrete"});
    io::GlbPrimitive triangle;
    triangle.material = 0;
    triangle.positions = {vec3(0.0f), vec3(1.0f, 0.0f, 0.0f), vec3(0.0f, 1.0f, 0.0f)};
    triangle.indices = {0, 1, 2};
    io::GlbNode node;
    node.name = "triangle";
    node.mesh = writer.add_mesh("triangle", {triangle});
    writer.add_node(node);
    const io::Bytes bytes = writer.finish("scene", extras);
    write(name, std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  }
  Scenario scenario(const std::string& rest) const { return scenario_of(rest, folder_.string()); }
  std::string refused(const std::string& rest) const {
    return refusal([&] { scenario(rest); });
  }
  fs::path folder_;
};

TEST(EarthPositions, OfEveryTrajectoryAreThoseOfTheFrame) {
  const LocalFrame frame(over_nap);
  const dvec3 a = frame.local_of_datum({52.012, 4.358, 10.0}), b = frame.local_of_datum({52.013, 4.36, 20.0});
  EXPECT_EQ(trajectory_of<StaticTrajectory>("type: static, position_deg: [52.012, 4.358, 10]").position_m, a);
  const auto way = trajectory_of<WayPointTrajectory>(
      "type: waypoints, points: [{t_s: 0, position_deg: [52.012, 4.358, 10]}, {t_s: 1, position_m: [1, 2, "
      "3]}]");
  EXPECT_EQ(way.points[0].position_m, a);
  EXPECT_EQ(way.points[1].position_m, dvec3(1.0, 2.0, 3.0));
  const auto box = trajectory_of<BezierTrajectory>(
      "type: bezier, box: {min_deg: [52.012, 4.358, 10], max_deg: [52.013, 4.36, 20]}");
  EXPECT_EQ(box.min_m, a);
  EXPECT_EQ(box.max_m, b);
  const auto curve = trajectory_of<BezierTrajectory>(
      "type: bezier, control_points_deg: [[52.012, 4.358, 10], [52.013, 4.36, 20], [52.012, 4.358, 10], "
      "[52.013, 4.36, 20]]");
  EXPECT_EQ(*curve.control_points, (std::array{a, b, a, b}));
  const auto line = trajectory_of<CorridorTrajectory>(
      "type: corridor, center_line_deg: [[52.012, 4.358, 10], [52.013, 4.36, 20]]");
  EXPECT_EQ(line.center_line_m, (std::vector{a, b}));
  const Scenario scene =
      scenario_of(fmt::format("scene: {{georeference: {}, objects: [{{name: car, generate: {{kind: car}}, "
                              "position_deg: [52.013, 4.36, "
                              "20]}}]}}\n",
                              delft_map));
  EXPECT_EQ(scene.scene.objects[0].position_m, b);
}

TEST(EarthPositions, HeightsBeginWhereTheScenarioSays) {
  const char* const place = "type: static, position_deg: [52.05, 4.5, 60]";
  const std::string own = fmt::format("{}, heights: ellipsoid", place);
  EXPECT_LT(apart_m(trajectory_of<StaticTrajectory>(place, ", heights: ellipsoid").position_m, east_of_delft),
            1e-6);
  EXPECT_LT(apart_m(trajectory_of<StaticTrajectory>(own).position_m, east_of_delft), 1e-6);
  const dvec3 higher = trajectory_of<StaticTrajectory>(place).position_m;  // above NAP
  EXPECT_NEAR(apart_m(higher, east_of_delft), 43.4, 1e-6);
  EXPECT_GT(higher.z, east_of_delft.z + 43.3);
  EXPECT_EQ(trajectory_of<StaticTrajectory>(fmt::format("{}, heights: datum", place), ", heights: ellipsoid")
                .position_m,
            higher);
}

TEST(EarthPositions, CrossTheDateLine) {
  const Georeference fiji{{-17.0, 179.99, 60.0}, 0.0, ""};
  const EarthPositions earth = earth_at(fiji);
  const auto at = [&](double latitude, double longitude, double height) {
    return earth.local({latitude, longitude, height},
                       [](const std::string& expected, const std::string& found) {
                         throw UserError(expected + " " + found);
                       });
  };
  EXPECT_LT(apart_m(at(-17.02, -179.95, 30.0), {6388.500656, -2214.375723, -33.585161}), 1e-6);
  EXPECT_LT(apart_m(at(-16.95, 179.93, 530.0), {-6391.371345, 5532.932676, 464.385090}), 1e-6);
  EXPECT_LT(apart_m(at(-17.0, 180.0, 1000.0), at(-17.0, -180.0, 1000.0)), 1e-6);
}

TEST(EarthPositions, SpacecraftMayBeFar) {
  const EarthPositions earth = earth_at(over_nap);
  const auto fail = [](const std::string& expected, const std::string& found) {
    throw UserError(expected + "|" + found);
  };
  EXPECT_GT(earth.local({50.0, 9.0, 550e3}, fail).z, 500e3);
  EXPECT_EQ(
      refusal([&] {
        earth.local({50.0, 9.0, 99e3}, fail);
      }),
      "a place within 100 km of the scene's origin at latitude 52.0116, longitude 4.3571|[50, 9, 99000], "
      "395 km away");
  EXPECT_EQ(refusal([&] {
              earth.local({4.3571, 52.0116, 5.0}, fail);
            }),
            "a place within 100 km of the scene's origin at latitude 52.0116, longitude 4.3571|[4.3571, "
            "52.0116, 5], 6532 km away; did you mean [52.0116, 4.3571, 5]? The latitude comes first");
}

// ------------------------------------------------------------------------------------------------ way-points

TEST(EarthWayPoints, CsvFindsItsColumnsByName) {
  const WayPointLog log{earth_at(over_nap), {}};
  const char* const texts[] = {
      "t,lat,lon,height\n0,52.05,4.5,60\n2,52.0116,4.3571,45\n",
      "Longitude, Latitude, Ele_m, Time_s\n4.5,52.05,60,0\n4.3571,52.0116,45,2\n",
      "# log\nlon,altitude,lat,timestamp\n4.5,60,52.05,2026-06-21T12:00:00Z\n"
      "4.3571,45,52.0116,2026-06-21T14:00:02+02:00\n",
  };
  for (const char* text : texts) {
    const auto points = parse_way_points(text, "f.csv", log);
    ASSERT_EQ(points.size(), 2u) << text;
    EXPECT_EQ(points[0].time_s, 0.0);
    EXPECT_EQ(points[1].time_s, 2.0);
    EXPECT_LT(apart_m(points[0].position_m, east_of_delft), 1e-6);
    EXPECT_LT(apart_m(points[1].position_m, dvec3(0.0)), 1e-6);
    EXPECT_FALSE(points[0].orientation);
  }
  const auto turned =
      parse_way_points("t,lat,lon,alt,yaw_deg,pitch_deg,roll_deg\n0,52.05,4.5,60,90,0,0\n", "f.csv", log);
  EXPECT_NEAR(glm::distance(*turned[0].orientation * dvec3(1, 0, 0), dvec3(0, 1, 0)), 0.0, 1e-15);
}

TEST(EarthWayPoints, DatesCountFromTheStartTime) {
  const WayPointLog log{earth_at(over_nap), 1782043200.0};  // 2026-06-21T12:00:00Z
  const auto points = parse_way_points(
      "time,x,y,z\n2026-06-21T11:59:59.5Z,0,0,1\n2026-06-21T14:00:00.125+02:00,0,0,2\n", "f.csv", log);
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0].time_s, -0.5);
  EXPECT_EQ(points[1].time_s, 0.125);
}

TEST(EarthWayPoints, CsvFaultsNameLineAndColumn) {
  const WayPointLog log{earth_at(over_nap), {}};
  const auto refused = [&](const std::string& text, const WayPointLog& with) {
    return refusal([&] { parse_way_points(text, "f.csv", with); });
  };
  EXPECT_EQ(refused("t,lat,lon,height\n0,52.05,4.5,60\n", {}),
            "f.csv:2:3: lat: expected a position in metres, since the scene has no georeference "
            "(scene.georeference), found a latitude and a longitude");
  EXPECT_EQ(refused("t,lat,lon\n0,1,2\n", log),
            "f.csv:1:7: expected the columns t, lat, lon, height, found no height");
  EXPECT_EQ(
      refused("t,lat,lon,ele,speed\n", log),
      "f.csv:1:15: expected a column of t, lat, lon, height, yaw_deg, pitch_deg, roll_deg, found 'speed'");
  EXPECT_EQ(refused("t,lat,lon,ele,alt\n", log),
            "f.csv:1:15: expected the column height once, found 'ele' and 'alt'");
  EXPECT_EQ(refused("t,lat,lon,ele,yaw_deg\n", log),
            "f.csv:1:15: expected the columns yaw_deg, pitch_deg, roll_deg, found no pitch_deg");
  EXPECT_EQ(refused("t,lat,lon,ele\n0,52.05,4.5\n", log),
            "f.csv:2:9: expected 4 values as in the header line, found 3");
  EXPECT_EQ(refused("t,lat,lon,ele\n0,52.05,4.5,\n", log),
            "f.csv:2:13: height: expected a finite number, found a gap");
  EXPECT_EQ(
      refused("t,lat,lon,ele\n0,4.5,52.05,60\n", log),
      "f.csv:2:3: lat: expected a place within 100 km of the scene's origin at latitude 52.0116, longitude "
      "4.3571, found [4.5, 52.05, 60], 6522 km away; did you mean [52.05, 4.5, 60]? The latitude comes "
      "first");
  EXPECT_EQ(
      refused("t,lat,lon,ele\n0,52.05,4.5,60\n2026-06-21T12:00:00Z,52.05,4.5,60\n", log),
      "f.csv:3:1: t: expected a number of seconds as in the lines before, found '2026-06-21T12:00:00Z'");
  EXPECT_EQ(
      refused("lat,lon,ele,t\n52.05,4.5,60,2026-06-21T12:00:00Z\n52.05,4.5,60,2026-06-21T12:00:00Z\n", log),
      "f.csv:3:14: t: expected a time greater than the one before, 0, found '2026-06-21T12:00:00Z'");
  EXPECT_EQ(refused("t,lat,lon,ele\n0,52.05,4.5,60\n", {log.earth, 0.0}),
            "f.csv:2:1: t: expected a date and time, since start_time is given, found '0'");
  EXPECT_EQ(refused("t,lat,lon,ele\n2026-06-21,52.05,4.5,60\n", log),
            "f.csv:2:1: t: expected a finite number of seconds, or a date and time with its offset such as "
            "2026-06-21T12:00:00Z, found '2026-06-21'");
  EXPECT_EQ(refused("lat,lon,ele,t\n", log), "f.csv: expected one way-point or more, found none");
}

constexpr const char* track = R"(<?xml version="1.0" encoding="UTF-8"?>
<gpx version="1.1" creator="x" xmlns="http://www.topografix.com/GPX/1/1">
  <metadata><time>2026-06-21T11:00:00Z</time></metadata>
  <trk><name>flight</name>
    <trkseg>
      <trkpt lat="52.05" lon="4.5"><ele>60</ele><time>2026-06-21T12:00:00Z</time><sat>9</sat></trkpt>
    </trkseg>
    <trkseg>
      <trkpt lat="52.0116" lon="4.3571"><ele> 45.0 </ele><time>2026-06-21T12:00:01.500Z</time></trkpt>
    </trkseg>
  </trk>
</gpx>
)";

std::string with(std::string text, const std::string& what, const std::string& instead) {
  return text.replace(text.find(what), what.size(), instead);
}

TEST(EarthWayPoints, GpxIsATrack) {
  const auto points = parse_gpx(track, "f.gpx", {earth_at(over_nap), {}});
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0].time_s, 0.0);
  EXPECT_EQ(points[1].time_s, 1.5);
  EXPECT_LT(apart_m(points[0].position_m, east_of_delft), 1e-6);
  EXPECT_LT(apart_m(points[1].position_m, dvec3(0.0)), 1e-6);
}

TEST(EarthWayPoints, GpxFaultsNameTheLine) {
  const auto refused = [&](const std::string& what, const std::string& instead) {
    return refusal([&] { parse_gpx(with(track, what, instead), "f.gpx", {earth_at(over_nap), {}}); });
  };
  EXPECT_EQ(refused("<ele>60</ele>", ""), "f.gpx:6: <trkpt>: ele: expected a number, found none");
  EXPECT_EQ(refused("lat=\"52.0116\"", "lat=\"north\""),
            "f.gpx:9: <trkpt>: lat: expected a number, found 'north'");
  EXPECT_EQ(
      refused("<time>2026-06-21T12:00:00Z</time>", ""),
      "f.gpx:6: <trkpt>: time: expected a finite number of seconds, or a date and time with its offset such "
      "as 2026-06-21T12:00:00Z, found ''");
  EXPECT_EQ(refused("T12:00:01.500Z", "T11:59:59Z"),
            "f.gpx:9: <trkpt>: time: expected a time greater than the one before, 0, found "
            "'2026-06-21T11:59:59Z'");
  EXPECT_THAT(refused("lon=\"4.5\"", "lon=\"45\""),
              HasSubstr("f.gpx:6: <trkpt>: position: expected a place"));
  EXPECT_THAT(refused("</trkseg>", ""), HasSubstr("XML: "));
  EXPECT_EQ(refused("</gpx>", "<trk/></gpx>"), "f.gpx:12: <gpx>: expected one track (<trk>), found a second");
  EXPECT_EQ(refusal([] { parse_gpx("<gpx/>", "f.gpx", {}); }), "f.gpx: expected a track (<trk>), found none");
  EXPECT_EQ(refusal([] { parse_gpx("<gpx><trk/></gpx>", "f.gpx", {}); }),
            "f.gpx: expected one track point (<trkpt>) or more, found none");
  EXPECT_EQ(refusal([] { parse_gpx("<kml/>", "f.gpx", {}); }),
            "f.gpx: expected the root element <gpx>: not a GPX file");
}

TEST_F(EarthFiles, ScenariosReadCsvAndGpx) {
  write("a.csv", "t,lat,lon,height\n0,52.05,4.5,16.6\n");
  write("a.gpx", with(track, "<ele>60</ele>", "<ele>16.6</ele>"));
  for (const char* source : {"csv: a.csv", "gpx: a.gpx, start_time: \"2026-06-21T12:00:00Z\""}) {
    const Scenario read = scenario(node_of(fmt::format("type: waypoints, {}", source)));
    const auto& points = std::get<WayPointTrajectory>(read.nodes[0].trajectory).points;
    EXPECT_EQ(points[0].time_s, 0.0);
    EXPECT_LT(apart_m(points[0].position_m, east_of_delft), 1e-6) << source;  // 16.6 + 43.4 m
  }
  EXPECT_THAT(refused(node_of("type: waypoints, csv: a.csv, gpx: a.gpx")),
              HasSubstr("expected one of 'csv' and 'gpx', found both"));
}

// ------------------------------------------------------------------------------------------------- receivers

TEST(EarthReceivers, ListFindsItsColumnsByName) {
  const auto points =
      parse_receiver_list("height,lat,lon\n60,52.05,4.5\n45,52.0116,4.3571\n", "r.csv", earth_at(over_nap));
  ASSERT_EQ(points.size(), 2u);
  EXPECT_LT(apart_m(points[0], east_of_delft), 1e-6);
  EXPECT_LT(apart_m(points[1], dvec3(0.0)), 1e-6);
  EXPECT_EQ(refusal([] { parse_receiver_list("lat,lon,height\n52.05,4.5,60\n", "r.csv"); }),
            "r.csv:2:1: lat: expected a position in metres, since the scene has no georeference "
            "(scene.georeference), found a latitude and a longitude");
  EXPECT_EQ(refusal([] { parse_receiver_list("lat,lon,t\n", "r.csv"); }),
            "r.csv:1:9: expected a column of lat, lon, height, found 't'");
}

// ---------------------------------------------------------------------------------------------- georeference

TEST_F(EarthFiles, GlbKeepsTheGeoreference) {
  const Georeference odd{{-17.123456789012345, 179.98765432109876, -0.1}, 61.2, "MSL \"1986\""};
  write_glb("odd.glb", scene::georeference_extras(odd));
  write_glb("none.glb", "");
  write_glb("other.glb", R"({"greatx_other": 1})");
  EXPECT_EQ(scene::georeference_of_file(folder_ / "odd.glb"), odd);
  EXPECT_EQ(scene::georeference_of_file(folder_ / "none.glb"), std::nullopt);
  EXPECT_EQ(scene::georeference_of_file(folder_ / "other.glb"), std::nullopt);
  write("cut.glb", "glTF\2");
  EXPECT_EQ(scene::georeference_of_file(folder_ / "cut.glb"), std::nullopt);
  EXPECT_EQ(scenario("scene: {file: odd.glb}\n").scene.georeference, odd);
  EXPECT_EQ(scenario("scene: {objects: [{name: a, file: odd.glb}]}\n").scene.georeference, odd);
  EXPECT_EQ(scenario("scene: {file: none.glb}\n").scene.georeference, std::nullopt);
}

TEST_F(EarthFiles, ScenarioMayGiveTheGeoreference) {
  write_glb("none.glb", "");
  write_glb("nap.glb", scene::georeference_extras(over_nap));
  write_glb("egm.glb", scene::georeference_extras({delft, 43.3, "EGM2008"}));
  const auto scene_of = [&](const std::string& rest) { return fmt::format("scene: {{{}}}\n", rest); };
  const std::string own = fmt::format("georeference: {}", delft_map);
  EXPECT_EQ(scenario(scene_of("file: none.glb, " + own)).scene.georeference, over_nap);
  EXPECT_EQ(scenario(scene_of("file: nap.glb, " + own)).scene.georeference, over_nap);
  EXPECT_EQ(scenario(scene_of("file: nap.glb, objects: [{name: a, file: none.glb, position_m: [1, 2, 3]}]"))
                .scene.georeference,
            over_nap);
  EXPECT_THAT(refused(scene_of("file: egm.glb, " + own)),
              HasSubstr("s.yaml:4: scene: expected one georeference, found {\"latitude_deg\":52.0116,"));
  EXPECT_THAT(refused(scene_of("file: egm.glb, objects: [{name: a, file: nap.glb}]")),
              HasSubstr("egm.glb and {\"latitude_deg\":52.0116"));
  for (const char* moved :
       {"position_m: [1, 0, 0]", "position_deg: [52, 4, 1]", "rotation_deg: [1, 0, 0]", "scale: 2"})
    EXPECT_THAT(
        refused(scene_of(fmt::format("objects: [{{name: a, file: nap.glb, {}}}]", moved))),
        HasSubstr("s.yaml:4: scene.objects: expected no position, rotation_deg and scale of the file '"));
}

TEST(EarthDocuments, FaultsNameFileLineAndField) {
  const auto refused = [](const std::string& reference) {
    return refusal([&] {
      scene::georeference_of_document(
          "{\"scenes\": [{},\n{\"extras\": {\"greatx_georeference\":\n" + reference + "}}], \"scene\": 1}",
          {"a.gltf", 1});
    });
  };
  constexpr const char* path = "scenes[1].extras.greatx_georeference";
  EXPECT_EQ(refused(R"({"latitude_deg": 52, "longitude_deg": 4, "height_m": 0})"), "accepted");
  EXPECT_EQ(refused(R"({"latitude_deg": 92, "longitude_deg": 4, "height_m": 0})"),
            fmt::format("a.gltf:3: {}.latitude_deg: expected a number from -90 to 90, found 92", path));
  EXPECT_EQ(refused(R"({"latitude_deg": 52, "longitude_deg": "4", "height_m": 0})"),
            fmt::format("a.gltf:3: {}.longitude_deg: expected a number from -180 to 180, found \"4\"", path));
  EXPECT_EQ(refused(R"({"latitude_deg": 52, "longitude_deg": 4})"),
            fmt::format("a.gltf:3: {}.height_m: expected a value, found none", path));
  EXPECT_EQ(refused(R"({"latitude_deg": 52, "longitude_deg": 4, "height_m": 0, "height": 1})"),
            fmt::format("a.gltf:3: {}.height: expected nothing: the members are latitude_deg, longitude_deg, "
                        "height_m, undulation_m and vertical_datum, found 1",
                        path));
  EXPECT_EQ(
      refused("[52, 4, 0]"),
      fmt::format("a.gltf:3: {}: expected an object with latitude_deg, longitude_deg and height_m, found a "
                  "list of 3",
                  path));
}

// -------------------------------------------------------------------------------------------------- sun, sky

TEST(EarthSky, PlaceIsThatOfTheScene) {
  const std::string scene = fmt::format("scene: {{georeference: {}}}\n", delft_map);
  const Scenario implied = scenario_of(scene + "environment: {time: \"2026-06-21T12:00:00+02:00\"}\n");
  const PlaceAndTime& place = *implied.environment.place;
  EXPECT_TRUE(place.of_scene);
  EXPECT_NEAR(degrees(place.latitude), 52.0116, 1e-12);
  EXPECT_NEAR(degrees(place.longitude), 4.3571, 1e-12);
  EXPECT_NEAR(place.height_m, 1.6, 1e-12);
  EXPECT_EQ(place.unix_s, 1782036000.0);
  EXPECT_TRUE(implied.warnings.empty());
  EXPECT_FALSE(scenario_of(scene).environment.place);  // without a time the sun stands where it always did

  const auto with_place = [&](double latitude, double longitude) {
    return scenario_of(scene +
                       fmt::format("environment: {{place: {{latitude_deg: {}, longitude_deg: {}}}, time: "
                                   "\"2026-06-21T12:00:00+02:00\"}}\n",
                                   latitude, longitude));
  };
  EXPECT_TRUE(with_place(52.9, 4.4).warnings.empty());
  const Scenario far = with_place(48.5, 4.4);
  EXPECT_FALSE(far.environment.place->of_scene);
  ASSERT_EQ(far.warnings.size(), 1u);
  EXPECT_EQ(
      far.warnings[0],
      "s.yaml:5: environment.place: the sun and the sky are those of latitude 48.5, longitude 4.4, but the "
      "scene's georeference is 3.51 degrees away at latitude 52.0116, longitude 4.3571");
}

TEST(EarthSky, PlacesAreNearAcrossTheDateLine) {
  const Scenario read = scenario_of(
      "scene: {georeference: {latitude_deg: -17, longitude_deg: 179.9, height_m: 60}}\n"
      "environment: {place: {latitude_deg: -17, longitude_deg: -179.9}, time: \"2026-06-21T12:00:00Z\"}\n");
  EXPECT_TRUE(read.warnings.empty());
}

}  // namespace
}  // namespace greatx::sim
