// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Navigation in closed form.
#include "view/camera/viewpoint.h"

#include <gtest/gtest.h>

#include "core/units.h"

namespace greatx::view {
namespace {

void expect_near(const dvec3& a, const dvec3& b, double tolerance = 1e-9) {
  EXPECT_LT(glm::length(a - b), tolerance) << a.x << ' ' << a.y << ' ' << a.z;
}

TEST(Viewpoint, AxesAreThoseOfItsOrientation) {
  const Viewpoint point({1, 2, 3}, radians(30), radians(20), 10);
  const apps::PictureView view = point.picture_view({0, 0, 0}, 640, 480, radians(50));
  expect_near(view.local_from_sensor.rotate({1, 0, 0}), point.forward());
  expect_near(view.local_from_sensor.rotate({0, 1, 0}), point.left());
  expect_near(view.local_from_sensor.rotate({0, 0, 1}), point.up());
  EXPECT_LT(point.forward().z, 0.0);  // pitch is positive downwards
}

TEST(Viewpoint, ThePivotIsInTheMiddleOfThePicture) {
  const dvec3 origin(4.5e5, 5.4e6, 30);
  const Viewpoint point(origin + dvec3(1, 2, 3), radians(130), radians(-20), 25);
  const apps::PictureView view = point.picture_view(origin, 640, 480, radians(50));
  const dvec3 pixel = view.project(point.pivot() - origin);
  EXPECT_NEAR(pixel.x, 320.0, 1e-6);
  EXPECT_NEAR(pixel.y, 240.0, 1e-6);
  EXPECT_NEAR(pixel.z, 25.0, 1e-6);
}

TEST(Viewpoint, OrbitKeepsThePivotAndTheDistance) {
  Viewpoint point({10, 0, 5}, 0.3, 0.2, 12);
  const dvec3 pivot = point.pivot();
  for (int i = 0; i < 50; ++i) {
    point.orbit(0.37, i % 2 == 0 ? 0.4 : -0.3);
    expect_near(point.pivot(), pivot, 1e-9);
    EXPECT_NEAR(glm::length(point.position() - pivot), 12.0, 1e-9);
    EXPECT_LE(std::abs(point.pitch()), radians(89) + 1e-12);
  }
}

TEST(Viewpoint, APanFollowsTheCursor) {
  Viewpoint point({0, 0, 10}, 0.7, 0.4, 20);
  const apps::PictureView before = point.picture_view({0, 0, 0}, 800, 600, radians(50));
  const dvec3 pivot = point.pivot();
  point.pan({35, -20}, before.fx);
  const apps::PictureView after = point.picture_view({0, 0, 0}, 800, 600, radians(50));
  const dvec3 pixel = after.project(pivot);
  EXPECT_NEAR(pixel.x, 400.0 + 35.0, 1e-6);
  EXPECT_NEAR(pixel.y, 300.0 - 20.0, 1e-6);
}

TEST(Viewpoint, ApproachKeepsThePivotAndStops) {
  Viewpoint point({0, 0, 10}, 0.7, 0.4, 20);
  const dvec3 pivot = point.pivot();
  point.approach(0.5);
  EXPECT_NEAR(point.distance_m(), 10.0, 1e-12);
  expect_near(point.pivot(), pivot);
  for (int i = 0; i < 200; ++i) point.approach(0.5);
  EXPECT_GT(point.distance_m(), 0.01);
  expect_near(point.pivot(), pivot);
}

TEST(Viewpoint, FromOutsideTheWholeSceneIsInThePicture) {
  const scene::Bounds bounds{{-100, 20, 0}, {60, 90, 35}};
  const Viewpoint point = Viewpoint::outside(bounds);
  const apps::PictureView view = point.picture_view({0, 0, 0}, 640, 480, radians(50));
  for (int i = 0; i < 8; ++i) {
    const dvec3 corner(i & 1 ? bounds.max.x : bounds.min.x, i & 2 ? bounds.max.y : bounds.min.y,
                       i & 4 ? bounds.max.z : bounds.min.z);
    const dvec3 pixel = view.project(corner);
    EXPECT_GT(pixel.z, view.near_m);
    EXPECT_GT(pixel.x, -160.0);
    EXPECT_LT(pixel.x, 800.0);
    EXPECT_GT(pixel.y, 0.0);
    EXPECT_LT(pixel.y, 480.0);
  }
}

TEST(Viewpoint, FliesAlongItsAxesAndTheWorldsUp) {
  Viewpoint point({0, 0, 0}, radians(90), 0.0, 5);
  point.fly({2, 0, 0});
  expect_near(point.position(), {0, 2, 0});
  point.fly({0, 1, 0});
  expect_near(point.position(), {-1, 2, 0});
  point.fly({0, 0, 3});
  expect_near(point.position(), {-1, 2, 3});
}

}  // namespace
}  // namespace greatx::view
