// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include "core/phase.h"
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

/// Returns the whole field: direct, reflected once, over one edge and over two.
Total total(const Setting& setting, const dvec3& tx, const dvec3& rx, const dvec3& sent) {
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
  }
  return sum;
}

/// Walks round a block of concrete in a circle and returns the largest step of the field where a path appears
/// or ends, relative to the field there, dB.
double largest_step_db(const dvec3& tx, const dvec3& sent, int& changes) {
  const double w = 12.0, d = 8.0;
  const Setting setting(
      block(w / wavelength, d / wavelength, [](HandScene& hand) { return hand.itu_material("concrete"); }));
  const auto place = [&](double turn) {
    return dvec3(0.5 * w + 19.0 * std::cos(turn), -0.5 * d + 16.0 * std::sin(turn), 1.5);
  };
  double most = 0.0;
  constexpr int steps = 1500;
  Total before = total(setting, tx, place(0.0), sent);
  for (int i = 1; i <= steps; ++i) {
    double low = 2.0 * pi * (i - 1) / steps, high = 2.0 * pi * i / steps;
    const Total after = total(setting, tx, place(high), sent);
    if (after.paths != before.paths) {
      Total at_low = before, at_high = after;
      while (high - low > 1e-5) {  // 0.2 mm; nearer, roundings decide whether a path exists (EdgeSides)
        const double middle = 0.5 * (low + high);
        const Total at = total(setting, tx, place(middle), sent);
        (at.paths == at_low.paths ? at_low : at_high) = at;
        (at.paths == at_low.paths ? low : high) = middle;
      }
      ++changes;
      const auto level_db = [](const FieldVector& field) {
        return 10.0 * std::log10(glm::dot(field.re, field.re) + glm::dot(field.im, field.im));
      };
      const double db = std::abs(level_db(at_high.field) - level_db(at_low.field));
      if (db > 0.05) printf("turn %.4f: %.3f dB\n", low, db);
      most = std::max(most, db);
    }
    before = after;
  }
  return most;
}

TEST(TwoEdges, AWalkRoundABlockHasNoStep) {
  int changes = 0;
  for (const dvec3& tx : {dvec3(-40.0, -3.0, 9.0), dvec3(-30.0, 25.0, 4.0)})
    for (const dvec3& sent : {dvec3(0, 0, 1), dvec3(0, 1, 0)})
      EXPECT_LT(largest_step_db(tx, sent, changes), 0.1);
  EXPECT_GT(changes, 40);
}

}  // namespace
}  // namespace greatx::rf
