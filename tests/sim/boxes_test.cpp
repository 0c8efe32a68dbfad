// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Compares boxes with projected vertices and with rays in fp64. Compares how much of an object is visible
// with closed forms and with counted pixels.
#include "sim/sensors/camera/boxes.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/sim/box_crowd.h"

namespace greatx::sim {
namespace {

TEST(Boxes, AreTheBoundsOfProjectedVertices) {
  const CameraDesc desc = box_camera();
  Crowd around = crowd(60, 6, 60);
  const scene::Scene scene = labelled(around.tiny);
  Boxes boxes(scene, desc, {});
  ASSERT_EQ(boxes.objects().size(), 60u);
  const Pose camera = look({0.3, -0.2, 0.1}, 4, 3, 2);
  const std::vector<ObjectBox> found = boxes.find(camera, around.bodies, nothing(desc));
  EXPECT_GT(found.size(), 20u);
  int cut = 0;
  for (const ObjectBox& box : found) {
    const Boxes::Object& object = boxes.objects()[box.object];
    dvec4 bounds(1e300, 1e300, -1e300, -1e300);
    for (const dvec3& vertex : object.vertices) {
      const dvec3 p = projected(desc, camera, around.bodies[object.body].apply(vertex));
      bounds = {std::min(bounds.x, p.x), std::min(bounds.y, p.y), std::max(bounds.z, p.x),
                std::max(bounds.w, p.y)};
    }
    for (int side = 0; side < 4; ++side) {
      EXPECT_NEAR(box.unclipped[side], bounds[side], 1e-9);
      EXPECT_NEAR(box.amodal[side], std::clamp(bounds[side], 0.0, side % 2 == 0 ? 96.0 : 64.0), 1e-9);
    }
    const double inside = (box.amodal.z - box.amodal.x) * (box.amodal.w - box.amodal.y),
                 whole = (bounds.z - bounds.x) * (bounds.w - bounds.y);
    EXPECT_NEAR(box.truncation(), 1.0 - inside / whole, 1e-9);
    cut += box.truncation() > 0.01 ? 1 : 0;
    EXPECT_FALSE(box.crosses_near);
    EXPECT_EQ(box.visible, 0u);
    EXPECT_EQ(box.visibility(), 0.0);
    // The corners of the 3-D box are the vertices.
    const Pose local_from_box = box.world_from_box;
    for (const dvec3& vertex : object.vertices) {
      const dvec3 in_box = local_from_box.inverse().apply(around.bodies[object.body].apply(vertex));
      for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(std::abs(in_box[axis]), 0.5 * object.size[axis], 1e-6);
      const dvec3 in_sensor = box.sensor_from_box.apply(in_box);
      EXPECT_LT(glm::length(camera.apply(in_sensor) - around.bodies[object.body].apply(vertex)), 1e-9);
    }
  }
  EXPECT_GT(cut, 2);
}

TEST(Boxes, CountThePixelsWhoseRaysMeetTheObject) {
  const CameraDesc desc = box_camera();
  Crowd around = crowd(40, 1, 30);
  const scene::Scene scene = labelled(around.tiny);
  Boxes boxes(scene, desc, {});
  for (const Pose& camera : {look({0, 0, 0}), look({3, 1, 0.5}, 20, -5, 70)}) {
    const std::vector<ObjectBox> found = boxes.find(camera, around.bodies, nothing(desc));
    size_t at = 0, near = 0;
    for (uint32_t i = 0; i < boxes.objects().size(); ++i) {
      const Boxes::Object& object = boxes.objects()[i];
      const uint32_t expected = rays_that_meet(object, around.bodies[object.body], desc, camera);
      const bool is_found = at < found.size() && found[at].object == i;
      ASSERT_EQ(is_found, expected > 0) << i;
      if (!is_found) continue;
      EXPECT_EQ(found[at].alone, expected) << i;
      near += found[at].crosses_near ? 1 : 0;
      ++at;
    }
    EXPECT_EQ(at, found.size());
    EXPECT_GT(at, 10u);
  }
}

TEST(Boxes, OfWhatCrossesTheNearPlaneReachToIt) {
  CameraDesc desc = box_camera();
  desc.near_m = 0.25;
  TinyScene tiny;
  // A plank below the camera that reaches from behind the camera to ahead of it.
  tiny.object("plank").quad({-5, -0.5, -1.5}, {8, -0.5, -1.5}, {8, 0.5, -1.5}, {-5, 0.5, -1.5});
  const scene::Scene scene = labelled(tiny);
  Boxes boxes(scene, desc, {});
  const std::vector<ObjectBox> found = boxes.find(look({0, 0, 0}), std::vector<Pose>(1), nothing(desc));
  ASSERT_EQ(found.size(), 1u);
  const ObjectBox& box = found[0];
  EXPECT_TRUE(box.crosses_near);
  EXPECT_NEAR(box.unclipped.x, desc.cx - desc.fx * 0.5 / 0.25, 1e-9);
  EXPECT_NEAR(box.unclipped.y, desc.cy + desc.fy * 1.5 / 8.0, 1e-9);
  EXPECT_NEAR(box.unclipped.z, desc.cx + desc.fx * 0.5 / 0.25, 1e-9);
  EXPECT_NEAR(box.unclipped.w, desc.cy + desc.fy * 1.5 / 0.25, 1e-9);
  EXPECT_NEAR(box.amodal.w, 64.0, 0.0);
  EXPECT_EQ(box.alone, rays_that_meet(boxes.objects()[0], {}, desc, look({0, 0, 0})));
}

TEST(Boxes, OfWhatIsBehindTheCameraAreNone) {
  const CameraDesc desc = box_camera();
  TinyScene tiny;
  tiny.object("behind").box({-9, -1, -1}, {-7, 1, 1});
  tiny.object("beside").box({1, 30, -1}, {2, 32, 1});
  tiny.object("far", 0).box({1e5, 0, 0}, {1e5 + 0.1, 0.1, 0.1});  // covers no pixel's centre
  const scene::Scene scene = labelled(tiny);
  Boxes boxes(scene, desc, {});
  EXPECT_TRUE(boxes.find(look({0, 0, 0}), std::vector<Pose>(1), nothing(desc)).empty());
}

TEST(Boxes, OfWhatIsLargerThanThePictureFillIt) {
  const CameraDesc desc = box_camera();
  TinyScene tiny;
  tiny.object("wall").quad({5, 50, -50}, {5, -50, -50}, {5, -50, 50}, {5, 50, 50});
  const scene::Scene scene = labelled(tiny);
  Boxes boxes(scene, desc, {});
  std::vector<uint32_t> all(96 * 64, 1);
  const std::vector<ObjectBox> found = boxes.find(look({0, 0, 0}), std::vector<Pose>(1), all);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].amodal, dvec4(0, 0, 96, 64));
  EXPECT_EQ(found[0].modal, (std::array<int32_t, 4>{0, 0, 96, 64}));
  EXPECT_EQ(found[0].alone, 96u * 64u);
  EXPECT_EQ(found[0].visibility(), 1.0);
  EXPECT_NEAR(found[0].truncation(), 1.0 - 96.0 * 64.0 / (desc.fx * 20.0 * desc.fy * 20.0), 1e-9);
}

