// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests the slopes of paths through the air, through foliage, and by bodies that move.
#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"
#include "rf/atmosphere/foliage.h"
#include "tests/rf/gradient_links.h"

namespace greatx::rf {
namespace {

using testing::expect_true_slopes;
using testing::Link;
using testing::over;
using testing::path_of;
using testing::reflecting;
using testing::slopes_of;
using Kind = ChannelParameter::Kind;

Link far_link() {
  Link link;
  link.hand.ground(1e5, 0.0, link.hand.itu_material("concrete"));
  link.transmitter = {0, 0, 40}, link.receiver = {900, 1200, 400};
  link.solve = reflecting({0});
  return link;
}

TEST(PathSlopes, ThroughTheAir) {
  for (const double carrier_hz : {28e9, 60e9, 140e9}) {
    SCOPED_TRACE(carrier_hz);
    Link link = far_link();
    link.hand.scene.materials[0].radio->layers[0].medium.extrapolate = true;
    link.carrier_hz = carrier_hz;
    link.weather.rain_mm_h = 25.0;
    link.weather.fog_g_m3 = 0.3;
    for (int effects = 1; effects < 8; ++effects) {
      link.effects.gas = effects & 1, link.effects.rain = effects & 2, link.effects.fog = effects & 4;
      expect_true_slopes(link, 10.0);
    }
  }
}

TEST(PathSlopes, RainIsRaised) {
  // In a clear sky beside the ground, amplitude 10^(-gamma d/20)/d: d ln|T|/dd = -gamma ln(10)/20 - 1/d.
  Link link;
  link.transmitter = {0, 0, 0}, link.receiver = {500, 0, 0};
  link.carrier_hz = 28e9;
  link.weather.rain_mm_h = 25.0;
  link.effects.rain = true;
  link.solve = over({}, {}, 0.0);
  const double gamma = 1e-3 * rain_db_per_km(rain_coefficients(link.carrier_hz), 25.0, 1.0).v;
  const Path path = path_of(link, {Kind::carrier}, 0.0);
  const PathSlope slope = slopes_of(link, {{Kind::receiver_position, 0, 0, 0}})[0];
  EXPECT_NEAR((slope.transfer[0] / path.transfer[0]).real(), -gamma * std::log(10.0) / 20.0 - 1.0 / 500.0,
              1e-15);
}

TEST(PathSlopes, ThroughFoliage) {
  // The depth counts as a constant, in the path that is compared, too.
  for (const double depth_m : {9.0, 60.0}) {
    Link link = far_link();
    link.effects.foliage = true;
    link.foliage.emplace();
    link.solve = [=](const FacetWorld& world, const std::vector<scene::Wedge>& wedges, const dvec3& tx,
                     const dvec3& rx) {
      GeometricPath path = reflecting({0})(world, wedges, tx, rx);
      path.foliage_m = depth_m;
      return path;
    };
    expect_true_slopes(link, 10.0);
  }
}

TEST(PathSlopes, MirrorsThatMoveAndTurn) {
  Link link;
  link.hand.itu_material("metal");
  link.hand.itu_material("glass", 0.01);
  for (int i = 0; i < 2; ++i) link.hand.body();
  link.hand.quad({-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}, 0, 1);
  link.hand.quad({-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}, 1, 2);
  Motion first, second;
  first.pose = {{0, 0, 0}, orientation_from_yaw_pitch_roll(0.2, 0.1, -0.05)};
  first.velocity = {3, 1, -2}, first.angular_velocity = {0.3, -0.7, 1.1};
  second.pose = {{1, 1, 6}, orientation_from_yaw_pitch_roll(0.4, -0.1, 0.1)};
  second.velocity = {-1, 2, 5}, second.angular_velocity = {-0.8, 0.2, 0.4};
  link.motions = {first, second};
  link.transmitter = {-3, 0, 4}, link.receiver = {3, 1, 2.5};
  for (const FacetSequence& facets : {FacetSequence{0}, FacetSequence{0, 1}}) {
    link.solve = reflecting(facets);
    expect_true_slopes(link, 0.2);
  }
}

}  // namespace
}  // namespace greatx::rf
