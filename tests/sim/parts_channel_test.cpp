// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests the channel with parts that turn on a node. Their surfaces give reflected paths a Doppler shift, and
// block the paths that they cross.
#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "scene/generator/mesh/materials.h"
#include "scene/generator/mesh/scene_writer.h"
#include "tests/support/kept_run.h"
#include "tests/support/temporary_folder.h"

namespace greatx::sim {
namespace {

using test::keep_run;
using test::KeptRun;

constexpr double vane_carrier_hz = 5e9, rate_hz = 3.0, face_m = 0.32;
const dvec3 axle(4, -3, 5);

/// Writes a mill with one upright vane, 4 m wide and 2 m high, whose outer face is `face_m` from the axle.
std::filesystem::path write_mill(const std::filesystem::path& folder) {
  using namespace scene::generator;
  SceneWriter writer;
  MeshBuilder vane, post;
  vane.box(material("motor_metal"), {face_m - 0.02, -2.0, -1.0}, {face_m, 2.0, 1.0});
  post.box(material("motor_metal"), {-0.05, -0.05, -5.0}, {0.05, 0.05, -1.5});
  const int root = writer.add_node({.name = "post", .mesh = writer.add_mesh("post", post)});
  writer.add_node({.name = "vane", .mesh = writer.add_mesh("vane", vane), .parent = root});
  const std::vector<std::byte> glb = writer.finish("mill");
  std::ofstream(folder / "mill.glb", std::ios::binary)
      .write(reinterpret_cast<const char*>(glb.data()), static_cast<std::streamsize>(glb.size()));
  return folder / "mill.glb";
}

std::string mill(const std::filesystem::path& file, const dvec3& tx, const dvec3& rx, double phase_deg,
                 const std::string& channel = "") {
  const auto end = [](const char* name, const dvec3& at) {
    return fmt::format(
        "  - {{name: {}, trajectory: {{type: static, position_m: [{}, {}, {}]}}, sensors: [{{name: antenna, "
        "type: "
        "antenna}}]}}\n",
        name, at.x, at.y, at.z);
  };
  return fmt::format(
      "greatx: 1\nname: test\nseed: 5\nticks: 5\ntick_rate_hz: 1000\nnodes:\n{}{}"
      "  - name: mill\n    trajectory: {{type: static, position_m: [{}, {}, {}]}}\n"
      "    model: {{file: {}, parts: [{{nodes: vane, rate_hz: {}, phase_deg: {}}}]}}\n"
      "channels:\n  - {{name: csi, tx: tx/antenna, rx: [rx/antenna], rate_hz: 1000, carrier_hz: {}, "
      "subcarriers: 16, "
      "bandwidth_hz: 20e6, max_depth: 1{}}}\neffects: {{moving_reflectors: on}}\n",
      end("tx", tx), end("rx", rx), axle.x, axle.y, axle.z, file.string(), rate_hz, phase_deg,
      vane_carrier_hz, channel);
}

/// Describes the path reflected at the vane's outer face after the vane has turned by `angle`.
struct Closed {
  Closed(dvec3 tx, dvec3 rx, double angle) : normal(std::cos(angle), std::sin(angle), 0.0) {
    tx -= axle, rx -= axle;
    const double a = glm::dot(normal, tx) - face_m, b = glm::dot(normal, rx) - face_m;
    const dvec3 image = tx - 2.0 * a * normal;
    length_m = glm::length(rx - image);
    point = image + (rx - image) * (a / (a + b));
    cosine = (a + b) / length_m;
  }
  dvec3 normal, point;  ///< normal of the face; point of reflection, from the axle
  double length_m = 0.0, cosine = 0.0;
};

TEST(PartsChannel, DopplerOffAVaneIsThatOfTheClosedForm) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = write_mill(folder.path());
  const dvec3 tx = axle + dvec3(20, 1, 0.2), rx = axle + dvec3(18, -4, -0.4);
  const double omega = 2.0 * pi * rate_hz;
  for (const std::string channel : {"", ", search: every_tick"}) {
    const KeptRun run = keep_run(mill(file, tx, rx, -8.0, channel));
    int found = 0;
    for (size_t tick = 0; tick < 5; ++tick) {
      const double angle = radians(-8.0) + omega * 1e-3 * static_cast<double>(tick), step = 1e-6;
      const Closed now(tx, rx, angle);
      // The Doppler shift follows from the path's length over time. It also follows from the speed v of the
      // reflecting point: 2 v cos(incidence) / lambda.
      const double slope =
          (Closed(tx, rx, angle + omega * step).length_m - Closed(tx, rx, angle - omega * step).length_m) /
          (2.0 * step);
      const double speed = glm::dot(glm::cross(dvec3(0, 0, omega), now.point), now.normal);
      const double doppler_hz = -slope * vane_carrier_hz / speed_of_light;
      EXPECT_NEAR(doppler_hz, 2.0 * speed * now.cosine * vane_carrier_hz / speed_of_light, 1e-5);
      EXPECT_GT(std::abs(doppler_hz), 10.0);
      const auto delays = run.array<double>(tick, "csi", "delay");
      const auto dopplers = run.array<double>(tick, "csi", "doppler");
      for (size_t i = 0; i < delays.size(); ++i) {
        if (std::abs(delays[i] * speed_of_light - now.length_m) > 1e-6) continue;
        ++found;
        EXPECT_NEAR(dopplers[i], doppler_hz, 1e-5) << channel << " tick " << tick;
      }
    }
    EXPECT_EQ(found, 5) << channel;
  }
}

TEST(PartsChannel, AVaneBlocksWhatItComesInFrontOf) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = write_mill(folder.path());
  const dvec3 tx = axle + dvec3(-9, 0.1, 0.1), rx = axle + dvec3(9, 0.1, -0.1);
  const auto line_of_sight = [&](double phase_deg) {
    return keep_run(mill(file, tx, rx, phase_deg)).array<uint8_t>(0, "csi", "line_of_sight")[0];
  };
  EXPECT_EQ(line_of_sight(0.0), 0);
  EXPECT_EQ(line_of_sight(90.0), 1);
  EXPECT_EQ(line_of_sight(180.0), 0);
}

/// An antenna on the mill sees through the mill's own vane at any angle.
TEST(PartsChannel, APartHidesNothingFromItsOwnNode) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = write_mill(folder.path());
  const dvec3 rx = axle + dvec3(9, 0.1, -0.1);
  std::string yaml = mill(file, axle, rx, 0.0);
  const std::string model = "    model: {file";
  yaml.insert(yaml.find(model), "    sensors: [{name: antenna, type: antenna}]\n");
  yaml.replace(yaml.find("tx: tx/antenna"), 14, "tx: mill/antenna");
  EXPECT_EQ(keep_run(yaml).array<uint8_t>(0, "csi", "line_of_sight")[0], 1);
}

}  // namespace
}  // namespace greatx::sim
