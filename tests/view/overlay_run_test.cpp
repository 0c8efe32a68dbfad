// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests overlays on the records of real runs: over a mirror, with a van that drives past.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>

#include "core/units.h"
#include "scene/description/scene_hash.h"
#include "sim/world/instance_boxes.h"
#include "tests/sim/radio_run.h"
#include "tests/view/overlay_support.h"
#include "view/overlay/box_shapes.h"
#include "view/overlay/path_shapes.h"
#include "view/overlay/sensing_shapes.h"
#include "view/overlay/sensor_shapes.h"

namespace greatx::view {
namespace {

using sim::testing::radio_material;
using test::KeptRun;
using test::TinyScene;
using ::testing::HasSubstr;
using testing::legend_of;

const dvec3 mast_m(5012.0, 7003.0, 6.0);
const dvec3 van_low(-2.0, -0.9, 0.1), van_high(2.2, 0.9, 1.9);

scene::Scene mirror_scene() {
  TinyScene tiny;
  const uint32_t metal = tiny.material_as(radio_material("metal"));
  const uint32_t van = tiny.body("van");
  tiny.object("ground", 0, metal).quad({4900, 6900, 0}, {5100, 6900, 0}, {5100, 7100, 0}, {4900, 7100, 0});
  tiny.object("cabin", van, metal).box(van_low, van_high);
  scene::Scene scene = tiny.build({5000.0, 7000.0, 0.0});
  for (scene::Instance& instance : scene.instances)
    instance.semantic_class =
        instance.body == 0 ? scene::SemanticClass::ground : scene::SemanticClass::vehicle;
  scene.hash = scene::hash_of(scene);
  return scene;
}

std::string mirror_scenario(const std::string& sensors, const std::string& channel) {
  return "greatx: 1\nname: test\nseed: 5\nticks: 3\ntick_rate_hz: 10\nnodes:\n"
         "  - name: mast\n"
         "    trajectory: {type: static, position_m: [5012, 7003, 6], rotation_deg: [140, 0, 0]}\n"
         "    sensors: [{name: panel, type: antenna, pattern: tr38901, polarization: slant, rows: 2, "
         "columns: "
         "4, row_spacing_wl: 0.5, column_spacing_wl: 0.5, mount: {position_m: [0.2, 0.1, 0.4], rotation_deg: "
         "[10, 5, 0]}}]\n"
         "  - name: uav\n"
         "    trajectory: {type: waypoints, interpolation: linear, points: [{t_s: 0, position_m: [4990, "
         "7000, "
         "4], rotation_deg: [30, 8, 3]}, {t_s: 1, position_m: [4995, 7003, 4.5], rotation_deg: [50, 8, "
         "3]}]}\n"
         "    sensors:\n"
         "      - {name: antenna, type: antenna, mount: {position_m: [0.3, -0.2, 0.1]}}\n" +
         sensors +
         "  - name: van\n"
         "    trajectory: {type: waypoints, interpolation: linear, points: [{t_s: 0, position_m: [4996, "
         "7004, "
         "0]}, {t_s: 1, position_m: [5006, 7008, 0]}]}\n" +
         channel;
}

/// A run and what overlays know of it.
struct MirrorRun {
  KeptRun run;
  RecordTables tables;

  static std::string run_json(const sim::Experiment& experiment) {
    nlohmann::json run;
    run["semantic_classes"] = scene::semantic_class_names();
    const std::vector<sim::InstanceBox> boxes = sim::instance_boxes(*experiment.world);
    for (size_t i = 0; i < boxes.size(); ++i) {
      const scene::Instance& instance = experiment.scene().instances[i];
      run["instances"].push_back(
          {{"name", instance.name}, {"class", scene::name_of(instance.semantic_class)}});
      const scene::Bounds& box = boxes[i].box;
      if (boxes[i].node) run["instances"].back()["node"] = experiment.scenario.nodes[*boxes[i].node].name;
      run["instances"].back()["box_m"] = {{box.min.x, box.min.y, box.min.z},
                                          {box.max.x, box.max.y, box.max.z}};
    }
    for (const scene::Material& material : experiment.scene().materials)
      run["materials"].push_back(material.name);
    for (const sim::Effect* effect : experiment.plan.all()) run["effects"][effect->name] = effect->on;
    return run.dump();
  }
  static MirrorRun make(const std::string& yaml) {
    auto world = std::make_shared<const sim::World>(sim::World{mirror_scene(), {0, 0, 1}, {0, 2}, {}, {}});
    const sim::Experiment experiment =
        sim::make_experiment(sim::parse_scenario(yaml, "test.yaml", "."), std::move(world));
    KeptRun run = test::keep_run(experiment);
    RecordTables tables(run_json(experiment), run.sensors, "run");
    return {std::move(run), std::move(tables)};
  }

