// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests whole ticks on small generated scenes, under validation.
#include "sim/run/simulator.h"

#include <cstring>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "tests/support/kept_run.h"

namespace greatx::sim {
namespace {

using test::keep_run;
using test::KeptRun;

void expect_same(const Array& a, const Array& b, const std::string& what) {
  EXPECT_EQ(a.shape, b.shape) << what;
  EXPECT_TRUE(a.bytes == b.bytes) << what;
}

/// Compares every record of `sensor` that both runs have.
void expect_same_sensor(const KeptRun& a, const KeptRun& b, const std::string& sensor) {
  ASSERT_EQ(a.packets.size(), b.packets.size());
  const auto spec =
      std::find_if(a.sensors.begin(), a.sensors.end(), [&](const SensorSpec& s) { return s.name == sensor; });
  ASSERT_NE(spec, a.sensors.end());
  for (size_t i = 0; i < a.packets.size(); ++i)
    for (const ArraySpec& array : spec->arrays)
      expect_same(a.array(i, sensor, array.name), b.array(i, sensor, array.name), sensor + "." + array.name);
}

const std::string head = "greatx: 1\nname: test\nseed: 5\nticks: 3\ntick_rate_hz: 10\n";
const std::string fair_city = "scene: {generate: {kind: city, seed: 3, size_m: 100}}\n";
/// Clouds take half of the time that such a small world needs to start. Tests that do not look at the sky do
/// without them.
const std::string city = fair_city + "environment: {clouds: 0}\n";
const std::string bs =
    "  - name: bs\n    trajectory: {type: static, position_m: [3, 4, 30]}\n"
    "    sensors: [{name: panel, type: antenna, polarization: vh, rows: 2, columns: 2}]\n";
const std::string camera =
    "      - {name: camera, type: camera, rate_hz: 10, width: 64, height: 48, fov_deg: 90, mount: "
    "{rotation_deg: [0, 40, 0]}}\n";
const std::string lidar =
    "      - {name: lidar, type: lidar, rate_hz: 10, channels: 8, elevation_min_deg: -60, elevation_max_deg: "
    "-10, azimuth_steps: 64}\n";
const std::string antenna = "      - {name: antenna, type: antenna, mount: {position_m: [0, 0, -0.5]}}\n";

const std::string bs_isotropic =
    "  - name: bs\n    trajectory: {type: static, position_m: [0, 0, 0]}\n    sensors: [{name: panel, type: "
    "antenna}]\n";

std::string uav(const std::string& sensors, const std::string& more = "") {
  return "  - name: uav\n    trajectory: {type: waypoints, points: [{t_s: 0, position_m: [-20, -15, 40]}, "
         "{t_s: 1, position_m: [10, 5, 45]}]}\n" +
         more + (sensors.empty() ? "" : "    sensors:\n" + sensors);
}
std::string channel(const std::string& more = "") {
  return "channels:\n  - {name: csi, tx: bs/panel, rx: [uav/antenna], rate_hz: 10, subcarriers: 16, "
         "bandwidth_hz: 20e6, "
         "max_depth: 2, rays: 20000" +
         more + "}\n";
}
const std::string uav_model = "    model: {generate: {kind: quadrotor, variant: large}}\n";

TEST(Simulator, OneSubmissionATickAndWholePackets) {
  const KeptRun r =
      keep_run(head + city + "nodes:\n" + bs + uav(camera + lidar + antenna, uav_model) + channel());
  EXPECT_EQ(r.statistics.ticks, 3);
  EXPECT_EQ(r.statistics.packets, 3);
  EXPECT_EQ(r.counters.submits, 3u);
  for (const Packet& packet : r.packets) {
    ASSERT_EQ(packet.records.size(), r.sensors.size());
    for (const Record& record : packet.records) {
      EXPECT_EQ(record.tick, packet.tick);
      EXPECT_EQ(record.time_ns, packet.tick * 100'000'000);
      ASSERT_EQ(record.arrays.size(), r.sensors[record.sensor].arrays.size());
    }
  }
}

TEST(HardCase, N64_WithoutASensorNothingIsDueAndNothingComes) {
  const KeptRun r = keep_run(head + "nodes:\n" + uav("", uav_model));
  EXPECT_EQ(r.statistics.ticks, 0);
  EXPECT_EQ(r.counters.submits, 0u);
  EXPECT_TRUE(r.packets.empty());
  EXPECT_EQ(r.statistics.consistency.at(depth_figure).count(), 0u);
  EXPECT_EQ(r.statistics.consistency.at(sight_figure).count(), 0u);
}

TEST(Simulator, SensorsOfDifferentRatesFireWhenTheyShould) {
  std::string yaml = head + city + "nodes:\n" + uav(camera + lidar);
  yaml.replace(yaml.find("ticks: 3"), 8, "ticks: 9");
  yaml.replace(yaml.find("lidar, rate_hz: 10"), 18, "lidar, rate_hz: 4 ");
  const KeptRun r = keep_run(yaml);
  std::vector<int64_t> lidar_ticks;
  for (const Packet& packet : r.packets)
    for (const Record& record : packet.records)
      if (r.sensors[record.sensor].kind == "lidar") lidar_ticks.push_back(record.tick);
  EXPECT_THAT(lidar_ticks, ::testing::ElementsAre(0, 3, 5, 8));  // round(k * 2.5), half up
}

/// From this height rays meet leaf sprays whose masks the picture cuts. A comparison of all rays
/// would err by 9.5e-3.
TEST(Consistency, RaysThatMeetHolesAreNotHeldAgainstThePicture) {
  const KeptRun r = keep_run(
      head + city +
      "nodes:\n  - name: uav\n    trajectory: {type: waypoints, points: [{t_s: 0, position_m: [-20, -15, "
      "20]}, {t_s: 1, position_m: [10, 5, 20]}]}\n    sensors:\n"
      "      - {name: camera, type: camera, rate_hz: 10, width: 160, height: 120, fov_deg: 90, mount: "
      "{rotation_deg: [0, 10, 0]}}\n");
  const Consistency& c = r.statistics.consistency;
  EXPECT_GT(c.at(depth_figure).count(), 300u);
  EXPECT_LT(c.at(depth_figure).max(), 1e-5);
}

TEST(Consistency, ModalitiesSeeOneWorld) {
  const KeptRun r =
      keep_run(head + fair_city + "nodes:\n" + bs + uav(camera + lidar + antenna, uav_model) + channel());
  const Consistency& c = r.statistics.consistency;
  EXPECT_GT(c.at(depth_figure).count(), 100u);
  EXPECT_LT(c.at(depth_figure).max(), 1e-4);
  EXPECT_GT(c.at(lidar_figure).count(), 20u);
  // The largest error may be that of a beam that meets something smaller than a pixel.
  EXPECT_LT(c.at(lidar_figure).quantile(0.99), 1e-4);
  EXPECT_GT(c.at(sight_figure).count(), 0u);
  EXPECT_LT(c.at(sight_figure).max(), 1e-12);
}

/// Boxes are those of the nodes in the poses. Cars roll and people swing their limbs within them.
TEST(Consistency, PicturesAndLidarSeePeopleAndCarsWhereTheyAre) {
  const KeptRun r = keep_run(
      head +
      "scene: {generate: {kind: city, seed: 7, size_m: 225}}\nenvironment: {clouds: 0}\n"
      "traffic: {vehicles: 12, cyclists: 4, pedestrians: 24}\n"
      "nodes:\n  - name: mast\n    trajectory: {type: static, position_m: [-8.2, -8.2, 8]}\n    sensors:\n"
      "      - {name: camera, type: camera, rate_hz: 10, width: 320, height: 240, fov_deg: 100, outputs: "
      "[depth, "
      "ids], mount: {rotation_deg: [45, 20, 0]}}\n"
      "      - {name: lidar, type: lidar, rate_hz: 10, channels: 32, elevation_min_deg: -50, "
      "elevation_max_deg: "
      "5, azimuth_steps: 720}\n");
  const Consistency& c = r.statistics.consistency;
  EXPECT_GT(c.at(depth_box_figure).count(), 100u);
  EXPECT_LT(c.at(depth_box_figure).max(), 1e-5);
  EXPECT_GT(c.at(lidar_box_figure).count(), 50u);
  EXPECT_LT(c.at(lidar_box_figure).max(), 1e-5);
}

TEST(Plan, ACameraAloneBuildsNothingOfRadioOrLidar) {
  const KeptRun alone = keep_run(head + city + "nodes:\n" + uav(camera) + "effects: {consistency: off}\n");
  EXPECT_FALSE(alone.built("lidar"));
  EXPECT_FALSE(alone.built("candidate"));
  EXPECT_FALSE(alone.built("visibility segments"));
  EXPECT_FALSE(alone.built("probe"));
  EXPECT_EQ(alone.counters.tlas_builds, 0u) << "nothing traces rays";
}

TEST(Plan, OtherSensorsChangeNoByte) {
  const KeptRun all =
      keep_run(head + fair_city + "nodes:\n" + bs + uav(camera + lidar + antenna, uav_model) + channel());
  expect_same_sensor(all, keep_run(head + fair_city + "nodes:\n" + bs + uav(camera, uav_model)),
                     "uav/camera");
  expect_same_sensor(all, keep_run(head + fair_city + "nodes:\n" + bs + uav(lidar, uav_model)), "uav/lidar");
  expect_same_sensor(all, keep_run(head + fair_city + "nodes:\n" + bs + uav(antenna, uav_model) + channel()),
                     "csi");
}

TEST(Plan, LineOfSightAloneSearchesNoReflection) {
  std::string yaml = head + city + "nodes:\n" + bs + uav(antenna) + channel();
  yaml.replace(yaml.find("max_depth: 2"), 12, "max_depth: 0");
  const KeptRun r = keep_run(yaml);
  EXPECT_FALSE(r.plan.reflection.on);
  EXPECT_FALSE(r.built("candidate"));
  EXPECT_EQ(r.array(0, "csi", "path_count").as<int32_t>()[0],
            r.array(0, "csi", "line_of_sight").as<uint8_t>()[0]);
}

TEST(Plan, AStaticSceneIsNeverRefitted) {
  if (!test::device().info().has_ray_query()) GTEST_SKIP() << "the driver traces no rays";
  const KeptRun still = keep_run(head + city + "nodes:\n" + uav(lidar), 0, 0, gpu::Tracer::driver);
  EXPECT_EQ(still.counters.tlas_builds, 1u);
  EXPECT_EQ(still.counters.tlas_refits, 0u);
  EXPECT_FALSE(still.plan.scene_motion.on);
  const KeptRun moving =
      keep_run(head + city + "nodes:\n" + uav(lidar, uav_model), 0, 0, gpu::Tracer::driver);
  EXPECT_EQ(moving.counters.tlas_refits, 2u);
}

TEST(Plan, TheTreeNeedsNoAccelerationStructure) {
  const KeptRun r = keep_run(head + city + "nodes:\n" + uav(lidar, uav_model), 0, 0, gpu::Tracer::tree);
  EXPECT_EQ(r.counters.tlas_builds + r.counters.tlas_refits, 0u);
  EXPECT_THAT(r.note("tracer"), ::testing::StartsWith("tree"));
}

TEST(Plan, ForcingWhatIsNotNeededChangesNothingBeyondItsBound) {
  const std::string base = head + city + "nodes:\n" + uav(camera);
  const KeptRun automatic = keep_run(base);
  EXPECT_FALSE(automatic.plan.normal_maps.on);
  const KeptRun forced = keep_run(base + "effects: {normal_maps: on, alpha_mask: on, moving_shadows: on}\n");
  EXPECT_TRUE(forced.plan.normal_maps.on);
  expect_same_sensor(automatic, forced, "uav/camera");

  // By day lamps add less than 1 % of the light, which is at most two steps of 8 bits.
  const KeptRun lamps = keep_run(base + "effects: {punctual_lights: on}\n");
  EXPECT_FALSE(automatic.plan.punctual_lights.on);
  expect_same(automatic.array(0, "uav/camera", "depth"), lamps.array(0, "uav/camera", "depth"), "depth");
  const auto a = automatic.array(0, "uav/camera", "rgb").as<uint8_t>(),
             b = lamps.array(0, "uav/camera", "rgb").as<uint8_t>();
  for (size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a[i], b[i], 2) << i;
}

TEST(Plan, NamesThatAreNoneAndSwitchesThatCannotBe) {
  try {
    keep_run(head + city + "nodes:\n" + uav(camera) + "effects: {dust: on}\n");
    FAIL();
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("'dust' is no effect; expected one of"));
    EXPECT_THAT(error.what(), ::testing::HasSubstr("static_shadows"));
  }
  EXPECT_THROW(keep_run(head + city + "nodes:\n" + uav(camera) + "effects: {camera: off}\n"), UserError);
}

TEST(Search, EveryTickFindsWhatOnceFinds) {
  const std::string base = head + city + "nodes:\n" + bs + uav(antenna);
  const KeptRun once = keep_run(base + channel(", search: once")),
                always = keep_run(base + channel(", search: every_tick"));
  EXPECT_GT(once.array(1, "csi", "path_count").as<int32_t>()[0], 0);
  expect_same_sensor(once, always, "csi");
  EXPECT_EQ(always.counters.submits, 3u) << "looking ahead takes no submission of its own";
}

TEST(Search, EveryTickLooksAheadOnlyToTicksOfTheChannel) {
  std::string yaml = head + city + "nodes:\n" + bs + uav(lidar + antenna) + channel(", search: every_tick");
  yaml.replace(yaml.find("ticks: 3"), 8, "ticks: 9");
  const std::string rate = "rx: [uav/antenna], rate_hz: 10";
  KeptRun all = keep_run(yaml);
  yaml.replace(yaml.find(rate), rate.size(), "rx: [uav/antenna], rate_hz: 2.5");
  const KeptRun few = keep_run(yaml);  // due at ticks 0, 4 and 8
  EXPECT_EQ(few.statistics.passes.at("candidate search").count, 2u)
      << "for ticks 4 and 8; 0 is searched before";
  EXPECT_EQ(all.statistics.passes.at("candidate search").count, 8u);
  for (const size_t tick : {0u, 4u, 8u})
    expect_same(few.array(tick, "csi", "cfr"), all.array(tick, "csi", "cfr"), "cfr");
}

TEST(Search, FromTheReceiverWhenOnlyThatStandsStill) {
  std::string yaml = head + city + "nodes:\n" + bs + uav(antenna) + channel();
  const KeptRun down = keep_run(yaml);
  yaml.replace(yaml.find("tx: bs/panel, rx: [uav/antenna]"), 31, "tx: uav/antenna, rx: [bs/panel]");
  const KeptRun up = keep_run(yaml);
  // Source and candidates are the same, so the paths are the same in reverse.
  for (size_t i = 0; i < 3; ++i) {
    auto delays_down = down.array(i, "csi", "delay").as<double>(),
         delays_up = up.array(i, "csi", "delay").as<double>();
    std::vector<double> a(delays_down.begin(), delays_down.end()), b(delays_up.begin(), delays_up.end());
    std::sort(a.begin(), a.end());
    std::sort(b.begin(), b.end());
    ASSERT_EQ(a.size(), b.size());
    for (size_t k = 0; k < a.size(); ++k) EXPECT_NEAR(a[k], b[k], 1e-12 * a[k]);
  }
}

// |H| = lambda / (4 pi d) at every subcarrier for isotropic antennas of one polarization. The flight is
// level, because a nose that points up would tilt the receiver's polarization.
TEST(Channel, FreeSpaceIsFriis) {
  const std::string yaml =
      head + "nodes:\n" + bs_isotropic +
      "  - name: uav\n    trajectory: {type: waypoints, points: [{t_s: 0, position_m: [-20, -15, 40]}, "
      "{t_s: 1, position_m: [10, 5, 40]}]}\n    sensors:\n" +
      antenna + channel();
  const KeptRun r = keep_run(yaml);
  const auto h = r.array(0, "csi", "cfr").as<std::complex<float>>();
  const double delay = r.array(0, "csi", "delay").as<double>()[0];
  const double friis = speed_of_light / 3.5e9 / (4 * pi * speed_of_light * delay);
  for (const std::complex<float>& value : h)
    EXPECT_NEAR(static_cast<double>(std::abs(value)) / friis, 1.0, 1e-6);
}

TEST(Simulator, SequencesDifferAndRepeat) {
  const std::string yaml = head + city +
                           "sequences: 2\nnodes:\n  - name: uav\n    trajectory: {type: bezier, box: {min_m: "
                           "[-30, -30, 40], max_m: [30, 30, 60]}, offset_m: [5, 5, 5]}\n    sensors:\n" +
                           lidar;
  const KeptRun first = keep_run(yaml, 0), again = keep_run(yaml, 0), second = keep_run(yaml, 1);
  expect_same_sensor(first, again, "poses");
  expect_same_sensor(first, again, "uav/lidar");
  EXPECT_FALSE(first.array(0, "poses", "position").bytes == second.array(0, "poses", "position").bytes);
}

TEST(Simulator, StartingLaterGivesTheSameRest) {
  const std::string yaml =
      head + fair_city + "nodes:\n" + bs + uav(camera + lidar + antenna, uav_model) + channel();
  const KeptRun whole = keep_run(yaml), rest = keep_run(yaml, 0, 1);
  ASSERT_EQ(rest.packets.size(), 2u);
  for (size_t i = 0; i < rest.packets.size(); ++i)
    test::expect_same_bytes(whole.sensors, whole.packets[i + 1], rest.packets[i]);
}

TEST(HardCase, N07_AtUtmCoordinatesTheSameOutput) {
  const auto at = [&](const dvec3& shift) {
    const auto v = [&](double x, double y, double z) {
      return fmt::format("[{}, {}, {}]", x + shift.x, y + shift.y, z + shift.z);
    };
    return head +
           "scene: {objects: [{name: city, generate: {kind: city, seed: 3, size_m: 100}, position_m: " +
           v(0, 0, 0) + "}]}\nenvironment: {clouds: 0}\nnodes:\n" +
           "  - name: bs\n    trajectory: {type: static, position_m: " + v(3, 4, 30) +
           "}\n    sensors: [{name: panel, type: antenna}]\n" +
           "  - name: uav\n    trajectory: {type: waypoints, points: [{t_s: 0, position_m: " +
           v(-20, -15, 40) + "}, {t_s: 1, position_m: " + v(10, 5, 45) + "}]}\n    sensors:\n" + camera +
           lidar + antenna + channel();
  };
  const KeptRun here = keep_run(at(dvec3(0.0))), there = keep_run(at({500000.0, 5400000.0, 120.0}));
  expect_same(here.array(0, "uav/camera", "instance"), there.array(0, "uav/camera", "instance"), "instance");
  expect_same(here.array(0, "uav/camera", "depth"), there.array(0, "uav/camera", "depth"), "depth");
  expect_same(here.array(0, "uav/lidar", "points"), there.array(0, "uav/lidar", "points"), "points");
  const auto a = here.array(1, "csi", "delay").as<double>(), b = there.array(1, "csi", "delay").as<double>();
  ASSERT_EQ(a.size(), b.size());
  ASSERT_GT(a.size(), 0u);
  for (size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(speed_of_light * a[i], speed_of_light * b[i], 1e-9);
}

TEST(HardCase, N25_AReceiverAloneIsTheSameAmongAHundred) {
  std::string nodes, all;
  for (int i = 0; i < 100; ++i) {
    nodes += fmt::format(
        "  - name: user{0}\n    trajectory: {{type: static, position_m: [{1}, {2}, {3}]}}\n    sensors: "
        "[{{name: "
        "antenna, type: antenna}}]\n",
        i, -45 + 9.1 * (i % 10), -45 + 9.3 * (i / 10), 1.5 + 0.5 * i);
    all += fmt::format("{}user{}/antenna", i == 0 ? "" : ", ", i);
  }
  const auto with = [&](const std::string& receivers) {
    std::string yaml = head + city + "nodes:\n" + bs + nodes + channel();
    yaml.replace(yaml.find("ticks: 3"), 8, "ticks: 1");
    yaml.replace(yaml.find("uav/antenna"), 11, receivers);
    return keep_run(yaml);
  };
  const KeptRun together = with(all);
  const auto counts = together.array(0, "csi", "path_count").as<int32_t>();
  ASSERT_EQ(counts.size(), 100u);
  const auto cfr = together.array(0, "csi", "cfr").as<std::complex<float>>();
  const auto delays = together.array(0, "csi", "delay").as<double>();
  int reflected = 0;
  for (const size_t receiver : {0u, 37u, 58u, 99u}) {
    const KeptRun alone = with(fmt::format("user{}/antenna", receiver));
    const auto own = alone.array(0, "csi", "cfr").as<std::complex<float>>();
    ASSERT_EQ(own.size() * 100, cfr.size());
    EXPECT_EQ(std::memcmp(own.data(), cfr.data() + receiver * own.size(), own.size_bytes()), 0) << receiver;
    const auto own_delays = alone.array(0, "csi", "delay").as<double>();
    ASSERT_EQ(own_delays.size(), static_cast<size_t>(counts[receiver])) << receiver;
    const size_t first = static_cast<size_t>(std::accumulate(counts.begin(), counts.begin() + receiver, 0));
    EXPECT_TRUE(std::equal(own_delays.begin(), own_delays.end(), delays.begin() + first)) << receiver;
    reflected += counts[receiver] > 1;
  }
  EXPECT_GT(reflected, 1) << "the comparison is to have reflections in it";
}

TEST(HardCase, N64_NoPathIsZeroAndFinite) {
  // The receiver is below the ground, and only the direct path is asked for.
  std::string yaml = head + city + "nodes:\n" + bs + uav(antenna) + channel();
  yaml.replace(yaml.find("max_depth: 2"), 12, "max_depth: 0");
  yaml.replace(yaml.find("[-20, -15, 40]"), 14, "[-20, -15, -40]");
  yaml.replace(yaml.find("[10, 5, 45]"), 11, "[10, 5, -45]");
  const KeptRun r = keep_run(yaml);
  ASSERT_EQ(r.packets.size(), 3u);
  EXPECT_EQ(r.array(0, "csi", "path_count").as<int32_t>()[0], 0);
  EXPECT_EQ(r.array(0, "csi", "line_of_sight").as<uint8_t>()[0], 0);
  EXPECT_EQ(r.array(0, "csi", "path_gain").as<double>()[0], 0.0);
  for (const char* ragged : {"delay", "amplitude", "vertex"})
    EXPECT_EQ(r.array(0, "csi", ragged).shape[0], 0) << ragged;
  const auto response = r.array(0, "csi", "cfr").as<std::complex<float>>();
  EXPECT_EQ(response.size(), 8u * 16u);
  for (const std::complex<float>& value : response) EXPECT_EQ(value, std::complex<float>(0.0f));
}

TEST(HardCase, N64_NothingToSeeIsEmptyAndFinite) {
  const KeptRun r =
      keep_run(head +
               "nodes:\n  - name: bs\n    trajectory: {type: static, position_m: [0, 0, 0]}\n    "
               "sensors: [{name: panel, type: antenna}]\n" +
               uav(camera + lidar + antenna) + channel());
  EXPECT_EQ(r.array(0, "uav/lidar", "points").shape[0], 0);
  for (const float z : r.array(0, "uav/camera", "depth").as<float>())
    EXPECT_EQ(z, std::numeric_limits<float>::infinity());
  EXPECT_EQ(r.array(0, "csi", "path_count").as<int32_t>()[0], 1);
  const KeptRun nobody = keep_run(head + "nodes: []\n");
  EXPECT_EQ(nobody.packets.size(), 0u);
}

}  // namespace
}  // namespace greatx::sim
