// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Compressed data sets hold the arrays of uncompressed ones, whatever the threads and wherever a run was
// killed. Rounded points keep their bound.
#include <cmath>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "io/dataset/dataset_reader.h"
#include "tests/apps/program.h"

namespace greatx::apps::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr const char* all_sensors = R"(greatx: 1
name: rig
seed: 2
ticks: 8
tick_rate_hz: 20
scene: {generate: {kind: canyon, seed: 3, size_m: 60}}
environment: {clouds: 0}
nodes:
  - name: mast
    trajectory: {type: static, position_m: [1, -20, 6]}
    sensors: [{name: a, type: antenna}]
  - name: eye
    trajectory: {type: waypoints, points: [{t_s: 0, position_m: [2, -16, 1.6], rotation_deg: [90, 0, 0]},
                                           {t_s: 1, position_m: [2, -14, 1.6], rotation_deg: [95, 0, 0]}]}
    sensors:
      - {name: a, type: antenna}
      - {name: cam, type: camera, rate_hz: 20, width: 64, height: 48, fov_deg: 80}
      - {name: listed, type: camera, rate_hz: 10, width: 64, height: 48, fov_deg: 80,
         outputs: [rgb, depth, flow, normals, boxes, depth_png24]}
      - {name: dvs, type: event_camera, rate_hz: 20, width: 62, height: 46, fov_deg: 70, steps: 4,
         outputs: [events, instance, differences, hdf5, text]}
      - {name: lidar, type: lidar, rate_hz: 20, channels: 16, elevation_min_deg: -20, elevation_max_deg: 10,
         azimuth_steps: 180, max_range_m: 100}
      - {name: bare, type: lidar, rate_hz: 20, channels: 8, elevation_min_deg: -20, elevation_max_deg: 10,
         azimuth_steps: 90, max_range_m: 100, outputs: [points, ply]}
      - {name: sky, type: lidar, rate_hz: 20, channels: 2, elevation_min_deg: 88, elevation_max_deg: 89,
         azimuth_steps: 20, max_range_m: 100}
      - name: radar
        type: radar
        rate_hz: 10
        waveform: {carrier_hz: 77e9, bandwidth_hz: 300e6, samples: 64, sample_rate_hz: 10e6, chirp_s: 12e-6,
          interval_s: 13e-6, chirps: 32}
        transmit: {columns: 1}
        receive: {columns: 4}
        power_dbm: 20
        receiver: {noise_figure_db: 12}
channels:
  - {name: csi, tx: mast/a, rx: [eye/a], rate_hz: 20, bandwidth_hz: 20e6, subcarriers: 16, max_depth: 1}
)";

class CompressionCli : public testing::Test {
 protected:
  CompressionCli() { write(all_sensors); }
  void write(const std::string& text) const { std::ofstream(path("rig.yaml")) << text; }
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  Outcome generate(const std::string& name, const std::string& options) const {
    return greatx(fmt::format("generate '{}' -o '{}' -q {}", path("rig.yaml"), path(name), options));
  }
  std::string file(const std::string& name) const { return read_file(path(name)); }
  bool there(const std::string& name) const { return fs::exists(path(name)); }

  /// Compares every array of every record.
  void expect_same_arrays(const std::string& one, const std::string& other) const {
    const io::DatasetReader a(path(one)), b(path(other));
    ASSERT_EQ(a.sensors().size(), b.sensors().size());
    ASSERT_EQ(a.records(0), b.records(0));
    size_t empty = 0;
    for (const io::IndexRow& row : a.records(0)) {
      const SensorSpec& sensor = a.sensors()[static_cast<size_t>(row.sensor)];
      for (const ArraySpec& spec : sensor.arrays) {
        const Array x = a.load(0, row, spec.name), y = b.load(0, row, spec.name);
        ASSERT_TRUE(x.dtype == y.dtype && x.shape == y.shape && x.bytes == y.bytes)
            << sensor.name << " " << spec.name << " " << row.tick;
        empty += x.bytes.empty();
      }
    }
    EXPECT_GT(empty, 0u) << "there are no empty records to test";
  }

  const greatx::test::TemporaryFolder folder_;
};

