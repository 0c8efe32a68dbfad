// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests turning rotors in the whole simulator. Every sensor sees the blades where they are, and no sensor
// sees those of its own node.
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "sim/scenario/parse/load_scenario.h"
#include "tests/support/kept_run.h"

namespace greatx::sim {
namespace {

using test::expect_same_bytes;
using test::keep_run;
using test::KeptRun;

constexpr uint32_t width = 96, height = 64;
const double focal = 0.5 * width / std::tan(radians(30.0));

std::string looks_down(const std::string& name, const std::string& outputs, double up,
                       const std::string& more = "") {
  return fmt::format(
      "      - {{name: {}, type: camera, rate_hz: 10, width: {}, height: {}, fov_deg: 60, antialiasing: "
      "none, "
      "outputs: [{}], mount: {{position_m: [0, 0, {}], rotation_deg: [0, 90, 0]}}{}}}\n",
      name, width, height, outputs, up, more);
}
std::string scans_down(const std::string& name, double up, const std::string& more = "") {
  return fmt::format(
      "      - {{name: {}, type: lidar, rate_hz: 10, channels: 32, elevation_min_deg: -25, "
      "elevation_max_deg: 25, "
      "azimuth_steps: 64, azimuth_start_deg: 25, azimuth_span_deg: -50, mount: {{position_m: [0, 0, {}], "
      "rotation_deg: [0, 90, 0]}}{}}}\n",
      name, up, more);
}

/// Returns a scenario with a drone under a watcher at rest, and the sensors that both carry.
std::string hover(const std::string& watching, const std::string& carried = "") {
  return "greatx: 1\nname: test\nseed: 5\nticks: 4\ntick_rate_hz: 10\nscene: {optical_only: true}\nnodes:\n"
         "  - name: watcher\n    trajectory: {type: static, position_m: [0, 0, 10]}\n" +
         (watching.empty() ? "" : "    sensors:\n" + watching) +
         "  - name: uav\n    trajectory: {type: waypoints, interpolation: linear, points: [{t_s: 0, "
         "position_m: [0, 0, "
         "7], rotation_deg: [0, 0, 0]}, {t_s: 1, position_m: [0.3, 0, 7], rotation_deg: [20, 5, 0]}]}\n"
         "    model: {generate: {kind: quadrotor, variant: large}, parts: [{nodes: [rotor_0, rotor_2], "
         "rate_hz: 37.25}, "
         "{nodes: [rotor_1, rotor_3], rate_hz: -37.25}]}\n" +
         (carried.empty() ? "" : "    sensors:\n" + carried);
}

struct Ran {
  explicit Ran(const std::string& yaml)
      : experiment(make_experiment(parse_scenario(yaml, "test.yaml", "."))),
        courses(make_courses(experiment.scenario, world, 0)),
        run(keep_run(experiment)) {}
  bool is_rotor(uint32_t id) const { return id > 0 && world.scene.bodies[body(id)].joint.has_value(); }
  uint32_t body(uint32_t id) const { return world.scene.instances[id - 1].body; }
  Pose pose(uint32_t body, size_t tick) const {
    return body_motion(world, courses, body, 0.1 * double(tick)).pose;
  }
  Experiment experiment;
  const World& world = *experiment.world;
  Courses courses;
  KeptRun run;
};

/// Returns the point at a pixel's centre in local coordinates. The cameras above look straight down with the
/// top of the picture towards +x.
dvec3 point_at(size_t pixel, double depth, const dvec3& eye) {
  const double right = (static_cast<double>(pixel % width) + 0.5 - 0.5 * width) / focal,
               down = (static_cast<double>(pixel / width) + 0.5 - 0.5 * height) / focal;
  return eye + depth * dvec3(-down, -right, -1.0);
}
dvec2 pixel_of(const dvec3& point, const dvec3& eye) {
  const dvec3 d = point - eye;
  return {0.5 * width + focal * d.y / d.z, 0.5 * height + focal * d.x / d.z};
}

/// Blades and hubs reach 0.66 m from their axis and are at most 4 cm high
/// (scene/generator/objects/quadrotor.cpp).
void expect_on_rotor(const dvec3& in_rotor, double slack) {
  EXPECT_LE(std::hypot(in_rotor.x, in_rotor.y), 0.66 + slack);
  EXPECT_GE(in_rotor.z, -0.022 - slack);
  EXPECT_LE(in_rotor.z, 0.04 + slack);
}

TEST(PartsRun, PicturesAndSweepsMeetTheBladesWhereTheyAre) {
  const Ran r(hover(looks_down("camera", "depth, ids, flow", 0.0) + scans_down("lidar", 0.0)));
  EXPECT_EQ(r.run.counters.submits, r.run.statistics.ticks);
  EXPECT_LT(r.run.statistics.consistency.at(depth_figure).max(), 1e-4);
  const dvec3 eye = dvec3(0, 0, 10) - r.world.scene.origin;
  size_t seen = 0, flows = 0;
  std::set<uint32_t> rotors;
  for (size_t tick = 0; tick < 4; ++tick) {
    const auto ids = r.run.array<uint16_t>(tick, "watcher/camera", "instance");
    const auto depth = r.run.array<float>(tick, "watcher/camera", "depth");
    const auto flow = r.run.array<float>(tick, "watcher/camera", "flow");
    for (size_t i = 0; i < ids.size(); ++i) {
      if (!r.is_rotor(ids[i])) continue;
      ++seen;
      rotors.insert(ids[i]);
      const uint32_t body = r.body(ids[i]);
      const dvec3 point = point_at(i, depth[i], eye), in_rotor = r.pose(body, tick).inverse().apply(point);
      expect_on_rotor(in_rotor, 1e-4);
      if (std::isnan(flow[2 * i])) continue;
      const dvec2 next = pixel_of(r.pose(body, tick + 1).apply(in_rotor), eye), now = pixel_of(point, eye);
      ++flows;
      ASSERT_NEAR(flow[2 * i], next.x - now.x, 2e-3);
      ASSERT_NEAR(flow[2 * i + 1], next.y - now.y, 2e-3);
    }
  }
  EXPECT_EQ(rotors.size(), 4u);
  EXPECT_GT(seen, 300u);
  EXPECT_GT(flows, 200u);
}

TEST(PartsRun, ASensorSeesNoPartOfItsOwnNode) {
  const std::string own = ", see_own_body: true";
  const auto hits = [](const Ran& r, const char* camera) {
    size_t count = 0;
    for (const uint16_t id : r.run.array<uint16_t>(1, camera, "instance")) count += r.is_rotor(id);
    return count;
  };
  const Ran hidden(hover("", looks_down("camera", "ids, depth", 2.5) + scans_down("lidar", 2.5))),
      seen(hover("", looks_down("camera", "ids, depth", 2.5, own) + scans_down("lidar", 2.5, own)));
  EXPECT_EQ(hits(hidden, "uav/camera"), 0u);
  EXPECT_GT(hits(seen, "uav/camera"), 100u);
  for (const uint16_t id : hidden.run.array<uint16_t>(1, "uav/camera", "instance")) EXPECT_EQ(id, 0);
  // The comparison with the depth pictures shows that the sweep has points only where a surface is visible.
  EXPECT_EQ(hidden.run.statistics.consistency.at(lidar_figure).count(), 0u);
  EXPECT_GT(seen.run.statistics.consistency.at(lidar_figure).count(), 10u);
  EXPECT_LT(seen.run.statistics.consistency.at(lidar_figure).max(), 1e-4);
}

TEST(PartsRun, TheBoxHoldsThePartsAndKeepsItsSize) {
  const Ran r(hover(looks_down("camera", "ids, boxes", 0.0)));
  const auto first = r.run.array<float>(0, "watcher/camera", "box_size");
  for (size_t tick = 0; tick < 4; ++tick) {
    const auto node = r.run.array<int32_t>(tick, "watcher/camera", "box_node");
    ASSERT_EQ(node.size(), 1u);
    EXPECT_EQ(node[0], 1);
    EXPECT_EQ(r.run.array<uint32_t>(tick, "watcher/camera", "box_instance_count")[0], 5u);
    const auto size = r.run.array<float>(tick, "watcher/camera", "box_size");
    for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(size[axis], first[axis]);
    // The box is 2 (1.1 cos 45 deg + 0.66) m wide.
    EXPECT_NEAR(size[0], 2.0 * (1.1 * std::sqrt(0.5) + 0.66), 0.01);
    // The box's rectangle encloses hull and blades as they stand.
    const auto ids = r.run.array<uint16_t>(tick, "watcher/camera", "instance");
    const auto modal = r.run.array<int32_t>(tick, "watcher/camera", "box_modal");
    int32_t left = width, right = 0;
    size_t pixels = 0;
    for (size_t i = 0; i < ids.size(); ++i)
      if (ids[i] != 0) {
        ++pixels;
        left = std::min(left, int32_t(i % width));
        right = std::max(right, int32_t(i % width) + 1);
      }
    EXPECT_EQ(modal[0], left);
    EXPECT_EQ(modal[2], right);
    EXPECT_EQ(r.run.array<uint32_t>(tick, "watcher/camera", "box_visible_pixels")[0], pixels);
  }
}

TEST(PartsRun, GoesOnAfterAResumeWithTheSameBytes) {
  const std::string events =
      "      - {name: events, type: event_camera, rate_hz: 10, width: 48, height: 32, fov_deg: 60, mount: "
      "{rotation_deg: "
      "[0, 90, 0]}}\n";
  const std::string yaml =
      hover(looks_down("camera", "rgb, depth, ids, flow, boxes", 0.0) + scans_down("lidar", 0.0) + events);
  const KeptRun all = keep_run(yaml);
  const KeptRun rest = keep_run(yaml, 0, 2);
  ASSERT_EQ(all.packets.size(), 4u);
  ASSERT_EQ(rest.packets.size(), 2u);
  for (size_t i = 0; i < 2; ++i) expect_same_bytes(all.sensors, all.packets[2 + i], rest.packets[i]);
  // The blades turn between the ticks, so the pictures differ.
  EXPECT_FALSE(all.array(2, "watcher/camera", "instance").bytes ==
               all.array(3, "watcher/camera", "instance").bytes);
  EXPECT_GT(all.counter("watcher/events.events"), 100u);
}

}  // namespace
}  // namespace greatx::sim
