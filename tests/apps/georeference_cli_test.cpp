// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A scenario in latitude and longitude gives the bytes of the same scenario in metres, from all seven
// modalities, at three places of the Earth. Data sets say where their nodes are, and the sun is that of the
// place.
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/geodesy.h"
#include "scene/generator/generate.h"
#include "scene/georeference/georeference.h"
#include "tests/apps/program.h"

namespace greatx::apps::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

/// Returns a .glb with the extras in its scene.
std::string with_extras(const std::vector<std::byte>& glb, const std::string& extras) {
  const std::string bytes(reinterpret_cast<const char*>(glb.data()), glb.size());
  uint32_t json_size = 0;
  std::memcpy(&json_size, bytes.data() + 12, 4);
  json document = json::parse(bytes.substr(20, json_size));
  document["scenes"][0]["extras"] = json::parse(extras);
  std::string text = document.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::string rest = bytes.substr(20 + json_size);
  const auto word = [](size_t value) {
    const auto small = static_cast<uint32_t>(value);
    return std::string(reinterpret_cast<const char*>(&small), 4);
  };
  return "glTF" + word(2) + word(20 + text.size() + rest.size()) + word(text.size()) + "JSON" + text + rest;
}

/// Returns a place some metres from the origin of a frame, with rounded numbers, as a person writes it.
Geodetic place_near(const LocalFrame& frame, const dvec3& local_m) {
  const Geodetic place = frame.datum_place(local_m);
  const auto rounded = [](double value, double digits) { return std::round(value * digits) / digits; };
  return {rounded(place.latitude_deg, 1e8), rounded(place.longitude_deg, 1e8), rounded(place.height_m, 1e3)};
}

/// How a scenario gives its positions.
enum class Positions { metres, degrees };

std::string position_of(const LocalFrame& frame, const Geodetic& place, Positions positions) {
  if (positions == Positions::degrees)
    return fmt::format("position_deg: [{}, {}, {}]", place.latitude_deg, place.longitude_deg, place.height_m);
  const dvec3 local = frame.local_of_datum(place);
  return fmt::format("position_m: [{}, {}, {}]", local.x, local.y, local.z);
}

constexpr const char* rig = R"(greatx: 1
name: rig
seed: 2
ticks: 4
tick_rate_hz: 20
scene: {SCENE}
environment: {clouds: 0}
nodes:
  - name: mast
    trajectory: {type: static, MAST}
    sensors: [{name: a, type: antenna}]
  - name: eye
    trajectory: {type: waypoints, EYE}
    sensors:
      - {name: a, type: antenna}
      - {name: cam, type: camera, rate_hz: 20, width: 48, height: 36, fov_deg: 80}
      - {name: dvs, type: event_camera, rate_hz: 20, width: 48, height: 36, fov_deg: 80, steps: 2}
      - {name: lidar, type: lidar, rate_hz: 20, channels: 8, elevation_min_deg: -20, elevation_max_deg: 10,
         azimuth_steps: 90, max_range_m: 100}
      - name: radar
        type: radar
        rate_hz: 10
        waveform: {carrier_hz: 77e9, bandwidth_hz: 300e6, samples: 64, sample_rate_hz: 10e6, chirp_s: 12e-6,
          interval_s: 13e-6, chirps: 32}
        transmit: {columns: 1}
        receive: {columns: 2}
        power_dbm: 20
        receiver: {noise_figure_db: 12}
channels:
  - {name: csi, tx: mast/a, rx: [eye/a], rate_hz: 20, bandwidth_hz: 20e6, subcarriers: 16, max_depth: 1}
)";

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  return text.replace(text.find(what), what.size(), with);
}

