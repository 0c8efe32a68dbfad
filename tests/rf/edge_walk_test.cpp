// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>

#include <gtest/gtest.h>

#include "core/phase.h"
#include "rf/edges/corners.h"
#include "rf/field/field.h"
#include "tests/rf/edge_contributions.h"
#include "tests/rf/exhaustive.h"

namespace greatx::rf {
namespace {

using namespace testing;

/// Tells which paths there are, to find where one appears.
struct Total {
  FieldVector field;
  std::vector<uint32_t> paths;
};

/// Returns the whole field: direct, reflected once, over one edge and over two, and over the ends of edges if
/// there are any.
Total total(const Setting& setting, const dvec3& tx, const dvec3& rx, const dvec3& sent,
            const OpenCorners& open = {}) {
  Total sum;
  const auto add = [&](const FieldVector& field, uint32_t path) {
    sum.field.re += field.re, sum.field.im += field.im;
    sum.paths.push_back(path);
  };
  for (const GeometricPath& geometry : testing::solve_paths(
           setting.world, tx, rx, testing::exhaustive_candidates(setting.world.facet_count(), 1))) {
    bool lit = true;
    for (size_t i = 0; i + 1 < geometry.vertices.size(); ++i)
      lit = lit && setting.visible(geometry.vertices[i], geometry.vertices[i + 1]);
    if (!lit) continue;
    const Path path = path_field(geometry, {&setting.world, &setting.surfaces}, dvec3(0.0), dvec3(0.0));
    const Complex in[2] = {glm::dot(theta_hat(path.departure), sent),
                           glm::dot(phi_hat(path.departure), sent)};
    FieldVector field;
    field.add(path.transfer[0] * in[0] + path.transfer[1] * in[1], theta_hat(path.arrival));
    field.add(path.transfer[2] * in[0] + path.transfer[3] * in[1], phi_hat(path.arrival));
    field.scale(unit_phasor(-turns_of(frequency_hz, path.delay_s)));
    add(field, geometry.facets().empty() ? 1000 : 1001 + geometry.facets()[0]);
  }
  const auto add_contribution = [&](const Contribution& path, uint32_t index) {
    const dvec3 in = glm::cross(path.map.beta_in, path.map.phi_in);
    FieldVector field;
    field.add(1.0, sent - glm::dot(sent, in) * in);
    field = path.map.apply(field);
    field.scale(unit_phasor(-turns_of(frequency_hz, path.length_m / speed_of_light)) / path.length_m);
    add(field, index);
  };
  for (uint32_t i = 0; i < setting.wedges.size(); ++i) {
    std::vector<Contribution> one;
    add_single(setting, setting.wedges[i], tx, rx, one);
    for (uint32_t m = 0; m < setting.wedges.size(); ++m)
      if (m != i) {
        const size_t before = one.size();
        add_pair(setting, setting.wedges[i], setting.wedges[m], tx, rx, one);
        if (one.size() > before) add_contribution(one.back(), 2000 + 10 * i + m);
        one.resize(before);
      }
    if (!one.empty()) add_contribution(one[0], 3000 + i);
    one.clear();
    for (const Corner corner : both_corners)
      if (open.open(i, corner)) add_corner(setting, setting.wedges[i], corner, tx, rx, one);
    for (const Contribution& end : one) add_contribution(end, 4000 + i);
  }
  return sum;
}

/// Tells whether a path over two edges is in one of the lists alone.
bool differ_by_a_pair(std::vector<uint32_t> a, std::vector<uint32_t> b) {
  std::ranges::sort(a), std::ranges::sort(b);
  std::vector<uint32_t> differ;
  std::ranges::set_symmetric_difference(a, b, std::back_inserter(differ));
  return std::ranges::any_of(differ, [](uint32_t path) { return path >= 2000 && path < 3000; });
}

/// Walks along a closed curve, place(0) to place(2 pi), and returns the largest step of the field where a
/// path appears or ends, relative to the field there, dB. Changes by paths over two edges count only if
/// `of_pairs`: their ends have no waves of their own.
double largest_step_db(const Setting& setting, const OpenCorners& open,
                       const std::function<dvec3(double)>& place, const dvec3& tx, const dvec3& sent,
                       bool of_pairs, int& changes) {
  double most = 0.0;
  constexpr int steps = 1500;
  Total before = total(setting, tx, place(0.0), sent, open);
  for (int i = 1; i <= steps; ++i) {
    double low = 2.0 * pi * (i - 1) / steps, high = 2.0 * pi * i / steps;
    const Total after = total(setting, tx, place(high), sent, open);
    if (after.paths != before.paths) {
      Total at_low = before, at_high = after;
      while (high - low > 1e-5) {  // 0.2 mm; nearer, roundings decide whether a path exists (EdgeSides)
        const double middle = 0.5 * (low + high);
        const Total at = total(setting, tx, place(middle), sent, open);
        (at.paths == at_low.paths ? at_low : at_high) = at;
        (at.paths == at_low.paths ? low : high) = middle;
      }
      if (!of_pairs && differ_by_a_pair(at_low.paths, at_high.paths)) {
        before = after;
        continue;
      }
      ++changes;
      const auto level_db = [](const FieldVector& field) {
        return 10.0 * std::log10(glm::dot(field.re, field.re) + glm::dot(field.im, field.im));
      };
      const double db = std::abs(level_db(at_high.field) - level_db(at_low.field));
      most = std::max(most, db);
    }
    before = after;
  }
  return most;
}

TEST(TwoEdges, AWalkRoundABlockHasNoStep) {
  const double w = 12.0, d = 8.0;
  const Setting setting(
      block(w / wavelength, d / wavelength, [](HandScene& hand) { return hand.itu_material("concrete"); }));
  const auto place = [&](double turn) {
    return dvec3(0.5 * w + 19.0 * std::cos(turn), -0.5 * d + 16.0 * std::sin(turn), 1.5);
  };
  int changes = 0;
  for (const dvec3& tx : {dvec3(-40.0, -3.0, 9.0), dvec3(-30.0, 25.0, 4.0)})
    for (const dvec3& sent : {dvec3(0, 0, 1), dvec3(0, 1, 0)})
      EXPECT_LT(largest_step_db(setting, {}, place, tx, sent, true, changes), 0.1);
  EXPECT_GT(changes, 40);
}

/// Returns a box on no ground.
HandScene box(const dvec3& size) {
  HandScene hand;
  const uint32_t concrete = hand.itu_material("concrete");
  const double x = size.x, y = size.y, z = size.z;
  hand.quad({0, 0, 0}, {0, 0, z}, {x, 0, z}, {x, 0, 0}, concrete);
  hand.quad({0, y, 0}, {x, y, 0}, {x, y, z}, {0, y, z}, concrete);
  hand.quad({0, 0, 0}, {0, y, 0}, {0, y, z}, {0, 0, z}, concrete);
  hand.quad({x, 0, 0}, {x, 0, z}, {x, y, z}, {x, y, 0}, concrete);
  hand.quad({0, 0, 0}, {x, 0, 0}, {x, y, 0}, {0, y, 0}, concrete);
  hand.quad({0, 0, z}, {0, y, z}, {x, y, z}, {x, 0, z}, concrete);
  return hand;
}

TEST(Corners, AWalkOverABoxHasNoStep) {
  const HandScene hand = box({6.0, 4.0, 5.0});
  const Setting setting(hand);
  const OpenCorners open(hand.scene, FacetKinds(6, FacetKind::opaque), setting.wedges);
  const auto place = [&](double turn) {
    return dvec3(3.0 + 9.0 * std::cos(turn), 12.0, 4.0 + 7.0 * std::sin(turn));
  };
  int changes = 0, without = 0;
  for (const dvec3& tx : {dvec3(4.0, -25.0, 6.0), dvec3(-9.0, -15.0, 3.0)})
    for (const dvec3& sent : {dvec3(0, 0, 1), dvec3(1, 0, 0)}) {
      EXPECT_LT(largest_step_db(setting, open, place, tx, sent, false, changes), 0.05);
      EXPECT_GT(largest_step_db(setting, {}, place, tx, sent, false, without), 0.5);
    }
  EXPECT_GT(changes, 10);
}

}  // namespace
}  // namespace greatx::rf
