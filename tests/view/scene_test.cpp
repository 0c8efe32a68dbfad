// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The picture of the main view: it shows what a recorded camera shows, the picked surface is the one under
// the cursor, paths end on the pixels of their antennas, and a lost device comes back.
#include <chrono>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "draw/paths/render.h"
#include "io/dataset/dataset_format.h"
#include "sim/dataset/dataset_info.h"
#include "sim/scenario/parse/load_scenario.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/kept_run.h"
#include "view/overlay/path_shapes.h"
#include "view/pick/pick.h"
#include "view/scene/moment_cache.h"
#include "view/scene/scene_view.h"

namespace greatx::view {
namespace {

const std::string room =
    "greatx: 1\nname: test\nseed: 5\nticks: 3\ntick_rate_hz: 10\nscene: {generate: {kind: room}}\nnodes:\n"
    "  - name: bs\n    trajectory: {type: static, position_m: [-4, -3, 2.5], rotation_deg: [30, 5, 0]}\n"
    "    sensors: [{name: panel, type: antenna, mount: {position_m: [0.2, 0.1, -0.1]}}]\n"
    "  - name: box\n    trajectory: {type: waypoints, points: [{t_s: 0, position_m: [2, -1, 0.5]}, {t_s: 1, "
    "position_m: [2, 2, 0.5]}]}\n    model: {generate: {kind: quadrotor, variant: large}}\n"
    "    sensors: [{name: antenna, type: antenna, mount: {position_m: [0.1, 0, 0.2]}}]\n"
    "  - name: eye\n    trajectory: {type: static, position_m: [-2.5, 2, 1.8], rotation_deg: [-35, 12, 3]}\n"
    "    sensors: [{name: camera, type: camera, rate_hz: 10, width: 120, height: 90, fov_deg: 80}]\n"
    "channels:\n  - {name: csi, tx: bs/panel, rx: [box/antenna], rate_hz: 10, subcarriers: 8, bandwidth_hz: "
    "20e6, max_depth: 2, rays: 4000}\n";

std::shared_ptr<const sim::Experiment> experiment_of(const std::string& yaml) {
  return std::make_shared<const sim::Experiment>(
      sim::make_experiment(sim::parse_scenario(yaml, "test.yaml", ".")));
}

SceneRequest through(const sim::Experiment& experiment, const std::string& camera, int64_t tick,
                     MomentCache& moments) {
  const apps::ScenarioView view = apps::scenario_view(apps::find_camera(camera, experiment.scenario),
                                                      experiment, moments.at(0, tick), 120);
  SceneRequest request;
  request.view = view.view;
  request.excluded_body = view.excluded_body;
  request.tick = tick;
  return request;
}

/// Waits for the picture of a request, or for an error.
std::shared_ptr<const ScenePicture> picture_of(SceneView& scene, const SceneRequest& request) {
  const uint64_t before = scene.version();
  scene.look(request);
  for (int i = 0; i < 60'000 && scene.version() == before; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return scene.error().empty() ? scene.picture() : nullptr;
}

class SceneViewTest : public testing::Test {
 protected:
  const gpu::DeviceOptions device_{"", true};
  const std::shared_ptr<const sim::Experiment> experiment_ = experiment_of(room);
  MomentCache moments_{experiment_};
};

TEST(PickedFacts, SayWhereOnTheEarthAPointIs) {
  const auto facts = [](const std::string& yaml) {
    Picked picked;
    picked.point = dvec3(-9996.993940, 10.011041, -7.818219);  // PROJ's, tests/core/geodesy_test.cpp
    return facts_of(picked, *experiment_of(yaml), ScenePicture(), 3.5e9);
  };
  std::string on_earth = room;
  on_earth.insert(
      on_earth.find("}}\nnodes") + 1,
      ", georeference: {latitude_deg: 52.0116, longitude_deg: 4.3571, height_m: 45, undulation_m: 43.4}");
  EXPECT_THAT(facts(on_earth),
              testing::Contains(testing::Pair("place", "52.0116000, 4.2115000 deg, 1.60 m above the datum")));
  EXPECT_THAT(facts(room), testing::Not(testing::Contains(testing::Key("place"))));
}

TEST_F(SceneViewTest, ShowsTheIdsThatACameraRecords) {
  const test::KeptRun run = test::keep_run(*experiment_);
  SceneView scene(experiment_, device_);
  for (const int64_t tick : {0, 2}) {
    const auto picture = picture_of(scene, through(*experiment_, "eye/camera", tick, moments_));
    ASSERT_NE(picture, nullptr) << scene.error();
    for (const Record& record : run.packets.at(static_cast<size_t>(tick)).records) {
      const SensorSpec& spec = run.sensors[record.sensor];
      if (spec.kind != "camera") continue;
      for (size_t i = 0; i < spec.arrays.size(); ++i) {
        if (spec.arrays[i].name != "instance") continue;
        ASSERT_EQ(record.arrays[i].shape, (std::vector<int64_t>{90, 120}));
        for (size_t p = 0; p < picture->instance.size(); ++p) {
          const uint32_t id = record.arrays[i].dtype == DType::u16 ? record.arrays[i].as<uint16_t>()[p]
                                                                   : record.arrays[i].as<uint32_t>()[p];
          ASSERT_EQ(picture->instance[p], id) << "tick " << tick << ", pixel " << p;
        }
      }
    }
  }
}

TEST_F(SceneViewTest, ThePickedSurfaceIsTheOneUnderTheCursor) {
  SceneView scene(experiment_, device_);
  const auto picture = picture_of(scene, through(*experiment_, "eye/camera", 1, moments_));
  ASSERT_NE(picture, nullptr) << scene.error();
  const dvec3 origin = experiment_->scene().origin;
  int picked_pixels = 0;
  for (int y = 0; y < 90; ++y)
    for (int x = 0; x < 120; ++x) {
      const size_t pixel = static_cast<size_t>(y) * 120 + static_cast<size_t>(x);
      const std::optional<Picked> picked = pick(*picture, x, y, origin);
      ASSERT_EQ(picked.has_value(), picture->instance[pixel] != 0);
      if (!picked) continue;
      ++picked_pixels;
      EXPECT_EQ(picked->instance + 1, picture->instance[pixel]);
      EXPECT_EQ(picked->material + 1, picture->material[pixel]);
      const dvec3 back = picture->request.view.project(picked->point - origin);
      EXPECT_NEAR(back.x, x + 0.5, 1e-6);
      EXPECT_NEAR(back.y, y + 0.5, 1e-6);
      EXPECT_NEAR(back.z, static_cast<double>(picture->depth[pixel]), 1e-6);
    }
  EXPECT_GT(picked_pixels, 9000) << "a room fills the picture";
  EXPECT_FALSE(pick(*picture, -1, 0, origin));
  EXPECT_FALSE(pick(*picture, 0, 90, origin));
}

TEST_F(SceneViewTest, PathsEndOnThePixelsOfTheirAntennas) {
  gpu::Device& device = greatx::test::device();
  sim::Simulator simulator(device, *experiment_);
  const io::DatasetInfo info = sim::dataset_info(*experiment_, device, simulator.sensors());
  const RecordTables tables(info.run_json, info.sensors, "run");
  const test::KeptRun run = test::keep_run(*experiment_);
  const std::vector<Record>& records = run.packets.at(1).records;
  const auto of_kind = [&](const std::string& kind) {
    return std::ranges::find_if(
        records, [&](const Record& record) { return run.sensors[record.sensor].kind == kind; });
  };
  ASSERT_NE(of_kind("csi"), records.end());
  ASSERT_NE(of_kind("pose"), records.end());
  const NodePoses poses(tables, *of_kind("pose"));
  const Shapes shapes = path_shapes(tables, run.sensors[of_kind("csi")->sensor], *of_kind("csi"), &poses, {});
  ASSERT_GT(shapes.lines.size(), 5u);

  const sim::Moment& moment = moments_.at(0, 1);
  const apps::PictureView view = through(*experiment_, "eye/camera", 1, moments_).view;
  const dvec3 origin = experiment_->scene().origin;
  const auto pixel_of = [&](const dvec3& world) { return dvec2(view.project_straight(world - origin)); };
  const dvec2 panel = pixel_of(moment.motions.at(0).pose.apply({0.2, 0.1, -0.1}));
  const dvec2 antenna = pixel_of(moment.motions.at(1).pose.apply({0.1, 0.0, 0.2}));
  std::map<uint32_t, std::vector<const LineShape*>> paths;
  for (const LineShape& line : shapes.lines)
    if (line.row != ~0u) paths[line.row].push_back(&line);
  ASSERT_GT(paths.size(), 2u);
  for (const auto& [row, lines] : paths) {
    EXPECT_LT(glm::distance(pixel_of(lines.front()->a), panel), 0.01) << shapes.rows[row].text;
    EXPECT_LT(glm::distance(pixel_of(lines.back()->b), antenna), 0.01) << shapes.rows[row].text;
  }
}

TEST_F(SceneViewTest, ALostDeviceComesBack) {
  SceneView whole(experiment_, device_), lost(experiment_, device_, {0, 3, 5});
  for (const int64_t tick : {0, 1, 2, 1}) {
    const SceneRequest request = through(*experiment_, "eye/camera", tick, moments_);
    const auto wanted = picture_of(whole, request), found = picture_of(lost, request);
    ASSERT_NE(wanted, nullptr) << whole.error();
    ASSERT_NE(found, nullptr) << lost.error();
    EXPECT_EQ(found->request.tick, tick);
    EXPECT_TRUE(found->rgb == wanted->rgb && found->depth == wanted->depth) << "tick " << tick;
  }
}

TEST_F(SceneViewTest, ADeviceThatIsLostAgainAtTheSamePictureIsAnError) {
  SceneView scene(experiment_, device_, {1, 2});
  ASSERT_NE(picture_of(scene, through(*experiment_, "eye/camera", 0, moments_)), nullptr);
  EXPECT_EQ(picture_of(scene, through(*experiment_, "eye/camera", 1, moments_)), nullptr);
  EXPECT_THAT(scene.error(), testing::HasSubstr("VK_ERROR_DEVICE_LOST"));
}

}  // namespace
}  // namespace greatx::view