class GeoreferenceCli : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
  }
  void write_canyon(const std::string& name, const std::string& extras) const {
    write(name, with_extras(scene::generate_glb({"canyon", 3, 60.0, ""}), extras));
  }
  /// Runs the scenario `name`.yaml into the folder `name`.
  void generate(const std::string& name) const {
    const Outcome outcome = greatx(fmt::format("generate '{}.yaml' -o '{}' -q", path(name), path(name)));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }
  /// Returns the files of the sequences by name.
  std::map<std::string, std::string> records(const std::string& name) const {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(path(name) + "/sequence_0000"))
      if (entry.is_regular_file())
        files[fs::relative(entry.path(), path(name)).string()] = read_file(entry.path());
    return files;
  }
  void expect_same_records(const std::string& a, const std::string& b) const {
    const auto one = records(a), other = records(b);
    ASSERT_GT(one.size(), 20u);
    ASSERT_EQ(one.size(), other.size());
    for (const auto& [file, bytes] : one) {
      ASSERT_TRUE(other.contains(file)) << file;
      EXPECT_TRUE(bytes == other.at(file)) << file << " differs";
    }
  }
  json info(const std::string& name) const { return json::parse(read_file(path(name) + "/dataset.json")); }
  /// Returns the numbers of an .npy file of version 1.
  static std::vector<double> numbers(const std::string& npy) {
    const size_t begin =
        10 + static_cast<uint8_t>(npy[8]) + 256 * static_cast<size_t>(static_cast<uint8_t>(npy[9]));
    std::vector<double> values((npy.size() - begin) / sizeof(double));
    std::memcpy(values.data(), npy.data() + begin, values.size() * sizeof(double));
    return values;
  }

  greatx::test::TemporaryFolder folder_;
};

struct Site {
  const char* name;
  Georeference reference;
};

class GeoreferenceSites : public GeoreferenceCli, public testing::WithParamInterface<Site> {};

TEST_P(GeoreferenceSites, DegreesAndMetresGiveTheSameBytes) {
  const Georeference& reference = GetParam().reference;
  const LocalFrame frame(reference);
  write_canyon("canyon.glb", scene::georeference_extras(reference));
  write_canyon("nowhere.glb", "{}");
  const Geodetic mast = place_near(frame, {1.0, -20.0, 6.0}), from = place_near(frame, {2.0, -16.0, 1.6}),
                 to = place_near(frame, {2.0, -14.0, 1.6});
  const auto scenario = [&](const std::string& file, Positions positions) {
    const std::string scene = fmt::format("file: '{}'", path(file));
    const std::string way = fmt::format(
        "points: [{{t_s: 0, {}, rotation_deg: [90, 0, 0]}}, {{t_s: 0.25, {}, rotation_deg: [95, 0, 0]}}]",
        position_of(frame, from, positions), position_of(frame, to, positions));
    return replaced(replaced(replaced(rig, "SCENE", scene), "MAST", position_of(frame, mast, positions)),
                    "EYE", way);
  };
  write("metres.yaml", scenario("canyon.glb", Positions::metres));
  write("degrees.yaml", scenario("canyon.glb", Positions::degrees));
  write("nowhere.yaml", scenario("nowhere.glb", Positions::metres));
  generate("metres");
  generate("degrees");
  generate("nowhere");
  expect_same_records("metres", "degrees");

  // The array says where the nodes are, and is all that the georeference adds.
  auto records_here = records("metres"), records_nowhere = records("nowhere");
  const std::string geodetic = "sequence_0000/poses/geodetic.npy";
  ASSERT_TRUE(records_here.contains(geodetic));
  ASSERT_FALSE(records_nowhere.contains(geodetic));
  const std::vector<double> places = numbers(records_here[geodetic]);
  ASSERT_EQ(places.size(), 4u * 2u * 3u);
  const Geodetic expected[] = {mast, from};
  for (size_t node = 0; node < 2; ++node) {
    EXPECT_NEAR(places[3 * node], expected[node].latitude_deg, 1e-12);
    EXPECT_NEAR(places[3 * node + 1], expected[node].longitude_deg, 1e-12);
    EXPECT_NEAR(places[3 * node + 2], expected[node].height_m + reference.undulation_m, 1e-8);
  }
  records_here.erase(geodetic);
  for (const auto& [file, bytes] : records_nowhere)
    if (file.find("index") == std::string::npos) {  // the index says which arrays there are
      EXPECT_TRUE(bytes == records_here.at(file)) << file << " differs";
    }
  EXPECT_EQ(info("metres")["run"]["georeference"], json::parse(scene::georeference_json(reference)));
  EXPECT_FALSE(info("nowhere")["run"].contains("georeference"));
  EXPECT_NE(info("metres")["run"]["scene_sha256"], info("nowhere")["run"]["scene_sha256"]);
  EXPECT_EQ(greatx(fmt::format("verify '{}'", path("degrees"))).code, 0);

  // The data set's own scenario runs again.
  fs::copy(path("degrees") + "/scenario.yaml", path("again.yaml"));
  generate("again");
  expect_same_records("degrees", "again");
}

