// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the consistency figures of a run again from its files. Values that were changed since are named by
// sensor and tick.
#include "apps/files/consistency_files.h"

#include <cstring>
#include <functional>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "io/dataset/dataset_format.h"
#include "io/formats/exr.h"
#include "tests/apps/program.h"
#include "tests/support/temporary_folder.h"

namespace greatx::apps {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* scenario = R"(greatx: 1
name: world
seed: 3
ticks: 2
tick_rate_hz: 10
scene: {generate: {kind: canyon, seed: 3, size_m: 60}}
environment: {clouds: 0}
nodes:
  - name: van
    trajectory: {type: waypoints, points: [{t_s: 0, position_m: [-2, -20, 1.5]}, )"
                                 R"({t_s: 1, position_m: [-2, -15, 1.5]}]}
    sensors:
      - {name: camera, type: camera, rate_hz: 10, width: 64, height: 48, fov_deg: 60, outputs: [depth, ids]}
      - {name: lidar, type: lidar, rate_hz: 10, channels: 8, elevation_min_deg: -12, )"
                                 R"(elevation_max_deg: 12, azimuth_steps: 256}
      - name: radar
        type: radar
        rate_hz: 10
        waveform: {bandwidth_hz: 300e6, chirps: 32, samples: 128, sample_rate_hz: 3e6}
        transmit: {pattern: tr38901}
        receive: {pattern: tr38901, columns: 2}
        receiver: {noise_figure_db: 12}
        outputs: [detections]
        echoes: {tubes: 1000, max_bounces: 1}
      - {name: antenna, type: antenna}
  - name: car
    trajectory: {type: waypoints, points: [{t_s: 0, position_m: [-2, -8, 0]}, )"
                                 R"({t_s: 1, position_m: [-2, -4, 0]}]}
    model: {generate: {kind: car, variant: hatchback}}
    sensors: [{name: antenna, type: antenna, mount: {position_m: [0, 0, 2.5]}}]
channels:
  - {name: csi, tx: van/antenna, rx: [car/antenna], rate_hz: 10, subcarriers: 16, )"
                                 R"(bandwidth_hz: 20e6, max_depth: 0}
)";

/// Makes one run for all tests. Each test works on a copy.
class ConsistencyFiles : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    made_ = std::make_unique<greatx::test::TemporaryFolder>();
    io::write_file_atomically(made_->path() / "world.yaml", std::string_view(scenario));
    const auto outcome = test::greatx(fmt::format(
        "generate {} -o {}", (made_->path() / "world.yaml").string(), (made_->path() / "set").string()));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("radar_range_vs_box"));
  }
  static void TearDownTestSuite() { made_.reset(); }
  void SetUp() override { fs::copy(made_->path() / "set", folder(), fs::copy_options::recursive); }
  fs::path folder() const { return own_.path() / "set"; }
  fs::path sequence() const { return folder() / "sequence_0000"; }

  std::string problems() const {
    std::string text;
    for (const io::Problem& problem : verify_consistency(folder()).problems) text += problem.str() + "\n";
    return text;
  }
  /// Edits the values behind the header of a .npy file.
  template <typename T>
  void change(const fs::path& file, const std::function<void(std::span<T>)>& edit) const {
    io::Bytes bytes = io::read_file(file);
    std::vector<T> values((bytes.size() - 256) / sizeof(T));
    std::memcpy(values.data(), bytes.data() + 256, values.size() * sizeof(T));
    edit(values);
    std::memcpy(bytes.data() + 256, values.data(), values.size() * sizeof(T));
    io::write_file_atomically(file, bytes);
  }

  static inline std::unique_ptr<greatx::test::TemporaryFolder> made_;
  greatx::test::TemporaryFolder own_;
};

TEST_F(ConsistencyFiles, EveryFigureIsFoundAgain) {
  const ConsistencyReport report = verify_consistency(folder());
  EXPECT_EQ(problems(), "");
  ASSERT_EQ(report.figures.size(), 5u);
  for (const ConsistencyReport::Figure& figure : report.figures) {
    EXPECT_EQ(figure.records, 2u) << figure.name;
    EXPECT_EQ(figure.unwritten, 0u);
    EXPECT_GE(figure.compared, figure.name == sim::lidar_figure ? 20u : 2u) << figure.name;
  }
  const auto sights = std::ranges::find(report.figures, sim::sight_figure, &ConsistencyReport::Figure::name);
  ASSERT_NE(sights, report.figures.end());
  EXPECT_LT(sights->largest, 1e-12);
  const auto outcome = test::greatx("verify " + folder().string());
  EXPECT_EQ(outcome.code, 0) << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr("radar_range_vs_box: recomputed from disk: 2 records"));
  EXPECT_THAT(outcome.out, HasSubstr("agrees with the run"));
  EXPECT_THAT(outcome.out, HasSubstr("depth_vs_ray: not recomputed: the rays are not written"));
}

TEST_F(ConsistencyFiles, AShiftedCloudIsNamed) {
  change<float>(sequence() / "van/lidar/points/000001.npy", [](std::span<float> values) {
    for (float& value : values) value *= 1.001f;
  });
  EXPECT_THAT(problems(),
              testing::StartsWith("sequence_0000/van/lidar, tick 1: lidar_vs_depth against van/camera"));
}

