// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests errors about cameras that planning finds before anything is built.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "sim/plan/effect_plan.h"
#include "sim/scenario/parse/load_scenario.h"

namespace greatx::sim {
namespace {

/// Returns the message of the error when a scenario with this sensor in line 8 is planned, or "accepted".
std::string message_of(const std::string& sensor) {
  const std::string text =
      "greatx: 1\nname: x\nticks: 5\nnodes:\n  - name: car\n"
      "    trajectory: {type: static, position_m: [0, 0, 1]}\n    sensors:\n      - {name: front, " +
      sensor + "}\n";
  const Scenario scenario = parse_scenario(text, "s.yaml", ".");
  try {
    make_effect_plan(scenario, {});
  } catch (const UserError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(CameraPlan, ADistortionThatFoldsThePictureIsNamedWithFileAndLine) {
  using ::testing::StartsWith;
  // 640x480 with fx = 320: the corner is 400 px from the middle. k1 = -0.4 folds at r = 0.9129, which the
  // picture shows at r' = 0.6086, that is at 194.7 px.
  const std::string message =
      "s.yaml:8: camera car/front: distortion: expected a model that does not fold within the picture, found "
      "one that holds up to a radius of 0.9129 (194.7 pixels from the principal point)";
  const std::string folds = "rate_hz: 30, fov_deg: 90, distortion: {k1: -0.4}";
  EXPECT_THAT(message_of("type: camera, " + folds), StartsWith(message));
  EXPECT_THAT(message_of("type: event_camera, " + folds), StartsWith(message));
  EXPECT_THAT(message_of("type: camera, rate_hz: 30, fov_deg: 90, distortion: {p1: 0.5}"),
              StartsWith("s.yaml:8: camera car/front: distortion: expected a model that does not fold"));
  // The same lens does not fold within a narrow picture.
  EXPECT_EQ(message_of("type: camera, rate_hz: 30, fov_deg: 35, distortion: {k1: -0.4}"), "accepted");
}

TEST(CameraPlan, AFisheyeThatFoldsIsNamedWithFileAndLine) {
  // 1 + 3 k1 t^2 = 0 at t = 1, where t_d = 2/3.
  const std::string lens =
      "type: camera, rate_hz: 30, width: 800, height: 600, fx: 300, lens: {model: fisheye, ";
  EXPECT_THAT(
      message_of(lens + "k1: -0.333333333333333333}"),
      ::testing::StartsWith("s.yaml:8: camera car/front: lens: expected a model that does not fold within "
                            "the picture, or a narrower circle_deg, found one that holds up to 114.592 "
                            "degrees (200 pixels from the principal point)"));
  EXPECT_THAT(message_of(lens + "k1: -0.333333333333333333, circle_deg: 120}"),
              ::testing::StartsWith("s.yaml:8: camera car/front: lens: expected a model that grows up to the "
                                    "image circle of 120 degrees, found one that holds up to 114.592"));
  EXPECT_EQ(message_of(lens + "k1: -0.333333333333333333, circle_deg: 114}"), "accepted");
}

TEST(CameraPlan, AVignettingThatLetsNoLightThroughIsNamedWithFileAndLine) {
  EXPECT_THAT(
      message_of("type: camera, rate_hz: 30, fov_deg: 90, vignetting: [-2, 0, 0]"),
      ::testing::StartsWith("s.yaml:8: camera car/front: vignetting: expected factors above 0 and up to 1"));
  EXPECT_EQ(message_of("type: camera, rate_hz: 30, fov_deg: 90, vignetting: [-0.3, 0, 0]"), "accepted");
}

TEST(CameraPlan, CloudsAndLandFollowTheSkyAndTheScene) {
  const auto plan_with = [](const std::string& environment, const scene::Scene& scene = {}) {
    return make_effect_plan(
        parse_scenario("greatx: 1\nname: x\nticks: 5\nenvironment: {" + environment +
                           "}\nnodes:\n  - name: car\n    trajectory: {type: static, position_m: [0, 0, 1]}\n"
                           "    sensors:\n      - {name: front, type: camera, rate_hz: 30, fov_deg: 90}\n",
                       "s.yaml", "."),
        scene);
  };
  EXPECT_TRUE(plan_with("").clouds.on);
  EXPECT_FALSE(plan_with("clouds: 0").clouds.on);
  EXPECT_TRUE(plan_with("clouds: 0, sky: overcast").clouds.on);
  EXPECT_FALSE(plan_with("sky_illuminance_lux: 0").clouds.on);
  EXPECT_FALSE(plan_with("").horizon.on) << "there is no scene";
  EXPECT_FALSE(plan_with("").markings.on);
  EXPECT_FALSE(plan_with("").thin_lines.on);
  EXPECT_TRUE(plan_with("horizon: city").horizon.on);
  EXPECT_THAT(plan_with("horizon: city").horizon.reason, ::testing::HasSubstr("city"));
  EXPECT_FALSE(plan_with("horizon: city, sky_illuminance_lux: 0").horizon.on);
}

}  // namespace
}  // namespace greatx::sim