INSTANTIATE_TEST_SUITE_P(Sites, GeoreferenceSites,
                         testing::Values(Site{"Delft", {{52.0116, 4.3571, 45.0}, 43.4, "NAP"}},
                                         Site{"Ushuaia", {{-54.8, -68.3, 25.0}, 13.0, ""}},
                                         Site{"DateLine",
                                              {{-17.0, 179.999995, 60.0}, 61.0, "MSL"}}),  // 0.5 m from it
                         [](const auto& site) { return site.param.name; });

TEST_F(GeoreferenceCli, LogsGiveTheBytesOfPoints) {
  const Georeference reference{{52.0116, 4.3571, 45.0}, 43.4, "NAP"};
  const LocalFrame frame(reference);
  const Geodetic mast = place_near(frame, {1.0, -20.0, 6.0}), from = place_near(frame, {2.0, -16.0, 1.6}),
                 to = place_near(frame, {2.0, -14.0, 1.6});
  const std::string scene = fmt::format("generate: {{kind: canyon, seed: 3, size_m: 60}}, georeference: {}",
                                        scene::georeference_json(reference));
  const std::string base =
      replaced(replaced(rig, "SCENE", scene), "MAST", position_of(frame, mast, Positions::degrees));
  write("points.yaml", replaced(base, "EYE",
                                fmt::format("points: [{{t_s: 0, {}}}, {{t_s: 0.25, {}}}]",
                                            position_of(frame, from, Positions::metres),
                                            position_of(frame, to, Positions::metres))));
  const auto row = [](const char* time, const Geodetic& place) {
    return fmt::format("{},{},{},{}\n", time, place.latitude_deg, place.longitude_deg, place.height_m);
  };
  write("log.csv",
        "time,lat,lon,ele\n" + row("2026-06-21T12:00:00Z", from) + row("2026-06-21T12:00:00.25Z", to));
  write("csv.yaml", replaced(base, "EYE", fmt::format("csv: '{}'", path("log.csv"))));
  const auto point = [](const char* time, const Geodetic& place) {
    return fmt::format("<trkpt lat=\"{}\" lon=\"{}\"><ele>{}</ele><time>{}</time></trkpt>\n",
                       place.latitude_deg, place.longitude_deg, place.height_m, time);
  };
  write("log.gpx", "<gpx><trk><trkseg>\n" + point("2026-06-21T12:00:00Z", from) +
                       point("2026-06-21T12:00:00.25Z", to) + "</trkseg></trk></gpx>\n");
  write("gpx.yaml", replaced(base, "EYE", fmt::format("gpx: '{}'", path("log.gpx"))));
  for (const char* name : {"points", "csv", "gpx"}) generate(name);
  expect_same_records("points", "csv");
  expect_same_records("points", "gpx");
}

constexpr const char* lit = R"(greatx: 1
name: lit
ticks: 1
scene: {generate: {kind: canyon, seed: 3, size_m: 60},
  georeference: {latitude_deg: -36.85, longitude_deg: 174.76,
  height_m: 60.5, undulation_m: 33.5}}
environment: {ENVIRONMENT time: "2026-06-21T15:00:00+12:00"}
nodes:
  - name: eye
    trajectory: {type: static, position_deg: [-36.85, 174.76, 28.5]}
    sensors: [{name: cam, type: camera, rate_hz: 1, width: 64, height: 48, fov_deg: 80}]
)";

