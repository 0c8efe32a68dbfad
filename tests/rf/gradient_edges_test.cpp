// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests the slopes of paths over edges and their ends, and of reflections by small facets.
#include <cmath>
#include <iostream>
#include <stdexcept>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "rf/edges/corners.h"
#include "tests/rf/gradient_links.h"

namespace greatx::rf {
namespace {

using testing::backwards;
using testing::expect_true_slopes;
using testing::HandScene;
using testing::Link;
using testing::over;
using testing::over_edge;
using testing::over_edges;
using testing::reflecting;
using Kind = ChannelParameter::Kind;

/// A house on the ground. Facets: walls x = 0, x = 10, y = 0, y = 8, the roof z = 6, the ground, and a wall
/// y = -15 beside it.
Link house_link() {
  Link link;
  HandScene& hand = link.hand;
  const uint32_t slab = hand.itu_material("concrete", 0.3), half_space = hand.itu_material("brick"),
                 glass = hand.itu_material("glass", 0.02), ground = hand.itu_material("medium_dry_ground");
  hand.quad({0, 0, 0}, {0, 0, 6}, {0, 8, 6}, {0, 8, 0}, slab);
  hand.quad({10, 0, 0}, {10, 8, 0}, {10, 8, 6}, {10, 0, 6}, half_space);
  hand.quad({0, 0, 0}, {10, 0, 0}, {10, 0, 6}, {0, 0, 6}, glass);
  hand.quad({0, 8, 0}, {0, 8, 6}, {10, 8, 6}, {10, 8, 0}, slab);
  hand.quad({0, 0, 6}, {10, 0, 6}, {10, 8, 6}, {0, 8, 6}, half_space);
  hand.quad({-50, -50, 0}, {50, -50, 0}, {50, 50, 0}, {-50, 50, 0}, ground);
  hand.quad({-50, -15, 0}, {-50, -15, 20}, {50, -15, 20}, {50, -15, 0}, slab);
  for (scene::Material& material : hand.scene.materials) {
    material.radio->roughness_m = 0.003;
    material.radio->scattering_coefficient = 0.3;
    material.radio->cross_polarization = 0.1;
    material.radio->pattern = scene::ScatteringPattern::backscattering;
  }
  link.effects.roughness = link.effects.scattering = true;
  return link;
}

uint32_t edge_of(const Link& link, uint32_t facet_a, uint32_t facet_b) {
  const auto wedges = scene::find_wedges(link.hand.scene, {.free_edges = link.free_edges});
  for (uint32_t i = 0; i < wedges.size(); ++i)
    if (wedges[i].facet_0 == std::min(facet_a, facet_b) && wedges[i].facet_n == std::max(facet_a, facet_b))
      return i;
  throw std::logic_error("no such edge");
}

TEST(PathSlopes, OverAnEdge) {
  Link link = house_link();
  const uint32_t edge = edge_of(link, 0, 2);
  struct Ends {
    dvec3 tx, rx;
    double position_m;
  };
  const Ends ends[] = {{{-5, 4, 2}, {4, -6, 3}, 0.3},        // hidden
                       {{-5, 4, 2}, {-1, -6, 3}, 0.3},       // lit, with a reflection of its own
                       {{-5, 1, 2}, {-4, -6, 4}, 0.3},       // lit
                       {{-5, -4, 2}, {3, -6, 3}, 0.3},       // near the boundary of a reflection
                       {{-5, 4, 2}, {5.01, -4.0, 3}, 2e-3},  // beside the shadow's boundary
                       {{-5, 4, 2}, {4.99, -4.0, 3}, 2e-3},
                       {{-0.02, 5, 2}, {6, -0.01, 3}, 5e-3}};  // along both faces
  for (const Ends& at : ends) {
    SCOPED_TRACE(at.rx.x);
    link.transmitter = at.tx, link.receiver = at.rx;
    link.solve = over_edge(edge);
    expect_true_slopes(link, at.position_m);
    link.solve = backwards(over_edge(edge));
    expect_true_slopes(link, at.position_m);
  }
}

TEST(PathSlopes, OnABoundaryTheSideThatCountsIsContinued) {
  // In line with the edge, EdgeSides say on which side of the shadow's boundary the path counts. Its slopes
  // are the limits from that side.
  Link link = house_link();
  const uint32_t edge = edge_of(link, 0, 2);
  const std::vector<ChannelParameter> parameters = testing::every_parameter(link);
  link.transmitter = {-5, 4, 2};
  const dvec3 on(5, -4, 3), into_shadow = glm::normalize(dvec3(4, 5, 0));
  for (const int side : {1, -1}) {
    const auto at = [&](const dvec3& receiver) {
      link.receiver = receiver;
      link.solve = [=](const FacetWorld& world, const std::vector<scene::Wedge>& wedges, const dvec3& tx,
                       const dvec3& rx) {
        GeometricPath path = over_edge(edge)(world, wedges, tx, rx);
        path.edge_sides[0].incident = static_cast<int8_t>(side);
        return path;
      };
      return testing::slopes_of(link, parameters);
    };
    const auto limit = at(on - 1e-6 * side * into_shadow), there = at(on);
    for (size_t i = 0; i < parameters.size(); ++i)
      for (int k = 0; k < 4; ++k) {
        double most = 0.0;
        for (const Complex& t : limit[i].transfer) most = std::max(most, std::abs(t));
        EXPECT_LE(std::abs(there[i].transfer[k] - limit[i].transfer[k]), 1e-4 * most)
            << testing::text_of(parameters[i]);
      }
  }
}

TEST(PathSlopes, OverAnEdgeOfAConductor) {
  Link link = house_link();
  for (const uint32_t facet : {0u, 2u})
    link.hand.scene.facets[facet].material = link.hand.itu_material("metal");
  link.transmitter = {-5, 4, 2}, link.receiver = {4, -6, 3};
  link.solve = over_edge(edge_of(link, 0, 2));
  expect_true_slopes(link, 0.3);
}

TEST(PathSlopes, ReflectionsBesideAnEdge) {
  Link link = house_link();
  const uint32_t edge = edge_of(link, 0, 2);
  struct Reflections {
    FacetSequence before, after;
    double transmitter_z, receiver_z;
  };
  const Reflections all[] = {{{}, {6}, 2, 3}, {{5}, {6}, 2, 10}, {{}, {5}, 4, 1.5}, {{}, {5, 6}, 3, 1.5}};
  for (const Reflections& at : all) {
    link.transmitter = {-5, 4, at.transmitter_z}, link.receiver = {4, -6, at.receiver_z};
    link.solve = over_edge(edge, at.before, at.after);
    expect_true_slopes(link, 0.05);
    link.solve = backwards(link.solve);
    expect_true_slopes(link, 0.05);
  }
}

TEST(PathSlopes, OverTheEndOfAnEdge) {
  Link link = house_link();
  const uint32_t edge = edge_of(link, 0, 2);
  const auto wedges = scene::find_wedges(link.hand.scene);
  for (const Corner corner : both_corners) {
    link.transmitter = {-5, 4, 7}, link.receiver = {4, -6, 5};
    link.solve = over({{InteractionType::diffraction, edge, static_cast<uint32_t>(corner)}},
                      {corner_point(wedges[edge], corner)}, 0.0);
    expect_true_slopes(link, 0.3);
    link.solve = backwards(link.solve);
    expect_true_slopes(link, 0.3);
  }
}

TEST(PathSlopes, OverARoof) {
  Link link = house_link();
  const uint32_t first = edge_of(link, 0, 4), second = edge_of(link, 1, 4);
  const dvec3 transmitters[] = {{-8, 3, 3}, {-8, 3, 6.5}, {-8, 3, 9}},
              receivers[] = {{19, 5, 2}, {19, 5, 6.2}};
  for (const dvec3& tx : transmitters)
    for (const dvec3& rx : receivers) {
      SCOPED_TRACE(tx.z + 100.0 * rx.z);
      link.transmitter = tx, link.receiver = rx;
      link.solve = over_edges(first, second);
      expect_true_slopes(link, 0.1);
      link.solve = backwards(over_edges(first, second));
      expect_true_slopes(link, 0.1);
    }
}

TEST(PathSlopes, OverTwoScreens) {
  Link link;
  link.hand.itu_material("wood", 0.02);
  link.hand.quad({0, -20, 0}, {0, 20, 0}, {0, 20, 7}, {0, -20, 6}, 0);
  link.hand.quad({6, -20, 0}, {7, 20, 0}, {7, 20, 6}, {6, -20, 7}, 0);
  link.free_edges = true;
  const auto wedges = scene::find_wedges(link.hand.scene, {.free_edges = true});
  uint32_t upper[2] = {0, 0};
  for (uint32_t i = 0; i < wedges.size(); ++i)
    if (wedges[i].a.z > 5.0 && wedges[i].b.z > 5.0) upper[wedges[i].facet_0] = i;
  for (const double height : {4.0, 6.4, 9.0}) {
    link.transmitter = {-8, 3, height}, link.receiver = {15, -4, 5};
    link.solve = over_edges(upper[0], upper[1]);
    expect_true_slopes(link, 0.1);
  }
  // A wall between them, and rain.
  link.hand.itu_material("glass", 0.01);
  link.hand.quad({3, -20, 0}, {3.5, 20, 0}, {3.5, 20, 20}, {3, -20, 20}, 1);
  link.hand.quad({10, -20, 0}, {10.5, 20, 0}, {10.5, 20, 20}, {10, -20, 20}, 1);
  link.effects.rain = true;
  link.weather.rain_mm_h = 30.0;
  link.carrier_hz = 28e9;
  link.solve = testing::through(over_edges(upper[0], upper[1]), {2, 3});
  expect_true_slopes(link, 0.03);
}

TEST(PathSlopes, APatchAndAnEdge) {
  Link link = house_link();
  const uint32_t edge = edge_of(link, 0, 2);
  const dvec3 patch(6, -15, 4);
  link.transmitter = {-5, 4, 2}, link.receiver = {2, -9, 3};
  link.solve = [=](const FacetWorld& world, const std::vector<scene::Wedge>& wedges, const dvec3& tx,
                   const dvec3& rx) {
    GeometricPath path = over_edge(edge)(world, wedges, tx, patch);
    path.interactions.push_back({InteractionType::scattering, 6, 3});
    path.vertices.push_back(rx);
    path.length_m += glm::distance(patch, rx);
    path.patch_area_m2 = 0.5;
    return path;
  };
  expect_true_slopes(link, 0.3);
  link.solve = backwards(link.solve);
  expect_true_slopes(link, 0.3);
}

/// A plate of the given half sides in the plane z = 0, tilted neighbours at its ends, and a link over it.
Link plate_link(double half_x, double half_y, double bend_deg) {
  Link link;
  HandScene& hand = link.hand;
  hand.itu_material("concrete", 0.1);
  hand.quad({-half_x, -half_y, 0}, {half_x, -half_y, 0}, {half_x, half_y, 0}, {-half_x, half_y, 0}, 0);
  if (bend_deg > 0.0) {
    const double run = half_x * std::cos(radians(bend_deg)), fall = half_x * std::sin(radians(bend_deg));
    hand.quad({half_x, -half_y, 0}, {half_x + run, -half_y, -fall}, {half_x + run, half_y, -fall},
              {half_x, half_y, 0}, 0);
    hand.quad({-half_x - run, -half_y, -fall}, {-half_x, -half_y, 0}, {-half_x, half_y, 0},
              {-half_x - run, half_y, -fall}, 0);
  }
  link.transmitter = {-5, 0.03, 5}, link.receiver = {4.1, -0.02, 4};
  link.effects.finite_reflectors = true;
  link.solve = reflecting({0});
  return link;
}

TEST(PathSlopes, FiniteReflectors) {
  for (const double half : {0.15, 0.6, 2.5}) {
    SCOPED_TRACE(half);
    Link link = plate_link(1.3 * half, half, 0.0);
    expect_true_slopes(link, 0.03);
    link.diffracting = {true, false};
    link.free_edges = true;
    link.solve = [](const FacetWorld& world, const std::vector<scene::Wedge>& wedges, const dvec3& tx,
                    const dvec3& rx) {
      GeometricPath path = reflecting({0})(world, wedges, tx, rx);
      path.edges_diffract = 1;
      return path;
    };
    expect_true_slopes(link, 0.03);
  }
}

TEST(PathSlopes, PiecesOfOneSurface) {
  for (const double bend_deg : {4.0, 20.0}) {
    SCOPED_TRACE(bend_deg);
    expect_true_slopes(plate_link(0.6, 1.5, bend_deg), 0.02);
  }
}

/// Prints what the slopes of a path cost, beside its field.
void print_cost(const char* what, const Link& link) {
  const std::vector<ChannelParameter> all = testing::every_parameter(link);
  std::vector<ChannelParameter> ends, materials;
  for (const ChannelParameter& p : all) {
    if (p.kind == Kind::transmitter_position || p.kind == Kind::receiver_position) ends.push_back(p);
    if (p.kind <= Kind::backscatter_share) materials.push_back(p);
  }
  const std::vector<ChannelParameter> four(all.end() - 13, all.end() - 9);
  std::cout << fmt::format("{:24} field {:7.2f} us", what, 1e6 * testing::cost_of(link, ends).field_s);
  for (const auto& [name, list] :
       {std::pair("4 of the ends'", four), {"6 positions", ends}, {"materials", materials}, {"all", all}}) {
    const testing::Cost cost = testing::cost_of(link, list);
    std::cout << fmt::format("; {} ({}): {:.1f} x", name, list.size(), cost.slopes_s / cost.field_s);
  }
  std::cout << "\n";
}

TEST(PathSlopes, CostIsPrinted) {
  Link link = house_link();
  link.transmitter = {-5, 4, 2}, link.receiver = {4, -16 + 2, 3};
  link.solve = over({}, {}, 0.0);
  print_cost("line of sight", link);
  link.solve = reflecting({5});
  print_cost("reflection", link);
  link.solve = reflecting({6});
  print_cost("reflection, slab", link);
  link.solve = reflecting({5, 6});
  print_cost("two reflections", link);
  link.receiver = {4, -6, 3};
  link.solve = over_edge(edge_of(link, 0, 2));
  print_cost("edge", link);
  link.solve = over({{InteractionType::scattering, 5, 1}}, {{1, -8, 0}});
  print_cost("patch", link);
  link.transmitter = {-8, 3, 3}, link.receiver = {19, 5, 2};
  link.solve = over_edges(edge_of(link, 0, 4), edge_of(link, 1, 4));
  print_cost("two edges", link);
  print_cost("finite reflector", plate_link(0.6, 1.5, 0.0));
}

}  // namespace
}  // namespace greatx::rf
