// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests the slopes of paths that surfaces reflect, let through and scatter.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "tests/rf/exhaustive.h"
#include "tests/rf/gradient_links.h"

namespace greatx::rf {
namespace {

using testing::expect_true_slopes;
using testing::HandScene;
using testing::Link;
using testing::over;
using testing::reflecting;
using testing::slopes_of;
using testing::through;
using Kind = ChannelParameter::Kind;

double angle_cosine(double degrees_from_normal) { return std::cos(radians(degrees_from_normal)); }

/// A reflection by the ground at a cosine of incidence.
Link ground_link(uint32_t (*material)(HandScene&), double cosine, double run_m = 20.0) {
  Link link;
  link.hand.ground(1e4, 0.0, material(link.hand));
  const double height = 0.5 * run_m * cosine / std::sqrt(1.0 - cosine * cosine);
  link.transmitter = {0.3, -0.2, 1.2 * height};
  link.receiver = {0.3 + 0.8 * run_m, -0.2 + 0.6 * run_m, 0.8 * height};
  link.solve = reflecting({0});
  return link;
}

scene::RadioMaterial& radio_of(Link& link, uint32_t material = 0) {
  return *link.hand.scene.materials[material].radio;
}

uint32_t concrete(HandScene& hand) { return hand.itu_material("concrete"); }
uint32_t lossless(HandScene& hand) { return hand.material("lossless", 4.0); }
uint32_t metal(HandScene& hand) { return hand.itu_material("metal"); }
uint32_t thin(HandScene& hand) { return hand.itu_material("glass", 0.003); }
uint32_t thick(HandScene& hand) { return hand.itu_material("concrete", 0.4); }
uint32_t layered(HandScene& hand) {
  const uint32_t wall = hand.itu_material("plasterboard", 0.0125);
  auto& layers = hand.scene.materials[wall].radio->layers;
  layers.push_back({*scene::itu_medium("wood"), 0.04});
  layers.push_back({*scene::itu_medium("brick"), 0.1});
  return wall;
}
uint32_t on_ground(HandScene& hand) {
  const uint32_t wall = layered(hand);
  hand.scene.materials[wall].radio->layers.push_back({*scene::itu_medium("medium_dry_ground"), 0.0});
  return wall;
}
uint32_t with_windows(HandScene& hand) {
  const uint32_t wall = thick(hand);
  scene::RadioWindows windows;
  windows.share = 0.3;
  windows.layers = {{*scene::itu_medium("glass"), 0.004},
                    {*scene::itu_medium("wood"), 0.012},
                    {*scene::itu_medium("glass"), 0.006}};
  hand.scene.materials[wall].radio->windows = windows;
  return wall;
}
constexpr uint32_t (*all_materials[])(HandScene&) = {concrete, lossless, metal,     thin,
                                                     thick,    layered,  on_ground, with_windows};

TEST(PathSlopes, FreeSpace) {
  Link link;
  link.transmitter = {1, 2, 3}, link.receiver = {5, -1, 15};
  link.solve = [](const FacetWorld&, const std::vector<scene::Wedge>&, const dvec3& tx, const dvec3& rx) {
    return GeometricPath{{}, {tx, rx}, glm::distance(tx, rx)};
  };
  const double length = 13.0;
  const dvec3 k = (link.receiver - link.transmitter) / length;
  for (uint32_t axis = 0; axis < 3; ++axis) {
    const auto slopes = slopes_of(link, {{Kind::transmitter_position, 0, 0, axis},
                                         {Kind::receiver_position, 0, 0, axis},
                                         {Kind::transmitter_velocity, 0, 0, axis},
                                         {Kind::receiver_velocity, 0, 0, axis}});
    const auto i = static_cast<int>(axis);
    // L = |r - t|, T = diag(1, -1)/L, f_D = (f/c) k . (v_t - v_r).
    for (const double sign : {-1.0, 1.0}) {
      const PathSlope& slope = slopes[sign > 0.0];
      EXPECT_NEAR(slope.length_m, sign * k[i], 1e-15);
      EXPECT_NEAR(slope.transfer[0].real(), -sign * k[i] / (length * length), 1e-17);
      EXPECT_NEAR(slope.transfer[3].real(), sign * k[i] / (length * length), 1e-17);
      dvec3 unit(0.0);
      unit[i] = 1.0;
      const dvec3 turned = sign * (unit - k[i] * k) / length;
      EXPECT_LT(glm::length(slope.departure - turned), 1e-16);
      EXPECT_LT(glm::length(slope.arrival + turned), 1e-16);
      const dvec3 closing = link.transmitter_velocity - link.receiver_velocity;
      EXPECT_NEAR(slope.doppler_hz, glm::dot(closing, turned) * link.carrier_hz / speed_of_light, 1e-14);
      EXPECT_NEAR(slopes[sign > 0.0 ? 3 : 2].doppler_hz, -sign * k[i] * link.carrier_hz / speed_of_light,
                  1e-14);
    }
  }
  expect_true_slopes(link);
}

TEST(PathSlopes, HalfSpaceIsFresnels) {
  // r_TE = (C - A)/(C + A) and r_TM = (eta C - A)/(eta C + A) with dA/deta = 1/(2A).
  for (const double cosine : {0.9, 0.5, 0.1, 1e-3}) {
    Link link = ground_link(concrete, cosine);
    const Complex eta =
        scene::relative_permittivity(radio_of(link).layers[0].medium, link.carrier_hz, "concrete");
    const Complex a = normal_component(eta, cosine), c = cosine;
    const Complex by_te = -2.0 * c / ((c + a) * (c + a)) / (2.0 * a);
    const Complex by_tm = (2.0 * a * c - eta * c / a) / ((eta * c + a) * (eta * c + a));
    const auto slopes = slopes_of(link, {{Kind::permittivity}, {Kind::conductivity}});
    const Path path = path_of(link, {Kind::carrier}, 0.0);
    const Complex by_sigma(0.0, -1.0 / (2.0 * pi * link.carrier_hz * vacuum_permittivity));
    for (int i = 0; i < 2; ++i) {
      const Complex by = (i == 0 ? 1.0 : by_sigma) / path.length_m;
      EXPECT_LT(std::abs(slopes[i].transfer[0] - by * by_tm), 1e-12 * std::abs(by * by_tm));
      EXPECT_LT(std::abs(slopes[i].transfer[3] + by * by_te), 1e-12 * std::abs(by * by_te));
      EXPECT_EQ(slopes[i].length_m, 0.0);
      EXPECT_EQ(slopes[i].doppler_hz, 0.0);
    }
  }
}

TEST(PathSlopes, ReflectionAtAnyAngle) {
  for (const auto material : all_materials)
    for (const double cosine : {angle_cosine(12.0), angle_cosine(55.0), 0.05}) {
      SCOPED_TRACE(cosine);
      expect_true_slopes(ground_link(material, cosine), 0.4 * cosine);
    }
}

TEST(PathSlopes, ReflectionNearGrazing) {
  for (const auto material : all_materials) {
    SCOPED_TRACE(std::find(std::begin(all_materials), std::end(all_materials), material) -
                 std::begin(all_materials));
    expect_true_slopes(ground_link(material, 1e-3), 2e-3);
  }
}

TEST(PathSlopes, ReflectionAtBrewstersAngle) {
  for (const auto material : {concrete, lossless, thick, layered}) {
    Link link = ground_link(material, 0.5);
    const double eta =
        scene::relative_permittivity(radio_of(link).layers[0].medium, link.carrier_hz, "").real();
    const double cosine = 1.0 / std::sqrt(1.0 + eta);
    expect_true_slopes(ground_link(material, cosine));
  }
}

TEST(PathSlopes, RoughSurfacesThatScatter) {
  for (const RoughnessModel model : {RoughnessModel::ament, RoughnessModel::miller_brown})
    for (const double height : {0.002, 0.01, 0.08}) {
      Link link = ground_link(thick, 0.4);
      radio_of(link).roughness_m = height;
      radio_of(link).scattering_coefficient = 0.35;
      radio_of(link).deviation_m = 0.003;
      radio_of(link).cross_polarization = 0.2;
      link.effects.roughness = link.effects.scattering = true;
      link.effects.roughness_model = model;
      expect_true_slopes(link);
    }
}

/// A room with walls of several materials.
Link room_link() {
  Link link;
  HandScene& hand = link.hand;
  thick(hand), layered(hand), metal(hand), with_windows(hand), concrete(hand), thin(hand);
  hand.room({7, 5, 3});
  for (uint32_t facet = 0; facet < 6; ++facet) hand.scene.facets[facet].material = facet;
  link.transmitter = {1.1, 2.2, 0.7}, link.receiver = {5.3, 3.1, 2.2};
  return link;
}

TEST(PathSlopes, SeveralReflections) {
  Link link = room_link();
  const FacetWorld world(link.hand.scene);
  const std::vector<GeometricPath> paths =
      testing::solve_paths(world, link.transmitter, link.receiver, testing::exhaustive_candidates(6, 4));
  ASSERT_GT(paths.size(), 100u);
  for (size_t i = 8; i < paths.size(); i += 9) {
    SCOPED_TRACE(i);
    link.solve = reflecting(paths[i].facets());
    if (i % 2 == 1) link.solve = testing::backwards(link.solve);
    expect_true_slopes(link, 0.001);
  }
}

TEST(PathSlopes, ThroughWalls) {
  Link link = room_link();
  // Two walls across the room; one is turned, and is passed twice.
  link.hand.quad({3, 0, 0}, {3, 5, 0}, {3, 5, 3}, {3, 0, 3}, 0);
  link.hand.quad({4, 0, 0}, {4.5, 5, 0}, {4.5, 5, 3}, {4, 0, 3}, 1);
  link.hand.quad({4.8, 0, 0}, {4.8, 5, 0}, {4.8, 5, 3}, {4.8, 0, 3}, 3);
  for (const FacetSequence& facets : {FacetSequence{4}, FacetSequence{3, 1}}) {
    link.solve = through(reflecting(facets), {6, 7, 8});
    expect_true_slopes(link, 0.1);
  }
}

TEST(PathSlopes, ScatteringPatches) {
  for (const scene::ScatteringPattern pattern :
       {scene::ScatteringPattern::lambertian, scene::ScatteringPattern::directive,
        scene::ScatteringPattern::backscattering}) {
    Link link = room_link();
    for (scene::Material& material : link.hand.scene.materials) {
      material.radio->scattering_coefficient = 0.4;
      material.radio->cross_polarization = 0.15;
      material.radio->pattern = pattern;
      material.radio->backscatter_share = 0.3;
      material.radio->roughness_m = 0.004;
      material.radio->deviation_m = 0.003;
    }
    link.effects.scattering = link.effects.roughness = true;
    link.solve = over({{InteractionType::scattering, 4, 7}}, {{3.1, 1.2, 0.0}}, 0.25);
    expect_true_slopes(link, 0.3);
    link.solve = testing::backwards(link.solve);
    expect_true_slopes(link, 0.3);
    link.solve = over({{InteractionType::scattering, 4, 7}, {InteractionType::scattering, 3, 2}},
                      {{3.1, 1.2, 0.0}, {2.2, 5.0, 1.3}}, 0.25, 0.4);
    expect_true_slopes(link, 0.3);
    link.solve = testing::backwards(link.solve);
    expect_true_slopes(link, 0.3);
  }
}

TEST(PathSlopes, ACornerIsNoSpecialPlace) {
  // The path back from the corner of a room has two runs of no length. Its length is |r - image|.
  Link link = room_link();
  link.transmitter = {2.0, 1.5, 1.0}, link.receiver = {4.0, 3.0, 2.0};
  link.solve = [](const FacetWorld& world, const std::vector<scene::Wedge>& wedges, const dvec3& tx,
                  const dvec3& rx) {
    return reflecting({0, 2, 4})(world, wedges, tx, rx);
  };
  const auto slopes = slopes_of(link, {{Kind::receiver_position, 0, 0, 0},
                                       {Kind::receiver_position, 0, 0, 1},
                                       {Kind::receiver_position, 0, 0, 2}});
  const dvec3 k = glm::normalize(link.receiver + link.transmitter);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(slopes[axis].length_m, k[axis], 1e-15);
    for (const Complex& t : slopes[axis].transfer) EXPECT_TRUE(std::isfinite(std::abs(t)));
  }
}

TEST(PathSlopes, NormalIncidence) {
  // Straight up and down the field goes as 1/L, whatever the basis.
  Link link = ground_link(thick, 0.5);
  link.transmitter = {0, 0, 2.5}, link.receiver = {0, 0, 1.5};
  const Path path = path_of(link, {Kind::carrier}, 0.0);
  const PathSlope up = slopes_of(link, {{Kind::receiver_position, 0, 0, 2}})[0];
  for (int i = 0; i < 4; ++i) EXPECT_LT(std::abs(up.transfer[i] + path.transfer[i] / 4.0), 1e-15);
  EXPECT_EQ(up.length_m, 1.0);
}

TEST(PathSlopes, WhatAPathDoesNotTouchLeavesItAlone) {
  Link link = room_link();
  link.solve = reflecting({4});
  for (const uint32_t material : {0u, 1u, 2u, 5u})
    for (const PathSlope& slope :
         slopes_of(link, {{Kind::permittivity, material}, {Kind::receiver_attitude, 0, 0, 1}}))
      for (const Complex& t : slope.transfer) EXPECT_EQ(t, 0.0);
}

std::string refused(const Link& link, const ChannelParameter& parameter) {
  try {
    slopes_of(link, {parameter});
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

TEST(PathSlopes, WhatIsRefused) {
  Link link = ground_link(concrete, 0.5);
  EXPECT_NE(refused(link, {Kind::thickness}).find("half-space"), std::string::npos);
  EXPECT_NE(refused(link, {Kind::permittivity, 3}).find("material below 1, found 3"), std::string::npos);
  EXPECT_NE(refused(link, {Kind::permittivity, 0, 2}).find("layer below 1, found 2"), std::string::npos);
  EXPECT_NE(refused(link, {Kind::permittivity, 0, 0, 0, true}).find("of its windows"), std::string::npos);
  EXPECT_NE(refused(link, {Kind::receiver_position, 0, 0, 3}).find("axis"), std::string::npos);
  radio_of(link).scattering_coefficient = 1.0;
  link.effects.scattering = true;
  EXPECT_NE(refused(link, {Kind::scattering}).find("no finite derivative"), std::string::npos);
  link.solve = over({{InteractionType::scattering, 0, 1}}, {{5, 4, 0}});
  EXPECT_EQ(refused(link, {Kind::scattering}), "");
  EXPECT_NE(refused(link, {Kind::cross_polarization}).find("no finite derivative"), std::string::npos);
}

}  // namespace
}  // namespace greatx::rf
