// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/compare/comparisons.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/camera/camera.h"
#include "sim/compare/consistency.h"

namespace greatx::sim {
namespace {

/// Provides a wall at 5 m before a camera, and a LiDAR beside the camera with two returns, of which one is
/// wrong by a tenth.
class Comparisons : public testing::Test {
 protected:
  Comparisons() {
    camera_.width = 40;
    camera_.height = 30;
    camera_.fx = camera_.fy = 20.0;
    camera_.cx = 20.0;
    camera_.cy = 15.0;
    images_.width = camera_.width;
    images_.height = camera_.height;
    images_.depth.assign(40 * 30, 5.0f);
    errors_.add(0.25);
    for (const char* name : {"poses", "uav/camera", "uav/lidar", "csi"}) {
      specs_.emplace_back();
      specs_.back().name = name;
    }
  }
  Witness witness(size_t sensor, const Evidence& evidence) const {
    return {{specs_[sensor], [](const std::string& name) -> Array { throw std::runtime_error(name); }},
            evidence};
  }
  Evidence poses() const { return {.poses = true}; }
  Evidence picture(uint32_t node) const {
    Evidence evidence{.pixels_against_rays = &errors_};
    evidence.depth = {node, Pose(), &camera_, &images_};
    return evidence;
  }
  Evidence returns(uint32_t node) const {
    Evidence evidence;
    evidence.returns = {node, Pose(), points_, ids_, ids_};
    return evidence;
  }
  Evidence sights() const { return {.delays_against_distances = &errors_}; }
  std::vector<Witness> everything(uint32_t node_of_lidar) const {
    return {witness(0, poses()), witness(1, picture(0)), witness(2, returns(node_of_lidar)),
            witness(3, sights())};
  }

  render::CameraDesc camera_;
  render::CameraImages images_;
  ErrorStatistics errors_;
  std::vector<SensorSpec> specs_;
  std::vector<float> points_{5.0f, 0.3f, 0.2f, 1.0f, 5.5f, -0.4f, 0.1f, 1.0f};
  std::vector<uint32_t> ids_{1, 1};
  World world_;
};

TEST_F(Comparisons, ARowSaysWhichRecordIsHeldAgainstWhich) {
  Comparer comparer(world_, true);
  comparer.compare(2, 7, everything(0));
  ASSERT_EQ(comparer.rows().size(), 2u);
  const ConsistencyRow &sight = comparer.rows()[0], &lidar = comparer.rows()[1];
  EXPECT_EQ(sight.figure, sight_figure);
  EXPECT_EQ(sight.sensor, "csi");
  EXPECT_EQ(sight.other, "poses");
  EXPECT_EQ(lidar.figure, lidar_figure);
  EXPECT_EQ(lidar.sensor, "uav/lidar");
  EXPECT_EQ(lidar.other, "uav/camera");
  EXPECT_EQ(lidar.compared, 2u);
  EXPECT_NEAR(lidar.largest, 0.5 / 5.5, 1e-6);
  EXPECT_EQ(lidar.sequence, 2u);
  EXPECT_EQ(lidar.tick, 7);
  EXPECT_EQ(comparer.totals().at(depth_figure).count(), 1u) << "a total, though no row";
}

TEST_F(Comparisons, TotalsAreThoseOfAllTicksAndSequences) {
  Comparer comparer(world_, true);
  for (const auto& [figure, total] : comparer.totals()) EXPECT_EQ(total.count(), 0u) << figure;
  EXPECT_EQ(comparer.totals().size(), comparisons().size());
  comparer.compare(0, 0, everything(0));
  comparer.compare(1, 0, everything(0));
  EXPECT_EQ(comparer.totals().at(lidar_figure).count(), 4u);
  EXPECT_EQ(comparer.totals().at(sight_figure).count(), 2u);
  EXPECT_EQ(comparer.totals().at(sight_figure).max(), 0.25);
  EXPECT_EQ(comparer.totals().at(radar_figure).count(), 0u);
}

TEST_F(Comparisons, ALidarOfAnotherNodeIsNotHeldAgainstTheCamera) {
  Comparer comparer(world_, true);
  comparer.compare(0, 0, everything(1));
  EXPECT_EQ(comparer.totals().at(lidar_figure).count(), 0u);
}

TEST_F(Comparisons, WithoutTheEffectThoseAreMadeThatCostNothing) {
  Comparer comparer(world_, false);
  comparer.compare(0, 0, everything(0));
  ASSERT_EQ(comparer.rows().size(), 1u);
  EXPECT_EQ(comparer.rows()[0].figure, sight_figure);
  EXPECT_EQ(comparer.totals().at(lidar_figure).count(), 0u);
  EXPECT_EQ(comparer.totals().at(depth_figure).count(), 0u);
}

TEST_F(Comparisons, AFigureIsFoundAgainFromFilesOrSaysWhyNot) {
  for (const Comparison& comparison : comparisons()) {
    EXPECT_EQ(comparison_called(comparison.figure), &comparison);
    EXPECT_EQ(comparison.recompute == nullptr, comparison.obstacle != nullptr) << comparison.figure;
    EXPECT_EQ(comparison.recompute == nullptr, comparison.needs == nullptr) << comparison.figure;
  }
  EXPECT_EQ(comparison_called("lidar"), nullptr);
  SensorSpec camera;
  EXPECT_THAT(comparison_called(lidar_figure)->needs(camera).of_other, ::testing::ElementsAre("depth"));
  camera.arrays.push_back({"box_2d", DType::f32, {-1, 4}, "pixel", ""});
  EXPECT_THAT(comparison_called(lidar_figure)->needs(camera).of_other,
              ::testing::ElementsAre("depth", "instance"));
}

}  // namespace
}  // namespace greatx::sim
