// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests the shapes of LiDARs, radars, boxes, trajectories and sensors of records made by hand.
#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include <fmt/format.h>

#include "core/units.h"
#include "tests/view/overlay_support.h"
#include "view/overlay/box_shapes.h"
#include "view/overlay/sensing_shapes.h"
#include "view/overlay/sensor_shapes.h"
#include "view/overlay/trajectory_shapes.h"

namespace greatx::view {
namespace {

using testing::expect_user_error;
using ::testing::HasSubstr;
using testing::json_of;
using testing::legend_of;
using testing::Made;
using testing::made_poses;
using testing::MadeNode;
using ::testing::Not;
using testing::same;

const Pose uav_pose{{500100.0, 4000200.0, 60.0}, orientation_from_yaw_pitch_roll(0.7, 0.3, -0.2)};
const Pose sensor_mount{{0.4, -0.1, 0.2}, orientation_from_yaw_pitch_roll(-0.3, 0.5, 0.1)};

Made sensor(const char* name, const char* kind, nlohmann::json metadata = nlohmann::json::object()) {
  Made made;
  made.spec.name = name;
  made.spec.kind = kind;
  metadata["body_from_sensor"] = json_of(sensor_mount);
  made.spec.metadata_json = metadata.dump();
  return made;
}

/// A run of one sensor on the node "uav", which moves and turns.
struct Rig {
  Made poses = made_poses({{"uav", uav_pose, {3.0, -1.0, 0.5}, {0.0, 0.0, 0.8}}});
  RecordTables tables;
  NodePoses at;
  explicit Rig(const Made& made, const std::string& run = "{}")
      : tables(run, std::vector{made.spec, poses.spec}, "test"), at(tables, poses.record) {}
};

/// The uav `dt_s` after the tick.
Pose uav_after(double dt_s) {
  return {uav_pose.position + dt_s * dvec3(3.0, -1.0, 0.5),
          glm::angleAxis(0.8 * dt_s, dvec3(0, 0, 1)) * uav_pose.orientation};
}

// --- Shapes::append

TEST(Shapes, AppendShiftsRows) {
  Shapes a, b;
  a.lines.push_back({{}, {}, {}, 1.0f, a.add_row("first", 1)});
  a.points.push_back({{}, {}, 2.0f, PointShape::Mark::dot});  // without a row
  b.note("legend");
  b.lines.push_back({{}, {}, {}, 1.0f, b.add_row("second", 2)});
  b.points.push_back({{}, {}, 2.0f, PointShape::Mark::dot, b.add_row("third", 3)});
  b.points.push_back({{}, {}, 2.0f, PointShape::Mark::dot});
  b.labels.push_back({{}, "name", {}});
  a.append(b);
  ASSERT_EQ(a.lines.size(), 2u);
  ASSERT_EQ(a.points.size(), 3u);
  EXPECT_EQ(a.rows.at(a.lines[0].row).text, "first");
  EXPECT_EQ(a.rows.at(a.lines[1].row).text, "second");
  EXPECT_EQ(a.points[0].row, ~0u);
  EXPECT_EQ(a.rows.at(a.points[1].row).id, 3u);
  EXPECT_EQ(a.points[2].row, ~0u);
  EXPECT_EQ(a.labels.size(), 1u);
  EXPECT_EQ(a.legend.size(), 1u);
  a.append(a);
  EXPECT_EQ(a.rows.size(), 6u);
  EXPECT_EQ(a.lines[3].row, 4u);
  EXPECT_FALSE(a.empty());
  EXPECT_TRUE(Shapes().empty());
}

// --- LiDAR

/// Returns of the plane z = 3 m of the world, `count` of them, from shots that all start at the tick.
Made cloud(size_t count) {
  Made made = sensor("uav/lidar", "lidar");
  const Pose sensor_from_world = (uav_pose * sensor_mount).inverse();
  std::vector<float> points;
  std::vector<uint16_t> ring;
  std::vector<float> time;
  std::vector<uint32_t> instance;
  for (size_t i = 0; i < count; ++i) {
    const double turn = 0.001 * static_cast<double>(i), r = 5.0 + static_cast<double>(i % 40);
    const dvec3 world = dvec3(uav_pose.position.x + r * std::cos(turn),
                              uav_pose.position.y + r * std::sin(turn), i % 5 == 0 ? 8.0 : 3.0);
    const dvec3 at = sensor_from_world.apply(world);
    for (int axis = 0; axis < 3; ++axis) points.push_back(static_cast<float>(at[axis]));
    points.push_back(0.5f + 0.001f * static_cast<float>(i % 100));
    ring.push_back(static_cast<uint16_t>(i % 16));
    time.push_back(0.0f);
    instance.push_back(static_cast<uint32_t>(i % 3));
  }
  const auto n = static_cast<int64_t>(count);
  made.add<float>("points", {n, 4}, points)
      .add<uint16_t>("ring", {n}, ring)
      .add<float>("time_offset", {n}, time)
      .add<uint32_t>("instance", {n}, instance);
  return made;
}

TEST(LidarShapes, LieOnThePlanesThatTheyMeet) {
  const Made made = cloud(1000);
  const Rig rig(made);
  const Shapes shapes = lidar_shapes(rig.tables, made.spec, made.record, &rig.at, {});
  ASSERT_EQ(shapes.points.size(), 1000u);
  for (size_t i = 0; i < 1000; ++i) EXPECT_NEAR(shapes.points[i].at.z, i % 5 == 0 ? 8.0 : 3.0, 1e-4);
  EXPECT_THAT(legend_of(shapes), HasSubstr("uav/lidar: 1000 points"));
}

TEST(LidarShapes, ArePlacedByThePoseOfTheirOwnShot) {
  Made made = cloud(2);
  const Rig rig(made);
  const double dt = 0.05;
  made.array("time_offset").as<float>()[1] = static_cast<float>(dt);
  const std::span<float> points = made.array("points").as<float>();
  const dvec3 in_sensor(points[4], points[5], points[6]);
  const auto second = [&](const RecordTables& tables) {
    return lidar_shapes(tables, made.spec, made.record, &rig.at, {}).points.at(1).at;
  };
  EXPECT_LT(glm::distance(second(rig.tables), (uav_after(dt) * sensor_mount).apply(in_sensor)), 1e-6);
  // Without the effect, all shots start from the pose at the tick.
  const Rig still(made, R"({"effects": {"lidar_sweep_motion": false}})");
  EXPECT_LT(glm::distance(second(still.tables), (uav_pose * sensor_mount).apply(in_sensor)), 1e-9);
}

TEST(LidarShapes, AreStridedAndSaySo) {
  const Made made = cloud(1'000'000);
  const Rig rig(made);
  LidarOptions options;
  options.most = 100'000;
  const Shapes shapes = lidar_shapes(rig.tables, made.spec, made.record, &rig.at, options);
  EXPECT_EQ(shapes.points.size(), 100'000u);
  EXPECT_THAT(legend_of(shapes), HasSubstr("100000 of 1000000 points, one in 10"));
  options.most = 300'000;
  EXPECT_EQ(lidar_shapes(rig.tables, made.spec, made.record, &rig.at, options).points.size(), 250'000u);
}

TEST(LidarShapes, AreColouredAsTheirOwnReturnsWhenStrided) {
  const Made made = cloud(240);
  const Rig rig(made);
  for (const LidarColors colors :
       {LidarColors::height, LidarColors::intensity, LidarColors::ring, LidarColors::instance}) {
    LidarOptions options;
    options.colors = colors;
    const Shapes every = lidar_shapes(rig.tables, made.spec, made.record, &rig.at, options);
    options.most = 60;
    const Shapes fourth = lidar_shapes(rig.tables, made.spec, made.record, &rig.at, options);
    ASSERT_EQ(fourth.points.size(), 60u);
    for (size_t i = 0; i < 60; ++i) {
      const PointShape &a = fourth.points[i], &b = every.points[4 * i];
      EXPECT_EQ(a.at, b.at);
      EXPECT_EQ(fourth.rows.at(a.row).text, every.rows.at(b.row).text);
      // Scales follow what is shown.
      if (colors == LidarColors::instance) {
        EXPECT_TRUE(same(a.color, b.color));
      }
      if (colors == LidarColors::ring && made.record.arrays[1].as<uint16_t>()[4 * i] == 12) {
        EXPECT_TRUE(same(a.color, io::turbo(0.92)));
      }
    }
  }
}

TEST(LidarShapes, AreColouredByWhatIsAsked) {
  const Made made = cloud(300);
  const Rig rig(made,
                R"({"instances": [{"name": "road", "class": "road"}, {"name": "van", "class": "vehicle"}]})");
  const auto shapes = [&](LidarColors colors) {
    LidarOptions options;
    options.colors = colors;
    return lidar_shapes(rig.tables, made.spec, made.record, &rig.at, options);
  };
  const Shapes height = shapes(LidarColors::height), ids = shapes(LidarColors::instance),
               rings = shapes(LidarColors::ring), intensity = shapes(LidarColors::intensity);
  EXPECT_TRUE(same(height.points[0].color, io::turbo(0.92)));  // 8 m, of 3 m to 8 m
  EXPECT_TRUE(same(height.points[1].color, io::turbo(0.08)));
  EXPECT_THAT(legend_of(height), HasSubstr("8.0 m height"));
  for (uint32_t i = 0; i < 3; ++i) EXPECT_TRUE(same(ids.points[i].color, io::color_of_id(i)));
  EXPECT_THAT(ids.rows.at(ids.points[1].row).text, HasSubstr("road (road)"));
  EXPECT_THAT(ids.rows.at(ids.points[2].row).text, HasSubstr("uav/lidar: 100 returns"));
  EXPECT_THAT(ids.rows.at(ids.points[0].row).text, HasSubstr("fog or rain"));
  EXPECT_EQ(ids.points[2].row, ids.points[5].row);
  EXPECT_TRUE(same(rings.points[0].color, io::turbo(0.08)));
  EXPECT_TRUE(same(rings.points[15].color, io::turbo(0.92)));
  EXPECT_THAT(legend_of(rings), HasSubstr("ring 15"));
  EXPECT_FALSE(same(intensity.points[2].color, intensity.points[97].color));
  EXPECT_THAT(legend_of(intensity), HasSubstr("intensity"));
}

TEST(LidarShapes, OfAnEmptySweepAreEmpty) {
  const Made made = cloud(0);
  const Rig rig(made);
  for (const LidarColors colors :
       {LidarColors::height, LidarColors::intensity, LidarColors::ring, LidarColors::instance}) {
    LidarOptions options;
    options.colors = colors;
    const Shapes shapes = lidar_shapes(rig.tables, made.spec, made.record, &rig.at, options);
    EXPECT_TRUE(shapes.empty());
    EXPECT_THAT(legend_of(shapes), HasSubstr("uav/lidar: 0 points"));
  }
}

TEST(LidarShapes, SayWhatIsMissing) {
  Made made = cloud(10);
  const Rig rig(made);
  EXPECT_THAT(legend_of(lidar_shapes(rig.tables, made.spec, made.record, nullptr, {})), HasSubstr("poses"));
  made.without("ring").without("instance");
  LidarOptions options;
  options.colors = LidarColors::ring;
  const Shapes no_ring = lidar_shapes(rig.tables, made.spec, made.record, &rig.at, options);
  EXPECT_TRUE(no_ring.empty());
  EXPECT_THAT(legend_of(no_ring), HasSubstr("'ring' is not recorded: add 'ply' or 'pcd'"));
  options.colors = LidarColors::height;
  const Shapes plain = lidar_shapes(rig.tables, made.spec, made.record, &rig.at, options);
  EXPECT_EQ(plain.points.size(), 10u);
  EXPECT_TRUE(plain.rows.empty());
  made.without("points");
  EXPECT_THAT(legend_of(lidar_shapes(rig.tables, made.spec, made.record, &rig.at, {})),
              HasSubstr("'points'"));
}

TEST(LidarShapes, RefuseDamagedArrays) {
  const Made good = cloud(10);
  const Rig rig(good);
  const auto refuse = [&](const Made& made, LidarColors colors, std::initializer_list<const char*> parts) {
    LidarOptions options;
    options.colors = colors;
    expect_user_error([&] { lidar_shapes(rig.tables, made.spec, made.record, &rig.at, options); }, parts);
  };
  Made bad = good;
  bad.array("points") = Array(DType::f64, {10, 4});
  refuse(bad, LidarColors::height, {"uav/lidar: points", "<f4 [n, 4]", "<f8 [10, 4]"});
  bad = good;
  bad.array("points") = Array(DType::f32, {10, 3});
  refuse(bad, LidarColors::height, {"points", "[10, 3]"});
  bad = good;
  bad.array("points").as<float>()[6] = std::numeric_limits<float>::infinity();
  refuse(bad, LidarColors::height, {"points", "finite"});
  bad = good;
  bad.array("ring") = Array(DType::u16, {9});
  refuse(bad, LidarColors::ring, {"ring", "<u2 [10]", "<u2 [9]"});
  bad = good;
  bad.array("instance") = Array(DType::u16, {10});
  refuse(bad, LidarColors::height, {"instance", "<u4 [10]"});
  bad = good;
  bad.array("time_offset") = Array(DType::f32, {11});
  refuse(bad, LidarColors::height, {"time_offset"});
  bad = good;
  bad.array("points") = Array(DType::f32, {});
  refuse(bad, LidarColors::height, {"points"});
}

// --- Radar

constexpr double frame_middle_s = 0.02;

Made radar(const std::vector<float>& velocities, bool bistatic = false) {
  nlohmann::json metadata{{"azimuth_min_rad", -0.5},
                          {"azimuth_max_rad", 0.5},
                          {"range_span_m", 100.0},
                          {"velocity_min_m_s", -12.5},
                          {"frame_middle_s", frame_middle_s}};
  if (bistatic) {
    metadata["illuminator"] = "point 4";
    metadata["body_from_illuminator"] = json_of(Pose{uav_pose.position + dvec3(0, 0, 50), dquat(1, 0, 0, 0)});
  }
  Made made = sensor("uav/radar", "radar", metadata);
  std::vector<float> xyzr, range, zero(velocities.size());
  std::vector<uint32_t> instance;
  for (size_t i = 0; i < velocities.size(); ++i) {
    xyzr.insert(xyzr.end(), {10.0f + static_cast<float>(i), 2.0f, -1.0f, 13.0f});
    range.push_back(std::hypot(10.0f + static_cast<float>(i), 2.0f, 1.0f));
    instance.push_back(static_cast<uint32_t>(i % 3));
  }
  const auto n = static_cast<int64_t>(velocities.size());
  made.add<float>("detections", {n, 4}, xyzr).add<float>("range", {n}, range);
  made.add<float>("velocity", {n}, velocities);
  for (const char* name : {"azimuth", "elevation", "snr", "power"}) made.add<float>(name, {n}, zero);
  made.add<uint32_t>("instance", {n}, instance);
  return made;
}

/// The arrows, in the order of detections that move.
std::vector<LineShape> arrows_of(const Shapes& shapes) {
  std::vector<LineShape> arrows;
  for (const LineShape& line : shapes.lines)
    if (line.arrow) arrows.push_back(line);
  return arrows;
}

TEST(RadarShapes, HaveArrowsOfTheRadialVelocity) {
  const std::vector<float> velocities{5.0f, -3.0f, 0.0f, 7.5f};
  const Made made = radar(velocities);
  const Rig rig(made);
  for (const double seconds : {1.0, 0.25}) {
    RadarOptions options;
    options.arrow_s = seconds;
    const Shapes shapes = radar_shapes(rig.tables, made.spec, made.record, &rig.at, options);
    const std::vector<LineShape> arrows = arrows_of(shapes);
    ASSERT_EQ(arrows.size(), 3u) << "what rests has none";
    const Pose world = uav_after(frame_middle_s) * sensor_mount;
    for (const auto& [arrow, i] : {std::pair(0, 0), std::pair(1, 1), std::pair(2, 3)}) {
      const dvec3 target = world.apply({10.0 + i, 2.0, -1.0});
      EXPECT_LT(glm::distance(arrows[arrow].a, target), 1e-5);
      const dvec3 motion = arrows[arrow].b - arrows[arrow].a;
      EXPECT_NEAR(glm::dot(motion, glm::normalize(target - world.position)),
                  seconds * static_cast<double>(velocities[static_cast<size_t>(i)]), 1e-6);
      EXPECT_NEAR(glm::length(motion), seconds * std::abs(velocities[static_cast<size_t>(i)]), 1e-6);
    }
  }
}

TEST(RadarShapes, OfABistaticRadarPointAlongTheGradientOfTheRange) {
  const Made made = radar({4.0f}, true);
  const Rig rig(made);
  const Shapes shapes = radar_shapes(rig.tables, made.spec, made.record, &rig.at, {});
  const std::vector<LineShape> arrows = arrows_of(shapes);
  ASSERT_EQ(arrows.size(), 1u);
  const dvec3 receiver = (uav_after(frame_middle_s) * sensor_mount).position,
              transmitter = uav_pose.position + dvec3(0, 0, 50);
  const auto half_way = [&](const dvec3& at) {
    return 0.5 * (glm::distance(at, transmitter) + glm::distance(at, receiver));
  };
  const dvec3 along = glm::normalize(arrows[0].b - arrows[0].a);
  EXPECT_NEAR(glm::length(arrows[0].b - arrows[0].a), 4.0, 1e-6);
  // No direction across it changes the range; along it the range grows.
  const dvec3 across = glm::normalize(glm::cross(along, dvec3(0.3, 0.8, 0.1)));
  const double step = 1e-3, here = half_way(arrows[0].a);
  EXPECT_NEAR((half_way(arrows[0].a + step * across) - here) / step, 0.0, 1e-3);
  EXPECT_GT((half_way(arrows[0].a + step * along) - here) / step, 0.1);
}

TEST(RadarShapes, TellRowsColoursAndFalseAlarms) {
  const Made made = radar({5.0f, -3.0f, 0.01f});  // the instances 0 (false alarm), 1, 2
  const Rig rig(made, R"({"instances": [{"name": "van", "class": "vehicle"}]})");
  const Shapes shapes = radar_shapes(rig.tables, made.spec, made.record, &rig.at, {});
  std::vector<PointShape> points = shapes.points;
  ASSERT_EQ(points.size(), 3u);
  EXPECT_EQ(points[0].mark, PointShape::Mark::cross);
  EXPECT_EQ(points[1].mark, PointShape::Mark::diamond);
  EXPECT_THAT(shapes.rows[points[0].row].text, HasSubstr("false alarm"));
  EXPECT_THAT(shapes.rows[points[1].row].text, HasSubstr("uav/radar: van"));
  EXPECT_THAT(shapes.rows[points[1].row].text, HasSubstr("velocity -3.00 m/s (approaching)"));
  EXPECT_THAT(shapes.rows[points[1].row].text, HasSubstr("RCS 13.0 dBsm"));
  EXPECT_FALSE(same(points[1].color, points[2].color));
  EXPECT_THAT(legend_of(shapes), HasSubstr("3 detections, 1 of them false alarms"));
  EXPECT_THAT(legend_of(shapes), HasSubstr("unambiguous to 12.50 m/s"));
}

TEST(RadarShapes, HaveTheFieldOfViewAsAFan) {
  const Made made = radar({});
  const Rig rig(made);
  const Shapes shapes = radar_shapes(rig.tables, made.spec, made.record, &rig.at, {});
  EXPECT_TRUE(shapes.points.empty());
  const Pose sensor_from_world = (uav_pose * sensor_mount).inverse();
  double widest = 0.0, farthest = 0.0;
  for (const LineShape& line : shapes.lines)
    for (const dvec3& end : {line.a, line.b}) {
      const dvec3 at = sensor_from_world.apply(end);
      EXPECT_NEAR(at.z, 0.0, 1e-6);
      farthest = std::max(farthest, glm::length(at));
      if (glm::length(at) > 1e-6) widest = std::max(widest, std::abs(std::atan2(at.y, at.x)));
    }
  EXPECT_NEAR(farthest, 100.0, 1e-6);
  EXPECT_NEAR(widest, 0.5, 1e-6);
  RadarOptions options;
  options.fan = false;
  EXPECT_TRUE(radar_shapes(rig.tables, made.spec, made.record, &rig.at, options).empty());
}

TEST(RadarShapes, SayWhatIsMissingAndRefuseDamage) {
  const Made good = radar({5.0f, -3.0f});
  const Rig rig(good);
  EXPECT_TRUE(radar_shapes(rig.tables, good.spec, good.record, nullptr, {}).empty());
  Made bad = good;
  bad.without("detections");
  EXPECT_THAT(legend_of(radar_shapes(rig.tables, bad.spec, bad.record, &rig.at, {})),
              HasSubstr("add 'detections' to its outputs"));
  const auto refuse = [&](const Made& made, std::initializer_list<const char*> parts) {
    expect_user_error([&] { radar_shapes(rig.tables, made.spec, made.record, &rig.at, {}); }, parts);
  };
  for (const char* name : {"range", "velocity", "azimuth", "elevation", "snr", "power"}) {
    bad = good;
    bad.array(name) = Array(DType::f32, {3});
    refuse(bad, {"uav/radar: ", name, "<f4 [2]", "<f4 [3]"});
    bad.array(name) = Array(DType::f64, {2});
    refuse(bad, {"uav/radar: ", name, "<f8 [2]"});
  }
  bad = good;
  bad.array("detections").as<float>()[1] = std::nanf("");
  refuse(bad, {"detections", "finite"});
  bad = good;
  bad.array("instance") = Array(DType::i32, {2});
  refuse(bad, {"instance"});
}

// --- Boxes

/// The corners of all boxes drawn: ends of lines.
bool is_inside(const Shapes& shapes, const Pose& box_from_world, const dvec3& point) {
  dvec3 low(1e300), high(-1e300);
  for (const LineShape& line : shapes.lines)
    for (const dvec3& end : {line.a, line.b}) {
      low = glm::min(low, box_from_world.apply(end));
      high = glm::max(high, box_from_world.apply(end));
    }
  const dvec3 at = box_from_world.apply(point);
  for (int axis = 0; axis < 3; ++axis)
    if (at[axis] < low[axis] - 1e-6 || at[axis] > high[axis] + 1e-6) return false;
  return true;
}

const std::string box_run =
    R"({"semantic_classes": ["unlabeled", "road", "pole", "uav"],
        "instances": [{"name": "road", "class": "road", "box_m": [[0, 0, 0], [100, 8, 0]]},
                      {"name": "pole", "class": "pole", "box_m": [[3, 3, 0], [3.2, 3.2, 5]]},
                      {"name": "frame", "class": "uav", "node": "uav",
                       "box_m": [[-0.3, -0.3, -0.1], [0.3, 0.3, 0.1]]},
                      {"name": "rotor", "class": "pole", "node": "uav",
                       "box_m": [[0.2, 0.2, 0.0], [0.5, 0.5, 0.2]]},
                      {"name": "label", "class": "pole"}]})";

TEST(BoxShapes, OfInstancesFollowTheirNode) {
  const Rig rig(sensor("uav/camera", "camera"), box_run);
  const Shapes shapes = instance_box_shapes(rig.tables, &rig.at, {});
  ASSERT_EQ(shapes.lines.size(), 24u) << "the pole, and the uav as one; no road";
  Shapes uav;
  for (const LineShape& line : shapes.lines)
    if (shapes.rows[line.row].text.starts_with("uav")) uav.lines.push_back(line);
  ASSERT_EQ(uav.lines.size(), 12u);
  for (const dvec3& corner : {dvec3(-0.3, -0.3, -0.1), dvec3(0.3, 0.3, 0.1), dvec3(0.5, 0.5, 0.2)})
    EXPECT_TRUE(is_inside(uav, uav_pose.inverse(), uav_pose.apply(corner)));
  EXPECT_FALSE(is_inside(uav, uav_pose.inverse(), uav_pose.apply({0.51, 0.0, 0.0})));
  const std::string text = shapes.rows[uav.lines[0].row].text;
  EXPECT_THAT(text, HasSubstr("uav (uav)"));
  EXPECT_THAT(text, HasSubstr("0.80 x 0.80 x 0.30 m"));
  EXPECT_THAT(text, HasSubstr(fmt::format("{:.2f} m/s", glm::length(dvec3(3.0, -1.0, 0.5)))));
  EXPECT_TRUE(same(uav.lines[0].color, io::color_of_id(3)));
  EXPECT_EQ(shapes.labels.size(), 1u);
  EXPECT_THAT(legend_of(shapes), HasSubstr("objects: 2 boxes"));

  BoxOptions all;
  all.hidden_classes.clear();
  EXPECT_EQ(instance_box_shapes(rig.tables, &rig.at, all).lines.size(), 36u);
  all.most = 1;
  const Shapes one = instance_box_shapes(rig.tables, &rig.at, all);
  EXPECT_EQ(one.lines.size(), 12u);
  EXPECT_THAT(one.rows[0].text, HasSubstr("uav")) << "what moves comes first";
  EXPECT_THAT(legend_of(one), HasSubstr("the first 1 of 3 boxes"));
  EXPECT_EQ(instance_box_shapes(rig.tables, nullptr, {}).lines.size(), 12u);
  const Rig none(sensor("uav/camera", "camera"));
  EXPECT_TRUE(instance_box_shapes(none.tables, &none.at, {}).empty());
  EXPECT_THAT(legend_of(instance_box_shapes(none.tables, &none.at, {})), HasSubstr("box_m"));
}

Made camera_boxes() {
  Made made = sensor("uav/camera", "camera");
  made.add<double>("box_center", {2, 3}, {10, 20, 1, 30, 40, 2});
  made.add<double>("box_orientation", {2, 4}, {1, 0, 0, 0, std::sqrt(0.5), 0, 0, std::sqrt(0.5)});
  made.add<float>("box_size", {2, 3}, {4, 2, 1.5f, 1, 2, 3});
  made.add<float>("box_visibility", {2}, {0.75f, 0.0f});
  made.add<uint32_t>("box_instance", {2}, {3, 2});
  made.add<uint8_t>("box_semantic", {2}, {3, 2});
  made.add<int32_t>("box_node", {2}, {0, -1});
  return made;
}

TEST(BoxShapes, OfACameraAreItsTruth) {
  const Made made = camera_boxes();
  const Rig rig(made, box_run);
  const Shapes shapes = box_shapes(rig.tables, &made.spec, &made.record, &rig.at, {});
  ASSERT_EQ(shapes.lines.size(), 24u);
  Shapes second;
  second.lines.assign(shapes.lines.begin() + 12, shapes.lines.end());
  // Turned by 90 degrees: 1 m along y, 2 m along x.
  EXPECT_TRUE(is_inside(second, Pose{}, {29.0, 39.5, 0.5}));
  EXPECT_TRUE(is_inside(second, Pose{}, {31.0, 40.5, 3.5}));
  EXPECT_FALSE(is_inside(second, Pose{}, {31.1, 40.0, 2.0}));
  EXPECT_THAT(shapes.rows[shapes.lines[0].row].text, HasSubstr("uav (uav)\n4.00 x 2.00 x 1.50 m"));
  EXPECT_THAT(shapes.rows[shapes.lines[0].row].text, HasSubstr("75 % visible to uav/camera"));
  EXPECT_THAT(shapes.rows[shapes.lines[12].row].text, HasSubstr("pole (pole)"));
  EXPECT_THAT(shapes.rows[shapes.lines[12].row].text, HasSubstr("never moves"));
  EXPECT_LT(shapes.lines[12].width_px, shapes.lines[0].width_px) << "hidden";
  // The same object has the same identity by either source.
  const Shapes instances = box_shapes(rig.tables, nullptr, nullptr, &rig.at, {});
  std::set<uint64_t> a, b;
  for (const ShapeRow& row : shapes.rows) a.insert(row.id);
  for (const ShapeRow& row : instances.rows) b.insert(row.id);
  EXPECT_EQ(a, b);
}

TEST(BoxShapes, OfACameraRefuseDamage) {
  const Made good = camera_boxes();
  const Rig rig(good, box_run);
  const auto refuse = [&](const Made& made, std::initializer_list<const char*> parts) {
    expect_user_error([&] { camera_box_shapes(rig.tables, made.spec, made.record, &rig.at, {}); }, parts);
  };
  Made bad = good;
  for (const char* name :
       {"box_orientation", "box_size", "box_visibility", "box_instance", "box_semantic", "box_node"}) {
    bad = good;
    bad.array(name).shape[0] = 3;
    refuse(bad, {"uav/camera: ", name});
    bad = good;
    bad.array(name) =
        Array(DType::i64, good.spec.arrays.empty() ? std::vector<int64_t>{} : bad.array(name).shape);
    refuse(bad, {"uav/camera: ", name, "<i8"});
  }
  bad = good;
  bad.array("box_node").as<int32_t>()[0] = 1;
  refuse(bad, {"box_node", "1 in row 0"});
  bad = good;
  bad.array("box_size").as<float>()[4] = -1.0f;
  refuse(bad, {"box_size", "row 1"});
  bad = good;
  bad.array("box_orientation").as<double>()[0] = 0.0;
  refuse(bad, {"box_orientation", "row 0"});
  bad = good;
  bad.without("box_center");
  EXPECT_THAT(legend_of(camera_box_shapes(rig.tables, bad.spec, bad.record, &rig.at, {})),
              HasSubstr("add 'boxes' to its outputs"));
  EXPECT_FALSE(box_shapes(rig.tables, &bad.spec, &bad.record, &rig.at, {}).empty()) << "those of instances";
}

// --- Trajectories

constexpr int64_t tick_ns = 100'000'000;

dvec3 circle(double time_s) {
  return {100.0 + 20.0 * std::cos(time_s), 20.0 * std::sin(time_s), 2.0 * time_s};
}
std::shared_ptr<const Record> poses_at(int64_t tick) {
  const double time_s = 0.1 * static_cast<double>(tick);
  return std::make_shared<const Record>(made_poses({{"uav", {circle(time_s), dquat(1, 0, 0, 0)}, {0, 5, 0}},
                                                    {"mast", {{7, 8, 9}, dquat(1, 0, 0, 0)}}},
                                                   tick, tick * tick_ns)
                                            .record);
}

struct Flight {
  Made poses = made_poses({{"uav", {}}, {"mast", {}}});
  RecordTables tables{"{}", std::vector{poses.spec}, "test"};
  PoseHistory history;
  explicit Flight(const std::vector<int64_t>& ticks) {
    for (const int64_t tick : ticks) history.add(0, poses_at(tick));
  }
  static std::vector<int64_t> all() {
    std::vector<int64_t> ticks;
    for (int64_t tick = 0; tick <= 100; ++tick) ticks.push_back(tick);
    return ticks;
  }
};

TEST(TrajectoryShapes, PassThroughTheRecords) {
  const Flight flight(Flight::all());
  TrajectoryOptions options;
  options.past_s = 2.0;
  options.future_s = 1.0;
  const Shapes shapes = trajectory_shapes(flight.tables, flight.history, 50 * tick_ns, options);
  ASSERT_EQ(shapes.lines.size(), 30u) << "of the uav alone";
  for (int i = 0; i < 30; ++i) {
    EXPECT_EQ(shapes.lines[static_cast<size_t>(i)].a, circle(0.1 * (30 + i)));
    EXPECT_EQ(shapes.lines[static_cast<size_t>(i)].b, circle(0.1 * (31 + i)));
  }
  // What is to come is darker.
  EXPECT_LT(shapes.lines[25].color.r, shapes.lines[15].color.r);
  EXPECT_TRUE(same(shapes.lines[0].color, shapes.lines[19].color));
  // Marks at 4, 5 and 6 s (3 s begins the line), and the two nodes now.
  std::vector<dvec3> dots;
  for (const PointShape& point : shapes.points)
    if (point.mark == PointShape::Mark::dot) dots.push_back(point.at);
  ASSERT_EQ(dots.size(), 3u);
  for (int i = 0; i < 3; ++i) EXPECT_LT(glm::distance(dots[static_cast<size_t>(i)], circle(4.0 + i)), 1e-12);
  ASSERT_EQ(shapes.labels.size(), 2u);
  EXPECT_EQ(shapes.labels[0].text, "uav");
  EXPECT_EQ(shapes.labels[0].at, circle(5.0));
  EXPECT_EQ(shapes.labels[1].at, dvec3(7, 8, 9));
  EXPECT_THAT(legend_of(shapes), HasSubstr("trajectories: 3.00 to 6.00 s"));
}

TEST(TrajectoryShapes, HaveNoLineWhereNothingIsKnown) {
  std::vector<int64_t> ticks = Flight::all();
  std::erase_if(ticks, [](int64_t tick) { return tick > 20 && tick < 60; });
  const Flight flight(ticks);
  const Shapes shapes = trajectory_shapes(flight.tables, flight.history, 30 * tick_ns, {});
  EXPECT_EQ(shapes.lines.size(), 60u);
  for (const LineShape& line : shapes.lines) EXPECT_LT(glm::distance(line.a, line.b), 3.0);
  EXPECT_THAT(legend_of(shapes), HasSubstr("1 gaps"));
  EXPECT_EQ(shapes.labels[0].at, circle(2.0)) << "the last that is known";
}

TEST(TrajectoryShapes, AreThinnedAndSaySo) {
  const Flight flight(Flight::all());
  TrajectoryOptions options;
  options.most_lines = 30;
  const Shapes shapes = trajectory_shapes(flight.tables, flight.history, 50 * tick_ns, options);
  EXPECT_LE(shapes.lines.size(), 32u);
  EXPECT_GE(shapes.lines.size(), 25u);
  EXPECT_EQ(shapes.lines.front().a, circle(0.0));
  EXPECT_EQ(shapes.lines.back().b, circle(10.0));
  EXPECT_EQ(shapes.labels[0].at, circle(5.0));
  EXPECT_THAT(legend_of(shapes), HasSubstr("one record in 4"));
}

TEST(TrajectoryShapes, OfNothingOrOneRecord) {
  const Flight none({});
  EXPECT_TRUE(trajectory_shapes(none.tables, none.history, 0, {}).empty());
  EXPECT_THAT(legend_of(trajectory_shapes(none.tables, none.history, 0, {})), HasSubstr("no poses"));
  const Flight one({3});
  const Shapes shapes = trajectory_shapes(one.tables, one.history, 3 * tick_ns, {});
  EXPECT_TRUE(shapes.lines.empty());
  EXPECT_EQ(shapes.labels.size(), 2u);
  TrajectoryOptions few;
  few.most_labels = 1;
  const Shapes fewer = trajectory_shapes(one.tables, one.history, 3 * tick_ns, few);
  EXPECT_EQ(fewer.labels.size(), 1u);
  EXPECT_THAT(legend_of(fewer), HasSubstr("1 more nodes without a name"));
}

TEST(TrajectoryShapes, RefuseDamagedRecords) {
  Flight flight({1, 2});
  Record bad = *poses_at(3);
  bad.arrays[0] = Array(DType::f64, {3, 3});
  flight.history.add(0, std::make_shared<const Record>(bad));
  expect_user_error([&] { trajectory_shapes(flight.tables, flight.history, 0, {}); },
                    {"poses: position, tick 3", "[2, 3]"});
}

TEST(PoseHistory, KeepsOneSequenceWithinItsBound) {
  PoseHistory history;
  EXPECT_EQ(history.at_or_before(5), nullptr);
  for (const int64_t tick : {4, 2, 8, 4}) history.add(0, poses_at(tick));
  EXPECT_EQ(history.size(), 3u);
  EXPECT_EQ(history.at(2)->tick, 2);
  EXPECT_EQ(history.at(3), nullptr);
  EXPECT_EQ(history.at_or_before(7)->tick, 4);
  EXPECT_EQ(history.at_or_before(1), nullptr);
  EXPECT_EQ(history.between(3 * tick_ns, 8 * tick_ns).size(), 2u);
  history.add(1, poses_at(1));
  EXPECT_EQ(history.size(), 1u);
  const uint64_t one = history.bytes();
  PoseHistory bounded(10 * one);
  for (int64_t tick = 0; tick < 100; ++tick) bounded.add(0, poses_at(tick));
  EXPECT_EQ(bounded.size(), 10u);
  EXPECT_EQ(bounded.bytes(), 10 * one);
  EXPECT_EQ(bounded.at(90)->tick, 90) << "the last ten";
  bounded.add(0, poses_at(0));  // a jump back
  EXPECT_EQ(bounded.at(99), nullptr);
  EXPECT_NE(bounded.at(0), nullptr);
}

// --- Sensors

nlohmann::json pinhole() {
  return {{"width", 640}, {"height", 480}, {"fx", 500.0}, {"fy", 520.0}, {"cx", 330.0}, {"cy", 225.0}};
}

TEST(SensorShapes, FrustaEndAtThePicturesCorners) {
  const Made made = sensor("uav/camera", "camera", pinhole());
  const Rig rig(made);
  SensorOptions options;
  options.frustum_m = 7.0;
  const Shapes shapes = sensor_shapes(rig.tables, &rig.at, options);
  const Pose sensor_from_world = (uav_pose * sensor_mount).inverse();
  std::set<std::pair<int, int>> corners;
  for (const LineShape& line : shapes.lines) {
    if (glm::distance(line.a, (uav_pose * sensor_mount).position) > 1e-9) continue;
    const dvec3 at = sensor_from_world.apply(line.b);  // x forward, y left, z up
    EXPECT_NEAR(at.x, 7.0, 1e-6);
    const double u = 330.0 + 500.0 * -at.y / at.x, v = 225.0 + 520.0 * -at.z / at.x;
    EXPECT_NEAR(u, std::round(u), 1e-5);
    corners.insert({static_cast<int>(std::lround(u)), static_cast<int>(std::lround(v))});
  }
  EXPECT_EQ(corners, (std::set<std::pair<int, int>>{{0, 0}, {640, 0}, {640, 480}, {0, 480}}));
  EXPECT_THAT(shapes.rows.at(0).text, HasSubstr("640 x 480 pixels"));
  EXPECT_THAT(shapes.rows.at(0).text, Not(HasSubstr("distortion")));
  EXPECT_EQ(shapes.labels.at(0).text, "uav/camera");
  nlohmann::json lens = pinhole();
  lens["distortion"] = {{"k1", -0.1}};
  const Made distorted = sensor("uav/camera", "camera", lens);
  const Rig other(distorted);
  EXPECT_THAT(sensor_shapes(other.tables, &other.at, {}).rows.at(0).text, HasSubstr("distortion"));
  EXPECT_EQ(pixel_ray({640, 480, 500, 520, 330, 225, 0, false, {}}, 330, 225), dvec3(1, 0, 0));
}

TEST(SensorShapes, AxesAreThoseOfTheSensor) {
  const Made made = sensor("uav/lidar", "lidar");
  const Rig rig(made);
  SensorOptions options;
  options.axis_m = 2.0;
  const Shapes shapes = sensor_shapes(rig.tables, &rig.at, options);
  ASSERT_EQ(shapes.lines.size(), 3u);
  const Pose world = uav_pose * sensor_mount;
  for (int axis = 0; axis < 3; ++axis) {
    dvec3 unit(0.0);
    unit[axis] = 1.0;
    const LineShape& line = shapes.lines[static_cast<size_t>(axis)];
    EXPECT_LT(glm::distance(line.b - line.a, 2.0 * world.rotate(unit)), 1e-6);
    EXPECT_TRUE(line.arrow);
  }
  EXPECT_TRUE(sensor_shapes(rig.tables, nullptr, {}).empty());
}

Made channel_of(const std::vector<nlohmann::json>& ends) {
  Made made;
  made.spec.name = "csi";
  made.spec.kind = "csi";
  made.spec.metadata_json =
      nlohmann::json{{"carrier_hz", 3.5e9}, {"transmitters", ends}, {"receivers", ends}}.dump();
  return made;
}

TEST(SensorShapes, AntennasAreTheirElementsAndTheirPattern) {
  nlohmann::json panel{{"name", "uav/panel"},
                       {"pattern", "tr38901"},
                       {"polarization", "slant"},
                       {"plane", "yz"},
                       {"rows", 2},
                       {"columns", 4},
                       {"row_spacing_m", 0.04},
                       {"column_spacing_m", 0.04},
                       {"body_from_antenna", json_of(sensor_mount)}};
  const Made made = channel_of({panel});
  const Rig rig(made);
  SensorOptions options;
  options.pattern_m = 3.0;
  const Shapes shapes = sensor_shapes(rig.tables, &rig.at, options);
  EXPECT_EQ(shapes.points.size(), 8u) << "an antenna at both ends is drawn once";
  const Pose antenna_from_world = (uav_pose * sensor_mount).inverse();
  for (const PointShape& point : shapes.points) EXPECT_NEAR(antenna_from_world.apply(point.at).x, 0.0, 1e-6);
  EXPECT_NEAR(glm::distance(shapes.points[0].at, shapes.points[1].at), 0.04, 1e-6);
  // The tip is on boresight. TR 38.901: 12 (65/65)^2 = 12 dB less at 65 degrees, so 1 - 12/30 of the length.
  double farthest = 0.0, behind = 0.0;
  for (const LineShape& line : shapes.lines)
    for (const dvec3& end : {line.a, line.b}) {
      const dvec3 at = antenna_from_world.apply(end);
      const double across = std::hypot(at.x, at.y), zenith = std::atan2(across, at.z);
      const double azimuth = across < 1e-6 ? 0.0 : std::atan2(at.y, at.x);  // 0 on the z axis
      if (glm::length(at) > farthest) farthest = glm::length(at);
      if (at.x < 0.0) behind = std::max(behind, glm::length(at));
      if (glm::length(at) < 1e-3) continue;
      const double down = std::min(std::min(12.0 * std::pow((degrees(zenith) - 90.0) / 65.0, 2.0), 30.0) +
                                       std::min(12.0 * std::pow(degrees(azimuth) / 65.0, 2.0), 30.0),
                                   30.0);
      EXPECT_NEAR(glm::length(at), 3.0 * (1.0 - down / 30.0), 1e-6);
    }
  EXPECT_NEAR(farthest, 3.0, 1e-6);
  EXPECT_LT(behind, 0.7);
  EXPECT_THAT(shapes.rows.at(0).text, HasSubstr("largest gain of an element 8.00 dBi"));
  EXPECT_THAT(shapes.rows.at(0).text, HasSubstr("8 elements, 16 ports"));
  options.patterns = false;
  EXPECT_TRUE(sensor_shapes(rig.tables, &rig.at, options).lines.empty());
}

TEST(SensorShapes, AreBoundedAndSaySo) {
  std::vector<nlohmann::json> ends;
  for (int i = 0; i < 30; ++i)
    ends.push_back({{"name", fmt::format("uav/antenna{}", i)},
                    {"pattern", "isotropic"},
                    {"polarization", "v"},
                    {"plane", "yz"},
                    {"rows", i == 0 ? 256 : 1},
                    {"columns", i == 0 ? 256 : 1},
                    {"row_spacing_m", 0.01},
                    {"column_spacing_m", 0.01}});
  ends.push_back({{"name", "ghost/antenna"}});
  const Made made = channel_of(ends);
  const Rig rig(made);
  const Shapes shapes = sensor_shapes(rig.tables, &rig.at, {});
  EXPECT_LE(shapes.points.size(), 4096u + 29u);
  EXPECT_THAT(shapes.rows.at(0).text, HasSubstr("one element in 16"));
  EXPECT_THAT(legend_of(shapes), HasSubstr("14 more without their patterns"));
  EXPECT_THAT(legend_of(shapes), HasSubstr("1 that the poses do not place"));
}

}  // namespace
}  // namespace greatx::view