TEST_F(GeoreferenceCli, SunIsThatOfThePlace) {
  write("here.yaml", replaced(lit, "ENVIRONMENT", ""));
  write("said.yaml",
        replaced(lit, "ENVIRONMENT", "place: {latitude_deg: -36.85, longitude_deg: 174.76, height_m: 27},"));
  write("there.yaml", replaced(lit, "ENVIRONMENT", "place: {latitude_deg: 36.85, longitude_deg: 174.76},"));
  generate("here");
  generate("said");
  const auto here = records("here"), said = records("said");
  ASSERT_GE(here.size(), 5u);
  EXPECT_TRUE(here == said);
  const Outcome there = greatx(fmt::format("generate '{0}.yaml' -o '{0}' -q", path("there")));
  EXPECT_EQ(there.code, 0);
  EXPECT_THAT(there.err,
              HasSubstr("there.yaml:7: environment.place: the sun and the sky are those of latitude "
                        "36.85, longitude 174.76, but the scene's georeference is 73.7 degrees away"));
  EXPECT_FALSE(here == records("there"));
  const Outcome words = greatx(fmt::format("explain '{}.yaml'", path("here")));
  EXPECT_THAT(words.out,
              HasSubstr("  origin at latitude -36.85000000, longitude 174.76000000, 60.500 m above the "
                        "ellipsoid, 27.000 m above the vertical datum\n"));
  EXPECT_THAT(words.out,
              HasSubstr("  sun and sky at latitude -36.85, longitude 174.76 (the scene's georeference), "
                        "2026-06-21T15:00:00+12:00\n"));
  const json facts = json::parse(greatx(fmt::format("explain --json '{}.yaml'", path("there"))).out);
  EXPECT_EQ(facts["georeference"]["height_m"], 60.5);
  EXPECT_EQ(facts["place"]["of_scene"], false);
  EXPECT_EQ(facts["warnings"].size(), 1u);
  const Outcome check = greatx(fmt::format("check --host '{}.yaml'", path("there")));
  EXPECT_EQ(check.code, 0);
  EXPECT_THAT(check.out, HasSubstr("doubt: scenario contradicts itself: "));
}

TEST_F(GeoreferenceCli, ReceiversMayBePlaces) {
  const Georeference reference{{52.0116, 4.3571, 45.0}, 43.4, "NAP"};
  const LocalFrame frame(reference);
  write_canyon("canyon.glb", scene::georeference_extras(reference));
  const Geodetic mast = place_near(frame, {1.0, -20.0, 6.0}), at = place_near(frame, {2.0, -16.0, 1.6});
  write("rig.yaml",
        replaced(replaced(replaced(rig, "SCENE", fmt::format("file: '{}'", path("canyon.glb"))), "MAST",
                          position_of(frame, mast, Positions::degrees)),
                 "EYE", fmt::format("points: [{{t_s: 0, {}}}]", position_of(frame, at, Positions::degrees))));
  const dvec3 local = frame.local_of_datum(at);
  write("metres.csv", fmt::format("{},{},{}\n", local.x, local.y, local.z));
  write("degrees.csv",
        fmt::format("lat,lon,height\n{},{},{}\n", at.latitude_deg, at.longitude_deg, at.height_m));
  const auto paths = [&](const char* list) {
    return greatx(fmt::format("paths '{}' --receivers '{}' --json", path("rig.yaml"), path(list)));
  };
  const Outcome metres = paths("metres.csv"), degrees = paths("degrees.csv");
  ASSERT_EQ(degrees.code, 0) << degrees.err;
  EXPECT_THAT(degrees.out, HasSubstr("\"paths\""));
  EXPECT_EQ(metres.out, degrees.out);
  const json link = json::parse(degrees.out)["receivers"][0];
  EXPECT_NEAR(link["geodetic"][0], at.latitude_deg, 1e-12);
  EXPECT_NEAR(link["geodetic"][1], at.longitude_deg, 1e-12);
  EXPECT_NEAR(link["geodetic"][2], at.height_m + 43.4, 1e-8);
  EXPECT_NEAR(link["transmitter_geodetic"][0], mast.latitude_deg, 1e-12);
  ASSERT_EQ(greatx(fmt::format("paths '{}' --receivers '{}' -q --csv-out '{}'", path("rig.yaml"),
                               path("degrees.csv"), path("out.csv")))
                .code,
            0);
  const std::string csv = read_file(path("out.csv"));
  EXPECT_THAT(csv, HasSubstr(",delay_spread_ns,latitude_deg,longitude_deg,height_m\n0,"));
  EXPECT_THAT(csv, HasSubstr(fmt::format(",{},", link["geodetic"][0].get<double>())));
  const Outcome info = greatx(fmt::format("scene info '{}'", path("canyon.glb")));
  EXPECT_THAT(info.out,
              HasSubstr("  origin at latitude 52.01160000, longitude 4.35710000, 45.000 m above the "
                        "ellipsoid, 1.600 m above NAP\n"));
}

}  // namespace
}  // namespace greatx::apps::test
