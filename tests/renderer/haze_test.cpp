// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks fog in pictures: Koschmieder's law, the white furnace and shadows that fade.
#include "renderer/daylight/haze.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/renderer/camera_rig.h"

namespace greatx::test {
namespace {

render::CameraEffects hazy() {
  render::CameraEffects effects = lambertian();
  effects.haze = true;
  return effects;
}

/// Returns a black wall across the view, from below the ground to a height of 400 m, over one side of the
/// picture only.
scene::Scene black_wall(double distance) {
  TinyScene tiny;
  scene::Material black = optical_material("black", 0.0f);
  tiny.object("wall", 0, tiny.material_as(black))
      .quad({distance, 0, -400}, {distance, -4000, -400}, {distance, -4000, 400}, {distance, 0, 400});
  return tiny.build();
}

TEST(Haze, ContrastAgainstTheHorizonFallsAsKoschmiederSays) {
  // C = (L_target - L_horizon) / L_horizon = -exp(-extinction d) for any light. C is 2 % at the visibility.
  const double extinction = render::fog_extinction(0.05);
  for (const double sun : {40.0, -3.0})
    for (const double share : {0.1, 0.5, 1.0}) {
      const double distance = share * render::visibility_m(extinction);
      render::Lighting light = plain_light(150.0, sun);
      light.haze_extinction_per_m = extinction;
      light.haze_depth = 1.0;
      render::CameraDesc desc = plain_camera(17, 1);
      desc.fx = desc.fy = 4000.0;  // the whole narrow picture is at the horizon
      CameraRig rig(black_wall(distance), light, desc, hazy());
      const render::CameraImages images = rig.shoot(look({0, 0, 1}));
      const size_t row = size_t(desc.height / 2) * desc.width;
      const double horizon = luminance_at(images, row + 2),
                   target = luminance_at(images, row + desc.width - 3);
      ASSERT_EQ(images.instance[row + 2], 0u);
      ASSERT_EQ(images.instance[row + desc.width - 3], 1u);
      EXPECT_NEAR((target - horizon) / horizon, -std::exp(-extinction * distance), 1e-3)
          << sun << " " << share;
    }
}

TEST(Haze, FurnaceStaysWhite) {
  render::Lighting furnace = white_world();
  furnace.haze_extinction_per_m = 0.1;
  furnace.haze_depth = 4.0;
  TinyScene tiny;
  tiny.object("cube", 0, tiny.material_as(optical_material("white", 1.0f))).box({-1, -1, -1}, {1, 1, 1});
  CameraRig rig(tiny.build(), furnace, plain_camera(48, 4), hazy());
  const render::CameraImages images = rig.shoot(look({-3, -2, 2.5}, 33.7, 35.0));
  for (size_t i = 0; i < images.depth.size(); ++i)
    EXPECT_NEAR(luminance_at(images, i) / (15000.0 / pi), 1.0, 4e-3) << i;
}

TEST(Haze, ShadowsFadeWithTheLayersDepth) {
  // The camera looks at ground under a roof and beside it. The lit ground receives the direct light and the
  // sky light that pass the layer.
  double before = 1e9;
  for (const double depth : {0.0, 1.0, 6.0}) {
    TinyScene tiny;
    const uint32_t grey = tiny.material_as(optical_material("grey", 0.5f));
    tiny.object("ground", 0, grey).quad({-30, -30, 0}, {30, -30, 0}, {30, 30, 0}, {-30, 30, 0});
    tiny.object("roof", 0, grey).box({0, -10, 4}, {20, 10, 4.2});
    render::Lighting light = plain_light(0.0, 90.0);
    light.haze_extinction_per_m = 1e-6;
    light.haze_depth = depth;
    CameraRig rig(tiny.build(), light, plain_camera(32, 1), hazy());
    const render::CameraImages images = rig.shoot(look({-3, 0, 3}, 0.0, 90.0));
    const render::LayerLight below = render::through_layer(1e5, 1.0, 15000.0, depth, light.ground_albedo);
    const double lit = luminance_at(images, size_t(28) * 32 + 16);  // behind the eye, away from the roof
    EXPECT_NEAR(lit / (0.5 / pi * (below.direct_lux + below.sky_lux)), 1.0, 2e-3) << depth;
    EXPECT_LT(below.direct_lux / below.sky_lux, before);
    before = below.direct_lux / below.sky_lux;
  }
  EXPECT_LT(before, 0.01);
}

TEST(Haze, OffLeavesTheBytesAlone) {
  TinyScene tiny;
  tiny.object("cube").box({-1, -1, 0}, {1, 1, 2});
  render::Lighting foggy = plain_light(30.0, 40.0);
  foggy.haze_extinction_per_m = 0.05;
  foggy.haze_depth = 2.0;
  CameraRig without(tiny.build(), plain_light(30.0, 40.0), plain_camera(32, 1), lambertian());
  CameraRig off(tiny.build(), foggy, plain_camera(32, 1), lambertian());
  CameraRig clear(tiny.build(), plain_light(30.0, 40.0), plain_camera(32, 1), hazy());
  const Pose sensor = look({-4, 0, 1});
  const auto expected = without.shoot(sensor).hdr;
  EXPECT_EQ(off.shoot(sensor).hdr, expected);
  EXPECT_EQ(clear.shoot(sensor).hdr, expected);  // the effect is on, but there is no fog
}

}  // namespace
}  // namespace greatx::test
