// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests the cameras' ground truth in the whole simulator. Several cameras in one submission give the same
// bytes as each alone, flow leads to the camera's own next sample, and boxes stand where the poses say.
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "tests/support/kept_run.h"

namespace greatx::sim {
namespace {

using test::keep_run;
using test::KeptRun;

const std::string all = "outputs: [rgb, depth, ids, depth_ray, normals, flow, boxes]";
std::string camera(const std::string& name, const std::string& rate, const std::string& more) {
  return "      - {name: " + name + ", type: camera, rate_hz: " + rate +
         ", width: 48, height: 32, fov_deg: 90, " + all + ", " + more + "}\n";
}
const std::string left = camera("left", "10", "mount: {position_m: [1.2, 0.3, 1.4]}");
const std::string right = camera("right", "10", "mount: {position_m: [1.2, -0.3, 1.4]}");
const std::string side = camera("side", "5", "mount: {position_m: [0, 0, 1.4], rotation_deg: [90, 0, 0]}");

const std::string fisheye =
    "      - {name: fisheye, type: camera, rate_hz: 10, width: 48, height: 48, fov_deg: 180, mount: "
    "{position_m: [0, 0, 3]}, lens: {model: fisheye, k1: -0.02, circle_deg: 190}, outputs: [rgb, depth, ids, "
    "depth_ray, normals, flow]}\n";
const std::string rolling =
    "      - {name: rolling, type: camera, rate_hz: 5, width: 48, height: 32, fov_deg: 90, mount: "
    "{position_m: "
    "[0, 0, 1.4], rotation_deg: [90, 0, 0]}, rolling_shutter: {readout_s: 0.1, bands: 2}, outputs: [rgb, "
    "depth, ids, depth_ray]}\n";

std::string scenario(const std::string& cameras, int ticks = 4, int tick_rate_hz = 10) {
  return fmt::format("greatx: 1\nname: test\nseed: 5\nticks: {}\ntick_rate_hz: {}\n", ticks, tick_rate_hz) +
         "scene: {generate: {kind: canyon, seed: 9, size_m: 60}, optical_only: true}\n"
         "nodes:\n"
         "  - name: van\n"
         "    trajectory: {type: waypoints, interpolation: linear, points: [{t_s: 0, position_m: [2.4, -20, "
         "0]}, "
         "{t_s: 2, position_m: [2.4, -10, 0]}]}\n"
         "    model: {generate: {kind: car, variant: van}}\n"
         "    sensors:\n" +
         cameras +
         "  - name: car\n"
         "    trajectory: {type: waypoints, interpolation: linear, points: [{t_s: 0, position_m: [2, -8, "
         "0]}, "
         "{t_s: 2, position_m: [1, 4, 0]}]}\n"
         "    model: {generate: {kind: car}}\n    class: vehicle\n";
}

TEST(Cameras, OfOneNodeHaveTheBytesThatEachHasAlone) {
  const KeptRun together = keep_run(scenario(left + right + side + fisheye + rolling));
  EXPECT_EQ(together.counters.submits, together.statistics.ticks);
  EXPECT_EQ(together.statistics.ticks, 4u);
  const std::pair<std::string, std::string> alone[] = {{"van/left", left},
                                                       {"van/right", right},
                                                       {"van/side", side},
                                                       {"van/fisheye", fisheye},
                                                       {"van/rolling", rolling}};
  for (const auto& [name, text] : alone) {
    const KeptRun one = keep_run(scenario(text));
    int compared = 0;
    for (size_t i = 0; i < together.packets.size(); ++i)
      for (const ArraySpec& array : together.spec(name).arrays) {
        const Array* const a = together.find(i, name, array.name);
        if (a == nullptr) continue;
        const Array* const b =
            one.find(i / (name == "van/side" || name == "van/rolling" ? 2 : 1), name, array.name);
        ASSERT_NE(b, nullptr);
        EXPECT_EQ(a->shape, b->shape) << name << ' ' << array.name;
        EXPECT_TRUE(a->bytes == b->bytes) << name << ' ' << array.name;
        ++compared;
      }
    EXPECT_GE(compared, 12) << name;
  }
}

TEST(Cameras, OfAStereoPairDifferByTheirBaseline) {
  const KeptRun outcome = keep_run(scenario(left + right));
  const auto ids_left = outcome.array<uint16_t>(0, "van/left", "instance"),
             ids_right = outcome.array<uint16_t>(0, "van/right", "instance");
  const auto depth_left = outcome.array<float>(0, "van/left", "depth"),
             depth_right = outcome.array<float>(0, "van/right", "depth");
  int same = 0, compared = 0;
  for (int row = 0; row < 32; ++row)
    for (int column = 0; column < 48; ++column) {
      const float z = depth_left[row * 48 + column];
      const double u = column + 0.5 - 24.0 * 0.6 / z;  // disparity fx b / z
      if (!std::isfinite(z) || u < 0.0) continue;
      const auto there = static_cast<size_t>(row * 48 + static_cast<int>(u));
      ++compared;
      // The other camera sees the same surface, up to half a pixel along it.
      same += ids_right[there] == ids_left[row * 48 + column] && std::abs(depth_right[there] - z) < 0.1 * z
                  ? 1
                  : 0;
    }
  EXPECT_GT(compared, 500);
  EXPECT_GT(same, 0.85 * compared);
}

/// Two bands of rows stand at a quarter of the readout before and after the tick, where a camera of a higher
/// rate takes whole pictures.
TEST(Cameras, RowsOfARollingShutterAreThoseOfTheirInstants) {
  std::string whole = side, slow = rolling;
  whole.replace(whole.find("rate_hz: 5"), 10, "rate_hz: 40");
  const KeptRun outcome = keep_run(scenario(whole + slow, 12, 40));
  const auto rows_of = [&](const char* camera, size_t packet, size_t row) {
    const auto depth = outcome.array<float>(packet, camera, "depth");
    const auto ids = outcome.array<uint16_t>(packet, camera, "instance");
    std::vector<std::pair<uint16_t, float>> pixels;
    for (size_t i = 48 * row; i < 48 * (row + 16); ++i) pixels.emplace_back(ids[i], depth[i]);
    return pixels;
  };
  // Returns the pixels that differ. Outlines may, by rounding.
  const auto other = [&](size_t row, size_t packet) {
    const auto a = rows_of("van/rolling", 8, row), b = rows_of("van/side", packet, row);
    int count = 0;
    for (size_t i = 0; i < a.size(); ++i)
      count += a[i].first != b[i].first ||
               !(a[i].second == b[i].second || std::abs(a[i].second - b[i].second) < 1e-5f * b[i].second);
    return count;
  };
  EXPECT_LE(other(0, 7), 4);
  EXPECT_LE(other(16, 9), 4);
  // The facade moves along itself, so that only its outlines and what stands before it differ at the tick.
  EXPECT_GT(other(0, 8) + other(16, 8), 60);
}

TEST(Flow, IsToTheCamerasOwnNextSample) {
  const KeptRun outcome = keep_run(scenario(left + side));
  // The van moves at 5 m/s along y and the side camera looks to -x. Static points move sideways by fx v dt /
  // z.
  int compared = 0;
  for (const size_t packet : {size_t{0}, size_t{2}}) {  // also the last sample: the trajectory continues
    const auto flow = outcome.array<float>(packet, "van/side", "flow");
    const auto depth = outcome.array<float>(packet, "van/side", "depth");
    const auto ids = outcome.array<uint16_t>(packet, "van/side", "instance");
    for (size_t i = 0; i < depth.size(); ++i) {
      if (ids[i] == 0 || outcome.instances[ids[i] - 1].body != 0) continue;
      ASSERT_NEAR(flow[2 * i], -24.0 * 5.0 * 0.2 / depth[i], 1e-4);
      ASSERT_NEAR(flow[2 * i + 1], 0.0, 1e-5);
      ++compared;
    }
  }
  EXPECT_GT(compared, 1000);
  EXPECT_EQ(outcome.find(1, "van/side", "flow"), nullptr);
  // The front camera samples at 10 Hz. Points ahead move away from the vanishing point by dz / (z - dz).
  for (size_t packet = 0; packet < 4; ++packet) {
    const auto flow = outcome.array<float>(packet, "van/left", "flow");
    const auto depth = outcome.array<float>(packet, "van/left", "depth");
    const auto ids = outcome.array<uint16_t>(packet, "van/left", "instance");
    for (size_t i = 0; i < depth.size(); ++i) {
      if (ids[i] == 0 || outcome.instances[ids[i] - 1].body != 0) continue;
      if (depth[i] < 0.5 + 0.1) {
        ASSERT_TRUE(std::isnan(flow[2 * i]));
        continue;
      }
      const double grows = 0.5 / (depth[i] - 0.5);
      ASSERT_NEAR(flow[2 * i], (static_cast<double>(i % 48) + 0.5 - 24.0) * grows, 1e-4);
      ASSERT_NEAR(flow[2 * i + 1], (static_cast<double>(i / 48) + 0.5 - 16.0) * grows, 1e-4);
    }
  }
}

TEST(Boxes, OfARunStandWhereThePosesSay) {
  const KeptRun outcome = keep_run(scenario(left));
  for (size_t packet = 0; packet < 4; ++packet) {
    const auto node = outcome.array<int32_t>(packet, "van/left", "box_node");
    const auto instance = outcome.array<uint32_t>(packet, "van/left", "box_instance");
    const auto center = outcome.array<double>(packet, "van/left", "box_center");
    const auto size = outcome.array<float>(packet, "van/left", "box_size");
    const auto visible = outcome.array<uint32_t>(packet, "van/left", "box_visible_pixels");
    const auto amodal = outcome.array<float>(packet, "van/left", "box_amodal");
    const auto modal = outcome.array<int32_t>(packet, "van/left", "box_modal");
    const auto ids = outcome.array<uint16_t>(packet, "van/left", "instance");
    const auto position = outcome.array<double>(packet, "poses", "position");
    size_t cars = 0;
    for (size_t i = 0; i < node.size(); ++i) {
      EXPECT_NE(node[i], 0);  // the camera's own van
      EXPECT_EQ(visible[i], std::ranges::count(ids, instance[i]));
      if (visible[i] > 0) {
        // The visible part lies within the projected vertices, except for a pixel at the rim.
        EXPECT_GE(modal[4 * i], amodal[4 * i] - 1.0f);
        EXPECT_GE(modal[4 * i + 1], amodal[4 * i + 1] - 1.0f);
        EXPECT_LE(modal[4 * i + 2], amodal[4 * i + 2] + 1.0f);
        EXPECT_LE(modal[4 * i + 3], amodal[4 * i + 3] + 1.0f);
      }
      if (node[i] != 1) continue;
      ++cars;
      EXPECT_NEAR(center[3 * i], position[3], 0.3);
      EXPECT_NEAR(center[3 * i + 1], position[4], 0.3);
      EXPECT_NEAR(center[3 * i + 2], 0.5 * size[3 * i + 2], 0.1);
      EXPECT_GT(size[3 * i], 3.0f);
      EXPECT_GT(visible[i], 5u);
    }
    EXPECT_EQ(cars, 1u);
  }
}

}  // namespace
}  // namespace greatx::sim