TEST(Boxes, ASquareHalfHiddenIsHalfVisible) {
  CameraDesc desc = box_camera(64, 64);
  desc.fx = desc.fy = desc.cx = desc.cy = 32.0;
  TinyScene tiny;
  // The square covers 16 x 16 pixels at 8 m. A board at 4 m hides its left half.
  tiny.object("square").quad({8, 2, -2}, {8, -2, -2}, {8, -2, 2}, {8, 2, 2});
  tiny.object("board").quad({4, 2, -2}, {4, 0, -2}, {4, 0, 2}, {4, 2, 2});
  scene::Scene scene = labelled(tiny);
  Boxes boxes(scene, desc, {});
  test::CameraRig rig(scene, test::plain_light(), desc);
  const Pose camera = look({0, 0, 0});
  const std::vector<ObjectBox> found = boxes.find(camera, std::vector<Pose>(1), rig.shoot(camera).instance);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].alone, 256u);
  EXPECT_EQ(found[0].visible, 128u);
  EXPECT_EQ(found[0].visibility(), 0.5);
  EXPECT_EQ(found[0].amodal, dvec4(24, 24, 40, 40));
  EXPECT_EQ(found[0].modal, (std::array<int32_t, 4>{32, 24, 40, 40}));
  EXPECT_EQ(found[1].visibility(), 1.0);
  EXPECT_EQ(found[1].alone, 16u * 32u);
}

