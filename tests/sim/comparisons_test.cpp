// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/compare/comparisons.h"

#include <cmath>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
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

/// A node carries a box of 2 m about its origin, and another node a camera and a LiDAR that look along +x.
/// The poses put the box 10 m before them, turned by 30 degrees about the vertical.
class AgainstBoxes : public testing::Test {
 protected:
  AgainstBoxes() {
    poses_.name = "poses";
    poses_.metadata_json = R"({"nodes": ["eye", "car"]})";
    const double half = 0.5 * radians(30.0);
    set(poses_, "position", std::vector<double>{100.0, 50.0, 2.0, 110.0, 50.0, 2.0});
    set(poses_, "orientation",
        std::vector<double>{1.0, 0.0, 0.0, 0.0, std::cos(half), 0.0, 0.0, std::sin(half)});
    for (const char* name : {"velocity", "acceleration", "angular_velocity"})
      set(poses_, name, std::vector<double>(6, 0.0));
    InstanceBox ground, car;
    ground.box.add(dvec3(-1e3, -1e3, -1.0));
    ground.box.add(dvec3(1e3, 1e3, 0.0));
    car.node = 1;
    car.box.add(dvec3(-1.0));
    car.box.add(dvec3(1.0));
    boxes_ = {ground, car};
    camera_.name = "eye/camera";
    camera_.metadata_json = R"({"width": 3, "height": 1, "fx": 3.0, "fy": 3.0, "cx": 1.5, "cy": 0.5,
      "near_m": 0.05, "body_from_sensor": {"position_m": [0, 0, 0], "orientation_wxyz": [1, 0, 0, 0]}})";
    lidar_.name = "eye/lidar";
    lidar_.metadata_json = R"({"point_error_m": 0.001, "receiver": {"range_std_m": 0.01},
      "body_from_sensor": {"position_m": [0, 0, 0], "orientation_wxyz": [1, 0, 0, 0]}})";
  }
  template <typename T>
  void set(const SensorSpec& sensor, const char* name, const std::vector<T>& values) {
    arrays_[sensor.name + "." + name] = Array::of<T>({std::ssize(values)}, values);
  }
  RecordView view(const SensorSpec& sensor) const {
    return {sensor,
            [this, &sensor](const std::string& name) { return arrays_.at(sensor.name + "." + name); }};
  }
  double depth_error(float depth, uint16_t instance) {
    set(camera_, "depth", std::vector<float>{INFINITY, depth, 7.0f});
    set(camera_, "instance", std::vector<uint16_t>{0, instance, 1});
    const ErrorStatistics errors = compare_depth_boxes(view(camera_), view(poses_), boxes_);
    return errors.count() == 1 ? errors.max() : NAN;
  }
  double lidar_error(float range) {
    set(lidar_, "points", std::vector<float>{range, 0.0f, 0.0f, 1.0f, 5.0f, 0.0f, 0.0f, 1.0f});
    set(lidar_, "instance", std::vector<uint32_t>{2, 1});
    set(lidar_, "power", std::vector<float>{1.0f, 1.0f});
    const ErrorStatistics errors = compare_lidar_boxes(view(lidar_), view(poses_), boxes_);
    return errors.count() == 1 ? errors.max() : NAN;
  }

  SensorSpec poses_, camera_, lidar_;
  std::vector<InstanceBox> boxes_;
  std::map<std::string, Array> arrays_;
  /// Along the axis, the face of the turned box begins here: its half length over the cosine of its turn.
  double face_m_ = 10.0 - 1.0 / std::cos(radians(30.0));
};

TEST_F(AgainstBoxes, APixelOutsideOfItsInstancesBoxIsFound) {
  EXPECT_LT(depth_error(static_cast<float>(face_m_), 2), 1e-7);
  EXPECT_EQ(depth_error(10.0f, 2), 0.0) << "inside";
  // 0.5 m before the face along the axis are 0.5 cos 30 from it.
  EXPECT_NEAR(depth_error(static_cast<float>(face_m_ - 0.5), 2),
              0.5 * std::cos(radians(30.0)) / (face_m_ - 0.5), 1e-6);
  EXPECT_TRUE(std::isnan(depth_error(5.0f, 1))) << "no node carries the ground, so it is not compared";
  EXPECT_TRUE(std::isnan(depth_error(5.0f, 9))) << "no such instance";
}

TEST_F(AgainstBoxes, AReturnOutsideByMoreThanItsNoiseIsFound) {
  EXPECT_EQ(lidar_error(static_cast<float>(face_m_)), 0.0);
  EXPECT_EQ(lidar_error(static_cast<float>(face_m_ - 0.06)), 0.0) << "six deviations of 0.01 m, and 0.001 m";
  const double before = face_m_ - 0.5;
  EXPECT_NEAR(lidar_error(static_cast<float>(before)), (0.5 * std::cos(radians(30.0)) - 0.061) / before,
              1e-6);
}

TEST_F(AgainstBoxes, ARecordOfAnotherShapeIsRefused) {
  set(camera_, "instance", std::vector<uint16_t>{0, 2});
  set(camera_, "depth", std::vector<float>{1.0f, 2.0f, 3.0f});
  EXPECT_THROW(compare_depth_boxes(view(camera_), view(poses_), boxes_), UserError);
}

}  // namespace
}  // namespace greatx::sim
