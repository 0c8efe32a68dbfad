// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Every choice of outputs of every sensor must make a data set that holds them, verifies and can be looked
// at. The choices are each output alone, each pair, and all. One run has a sensor for each choice.
#include <algorithm>
#include <filesystem>
#include <fstream>

#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/apps/program.h"

namespace greatx::apps::test {
namespace {

using Names = std::vector<std::string>;

/// An output, and the files and folders that it makes.
struct Output {
  std::string name;
  Names makes;
};

const std::vector<Output> camera{{"rgb", {"rgb"}},
                                 {"depth", {"depth"}},
                                 {"ids", {"instance", "semantic", "material"}},
                                 {"hdr", {"hdr"}},
                                 {"depth_png24", {"depth24"}},
                                 {"depth_log", {"depth_log"}},
                                 {"depth_ray", {"depth_ray"}},
                                 {"normals", {"normals"}},
                                 {"flow", {"flow"}},
                                 {"boxes", {"boxes"}}};
const std::vector<Output> event_camera{
    {"events", {"t.npy", "x.npy", "y.npy", "p.npy", "dropped.npy", "pictures.npy"}},
    {"differences", {"difference.npy", "differences"}},
    {"hdf5", {"events.h5"}},
    {"text", {"events_text.txt"}},
    {"instance", {"instance.npy"}}};
const std::vector<Output> lidar{
    {"points", {"points"}}, {"ply", {"cloud"}}, {"pcd", {"pcd"}}, {"kitti", {"velodyne"}}};
const std::vector<Output> radar{{"cube", {"cube.npy"}},
                                {"range_doppler", {"range_doppler.npy"}},
                                {"range_azimuth", {"range_azimuth.npy"}},
                                {"detections", {"detections.npy", "range.npy", "instance.npy"}}};
const std::vector<Output> channel{{"cfr", {"cfr.npy"}},
                                  {"paths", {"paths"}},
                                  {"cfr_parts", {"cfr_line_of_sight.npy", "cfr_others.npy"}},
                                  {"coherence", {"coherence_bandwidth.npy", "coherence_time.npy"}}};

/// Returns each output alone, each pair of outputs, and all outputs.
std::vector<std::vector<Output>> choices(const std::vector<Output>& outputs) {
  std::vector<std::vector<Output>> all;
  for (size_t i = 0; i < outputs.size(); ++i) {
    all.push_back({outputs[i]});
    for (size_t j = i + 1; j < outputs.size(); ++j) all.push_back({outputs[i], outputs[j]});
  }
  all.push_back(outputs);
  return all;
}

Names names_of(const std::vector<Output>& choice) {
  Names names;
  for (const Output& output : choice) names.push_back(output.name);
  return names;
}

bool holds(const std::vector<Output>& choice, const std::string& name) {
  return std::ranges::any_of(choice, [&](const Output& output) { return output.name == name; });
}

class Outputs : public testing::Test {
 protected:
  /// Writes a scenario with these sensors of the node `eye` and these channels. Returns the file's path.
  std::string scenario(const std::string& sensors, const std::string& channels = "") const {
    const std::string file = (folder_.path() / "outputs.yaml").string();
    std::ofstream(file) << "greatx: 1\nname: outputs\nticks: 2\ntick_rate_hz: 10\n"
                           "scene: {generate: {kind: room}}\n"
                           "nodes:\n"
                           "  - name: mast\n"
                           "    trajectory: {type: static, position_m: [1, 0.5, 1.8]}\n"
                           "    sensors: [{name: antenna, type: antenna}]\n"
                           "  - name: eye\n"
                           "    trajectory: {type: waypoints, points: [{t_s: 0, position_m: [-1, 0, 1.2]}, "
                           "{t_s: 1, position_m: [-0.5, 0, 1.2]}]}\n"
                           "    sensors:\n      - {name: antenna, type: antenna}\n"
                        << sensors << channels;
    return file;
  }
  /// Runs every choice. `row` returns the YAML of sensor number i with its outputs. `in` is the folder above
  /// the folders of the sensors.
  template <typename Row>
  void sweep(const std::vector<std::vector<Output>>& all, const std::string& in, bool is_channel,
             const Row& row) {
    std::string rows = is_channel ? "channels:\n" : "";
    for (size_t i = 0; i < all.size(); ++i)
      rows += row(i, fmt::format("outputs: [{}]", fmt::join(names_of(all[i]), ", ")));
    const std::string data = (folder_.path() / "data").string();
    const std::string file = is_channel ? scenario("", rows) : scenario(rows);
    const Outcome run = greatx(fmt::format("generate {} -o {} -q", file, data));
    ASSERT_EQ(run.code, 0) << run.err;
    for (size_t i = 0; i < all.size(); ++i)
      for (const Output& output : all[i])
        for (const std::string& made : output.makes)
          EXPECT_TRUE(std::filesystem::exists(fmt::format("{}/sequence_0000/{}s{}/{}", data, in, i, made)))
              << made << " of " << fmt::format("{}", fmt::join(names_of(all[i]), ", "));
    const Outcome verified = greatx("verify " + data);
    EXPECT_EQ(verified.code, 0) << verified.out << verified.err;
    EXPECT_THAT(verified.out, testing::HasSubstr("complete and sound"));
    const Outcome seen = greatx("inspect " + data);
    EXPECT_EQ(seen.code, 0) << seen.err;
    EXPECT_TRUE(std::filesystem::exists(data + "/contact_sheet.png"));
  }
  const greatx::test::TemporaryFolder folder_;
};

TEST_F(Outputs, OfALidarMayBeChosenFreely) {
  sweep(choices(lidar), "eye/", false, [](size_t i, const std::string& outputs) {
    return fmt::format(
        "      - {{name: s{}, type: lidar, rate_hz: 10, channels: 2, elevation_min_deg: -20, "
        "elevation_max_deg: -5, "
        "azimuth_steps: 8, {}}}\n",
        i, outputs);
  });
}

/// The points of a LiDAR that delivers nothing else equal those of a LiDAR that delivers everything.
TEST_F(Outputs, OfALidarDoNotChangeOneAnother) {
  std::string rows;
  const Names chosen{"points", "kitti", "points, ply, pcd, kitti"};
  for (size_t i = 0; i < chosen.size(); ++i)
    rows += fmt::format(
        "      - {{name: s{}, type: lidar, rate_hz: 10, channels: 4, elevation_min_deg: -20, "
        "elevation_max_deg: -5, "
        "azimuth_steps: 32, outputs: [{}]}}\n",
        i, chosen[i]);
  const std::string data = (folder_.path() / "data").string();
  ASSERT_EQ(greatx(fmt::format("generate {} -o {} -q", scenario(rows), data)).code, 0);
  const auto file = [&](const std::string& name) { return read_file(data + "/sequence_0000/eye/" + name); };
  EXPECT_GT(file("s1/velodyne/000001.bin").size(), 1000u);
  EXPECT_EQ(file("s0/points/000001.npy"), file("s2/points/000001.npy"));
  EXPECT_EQ(file("s1/velodyne/000001.bin"), file("s2/velodyne/000001.bin"));
}

TEST_F(Outputs, OfACameraMayBeChosenFreely) {
  sweep(choices(camera), "eye/", false, [](size_t i, const std::string& outputs) {
    return fmt::format(
        "      - {{name: s{}, type: camera, rate_hz: 10, width: 12, height: 8, fov_deg: 80, antialiasing: "
        "none, {}}}\n",
        i, outputs);
  });
}

/// Outputs that are made from events need the events. A choice without them is refused by name.
TEST_F(Outputs, OfAnEventCameraMayBeChosenFreelyBesideEvents) {
  std::vector<std::vector<Output>> good;
  const auto row = [](size_t i, const std::string& outputs) {
    return fmt::format(
        "      - {{name: s{}, type: event_camera, rate_hz: 10, width: 12, height: 8, fov_deg: 80, {}}}\n", i,
        outputs);
  };
  for (const std::vector<Output>& choice : choices(event_camera)) {
    if (holds(choice, "events") || names_of(choice) == Names{"differences"}) {
      good.push_back(choice);
      continue;
    }
    const std::string outputs = fmt::format("outputs: [{}]", fmt::join(names_of(choice), ", "));
    const Outcome refused = greatx("explain " + scenario(row(0, outputs)));
    EXPECT_EQ(refused.code, 1) << outputs;
    EXPECT_THAT(refused.err, testing::HasSubstr("outputs: expected 'events' beside")) << outputs;
  }
  sweep(good, "eye/", false, row);
}

TEST_F(Outputs, OfARadarMayBeChosenFreely) {
  sweep(choices(radar), "eye/", false, [](size_t i, const std::string& outputs) {
    return fmt::format(
        "      - {{name: s{}, type: radar, rate_hz: 10, waveform: {{bandwidth_hz: 300e6, samples: 64, "
        "sample_rate_hz: 25e6, chirp_s: 12e-6, interval_s: 13e-6, chirps: 16}}, receive: {{columns: 2}}, "
        "{}}}\n",
        i, outputs);
  });
}

TEST_F(Outputs, OfAChannelMayBeChosenFreely) {
  std::vector<std::vector<Output>> all = choices(channel);
  all.push_back({});  // only the arrays that every link has
  sweep(all, "", true, [](size_t i, const std::string& outputs) {
    return fmt::format(
        "  - {{name: s{}, tx: mast/antenna, rx: [eye/antenna], rate_hz: 10, carrier_hz: 3.5e9, subcarriers: "
        "4, "
        "bandwidth_hz: 20e6, max_depth: 1, {}}}\n",
        i, outputs);
  });
}

}  // namespace
}  // namespace greatx::apps::test
