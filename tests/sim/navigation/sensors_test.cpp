// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Inertial sensors, GNSS receivers, barometers and magnetometers in whole runs.
#include <cmath>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "sim/navigation/atmosphere.h"
#include "sim/navigation/inertial.h"
#include "sim/navigation/magnetic_field.h"
#include "sim/sensors/navigation/sky_view.h"
#include "tests/support/kept_run.h"

namespace greatx::sim {
namespace {

using test::keep_run;
using test::KeptRun;
using ::testing::HasSubstr;

const std::string noon =
    "environment: {place: {latitude_deg: 52, longitude_deg: 4.4, height_m: 20}, "
    "time: 2026-06-21T12:00:00Z}\n";

/// Returns a scenario of one node that moves, with `sensors` as lines of YAML.
std::string drive(const std::string& sensors, const std::string& scene = "", const std::string& more = noon) {
  return "greatx: 1\nname: drive\nseed: 5\nticks: 11\ntick_rate_hz: 10\n" + scene + more +
         "nodes:\n  - name: car\n    trajectory: {type: waypoints, interpolation: smooth, points: ["
         "{t_s: 0, position_m: [0, 0, 3], rotation_deg: [0, 0, 0]}, "
         "{t_s: 0.6, position_m: [5, 1, 3.2], rotation_deg: [30, 5, 2]}, "
         "{t_s: 1.2, position_m: [9, 5, 3.1], rotation_deg: [80, -4, 5]}]}\n    sensors:\n" +
         sensors;
}

std::vector<dvec3> vectors(const std::vector<double>& values) {
  std::vector<dvec3> out;
  for (size_t i = 0; i + 2 < values.size(); i += 3) out.emplace_back(values[i], values[i + 1], values[i + 2]);
  return out;
}
std::vector<dvec3> vectors(const KeptRun& run, const char* sensor, const char* name) {
  return vectors(run.joined<double>(sensor, name));
}

const std::string imu_200hz =
    "      - {name: imu, type: imu, rate_hz: 10, samples_per_record: 20, mount: {position_m: [0.5, 0.1, "
    "0.2], "
    "rotation_deg: [3, 2, 1]}}\n";

TEST(ImuSensor, ARecordHoldsTheSamplesSinceTheRecordBefore) {
  const KeptRun run = keep_run(drive(imu_200hz));
  const auto times = run.joined<int64_t>("car/imu", "time");
  ASSERT_EQ(times.size(), 201u);
  for (size_t i = 0; i < times.size(); ++i) EXPECT_EQ(times[i], static_cast<int64_t>(i) * 5'000'000);
  EXPECT_EQ(run.array(0, "car/imu", "time").shape, (std::vector<int64_t>{1}));
  EXPECT_EQ(run.array(3, "car/imu", "specific_force").shape, (std::vector<int64_t>{20, 3}));
  EXPECT_EQ(run.spec("car/imu").rate, "10");
  EXPECT_THAT(run.spec("car/imu").metadata_json, HasSubstr("\"sample_rate_hz\":200.0"));
}

TEST(ImuSensor, TheTruthOfItsSamplesIsTheSameAtAnyRateOfRecords) {
  // 200 Hz as 20 samples of each of 10 records, and as 200 records on a tick of 1 ms.
  std::string fast = drive(
      "      - {name: imu, type: imu, rate_hz: 200, mount: {position_m: [0.5, 0.1, 0.2], rotation_deg: [3, "
      "2, "
      "1]}}\n");
  fast.replace(fast.find("ticks: 11\ntick_rate_hz: 10"), 26, "ticks: 1001\ntick_rate_hz: 1000");
  const KeptRun grouped = keep_run(drive(imu_200hz)), single = keep_run(fast);
  for (const char* name : {"specific_force_true", "angular_rate_true", "specific_force", "angular_rate"}) {
    const auto a = vectors(grouped, "car/imu", name), b = vectors(single, "car/imu", name);
    ASSERT_EQ(a.size(), b.size());
    for (size_t i = 0; i < a.size(); ++i) EXPECT_LT(glm::length(a[i] - b[i]), 2e-2) << name << i;
  }
  const auto a = vectors(grouped, "car/imu", "gyroscope_bias"),
             b = vectors(single, "car/imu", "gyroscope_bias");
  EXPECT_EQ(a.back(), b.back()) << "the noise goes by samples, not by records";
}

TEST(ImuSensor, IntegratesToTheTrajectory) {
  // Dead reckoning with the mean of each interval without errors ends where the trajectory ends.
  const KeptRun run =
      keep_run(drive("      - {name: imu, type: imu, device: ideal, rate_hz: 10, samples_per_record: 20, "
                     "output: mean, mount: "
                     "{position_m: [0.5, 0.1, 0.2], rotation_deg: [3, 2, 1]}}\n"));
  const auto force = vectors(run, "car/imu", "specific_force"),
             rate = vectors(run, "car/imu", "angular_rate");
  EXPECT_EQ(force, vectors(run, "car/imu", "specific_force_true")) << "an ideal sensor has no errors";
  const Pose mount{{0.5, 0.1, 0.2}, orientation_from_yaw_pitch_roll(radians(3), radians(2), radians(1))};
  const auto motion = [&](size_t packet) {
    const auto p = run.array<double>(packet, "poses", "position"),
               q = run.array<double>(packet, "poses", "orientation"),
               v = run.array<double>(packet, "poses", "velocity"),
               w = run.array<double>(packet, "poses", "angular_velocity");
    Motion m;
    m.pose = {{p[0], p[1], p[2]}, dquat(q[0], q[1], q[2], q[3])};
    m.velocity = {v[0], v[1], v[2]};
    m.angular_velocity = {w[0], w[1], w[2]};
    return navigation::mounted(m, dvec3(0.0), mount);
  };
  const Motion begin = motion(0), end = motion(10);
  const double g = navigation::normal_gravity(radians(52.0), 20.0), step_s = 0.005;
  dquat attitude = begin.pose.orientation;
  dvec3 velocity = begin.velocity;
  for (size_t i = 1; i < force.size(); ++i) {
    velocity += step_s * (attitude * force[i] - dvec3(0.0, 0.0, g));
    const dvec3 angle = step_s * rate[i];
    if (glm::length(angle) > 0.0)
      attitude = attitude * glm::angleAxis(glm::length(angle), glm::normalize(angle));
  }
  EXPECT_LT(glm::length(velocity - end.velocity), 1e-9);
  EXPECT_LT(glm::length(navigation::rotation_vector(glm::conjugate(attitude) * end.pose.orientation)), 1e-9);
}

TEST(NavigationSensors, DeliverTheSameBytesWhereverARunBegins) {
  const std::string sensors =
      imu_200hz +
      "      - {name: gnss, type: gnss, rate_hz: 5}\n      - {name: air, type: barometer, rate_hz: 10}\n"
      "      - {name: compass, type: magnetometer, rate_hz: 10, drift_ut: 1}\n";
  const KeptRun whole = keep_run(drive(sensors), 3);
  const KeptRun resumed = keep_run(drive(sensors), 3, 7);
  ASSERT_EQ(whole.packets.size(), 11u);
  ASSERT_EQ(resumed.packets.size(), 4u);
  for (size_t i = 0; i < resumed.packets.size(); ++i)
    test::expect_same_bytes(whole.sensors, whole.packets[7 + i], resumed.packets[i]);
  // Another sequence, another seed and another name have other errors; another sensor changes none.
  const KeptRun other = keep_run(drive(sensors), 4), alone = keep_run(drive(imu_200hz), 3);
  EXPECT_NE(whole.joined<double>("car/imu", "gyroscope_bias"),
            other.joined<double>("car/imu", "gyroscope_bias"));
  EXPECT_EQ(whole.joined<double>("car/imu", "specific_force"),
            alone.joined<double>("car/imu", "specific_force"));
}

TEST(GnssSensor, KnowsWhereItIsInTheOpenAndStatesItsErrors) {
  const KeptRun run =
      keep_run(drive("      - {name: gnss, type: gnss, rate_hz: 10, mount: {position_m: [0, 0, 1.5]}}\n"));
  for (size_t packet = 0; packet < run.packets.size(); ++packet) {
    ASSERT_EQ(run.array<uint8_t>(packet, "car/gnss", "fix")[0], 1);
    const auto used = run.array<uint8_t>(packet, "car/gnss", "satellites_used")[0];
    EXPECT_GE(used, 5);
    const auto states = run.array<uint8_t>(packet, "car/gnss", "satellite_state");
    EXPECT_EQ(std::count(states.begin(), states.end(), 1), used);
    EXPECT_EQ(std::count(states.begin(), states.end(), 3), 0) << "nothing stands here";
    const auto p = run.array<double>(packet, "car/gnss", "position"),
               t = run.array<double>(packet, "car/gnss", "position_true");
    const auto c = run.array<double>(packet, "car/gnss", "position_covariance");
    for (int axis = 0; axis < 3; ++axis) EXPECT_LT(std::abs(p[axis] - t[axis]), 5.0 * std::sqrt(c[4 * axis]));
    EXPECT_NEAR(t[2] - run.array<double>(packet, "poses", "position")[2], 1.5, 0.02);
    const auto geodetic = run.array<double>(packet, "car/gnss", "geodetic_true");
    EXPECT_NEAR(geodetic[0], 52.0, 1e-3);
    EXPECT_NEAR(geodetic[2], 20.0 + t[2], 1e-3);
  }
  EXPECT_EQ(run.counter("car/gnss.fixes"), 11u);
}

TEST(GnssSensor, AStreetHidesSatellitesAndItsWallsReflectThem) {
  const auto count = [](const KeptRun& run, uint8_t state) {
    const auto states = run.joined<uint8_t>("car/gnss", "satellite_state");
    return std::count(states.begin(), states.end(), state);
  };
  const std::string gnss = "      - {name: gnss, type: gnss, rate_hz: 10";
  const std::string canyon = "scene: {generate: {kind: canyon, seed: 9, size_m: 120}, optical_only: true}\n";
  const KeptRun open = keep_run(drive(gnss + "}\n")), street = keep_run(drive(gnss + "}\n", canyon));
  const KeptRun deaf = keep_run(drive(gnss + ", reflections: false}\n", canyon));
  EXPECT_LT(count(street, 1), count(open, 1));
  EXPECT_EQ(count(street, 1), count(deaf, 1));
  EXPECT_GT(count(street, 2), 0);
  EXPECT_EQ(count(deaf, 2), 0);
  EXPECT_EQ(count(street, 0), count(open, 0)) << "the mask knows no houses";
  // A reflected signal comes late, by less than twice the way across the street.
  const auto states = street.joined<uint8_t>("car/gnss", "satellite_state");
  const auto errors = street.joined<double>("car/gnss", "pseudorange_error");
  double latest = 0.0;
  for (size_t i = 0; i < states.size(); ++i) {
    EXPECT_EQ(std::isfinite(errors[i]), states[i] == 1 || states[i] == 2);
    if (states[i] == 2) latest = std::max(latest, errors[i]);
  }
  EXPECT_GT(latest, 5.0);
  EXPECT_LT(latest, 80.0);
}

TEST(SkyView, HearsASatelliteOverTheWallByTheMirrorImage) {
  // Directions all over the sky, from the middle of a street along y between houses.
  const Experiment experiment = make_experiment(
      parse_scenario(drive("      - {name: imu, type: imu, rate_hz: 10}\n",
                           "scene: {generate: {kind: canyon, seed: 9, size_m: 120}, optical_only: true}\n"),
                     "test.yaml", "."));
  const World& world = *experiment.world;
  const SkyView view(world);
  const std::vector<Pose> bodies(world.scene.bodies.size());
  const dvec3 at = world.scene.to_local(dvec3(1.0, 4.0, 1.5));
  const navigation::Sky sky = view.sky({at, dvec3(0.0), bodies, 0}, true);
  EXPECT_EQ(sky({0.0, 0.0, 1.0}).state, navigation::SignalPath::State::direct);
  EXPECT_EQ(sky({0.0, 0.0, -1.0}).state, navigation::SignalPath::State::blocked);
  size_t reflected = 0;
  for (int azimuth = -180; azimuth < 180; azimuth += 5)
    for (int elevation = 5; elevation < 90; elevation += 5) {
      const double a = radians(azimuth), e = radians(elevation);
      const dvec3 direction(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
      const navigation::SignalPath path = sky(direction);
      if (path.state != navigation::SignalPath::State::reflected) {
        EXPECT_EQ(path.excess_m, 0.0);
        continue;
      }
      ++reflected;
      // The wall that the ray to the mirror image meets lies behind the antenna as seen from the satellite.
      EXPECT_GT(path.excess_m, 0.0);
      EXPECT_LT(path.excess_m, 2.0 * 40.0 * std::cos(e));
    }
  EXPECT_GT(reflected, 20u);
}

TEST(Barometer, MeasuresThePressureAtItsHeightAboveTheSea) {
  const std::string sensors =
      "      - {name: air, type: barometer, rate_hz: 10, noise_pa: 0, bias_pa: 0, drift_pa: 0, "
      "resolution_pa: 0}\n";
  const KeptRun placed = keep_run(drive(sensors)), nowhere = keep_run(drive(sensors, "", ""));
  for (size_t packet = 0; packet < 11; ++packet) {
    const double z = placed.array<double>(packet, "poses", "position")[2];
    EXPECT_NEAR(placed.array<double>(packet, "car/air", "height_true")[0], 20.0 + z, 1e-4);
    EXPECT_NEAR(nowhere.array<double>(packet, "car/air", "height_true")[0], z, 1e-12);
    EXPECT_NEAR(nowhere.array<double>(packet, "car/air", "height")[0], z, 1e-6);
    EXPECT_NEAR(nowhere.array<double>(packet, "car/air", "pressure")[0], navigation::air_pressure(z), 1e-9);
  }
}

TEST(Magnetometer, MeasuresTheFieldInItsAxes) {
  const KeptRun run =
      keep_run(drive("      - {name: compass, type: magnetometer, rate_hz: 10, noise_ut: 0, hard_iron_ut: 0, "
                     "soft_iron: 0, resolution_ut: 0}\n"));
  const dvec3 field = navigation::magnetic_field({52.0, 4.4, 23.0}, 2026.47);
  for (size_t packet = 0; packet < 11; ++packet) {
    const auto q = run.array<double>(packet, "poses", "orientation"),
               b = run.array<double>(packet, "car/compass", "field");
    const dvec3 world = dquat(q[0], q[1], q[2], q[3]) * dvec3(b[0], b[1], b[2]);
    EXPECT_LT(glm::length(world - field), 2e-9);
    EXPECT_EQ(b[0], run.array<double>(packet, "car/compass", "field_true")[0]);
  }
}

TEST(NavigationSensors, SayWhatTheyNeed) {
  const auto message = [](const std::string& yaml) {
    try {
      keep_run(yaml);
    } catch (const UserError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(message(drive("      - {name: g, type: gnss, rate_hz: 10}\n", "", "")),
              testing::AllOf(HasSubstr("test.yaml:"), HasSubstr("a GNSS receiver needs the place")));
  EXPECT_THAT(message(drive("      - {name: m, type: magnetometer, rate_hz: 10}\n", "", "")),
              HasSubstr("a magnetometer needs the place"));
  EXPECT_THAT(message(drive("      - {name: i, type: imu, rate_hz: 10, earth_rotation: true}\n", "", "")),
              HasSubstr("'earth_rotation' needs the place"));
  EXPECT_THAT(
      message(drive("      - {name: g, type: gnss, rate_hz: 10}\n",
                    "scene: {georeference: {latitude_deg: 52, longitude_deg: 4, height_m: 0}}\n", "")),
      HasSubstr("needs the time"));
  EXPECT_EQ(message(drive("      - {name: g, type: gnss, rate_hz: 10, time: 2026-06-21T12:00:00Z}\n",
                          "scene: {georeference: {latitude_deg: 52, longitude_deg: 4, height_m: 0}}\n", "")),
            "");
}

}  // namespace
}  // namespace greatx::sim
