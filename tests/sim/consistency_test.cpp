// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/compare/consistency.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "sim/compare/error_statistics.h"

namespace greatx::sim {
namespace {

render::CameraDesc camera() {
  render::CameraDesc desc;
  desc.width = 40;
  desc.height = 30;
  desc.fx = desc.fy = 20.0;
  desc.cx = 20.0;
  desc.cy = 15.0;
  return desc;
}

/// Returns the planar depth of the plane n . p = d (sensor frame) at each pixel's centre.
render::CameraImages picture_of_plane(const dvec3& normal, double d) {
  const render::CameraDesc desc = camera();
  render::CameraImages images;
  images.width = desc.width;
  images.height = desc.height;
  for (uint32_t row = 0; row < desc.height; ++row)
    for (uint32_t column = 0; column < desc.width; ++column) {
      images.depth.push_back(
          static_cast<float>(d / glm::dot(normal, pixel_ray(desc, column + 0.5, row + 0.5))));
      images.instance.push_back(1);
      images.material.push_back(3);
    }
  return images;
}

TEST(InteriorPlane, ATiltedPlaneIsInteriorEverywhereButAtTheBorder) {
  const render::CameraImages images = picture_of_plane(glm::normalize(dvec3(1, 0.2, -0.1)), 12.0);
  EXPECT_FALSE(interior_plane(images, 0, 5));
  EXPECT_FALSE(interior_plane(images, 39, 5));
  for (uint32_t row = 1; row < 29; ++row)
    for (uint32_t column = 1; column < 39; ++column) EXPECT_TRUE(interior_plane(images, column, row));
}

TEST(InteriorPlane, EdgesSkyAndOtherInstancesAreNot) {
  render::CameraImages images = picture_of_plane({1, 0, 0}, 10.0);
  const auto at = [&](uint32_t column, uint32_t row) { return size_t{row} * images.width + column; };
  images.depth[at(10, 10)] = 11.0f;
  EXPECT_FALSE(interior_plane(images, 11, 11));
  images.depth[at(20, 10)] = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(interior_plane(images, 21, 10));
  images.instance[at(30, 10)] = 2;
  EXPECT_FALSE(interior_plane(images, 29, 9));
  EXPECT_TRUE(interior_plane(images, 15, 20));
}

TEST(LidarAgainstDepth, BetweenPixelCentresThePlaneIsExact) {
  const dvec3 normal = glm::normalize(dvec3(1, 0.3, 0.2));
  const render::CameraImages images = picture_of_plane(normal, 9.0);
  const dvec3 ray = pixel_ray(camera(), 17.83, 11.29);
  const dvec3 point = ray * (9.0 / glm::dot(normal, ray));
  const auto error = lidar_against_depth(camera(), images, {point, 1, 3});
  ASSERT_TRUE(error);
  EXPECT_LT(*error, 1e-6);
  // The error of a return 1 cm behind the surface is 1 cm.
  const auto wrong = lidar_against_depth(camera(), images, {point * (1.0 + 0.01 / point.x), 1, 3});
  ASSERT_TRUE(wrong);
  EXPECT_NEAR(*wrong, 0.01 / point.x, 1e-4);
  EXPECT_FALSE(lidar_against_depth(camera(), images, {point, 2, 3})) << "another instance";
  EXPECT_FALSE(lidar_against_depth(camera(), images, {-point, 1, 3})) << "behind the camera";
  EXPECT_FALSE(lidar_against_depth(camera(), images, {point, 1, 4})) << "behind a pane of another material";
}

TEST(LidarAgainstDepth, NoiseAlongTheBeamAccountsForAsMuchAsItCan) {
  const dvec3 normal = glm::normalize(dvec3(1, 0.3, 0.2));
  const render::CameraImages images = picture_of_plane(normal, 9.0);
  const dvec3 ray = pixel_ray(camera(), 17.83, 11.29), beam = glm::normalize(ray);
  const dvec3 point = ray * (9.0 / glm::dot(normal, ray));
  const auto error = [&](double off_m, double bound_m) {
    return lidar_against_depth(camera(), images, {point + off_m * beam, 1, 3, 0.0, beam, bound_m});
  };
  // Within the bound everything is explained; beyond it, what is left is the way beyond it: with n d = k a way
  // of s changes the depth by k s / (1 + k s), and the bound explains k e / (1 - k e).
  for (const double off_m : {-0.199, -0.1, 0.0, 0.1, 0.199}) {
    ASSERT_TRUE(error(off_m, 0.2));
    EXPECT_LT(*error(off_m, 0.2), 1e-6) << off_m;
  }
  ASSERT_TRUE(error(0.3, 0.2));
  const double k = glm::dot(normal, beam) / 9.0;
  EXPECT_NEAR(*error(0.3, 0.2), 0.3 * k / (1.0 + 0.3 * k) - 0.2 * k / (1.0 - 0.2 * k), 1e-6);
  // A beam from the side moves the point over the picture: not compared.
  EXPECT_FALSE(lidar_against_depth(camera(), images, {point, 1, 3, 0.0, {0, 1, 0}, 1.0}));
  EXPECT_NEAR(RangeNoise({0.01, 0.3, 1e-9}).bound_m(1e-8), 6.0 * std::hypot(0.01, 0.03), 1e-12);
  EXPECT_EQ(RangeNoise({}).bound_m(1e-8), 0.0);
}

TEST(ErrorStatistics, BoundsQuantiles) {
  ErrorStatistics statistics;
  EXPECT_EQ(statistics.quantile(0.99), 0.0);
  for (int i = 1; i <= 1000; ++i) statistics.add(i * 1e-6);
  EXPECT_EQ(statistics.count(), 1000u);
  EXPECT_DOUBLE_EQ(statistics.max(), 1e-3);
  EXPECT_GE(statistics.quantile(0.5), 500e-6);
  EXPECT_LE(statistics.quantile(0.5), 500e-6 * 1.26);
  ErrorStatistics outlier;
  outlier.add(0.5);
  outlier.add(0.0);
  statistics.add(outlier);
  EXPECT_DOUBLE_EQ(statistics.max(), 0.5);
  EXPECT_LE(statistics.quantile(0.99), 1e-3 * 1.26);
}

TEST(ProbePixels, LieInThePictureAndSpread) {
  const auto pixels = probe_pixels(64, 48, 256);
  int left = 0;
  for (const glm::uvec2& pixel : pixels) {
    EXPECT_LT(pixel.x, 64u);
    EXPECT_LT(pixel.y, 48u);
    left += pixel.x < 32;
  }
  EXPECT_NEAR(left, 128, 16);
}

}  // namespace
}  // namespace greatx::sim