TEST_F(ConsistencyFiles, AScaledDepthPictureIsNamed) {
  const fs::path file = sequence() / "van/camera/depth/000000.exr";
  Array depth = io::read_exr(file);
  for (float& value : depth.as<float>()) value *= 1.001f;
  io::write_file_atomically(file, io::encode_exr(depth));
  EXPECT_THAT(problems(), HasSubstr("van/lidar, tick 0: lidar_vs_depth against van/camera"));
}

TEST_F(ConsistencyFiles, ACarBesideItsPixelsIsNamed) {
  // The car is the second node; its box leaves no millimetre about it.
  change<double>(sequence() / "poses/position.npy", [](std::span<double> values) { values[4] += 0.5; });
  EXPECT_THAT(problems(), HasSubstr("sequence_0000/van/camera, tick 0: depth_vs_box against poses"));
  EXPECT_THAT(problems(), HasSubstr("sequence_0000/van/lidar, tick 0: lidar_vs_box against poses"));
}

TEST_F(ConsistencyFiles, ADelayAPoseAndARangeAreNamed) {
  change<double>(sequence() / "csi/paths/delay.npy",
                 [](std::span<double> delays) { delays[1] *= 1.0 + 1e-9; });
  EXPECT_THAT(problems(), testing::StartsWith("sequence_0000/csi, tick 1: line_of_sight_delay_vs_distance"));
  // The check finds a change by a nanometre in a metre, and so it finds a centimetre in the van's position.
  change<double>(sequence() / "poses/position.npy", [](std::span<double> values) { values[0] += 0.01; });
  EXPECT_THAT(problems(),
              HasSubstr("sequence_0000/csi, tick 0: line_of_sight_delay_vs_distance against poses"));
  change<float>(sequence() / "van/radar/range.npy", [](std::span<float> ranges) {
    for (float& range : ranges) range += 12.0f;
  });
  EXPECT_THAT(problems(), HasSubstr("sequence_0000/van/radar, tick 0: radar_range_vs_box against poses"));
}

TEST_F(ConsistencyFiles, MetadataThatLieAreNamed) {
  const fs::path file = folder() / io::dataset_file;
  const std::string original = io::read_text_file(file);
  const auto set = [&](const char* path, const nlohmann::ordered_json& value) {
    auto json = nlohmann::ordered_json::parse(original);
    json[nlohmann::ordered_json::json_pointer(path)] = value;
    io::write_file_atomically(file, json.dump(2));
  };
  std::map<std::string, size_t> sensors;
  const auto json = nlohmann::ordered_json::parse(original);
  for (size_t i = 0; i < json["sensors"].size(); ++i) sensors[json["sensors"][i]["name"]] = i;
  const auto metadata = [&](const char* sensor, const char* field) {
    return fmt::format("/sensors/{}/metadata/{}", sensors.at(sensor), field);
  };
  for (const nlohmann::ordered_json& value :
       {nlohmann::ordered_json::array({1}), nlohmann::ordered_json("x")}) {
    set(metadata("van/camera", "body_from_sensor/position_m").c_str(), value);
    EXPECT_THAT(problems(), HasSubstr("sequence_0000/van/lidar, tick 0: lidar_vs_depth: "));
    set(metadata("csi", "receivers/0/body_from_antenna/position_m").c_str(), value);
    EXPECT_THAT(problems(), HasSubstr("sequence_0000/csi, tick 0: line_of_sight_delay_vs_distance: "));
    set(metadata("poses", "nodes").c_str(), value);
    EXPECT_THROW(problems(), UserError);
    set("/run/instances/0/box_m", value);
    EXPECT_THROW(problems(), UserError);
  }
  set(metadata("van/camera", "width").c_str(), 4'000'000'000);
  EXPECT_THAT(problems(), HasSubstr("van/camera: depth: expected"));
  set(metadata("poses", "nodes").c_str(), {"van", "car", "third"});
  EXPECT_THAT(problems(), HasSubstr("poses: position: expected 9 elements"));
}

TEST_F(ConsistencyFiles, WhatIsMissingOrBrokenIsSaid) {
  const fs::path file = folder() / io::consistency_file;
  const std::string text = io::read_text_file(file);
  EXPECT_EQ(consistency_csv(parse_consistency_csv(text, "x")), text);
  io::write_file_atomically(file, std::string_view("figure\n"));
  EXPECT_THROW(verify_consistency(folder()), UserError);
  io::write_file_atomically(file, text + "radar_range_vs_box,0,1,van/radar,poses,x,0\n");
  EXPECT_THROW(verify_consistency(folder()), UserError);
  io::write_file_atomically(file, text + "radar_range_vs_box,0,1,van/other,poses,1,0\n");
  EXPECT_THAT(problems(), HasSubstr("van/other"));
  fs::remove(file);
  const ConsistencyReport report = verify_consistency(folder());
  EXPECT_THAT(report.figures, IsEmpty());
  ASSERT_EQ(report.notes.size(), 1u);
  EXPECT_THAT(report.notes[0], HasSubstr("consistency.csv is not there"));
}

}  // namespace
}  // namespace greatx::apps