  const Record& record(size_t packet, const std::string& sensor) const {
    for (const Record& record : run.packets.at(packet).records)
      if (run.sensors[record.sensor].name == sensor) return record;
    throw std::runtime_error("no record of " + sensor);
  }
  NodePoses poses(size_t packet) const { return NodePoses(tables, record(packet, "poses")); }
};

const MirrorRun& flight() {
  static const MirrorRun run = MirrorRun::make(mirror_scenario(
      "      - {name: camera, type: camera, rate_hz: 10, width: 64, height: 48, fov_deg: 70, outputs: "
      "[ids, boxes], mount: {position_m: [0.1, 0, -0.1], rotation_deg: [0, 25, 0]}}\n"
      "      - {name: lidar, type: lidar, rate_hz: 10, channels: 8, elevation_min_deg: -60, "
      "elevation_max_deg: -10, azimuth_steps: 90, sweep_s: 0.1, max_range_m: 80, mount: {position_m: [0, 0, "
      "-0.2], rotation_deg: [20, 0, 0]}}\n",
      "channels:\n  - {name: csi, tx: mast/panel, rx: [uav/antenna], rate_hz: 10, carrier_hz: 3.5e9, "
      "subcarriers: 4, bandwidth_hz: 20e6, max_depth: 2, outputs: [paths]}\n"));
  return run;
}

dvec3 end_of(const MirrorRun& run, size_t packet, const std::string& node, const dvec3& mount) {
  return pose_of(run.tables, node, run.record(packet, "poses")).apply(mount);
}

/// Of each path shown its lines, by the identity of the path.
std::map<uint64_t, std::vector<LineShape>> paths_by_id(const Shapes& shapes) {
  std::map<uint64_t, std::vector<LineShape>> paths;
  for (const LineShape& line : shapes.lines) paths[shapes.rows.at(line.row).id].push_back(line);
  return paths;
}

Shapes csi_shapes(const MirrorRun& run, size_t packet) {
  const NodePoses poses = run.poses(packet);
  return path_shapes(run.tables, run.run.spec("csi"), run.record(packet, "csi"), &poses, {});
}

TEST(OverlayRun, AMirrorsPathTurnsAtTheMirrorPoint) {
  const MirrorRun& run = flight();
  for (size_t packet = 0; packet < 3; ++packet) {
    const dvec3 t = end_of(run, packet, "mast", {0.2, 0.1, 0.4}),
                r = end_of(run, packet, "uav", {0.3, -0.2, 0.1});
    const Shapes shapes = csi_shapes(run, packet);
    bool line_of_sight = false, mirrored = false;
    for (const auto& [id, lines] : paths_by_id(shapes)) {
      EXPECT_LT(glm::distance(lines.front().a, t), 1e-6);
      EXPECT_LT(glm::distance(lines.back().b, r), 1e-6);
      for (size_t i = 0; i + 1 < lines.size(); ++i) EXPECT_EQ(lines[i].b, lines[i + 1].a);
      double length_m = 0.0;
      for (const LineShape& line : lines) length_m += glm::distance(line.a, line.b);
      const std::string& text = shapes.rows[lines[0].row].text;
      EXPECT_THAT(text, HasSubstr(fmt::format("length {:.3f} m", length_m)));
      if (text.starts_with("LoS")) {
        line_of_sight = true;
        const double friis = 20.0 * std::log10(speed_of_light / 3.5e9 / (4.0 * pi * glm::distance(t, r)));
        EXPECT_THAT(text, HasSubstr(fmt::format("gain {:.2f} dB", friis)));
      }
      if (lines.size() != 2 || text.find("R ground (metal)") == std::string::npos) continue;
      mirrored = true;
      const dvec3 expected = glm::mix(t, r, t.z / (t.z + r.z));
      EXPECT_LT(glm::distance(lines[0].b, dvec3(expected.x, expected.y, 0.0)), 1e-6);
    }
    EXPECT_TRUE(line_of_sight);
    EXPECT_TRUE(mirrored);
  }
}

TEST(OverlayRun, PathsKeepTheirIdentityFromTickToTick) {
  const MirrorRun& run = flight();
  const auto ids = [&](size_t packet) {
    std::map<std::string, uint64_t> by_name;  // the first line of the row, and what is touched
    const Shapes shapes = csi_shapes(run, packet);
    for (const auto& [id, lines] : paths_by_id(shapes)) {
      const std::string& text = shapes.rows[lines[0].row].text;
      if (text.starts_with("LoS")) by_name["line of sight"] = id;
      if (lines.size() == 2 && text.find("R ground") != std::string::npos) by_name["ground"] = id;
    }
    return by_name;
  };
  const auto first = ids(0);
  EXPECT_EQ(first.size(), 2u);
  EXPECT_EQ(ids(1), first);
  EXPECT_EQ(ids(2), first);
}

TEST(OverlayRun, LidarPointsLieOnTheGroundAndOnTheVan) {
  const MirrorRun& run = flight();
  for (size_t packet = 0; packet < 3; ++packet) {
    const NodePoses poses = run.poses(packet);
    const Shapes shapes =
        lidar_shapes(run.tables, run.run.spec("uav/lidar"), run.record(packet, "uav/lidar"), &poses, {});
    const auto ids = run.run.array<uint32_t>(packet, "uav/lidar", "instance");
    const auto times = run.run.array<float>(packet, "uav/lidar", "time_offset");
    ASSERT_EQ(shapes.points.size(), ids.size());
    size_t ground = 0, van = 0;
    for (size_t i = 0; i < ids.size(); ++i) {
      const dvec3& at = shapes.points[i].at;
      if (ids[i] == 1) {
        ++ground;
        EXPECT_NEAR(at.z, 0.0, 1e-4);
        continue;
      }
      ++van;
      const dvec3 inside = poses.after(2, static_cast<double>(times[i])).inverse().apply(at);
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GT(inside[axis], van_low[axis] - 1e-3);
        EXPECT_LT(inside[axis], van_high[axis] + 1e-3);
      }
      EXPECT_THAT(shapes.rows.at(shapes.points[i].row).text, HasSubstr("cabin (vehicle)"));
    }
    EXPECT_GT(ground, 200u);
    EXPECT_GT(van, 3u);
  }
}

TEST(OverlayRun, BoxesOfTruthAndOfInstancesHoldTheVan) {
  const MirrorRun& run = flight();
  for (size_t packet = 0; packet < 3; ++packet) {
    const NodePoses poses = run.poses(packet);
    const Record& camera = run.record(packet, "uav/camera");
    const Shapes truth = box_shapes(run.tables, &run.run.spec("uav/camera"), &camera, &poses, {}),
                 instances = box_shapes(run.tables, nullptr, nullptr, &poses, {});
    for (const Shapes* shapes : {&truth, &instances}) {
      ASSERT_EQ(shapes->lines.size(), 12u) << "of the van alone";
      EXPECT_THAT(shapes->rows[0].text, HasSubstr("van (vehicle)\n4.20 x 1.80 x 1.80 m"));
      EXPECT_THAT(shapes->rows[0].text, HasSubstr(fmt::format("{:.2f} m/s", std::hypot(10.0, 4.0))));
      // Every vertex of the van is a corner of the box.
      for (int i = 0; i < 8; ++i) {
        const dvec3 vertex =
            poses.pose(2).apply({(i & 1) ? van_high.x : van_low.x, (i & 2) ? van_high.y : van_low.y,
                                 (i & 4) ? van_high.z : van_low.z});
        double nearest = 1e9;
        for (const LineShape& line : shapes->lines)
          nearest = std::min({nearest, glm::distance(line.a, vertex), glm::distance(line.b, vertex)});
        EXPECT_LT(nearest, 1e-5);
      }
    }
  }
}

TEST(OverlayRun, SensorsStandWhereTheirMountsSay) {
  const MirrorRun& run = flight();
  const NodePoses poses = run.poses(2);
  const Shapes shapes = sensor_shapes(run.tables, &poses, {});
  EXPECT_THAT(legend_of(shapes), ::testing::Not(HasSubstr("do not place")));
  std::map<std::string, dvec3> places;
  for (const LabelShape& label : shapes.labels) places[label.text] = label.at;
  ASSERT_EQ(places.size(), 4u);
  EXPECT_LT(glm::distance(places["uav/camera"], end_of(run, 2, "uav", {0.1, 0.0, -0.1})), 1e-6);
  EXPECT_LT(glm::distance(places["uav/lidar"], end_of(run, 2, "uav", {0.0, 0.0, -0.2})), 1e-6);
  EXPECT_LT(glm::distance(places["mast/panel"], end_of(run, 2, "mast", {0.2, 0.1, 0.4})), 1e-6);
  EXPECT_LT(glm::distance(places["uav/antenna"], end_of(run, 2, "uav", {0.3, -0.2, 0.1})), 1e-6);
  size_t elements = 0;
  for (const PointShape& point : shapes.points)
    elements += shapes.rows.at(point.row).text.starts_with("mast/panel");
  EXPECT_EQ(elements, 8u);
}

TEST(OverlayRun, DetectionsOfARadarLieOnTheVan) {
  const MirrorRun run = MirrorRun::make(mirror_scenario(
      "      - name: radar\n        type: radar\n        rate_hz: 10\n        mount: {rotation_deg: [-15, 5, "
      "0]}\n"
      "        waveform: {carrier_hz: 77e9, bandwidth_hz: 300e6, chirps: 32, samples: 64, sample_rate_hz: "
      "3e6}\n"
      "        transmit: {pattern: isotropic}\n        receive: {pattern: isotropic, columns: 4}\n"
      "        field_of_view: {azimuth_deg: [-60, 60], elevation_deg: [-40, 20]}\n"
      "        outputs: [detections]\n        echoes: {tubes: 1500, max_bounces: 1}\n",
      ""));
  size_t real = 0;
  for (size_t packet = 0; packet < 3; ++packet) {
    const NodePoses poses = run.poses(packet);
    const Shapes shapes =
        radar_shapes(run.tables, run.run.spec("uav/radar"), run.record(packet, "uav/radar"), &poses, {});
    const auto range = run.run.array<float>(packet, "uav/radar", "range");
    const auto velocity = run.run.array<float>(packet, "uav/radar", "velocity");
    ASSERT_EQ(shapes.points.size(), range.size());
    const dvec3 eye = poses.world_from(run.tables.facts(run.run.spec("uav/radar")).place)->position;
    std::map<uint32_t, const LineShape*> arrows;
    for (const LineShape& line : shapes.lines)
      if (line.arrow) arrows[line.row] = &line;
    for (size_t i = 0; i < range.size(); ++i) {
      const PointShape& point = shapes.points[i];
      // The radar moves by 6 m/s, and its frame takes some milliseconds.
      EXPECT_NEAR(glm::distance(point.at, eye), static_cast<double>(range[i]), 0.05);
      const double v = static_cast<double>(velocity[i]);
      if (v == 0.0) continue;
      ASSERT_TRUE(arrows.contains(point.row));
      const LineShape& arrow = *arrows[point.row];
      EXPECT_NEAR(glm::distance(arrow.b, eye) - glm::distance(arrow.a, eye), v, 0.02 * std::abs(v) + 1e-3);
      real += shapes.rows[point.row].text.find("cabin") != std::string::npos;
    }
    EXPECT_GT(shapes.lines.size(), 20u) << "the fan";
  }
  EXPECT_GT(real, 0u);
}

}  // namespace
}  // namespace greatx::view
