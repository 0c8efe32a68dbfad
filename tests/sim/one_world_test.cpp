// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A corner reflector approaches a node that carries every sensor. All sensors must report the same world.
//
// The corner is a triangular trihedral of metal. Its apex is the origin of its node, and its axis points at
// the sensors. Both nodes move along one line, so that the distance of apex and sensors is known at any time:
//   R(t) = first_m - closing_m_s t.
// - Radar: three reflections at three perpendicular planes equal one reflection at the apex. Every way back
//   to a point of it is therefore 2 R long, whichever facets it takes first, and the whole main echo of the
//   trihedral has the delay 2 R/c.
// - Radio: for the same reason a path of three reflections from an antenna at d beside the sensors to one at
//   -d is exactly |(s + d) + (s - d)| = 2 R long, where s is the sensors' position from the apex.
// - LiDAR and camera: the shot and the pixel along the axis meet the apex.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/units.h"
#include "scene/description/scene_hash.h"
#include "sim/scenario/parse/load_scenario.h"
#include "tests/support/kept_run.h"
#include "tests/support/tiny_scene.h"

namespace greatx::sim {
namespace {

using test::keep_run;
using test::KeptRun;

constexpr double first_m = 12.0, closing_m_s = 6.0, edge_m = 0.4;
double distance_at(double time_s) { return first_m - closing_m_s * time_s; }

scene::Material metal() {
  scene::Material material;
  material.name = "metal";
  scene::RadioMaterial radio;
  radio.layers.push_back({*scene::itu_medium("metal"), 0.0});
  material.radio = radio;
  return material;
}

/// Returns a static wall behind the corner, askew to the line so that it reflects nothing back, and the
/// corner as body 1, open towards its x axis.
scene::Scene corner_scene() {
  test::TinyScene scene;
  const uint32_t metallic = scene.material_as(metal());
  scene.object("wall", 0, metallic).box({16, -20, -20}, {17, 20, 20});
  const uint32_t body = scene.body("corner");
  dvec3 edges[3];
  for (int i = 0; i < 3; ++i) {
    const double angle = radians(90.0 + 120.0 * i);
    edges[i] = edge_m * (dvec3(1, 0, 0) + std::sqrt(2.0) * dvec3(0, std::cos(angle), std::sin(angle))) /
               std::sqrt(3.0);
  }
  scene.object("corner", body, metallic);
  for (int i = 0; i < 3; ++i) scene.triangle(dvec3(0.0), edges[i], edges[(i + 1) % 3]);
  scene::Scene built = scene.build();
  built.hash = scene::hash_of(built);
  return built;
}

/// The line runs 30 degrees north of east, so that nothing lies along an axis of the world.
std::string at(double along_m) {
  return fmt::format("[{}, {}, 1.5]", along_m * std::cos(radians(30.0)), along_m * std::sin(radians(30.0)));
}
std::string along(double from_m, double to_m) {
  return "    trajectory: {type: waypoints, interpolation: linear, points: [{t_s: 0, position_m: " +
         at(from_m) + "}, {t_s: 1, position_m: " + at(to_m) + "}]}\n";
}

struct Rates {
  std::string tick = "10", camera = "10", lidar = "10", radar = "10", events = "10", channel = "10";
  int64_t ticks = 3;
  std::string sweep = "";   ///< additional YAML of the LiDAR
  std::string echoes = "";  ///< additional YAML of the radar's echoes
  std::string waveform =
      "{carrier_hz: 77e9, bandwidth_hz: 1e9, chirps: 64, samples: 128, sample_rate_hz: 3e6}";
  std::string transmit = "{pattern: isotropic}";
};

std::string scenario(const Rates& rates) {
  return "greatx: 1\nname: test\nseed: 5\nticks: " + std::to_string(rates.ticks) +
         "\ntick_rate_hz: " + rates.tick + "\nenvironment: {clouds: 0}\nnodes:\n  - name: rig\n" +
         along(0.0, 2.0) +
         "    sensors:\n"
         "      - {name: camera, type: camera, rate_hz: " +
         rates.camera +
         ", width: 65, height: 65, fov_deg: 10, outputs: [depth, depth_ray, ids]}\n"
         "      - {name: lidar, type: lidar, rate_hz: " +
         rates.lidar + ", raster: {columns: 21, rows: 21, azimuth_deg: [1, -1], elevation_deg: [-1, 1]}" +
         rates.sweep +
         "}\n"
         "      - {name: events, type: event_camera, rate_hz: " +
         rates.events +
         ", width: 65, height: 65, fov_deg: 10, outputs: [events, instance], threshold: 0.05, steps: 4}\n"
         "      - name: radar\n        type: radar\n        rate_hz: " +
         rates.radar + "\n        waveform: " + rates.waveform + "\n        transmit: " + rates.transmit +
         "\n        receive: {pattern: isotropic, columns: 2}\n"
         "        field_of_view: {azimuth_deg: [-4, 4], elevation_deg: [-4, 4]}\n"
         "        receiver: {noise_figure_db: 12}\n        outputs: [detections]\n"
         "        echoes: {tubes: 1500, max_bounces: 3" +
         rates.echoes +
         "}\n"
         "      - {name: tx, type: antenna, mount: {position_m: [0, 0.05, 0.02]}}\n"
         "      - {name: rx, type: antenna, mount: {position_m: [0, -0.05, -0.02]}}\n"
         "  - name: corner\n" +
         along(first_m, first_m - 4.0) +
         "channels:\n  - {name: csi, tx: rig/tx, rx: [rig/rx], rate_hz: " + rates.channel +
         ", carrier_hz: 28e9, subcarriers: 16, bandwidth_hz: 20e6, max_depth: 3}\n"
         "effects: {moving_reflectors: on, line_of_sight: off}\n";
}

KeptRun run(const Rates& rates) {
  auto world = std::make_shared<const World>(World{corner_scene(), {0, 1}, {0, 1}, {}, {}});
  return keep_run(make_experiment(parse_scenario(scenario(rates), "test.yaml", "."), std::move(world)));
}

uint32_t id_of(const KeptRun& r, const std::string& name) {
  for (uint32_t i = 0; i < r.instances.size(); ++i)
    if (r.instances[i].name == name) return i + 1;
  throw std::runtime_error("no instance " + name);
}

double seconds(const Packet& packet) { return 1e-9 * static_cast<double>(packet.time_ns); }

constexpr size_t middle_pixel = 32 * 65 + 32, middle_shot = 10 * 21 + 10;

/// Checks the depth along the ray of the middle pixel, whose centre looks at the apex. Bound: the rasteriser
/// snaps corners to 1/256 of a pixel, which is 2 tan 5 deg R/65 = 0.032 m wide. Next to the apex the depth of
/// the faces grows by sqrt(2) of the distance from the axis: 0.032 m/512 x 1.42 < 1e-4 m. fp32 adds 1e-6 m.
void expect_depth(const KeptRun& r, size_t packet) {
  EXPECT_NEAR(r.array<float>(packet, "rig/camera", "depth_ray")[middle_pixel],
              distance_at(seconds(r.packets[packet])), 1e-4);
  EXPECT_EQ(r.array<uint16_t>(packet, "rig/camera", "instance")[middle_pixel], id_of(r, "corner"));
}

/// Checks the shot along the axis at its own time. Bound: coordinates up to 12 m in fp32 are exact to 1e-6 m.
/// A few rotations and additions and the slope of the faces make this 1e-5 m.
void expect_lidar(const KeptRun& r, size_t packet, double sweep_s) {
  const auto range = r.array<float>(packet, "rig/lidar", "range"),
             time = r.array<float>(packet, "rig/lidar", "time_offset");
  ASSERT_EQ(range.size(), 441u);  // every shot must meet something, or middle_shot would be another shot
  EXPECT_NEAR(time[middle_shot], sweep_s * 0.5, sweep_s / 400.0);
  EXPECT_NEAR(range[middle_shot], distance_at(seconds(r.packets[packet]) + time[middle_shot]), 1e-5);
  EXPECT_EQ(r.array<uint32_t>(packet, "rig/lidar", "instance")[middle_shot], id_of(r, "corner"));
}

/// Checks the corner's detection at the middle of the frame. Bounds:
/// - The corner reflects the rays that meet a hexagon of half-width rho = edge sqrt(2)/3 about the axis. A
///   ray through a point rho beside the axis travels 2 sqrt(R^2 + rho^2). Its range is farther by up to
///   rho^2/(2 R), 1.7 mm, and never nearer.
/// - The noise is 48 dB below the cell. The error is at best sqrt(6/SNR)/(2 pi) = 0.0016 bins (D. C. Rife, R.
///   R. Boorstyn, IEEE Trans. Inf. Theory 20(5), 1974), and a third more under a Hann window. The test allows
///   five times that, 0.01 bins, in range and in velocity. Reflections of single faces and edges are below
///   that.
/// - The range offset by velocity (f_c/S = 3 ms) is removed beforehand. An error of 0.01 velocity bins leaves
///   0.02 mm.
void expect_radar(const KeptRun& r, size_t packet, float least_snr_db = 48.0f) {
  const nlohmann::json about = nlohmann::json::parse(r.spec("rig/radar").metadata_json);
  const double bin_m = about["range_bin_m"], velocity_bin = about["velocity_bin_m_s"];
  EXPECT_NEAR(bin_m, 0.15, 0.001);
  const auto range = r.array<float>(packet, "rig/radar", "range"),
             velocity = r.array<float>(packet, "rig/radar", "velocity"),
             snr = r.array<float>(packet, "rig/radar", "snr");
  ASSERT_EQ(range.size(), 1u) << "the wall stands askew";
  EXPECT_GT(snr[0], least_snr_db);
  const double expected_m = distance_at(seconds(r.packets[packet]) + about["frame_middle_s"].get<double>());
  const double rho_m = edge_m * std::sqrt(2.0) / 3.0;
  EXPECT_GT(range[0], expected_m - 0.01 * bin_m);
  EXPECT_LT(range[0], expected_m + 0.5 * rho_m * rho_m / expected_m + 0.01 * bin_m);
  EXPECT_NEAR(velocity[0], -closing_m_s, 0.01 * velocity_bin);
  EXPECT_EQ(r.array<uint32_t>(packet, "rig/radar", "instance")[0], id_of(r, "corner"));
  // The detection lies straight ahead except for the noise of the angle, which is at most 0.3 rad of phase at
  // two elements half a wavelength apart.
  const auto point = r.array<float>(packet, "rig/radar", "detections");
  EXPECT_NEAR(point[0], range[0], 0.01 * range[0]);
}

/// The paths are exact in fp64: 1e-9 m, 1e-9 m/s.
void expect_paths(const KeptRun& r, size_t packet) {
  const auto delay = r.array<double>(packet, "csi", "delay"),
             doppler = r.array<double>(packet, "csi", "doppler");
  const auto object = r.array<uint32_t>(packet, "csi", "object");
  int over_the_corner = 0;
  for (size_t i = 0; i < delay.size(); ++i) {
    if (object[3 * i] != id_of(r, "corner")) continue;
    ++over_the_corner;
    EXPECT_EQ(object[3 * i + 1], object[3 * i]);
    EXPECT_EQ(object[3 * i + 2], object[3 * i]);
    EXPECT_NEAR(0.5 * speed_of_light * delay[i], distance_at(seconds(r.packets[packet])), 1e-9);
    EXPECT_NEAR(0.5 * speed_of_light / 28e9 * doppler[i], closing_m_s, 1e-9);
  }
  EXPECT_GE(over_the_corner, 1);
}

void expect_poses(const KeptRun& r, size_t packet) {
  const auto velocity = r.array<double>(packet, "poses", "velocity"),
             position = r.array<double>(packet, "poses", "position");
  const dvec3 apart =
      dvec3(position[3], position[4], position[5]) - dvec3(position[0], position[1], position[2]);
  const dvec3 relative =
      dvec3(velocity[3], velocity[4], velocity[5]) - dvec3(velocity[0], velocity[1], velocity[2]);
  EXPECT_NEAR(glm::length(apart), distance_at(seconds(r.packets[packet])), 1e-12);
  EXPECT_NEAR(glm::dot(glm::normalize(apart), relative), -closing_m_s, 1e-12);
}

TEST(OneWorld, TheSameRangeVelocityAndInstanceInEverySensor) {
  const KeptRun r = run({});
  ASSERT_EQ(r.packets.size(), 3u);
  for (size_t packet = 0; packet < 3; ++packet) {
    expect_poses(r, packet);
    expect_depth(r, packet);
    expect_lidar(r, packet, 0.0);
    expect_radar(r, packet);
    expect_paths(r, packet);
  }
  // Events of the corner come from its growing outline, where the pictures before and after show the corner.
  size_t of_corner = 0;
  for (size_t packet = 1; packet < 3; ++packet) {
    const auto instance = r.array<uint32_t>(packet, "rig/events", "instance");
    const auto x = r.array<uint16_t>(packet, "rig/events", "x"),
               y = r.array<uint16_t>(packet, "rig/events", "y");
    const auto ids = r.array<uint16_t>(packet, "rig/camera", "instance");
    for (size_t i = 0; i < instance.size(); ++i) {
      if (instance[i] != id_of(r, "corner")) continue;
      ++of_corner;
      // The corner only grows, so that pixels that it covers at an event are still covered at the tick.
      EXPECT_EQ(ids[size_t{y[i]} * 65 + x[i]], instance[i]);
    }
  }
  EXPECT_GT(of_corner, 20u);
}

TEST(OneWorld, EveryWaveformSeesTheCorner) {
  const std::string alone = "{pattern: isotropic}\n        power_dbm: ";
  const std::string together =
      "{pattern: isotropic, columns: 2, column_spacing_wl: 1}\n        power_dbm: 12";
  const std::pair<std::string, std::string> radars[] = {
      {"{multiplexing: ddm, bandwidth_hz: 1e9, chirps: 192, samples: 128, sample_rate_hz: 3e6}", together},
      {"{type: stepped, bandwidth_hz: 1e9, steps: 128, step_s: 1e-6, sweeps: 64}", alone + "12"},
      // The noise of the whole band: 25 dB more than in the samples of ramps.
      {"{type: ofdm, spacing_hz: 5e6, subcarriers: 200, prefix_s: 0.2e-6, interval_s: 30e-6, symbols: 256}",
       alone + "33"},
      {"{type: pmcw, chip_rate_hz: 1e9, chips: 2047, averages: 8, interval_s: 30e-6, blocks: 64}",
       alone + "20\n        processing: {cfar: {false_alarm: 1e-9}}"},
  };
  for (const auto& [waveform, transmit] : radars) {
    SCOPED_TRACE(waveform);
    Rates rates;
    rates.waveform = waveform;
    rates.transmit = transmit;
    const KeptRun r = run(rates);
    ASSERT_EQ(r.packets.size(), 3u);
    // The sidelobes of the windows count as noise, some dB more in the folded map of Doppler bands.
    for (size_t packet = 0; packet < 3; ++packet) expect_radar(r, packet, 46.5f);
  }
}

TEST(OneWorld, SweepsSubStepsAndRadarUpdatesAtTheirOwnRates) {
  // Ticks at 100 Hz. One of the sensors' rates does not divide this rate.
  Rates rates{"100", "20", "10", "30", "50", "100"};
  rates.ticks = 12;
  rates.sweep = ", sweep_s: 0.05";
  rates.echoes = ", updates: 4";
  const KeptRun r = run(rates);
  const std::map<std::string, std::vector<int64_t>> due{{"rig/camera", {0, 5, 10}},
                                                        {"rig/lidar", {0, 10}},
                                                        {"rig/radar", {0, 3, 7, 10}},
                                                        {"rig/events", {0, 2, 4, 6, 8, 10}}};
  EXPECT_EQ(r.counters.submits, 12u) << "one for each tick";
  ASSERT_EQ(r.packets.size(), 12u);
  for (size_t packet = 0; packet < 12; ++packet) {
    const int64_t tick = r.packets[packet].tick;
    EXPECT_EQ(tick, static_cast<int64_t>(packet));
    // The packet is complete: it has the due records with all their arrays, in order, and nothing else.
    std::vector<std::string> expected{"poses"}, found;
    for (const SensorSpec& spec : r.sensors)
      if (due.contains(spec.name) && std::ranges::count(due.at(spec.name), tick) > 0)
        expected.push_back(spec.name);
    expected.push_back("csi");
    for (const Record& record : r.packets[packet].records) {
      const SensorSpec& spec = r.sensors[record.sensor];
      found.push_back(spec.name);
      EXPECT_EQ(record.time_ns, 10'000'000 * tick);
      ASSERT_EQ(record.arrays.size(), spec.arrays.size()) << spec.name;
      for (size_t a = 0; a < spec.arrays.size(); ++a) {
        EXPECT_EQ(record.arrays[a].dtype, spec.arrays[a].dtype) << spec.name << '.' << spec.arrays[a].name;
        EXPECT_EQ(record.arrays[a].shape.size(), spec.arrays[a].shape.size())
            << spec.name << '.' << spec.arrays[a].name;
      }
    }
    EXPECT_EQ(found, expected) << "tick " << tick;
    expect_poses(r, packet);
    expect_paths(r, packet);
    for (const std::string& name : found) {
      if (name == "rig/camera") expect_depth(r, packet);
      if (name == "rig/lidar") expect_lidar(r, packet, 0.05);
      if (name == "rig/radar") expect_radar(r, packet);
    }
  }
}

}  // namespace
}  // namespace greatx::sim