TEST_F(CompressionCli, EveryArrayOfEverySensorIsTheSame) {
  ASSERT_EQ(generate("plain", "").code, 0);
  for (const std::string compression : {"none", "fast", "small"}) {
    SCOPED_TRACE(compression);
    const Outcome run = generate(compression, "--compression " + compression);
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_THAT(file(compression + "/scenario.yaml"), HasSubstr("compression: " + compression));
    expect_same_arrays("plain", compression);
    const Outcome verified = greatx("verify '" + path(compression) + "'");
    EXPECT_EQ(verified.code, 0) << verified.out << verified.err;
    EXPECT_EQ(greatx("inspect '" + path(compression) + "'").code, 0);
    const std::string eye = "/sequence_0000/eye/";
    // Files for other tools have the same bytes.
    for (const std::string made : {"dvs/events.h5", "dvs/events_text.txt"})
      EXPECT_EQ(file(compression + eye + made), file("plain" + eye + made)) << made;
    const bool packed = compression != "none";
    for (const std::string twice : {"cam/depth", "cam/depth24", "lidar/cloud", "lidar/points"})
      EXPECT_NE(there(compression + eye + twice), packed) << twice;
    for (const std::string once : {"cam", "listed", "dvs", "lidar", "bare", "radar"})
      EXPECT_EQ(there(compression + eye + once + "/records.h5"), packed) << once;
    // What the scenario lists is written.
    for (const std::string listed : {"listed/depth/000000.exr", "listed/depth24/000000.png",
                                     "listed/normals/000000.exr", "bare/cloud/000000.ply"})
      EXPECT_TRUE(there(compression + eye + listed)) << listed;
    EXPECT_TRUE(there(compression + "/sequence_0000/csi/cfr.npy"));
    EXPECT_FALSE(there(compression + eye + "dvs/records.chunks.part"));
  }
}

TEST_F(CompressionCli, ThreadsChangeNoByte) {
  ASSERT_EQ(generate("one", "--compression fast --threads 1").code, 0);
  for (const std::string threads : {"2", "8"}) {
    ASSERT_EQ(generate(threads, "--compression fast --threads " + threads).code, 0);
    EXPECT_EQ(file(threads + "/manifest.json"), file("one/manifest.json"));
  }
  EXPECT_THAT(file("one/manifest.json"), HasSubstr("eye/lidar/records.h5"));
}

TEST_F(CompressionCli, AKilledRunIsFinishedToTheSameBytes) {
  const std::string options = "--compression small --ticks 60 --sequences 2";
  ASSERT_EQ(generate("whole", options).code, 0);
  // The run is killed when the packed returns of some records are written.
  for (const int bytes : {20'000, 200'000}) {
    SCOPED_TRACE(bytes);
    const std::string stream = path("cut") + "/sequence_0000/eye/lidar/records.chunks.part";
    const std::string command = fmt::format(
        "'{}' generate '{}' -o '{}' -q {} & run=$!; n=0; while [ $n -lt 6000 ] && "
        "[ $(stat -c %s '{}' 2>/dev/null || echo 0) -lt {} ]; do sleep 0.005; n=$((n+1)); done; "
        "kill -9 $run; wait $run 2>/dev/null; true",
        GREATX_PROGRAM, path("rig.yaml"), path("cut"), options, stream, bytes);
    ASSERT_EQ(std::system(command.c_str()), 0);
    ASSERT_FALSE(there("cut/manifest.json"));
    const io::DatasetReader reader(path("cut"));  // whole records of an unfinished run can be read
    for (const io::IndexRow& row : reader.records(0))
      for (const ArraySpec& spec : reader.sensors()[static_cast<size_t>(row.sensor)].arrays)
        EXPECT_NO_THROW(reader.load(0, row, spec.name));
    const Outcome resumed = generate("cut", options + " --resume");
    ASSERT_EQ(resumed.code, 0) << resumed.err;
    EXPECT_EQ(file("cut/manifest.json"), file("whole/manifest.json"));
    EXPECT_EQ(greatx("verify '" + path("cut") + "'").code, 0);
    fs::remove_all(path("cut"));
  }
  EXPECT_EQ(generate("whole", "--compression fast --ticks 60 --sequences 2 --resume").code, 1)
      << "another compression is another run";
}