/// Compares each object's pixels in the picture with a picture of the object alone by the same rasteriser.
TEST(Boxes, VisibilityAgainstPicturesOfEachObjectAlone) {
  const CameraDesc desc = box_camera();
  const Crowd around = crowd(30, 4, 25);
  const scene::Scene scene = labelled(around.tiny);
  Boxes boxes(scene, desc, {});
  const Pose camera = look({0, 0, 0}, 3, 2, 1);
  test::CameraRig rig(scene, test::plain_light(), desc);
  const std::vector<Pose> moving(around.bodies.begin() + 1, around.bodies.end());
  const render::CameraImages all = rig.shoot(camera, moving);
  const std::vector<ObjectBox> found = boxes.find(camera, around.bodies, all.instance);
  EXPECT_GT(found.size(), 10u);
  int partly = 0;
  for (const ObjectBox& box : found) {
    const Boxes::Object& object = boxes.objects()[box.object];
    const uint32_t id = object.first_instance + 1;
    std::vector<Pose> alone(moving.size(), look({-1000, 0, 0}));
    alone[object.body - 1] = moving[object.body - 1];
    const std::vector<uint32_t> picture = rig.shoot(camera, alone).instance;
    const auto count = [&](const std::vector<uint32_t>& ids) { return std::ranges::count(ids, id); };
    EXPECT_EQ(box.visible, count(all.instance));
    // The rasteriser snaps vertices to 1/256 pixel, so that a pixel at the rim may fall to either side.
    EXPECT_NEAR(box.alone, static_cast<double>(count(picture)), 2.0);
    EXPECT_GE(box.alone, box.visible);
    EXPECT_GE(box.visibility(), 0.0);
    EXPECT_LE(box.visibility(), 1.0);
    partly += box.visibility() > 0.0 && box.visibility() < 0.99 ? 1 : 0;
  }
  EXPECT_GT(partly, 3);
  // Every id in the picture has a box.
  for (const uint32_t id : all.instance)
    EXPECT_TRUE(id == 0 || std::ranges::any_of(found, [&](const ObjectBox& box) {
                  return boxes.objects()[box.object].first_instance + 1 == id;
                }));
}

TEST(Boxes, PartsOfABodyAreOneObjectAndClassesChoose) {
  TinyScene tiny;
  const uint32_t car = tiny.body("car"), own = tiny.body("own");
  tiny.object("house").box({10, 5, 0}, {14, 9, 8});
  tiny.object("lamp").box({9, -3, 0}, {9.2, -2.8, 5});
  tiny.object("chassis", car).box({-2, -1, 0}, {2, 1, 1});
  tiny.object("roof", car).box({-1, -0.9, 1}, {1, 0.9, 1.5});
  tiny.object("bonnet", own).box({0.5, -1, -1}, {1, 1, -0.5});
  scene::Scene scene = tiny.build();
  using enum scene::SemanticClass;
  const scene::SemanticClass classes[] = {building, street_lamp, vehicle, vehicle, vehicle};
  for (size_t i = 0; i < 5; ++i) scene.instances[i].semantic_class = classes[i];
  CameraDesc desc = box_camera();
  desc.excluded_body = own;
  {
    Boxes boxes(scene, desc, {});
    ASSERT_EQ(boxes.objects().size(), 2u);
    EXPECT_EQ(boxes.objects()[0].first_instance, 1u);
    const Boxes::Object& object = boxes.objects()[1];
    EXPECT_EQ(object.first_instance, 2u);
    EXPECT_EQ(object.instance_count, 2u);
    EXPECT_EQ(object.semantic_class, vehicle);
    EXPECT_EQ(object.size, dvec3(4, 2, 1.5));
    EXPECT_EQ(object.body_from_box.position, dvec3(0, 0, 0.75));
    std::vector<uint32_t> ids = nothing(desc);
    ids[0] = 3, ids[1] = 4, ids[2] = 1, ids[96] = 4;  // chassis, roof, house
    const std::vector<ObjectBox> found =
        boxes.find(look({0, 0, 1}), std::vector<Pose>{{}, look({12, 0, 0}, 30), {}}, ids);
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[1].visible, 3u);
    EXPECT_EQ(found[1].modal, (std::array<int32_t, 4>{0, 0, 2, 2}));
    EXPECT_NEAR(glm::length(found[1].world_from_box.position - dvec3(12, 0, 0.75)), 0.0, 1e-12);
  }
  const std::vector<std::string> wanted{"building"};
  Boxes boxes(scene, desc, wanted);
  ASSERT_EQ(boxes.objects().size(), 1u);
  EXPECT_EQ(boxes.objects()[0].first_instance, 0u);
}

TEST(Boxes, OfUtmCoordinatesAreThoseOfTheOrigin) {
  const CameraDesc desc = box_camera();
  const dvec3 utm(448320.0, 5411904.0, 128.0);
  const auto make = [&](const dvec3& at) {
    TinyScene tiny;
    tiny.object("crate").box(at + dvec3(5, -1, -1), at + dvec3(7, 0.5, 1));
    return labelled(tiny, scene::SemanticClass::furniture, at);
  };
  const scene::Scene a = make(dvec3(0.0)), b = make(utm);
  Boxes here(a, desc, {}), there(b, desc, {});
  const ObjectBox x = here.find(look({0, 0, 0}), std::vector<Pose>(1), nothing(desc)).at(0),
                  y = there.find(look({0, 0, 0}), std::vector<Pose>(1), nothing(desc)).at(0);
  EXPECT_EQ(x.unclipped, y.unclipped);
  EXPECT_EQ(x.alone, y.alone);
  EXPECT_LT(glm::length(y.world_from_box.position - x.world_from_box.position - utm), 1e-8);
  EXPECT_EQ(x.sensor_from_box.position, y.sensor_from_box.position);
}

}  // namespace
}  // namespace greatx::sim
