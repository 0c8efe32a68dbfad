// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/light/sky_view.h"

#include <cmath>

#include <glm/gtc/packing.hpp>
#include <gtest/gtest.h>

#include "tests/support/tiny_scene.h"

namespace greatx::test {
namespace {

/// Returns two rows of houses along y, `height` m high and `street` m apart, on cells of one metre.
render::HeightField canyon(double street, double height) {
  render::HeightField field;
  field.width = field.height = 401;
  field.heights.assign(size_t{401} * 401, 0.0f);
  for (uint32_t row = 0; row < 401; ++row)
    for (uint32_t column = 0; column < 401; ++column)
      if (std::abs(double(column) - 200.0) > 0.5 * street)
        field.heights[size_t{row} * 401 + column] = float(height);
  return field;
}

TEST(SkyView, CanyonHasTheShareOfItsClosedForm) {
  // T. Oke, "Canyon geometry and the nocturnal urban heat island" (1981): the share is cos(atan(2 H / W)) in
  // the middle of the floor.
  for (const auto& [street, height] : {std::pair(20.0, 10.0), std::pair(20.0, 20.0), std::pair(40.0, 10.0)}) {
    const double expected = 1.0 / std::sqrt(1.0 + std::pow(2.0 * height / street, 2.0));
    // docs/light.md states this error.
    EXPECT_NEAR(render::sky_share(canyon(street, height), 200, 200, 0.0), expected, 0.06)
        << street << " " << height;
  }
}

TEST(SkyView, GrowsWithHeightToTheWholeSky) {
  const render::HeightField field = canyon(20.0, 15.0);
  double before = 0.0;
  for (const double above : {0.0, 5.0, 10.0, 14.0}) {
    const double share = render::sky_share(field, 200, 200, above);
    EXPECT_GT(share, before);
    before = share;
  }
  EXPECT_EQ(render::sky_share(field, 200, 200, 15.0), 1.0);
  EXPECT_EQ(render::sky_share(field, 20, 200, 0.0), 1.0);  // on a roof
}

TEST(SkyView, OpenGroundSeesTheWholeSky) {
  TinyScene tiny;
  tiny.quad({-50, -50, 0}, {50, -50, 0}, {50, 50, 0}, {-50, 50, 0});
  const render::HeightField field = render::height_field(tiny.build());
  for (const float height : field.heights) EXPECT_NEAR(height, 0.0f, 1e-4f);
  EXPECT_EQ(render::sky_share(field, field.width / 2, field.height / 2, 0.0), 1.0);
}

TEST(SkyView, HeightsAreThoseOfTheHighestSurface) {
  TinyScene tiny;
  tiny.quad({-32, -32, 0}, {32, -32, 0}, {32, 32, 0}, {-32, 32, 0});
  tiny.object("house").box({-8, -8, 0}, {8, 8, 12});
  const render::HeightField field = render::height_field(tiny.build());
  const auto at = [&](double x, double y) {
    const dvec2 cell = (dvec2(x, y) - field.corner) / field.cell_m;
    return field.heights[size_t(cell.y) * field.width + size_t(cell.x)];
  };
  EXPECT_NEAR(at(0, 0), 12.0, 1e-3);
  EXPECT_NEAR(at(20, 0), 0.0, 1e-3);
  EXPECT_NEAR(at(7.9, 0), 12.0, 1e-3);
}

TEST(SkyView, HardCaseN64EmptySceneHasOneOpenCell) {
  const render::HeightField field = render::height_field(TinyScene().build());
  ASSERT_EQ(field.heights.size(), 1u);
  const std::vector<uint16_t> texels = render::sky_view_texels(field);
  ASSERT_EQ(texels.size(), 4u);
  for (size_t i = 1; i < 4; ++i) EXPECT_EQ(glm::unpackHalf1x16(texels[i]), 1.0f);
}

}  // namespace
}  // namespace greatx::test