TEST_F(CompressionCli, RoundedPointsKeepTheirBound) {
  constexpr double step_m = 0.005;
  ASSERT_EQ(generate("exact", "").code, 0);
  const std::string rounded = "--set nodes[eye].sensors[lidar].point_step_m=0.005";
  ASSERT_EQ(generate("plain", rounded).code, 0);
  ASSERT_EQ(generate("packed", rounded + " --compression fast").code, 0);
  expect_same_arrays("plain", "packed");
  const io::DatasetReader exact(path("exact")), packed(path("packed"));
  size_t moved = 0;
  double error_m = 0.0;
  for (size_t s = 0; s < packed.sensors().size(); ++s) {
    if (packed.sensors()[s].name != "eye/lidar") continue;
    error_m = nlohmann::json::parse(packed.sensors()[s].metadata_json).at("point_error_m");
    EXPECT_NEAR(error_m, std::sqrt(3.0) / 2.0 * step_m, 1e-4 * step_m + 3e-5);
    for (const io::IndexRow& row : packed.records_of(0, s)) {
      const Array a = exact.load(0, row, "points"), b = packed.load(0, row, "points");
      ASSERT_EQ(a.shape, b.shape);
      for (size_t i = 0; i < a.as<float>().size(); i += 4) {
        double squares = 0.0;
        for (size_t c = 0; c < 3; ++c) {
          const double x = a.as<float>()[i + c], y = b.as<float>()[i + c];
          EXPECT_LE(std::abs(x - y), 0.5 * step_m + 1e-5);
          EXPECT_EQ(static_cast<float>(step_m * std::round(y / step_m)), b.as<float>()[i + c]);
          squares += (x - y) * (x - y);
          moved += x != y;
        }
        EXPECT_LE(std::sqrt(squares), error_m);
        EXPECT_EQ(a.as<float>()[i + 3], b.as<float>()[i + 3]) << "the intensity is exact";
      }
      EXPECT_EQ(exact.load(0, row, "range").bytes, packed.load(0, row, "range").bytes);
    }
  }
  EXPECT_GT(moved, 1000u);
  EXPECT_GT(error_m, 0.0);
  // The comparison with the depth picture accounts for the bound, and the files say the same as the run.
  const Outcome verified = greatx("verify '" + path("packed") + "'");
  EXPECT_EQ(verified.code, 0) << verified.out << verified.err;
  EXPECT_THAT(verified.out, HasSubstr("lidar_vs_depth: recomputed"));
  const nlohmann::json run = nlohmann::json::parse(
      greatx(fmt::format("generate '{}' -o '{}' --json {}", path("rig.yaml"), path("again"), rounded)).out);
  const nlohmann::json& figure = run.at("consistency").at("lidar_vs_depth");
  EXPECT_GT(figure.at("compared"), 100);
  EXPECT_LT(figure.at("max_relative_error"), 1e-5);
  ASSERT_EQ(generate("floats", "--compression fast").code, 0);
  EXPECT_LT(file("packed/sequence_0000/eye/lidar/records.h5").size(),
            0.9 * static_cast<double>(file("floats/sequence_0000/eye/lidar/records.h5").size()));
}

TEST_F(CompressionCli, MistakesAreNamed) {
  const auto message = [&](const std::string& set) { return generate("bad", "--set " + set).err; };
  EXPECT_THAT(message("nodes[eye].sensors[lidar].point_step_m=0.003"),
              HasSubstr("nodes[1].sensors[4].point_step_m: expected a step of at least max_range_m / 32767 = "
                        "0.00305185, so that coordinates fit 16 bits, found '0.003'"));
  EXPECT_THAT(message("nodes[eye].sensors[lidar].point_step_m=0"), HasSubstr("point_step_m: expected"));
  EXPECT_THAT(message("nodes[eye].sensors[cam].point_step_m=0.01"), HasSubstr("point_step_m"));
  EXPECT_THAT(message("storage.compression=zip"),
              HasSubstr("storage.compression: expected one of none, fast, small, found 'zip'"));
  EXPECT_THAT(message("storage.level=3"), HasSubstr("level"));
  EXPECT_EQ(generate("bad", "--compression zip").code, 1);
}

}  // namespace
}  // namespace greatx::apps::test
