// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks that paths are reciprocal for any orientation of the antennas.
#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "core/random.h"
#include "core/units.h"
#include "rf/channel/frequency_response.h"
#include "rf/edges/diffraction.h"
#include "rf/field/field.h"
#include "rf/geometry/geometry.h"
#include "tests/rf/exhaustive.h"
#include "tests/rf/scenes.h"
#include "tests/rf/turned_field.h"

namespace greatx::rf {
namespace {

using testing::exhaustive_candidates;
using testing::HandScene;
using testing::solve_paths;
using testing::turned_field;

constexpr double link_hz = 3.5e9;

GeometricPath reversed(GeometricPath path) {
  std::reverse(path.interactions.begin(), path.interactions.end());
  std::reverse(path.vertices.begin(), path.vertices.end());
  return path;
}

/// Returns the response between V and H ports, [rx][tx], of antennas with the given orientations.
std::array<std::array<Complex, 2>, 2> ports(const std::vector<Path>& paths, const dquat& tx,
                                            const dquat& rx) {
  ArrayPose from, to;
  from.array.polarization = to.array.polarization = Polarization::vh;
  from.orientation = tx, to.orientation = rx;
  const auto h = frequency_response_fp64(paths, from, to, {link_hz, 30e3, 1, 1, 1e-3});
  return {{{h[0], h[1]}, {h[2], h[3]}}};
}

/// Returns the relative difference between both directions for V, H and both circular polarizations at either
/// end. An antenna that transmits V + jH receives E_V + jE_H: its receiving pattern under C_R^H is the
/// conjugate of its transmitting one.
double reciprocity_error(const std::vector<Path>& forward, const std::vector<Path>& backward) {
  const dquat a = orientation_from_yaw_pitch_roll(0.7, 0.2, -0.4),
              b = orientation_from_yaw_pitch_roll(-2, 0.5, 1);
  const auto there = ports(forward, a, b), back = ports(backward, b, a);
  const Complex i(0.0, 1.0);
  const std::array<std::array<Complex, 2>, 4> states{{{1.0, 0.0}, {0.0, 1.0}, {1.0, i}, {1.0, -i}}};
  double scale = 0.0, error = 0.0;
  for (const auto& p : states)
    for (const auto& q : states) {
      Complex one = 0.0, other = 0.0;
      for (int r = 0; r < 2; ++r)
        for (int t = 0; t < 2; ++t) {
          one += q[r] * there[r][t] * p[t];
          other += p[r] * back[r][t] * q[t];
        }
      scale = std::max(scale, std::abs(one));
      error = std::max(error, std::abs(one - other));
    }
  return error / scale;
}

/// Holds a room with a thin screen in it, all of one material.
struct ScreenRoom {
  HandScene hand;
  scene::Wedge wedge{
      .a = {3, 2, 0}, .b = {3, 2, 3}, .tangent_0 = {0, -1, 0}, .normal_0 = {1, 0, 0}, .n = 2.0};
  explicit ScreenRoom(double conductivity) {
    hand.material("metal", 1.0, conductivity);
    hand.room({7, 5, 3});
    wedge.facet_0 = hand.quad({3, 0, 0}, {3, 2, 0}, {3, 2, 3}, {3, 0, 3});
  }
};

TEST(ReciprocityHardCase, N52_ConductorScene) {
  // The test covers reflections to depth 3 and the diffraction at the edge of the screen, separately and in
  // sum. Luebbers' coefficients are not reciprocal: with 1e7 S/m, a single diffracted path has a relative
  // error of 5e-6, and its contribution to the sum has a smaller one.
  for (const double conductivity : {1e7, 1e30}) {
    const ScreenRoom room(conductivity);
    const FacetWorld world(room.hand.scene);
    const RadioSurfaces surfaces(room.hand.scene, link_hz);
    FieldModel model{&world, &surfaces};
    model.wedges = {&room.wedge, 1};
    const dvec3 tx(1.1, 2.2, 0.7), rx(5.3, 3.1, 2.2), edge = keller_point(room.wedge, tx, rx).value();
    std::vector<GeometricPath> geometry = solve_paths(world, tx, rx, exhaustive_candidates(7, 3));
    geometry.push_back({{{InteractionType::diffraction, 0}},
                        {tx, edge, rx},
                        glm::length(edge - tx) + glm::length(rx - edge)});
    std::vector<Path> forward, backward;
    for (const GeometricPath& path : geometry) {
      forward.push_back(path_field(path, model, {}, {}));
      backward.push_back(path_field(reversed(path), model, {}, {}));
      const bool diffracted = !path.interactions.empty() && path.facets().empty();
      EXPECT_LE(reciprocity_error({forward.back()}, {backward.back()}),
                diffracted && conductivity == 1e7 ? 1e-5 : 1e-6);
    }
    EXPECT_GT(forward.size(), 30u);
    EXPECT_LE(reciprocity_error(forward, backward), 1e-6);
  }
}

TEST(Reciprocity, LayeredWalls) {
  // A wall of layers transmits the same from both sides, although its reflection differs.
  HandScene hand;
  const uint32_t wall = hand.material("plaster on concrete", 2.73, 0.01, 0.02);
  hand.scene.materials[wall].radio->layers.push_back({*scene::itu_medium("concrete"), 0.1});
  hand.quad({3, -9, -9}, {3, 9, -9}, {4, 9, 9}, {4, -9, 9}, wall);
  const FacetWorld world(hand.scene);
  const RadioSurfaces surfaces(hand.scene, link_hz);
  const dvec3 tx(0, 0, 1), rx(10, 3, 2);
  const GeometricPath passed{
      {{InteractionType::transmission, 0}}, {tx, glm::mix(tx, rx, 0.35), rx}, glm::length(rx - tx)};
  const std::vector<Path> there{path_field(passed, {&world, &surfaces}, {}, {})};
  const std::vector<Path> back{path_field(reversed(passed), {&world, &surfaces}, {}, {})};
  EXPECT_LE(reciprocity_error(there, back), 1e-12);
}

TEST(ReciprocityHardCase, N50_UprightAntennas) {
  // At a pitch of +-90 degrees the rotation remains orthogonal, the field follows the pitch continuously, and
  // yaw and roll are one angle.
  RandomStream random(50, 0);
  for (const double pitch : {pi / 2, -pi / 2})
    for (int i = 0; i < 20; ++i) {
      const double yaw = random.uniform(-3, 3), roll = random.uniform(-3, 3), more = random.uniform(-3, 3);
      const dvec3 direction =
          glm::normalize(dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
      const dquat upright = orientation_from_yaw_pitch_roll(yaw, pitch, roll);
      const glm::dmat3 r = glm::mat3_cast(upright), unit = glm::transpose(r) * r;
      for (int k = 0; k < 9; ++k) EXPECT_NEAR(unit[k / 3][k % 3], k % 4 == 0 ? 1.0 : 0.0, 1e-15);
      const auto field = [&](double y, double p, double x) {
        return turned_field(Pattern::half_wave_dipole, 0.4, orientation_from_yaw_pitch_roll(y, p, x),
                            direction);
      };
      const Jones here = field(yaw, pitch, roll);
      for (const double aside : {1e-9, -1e-9}) {
        EXPECT_LT(std::abs(field(yaw, pitch + aside, roll).theta - here.theta), 1e-8);
        EXPECT_LT(std::abs(field(yaw, pitch + aside, roll).phi - here.phi), 1e-8);
      }
      const Jones turned = field(yaw + more, pitch, roll + (pitch > 0 ? more : -more));
      EXPECT_LT(std::abs(turned.theta - here.theta) + std::abs(turned.phi - here.phi), 1e-13);
    }
}

TEST(ReciprocityHardCase, N51_HalfTurns) {
  // a -> -a: antennas are turned over, and an echo returns the way it came. No value is NaN, the power
  // remains, and two half turns change nothing.
  RandomStream random(51, 0);
  for (int i = 0; i < 50; ++i) {
    const auto direction = [&] {
      return glm::normalize(dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
    };
    const dvec3 a = i == 0 ? dvec3(0, 0, 1) : direction(), seen = direction();
    const dvec3 axis = glm::normalize(glm::cross(a, direction()));
    const dquat half = glm::angleAxis(pi, axis);
    EXPECT_LT(glm::length(half * a + a), 1e-15);
    const Jones turned = turned_field(Pattern::half_wave_dipole, 0.3, half, seen);
    const Jones own = element_field(Pattern::half_wave_dipole, 0.3, glm::conjugate(half) * seen);
    EXPECT_NEAR(std::norm(turned.theta) + std::norm(turned.phi), std::norm(own.theta) + std::norm(own.phi),
                1e-14);
    const Jones twice = turned_field(Pattern::half_wave_dipole, 0.3, half * half, seen);
    const Jones none = turned_field(Pattern::half_wave_dipole, 0.3, dquat(1, 0, 0, 0), seen);
    EXPECT_LT(std::abs(twice.theta - none.theta) + std::abs(twice.phi - none.phi), 1e-13);
  }
  HandScene hand;
  hand.material("conductor", 1.0, 1e30);
  hand.ground(10.0);
  const FacetWorld world(hand.scene);
  const RadioSurfaces surfaces(hand.scene, link_hz);
  const auto paths = solve_paths(world, {1, 2, 3}, {1, 2, 3}, exhaustive_candidates(1, 1));
  ASSERT_EQ(paths.size(), 1u);
  const Path echo = path_field(paths[0], {&world, &surfaces}, {}, {});
  EXPECT_EQ(echo.departure, echo.arrival);
  // Straight down and back, a conductor inverts the field, and both ends have the same theta-hat and phi-hat.
  EXPECT_LT(std::abs(echo.transfer[0] * 6.0 + 1.0) + std::abs(echo.transfer[3] * 6.0 + 1.0), 1e-12);
  EXPECT_LT(std::abs(echo.transfer[1]) + std::abs(echo.transfer[2]), 1e-12);
}

}  // namespace
}  // namespace greatx::rf
