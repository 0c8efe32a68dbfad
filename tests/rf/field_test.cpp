// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/field/field.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/phase.h"
#include "core/random.h"
#include "core/units.h"
#include "rf/channel/frequency_response.h"
#include "rf/edges/diffraction.h"
#include "rf/geometry/geometry.h"
#include "tests/rf/exhaustive.h"
#include "tests/rf/scenes.h"

namespace greatx::rf {
namespace {

using testing::exhaustive_candidates;
using testing::HandScene;
using testing::solve_paths;

constexpr double frequency_hz = 3.5e9;

struct Solved {
  FacetWorld world;
  RadioSurfaces surfaces;
  std::vector<Path> paths;
};

Solved solve(const HandScene& hand, const dvec3& tx, const dvec3& rx, uint32_t depth,
             double f_hz = frequency_hz, const dvec3& v_tx = dvec3(0.0), const dvec3& v_rx = dvec3(0.0)) {
  Solved solved{FacetWorld(hand.scene), RadioSurfaces(hand.scene, f_hz), {}};
  const CandidateList candidates = exhaustive_candidates(solved.world.facet_count(), depth);
  for (const GeometricPath& path : solve_paths(solved.world, tx, rx, candidates))
    solved.paths.push_back(path_field(path, {&solved.world, &solved.surfaces}, v_tx, v_rx));
  return solved;
}

void expect_near(Complex found, Complex expected, double tolerance) {
  EXPECT_NEAR(found.real(), expected.real(), tolerance);
  EXPECT_NEAR(found.imag(), expected.imag(), tolerance);
}

/// Holds the field vector at the receiver for a unit field `polarization` at the transmitter.
struct Vector {
  Complex x, y, z;
};
Vector received(const Path& path, const dvec3& polarization) {
  const Complex theta_in = glm::dot(theta_hat(path.departure), polarization);
  const Complex phi_in = glm::dot(phi_hat(path.departure), polarization);
  const Complex theta = path.transfer[0] * theta_in + path.transfer[1] * phi_in;
  const Complex phi = path.transfer[2] * theta_in + path.transfer[3] * phi_in;
  const dvec3 t = theta_hat(path.arrival), p = phi_hat(path.arrival);
  return {theta * t.x + phi * p.x, theta * t.y + phi * p.y, theta * t.z + phi * p.z};
}

TEST(PathField, LineOfSight) {
  HandScene hand;
  const Solved solved = solve(hand, {0, 0, 10}, {300, 400, 10}, 0);
  ASSERT_EQ(solved.paths.size(), 1u);
  const Path& path = solved.paths[0];
  EXPECT_EQ(path.length_m, 500.0);
  EXPECT_EQ(path.delay_s, 500.0 / speed_of_light);
  EXPECT_EQ(path.doppler_hz, 0.0);
  EXPECT_LT(glm::length(path.departure - dvec3(0.6, 0.8, 0)), 1e-15);
  EXPECT_LT(glm::length(path.departure + path.arrival), 1e-15);
  // The matrix is diag(1, -1): phi-hat changes its sign because the arrival points back (TR 38.901, eq.
  // 7.5-29).
  expect_near(path.transfer[0] * 500.0, 1.0, 1e-15);
  expect_near(path.transfer[3] * 500.0, -1.0, 1e-15);
  expect_near(path.transfer[1], 0.0, 1e-18);
  expect_near(path.transfer[2], 0.0, 1e-18);
}

TEST(PathField, LineOfSightKeepsTheFieldVector) {
  HandScene hand;
  RandomStream random(4, 0);
  for (int i = 0; i < 50; ++i) {
    const dvec3 rx(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9));
    const Path path = solve(hand, dvec3(0.0), rx, 0).paths[0];
    const dvec3 sent = glm::normalize(glm::cross(path.departure, dvec3(0.3, -0.5, 0.81)));
    const Vector got = received(path, sent);
    expect_near(got.x * path.length_m, sent.x, 1e-14);
    expect_near(got.y * path.length_m, sent.y, 1e-14);
    expect_near(got.z * path.length_m, sent.z, 1e-14);
  }
}

TEST(PathField, GroundSplitsIntoTeAndTm) {
  HandScene hand;
  hand.itu_material("concrete");
  hand.ground(100.0);
  const double height = 3.0, run = 4.0;
  const Solved solved = solve(hand, {0, 0, height}, {2 * run, 0, height}, 1);
  ASSERT_EQ(solved.paths.size(), 2u);
  const Path& path = solved.paths[1];
  EXPECT_NEAR(path.length_m, 10.0, 1e-14);
  const Complex eta = scene::relative_permittivity(*scene::itu_medium("concrete"), frequency_hz, "concrete");
  const FresnelCoefficients fresnel = half_space(eta, 0.6);
  // On a conductor, vertical polarization keeps its sense (r_TM = +1) and horizontal polarization changes it
  // (r_TE = -1). In addition, phi-hat contributes a factor of -1 because the arrival points back.
  expect_near(path.transfer[0] * 10.0, fresnel.r_tm, 1e-14);
  expect_near(path.transfer[3] * 10.0, -fresnel.r_te, 1e-14);
  expect_near(path.transfer[1] * 10.0, 0.0, 1e-14);
  expect_near(path.transfer[2] * 10.0, 0.0, 1e-14);
}

TEST(PathField, ConductorMirrorsTheSource) {
  // Image theory: a conductor reflects the field of the mirrored source with the opposite sign, E' = -(E - 2
  // n (n . E)), for any polarization and angle. Several walls act in turn.
  HandScene hand;
  hand.material("conductor", 1.0, 1e30);
  hand.room({7, 5, 3});
  const Solved solved = solve(hand, {1.1, 2.2, 0.7}, {5.3, 3.1, 2.2}, 3);
  ASSERT_EQ(solved.paths.size(), 63u);
  for (const Path& path : solved.paths) {
    const dvec3 sent = glm::normalize(glm::cross(path.departure, dvec3(0.3, -0.5, 0.81)));
    dvec3 expected = sent;
    for (const uint32_t facet : path.facets()) {
      const dvec3 normal = solved.world.facet(facet).normal;
      expected = -(expected - 2.0 * normal * glm::dot(normal, expected));
    }
    const Vector got = received(path, sent);
    expect_near(got.x * path.length_m, expected.x, 1e-8);
    expect_near(got.y * path.length_m, expected.y, 1e-8);
    expect_near(got.z * path.length_m, expected.z, 1e-8);
  }
}

TEST(PathFieldHardCase, N26_NormalIncidenceAnyBasis) {
  // The field is the same for an echo from straight ahead and for directions that approach the normal.
  HandScene hand;
  hand.itu_material("concrete");
  hand.ground(100.0);
  const Complex eta = scene::relative_permittivity(*scene::itu_medium("concrete"), frequency_hz, "concrete");
  const Complex r = half_space(eta, 1.0).r_te;
  for (const double aside : {0.0, 1e-15, 1e-12, 1e-9, 1e-8, 3e-8, 1e-7, 1e-6}) {
    const Path path = solve(hand, {0, 0, 5}, {aside, 0.7 * aside, 5}, 1).paths.back();
    ASSERT_EQ(path.facets().size(), 1u);
    // At the poles, theta and phi depend on the choice of the basis; so the test compares vectors.
    for (const dvec3& sent : {dvec3(1, 0, 0), dvec3(0, 1, 0), dvec3(0.6, 0.8, 0)}) {
      const Vector got = received(path, sent);
      expect_near(got.x * path.length_m, r * sent.x, 1e-12 + aside);
      expect_near(got.y * path.length_m, r * sent.y, 1e-12 + aside);
      expect_near(got.z * path.length_m, 0.0, 1e-12 + aside);
    }
  }
}

TEST(PathField, CornerTieHasADirectionInItsEmptySegment) {
  HandScene hand;
  hand.material("conductor", 1.0, 1e30);
  hand.quad({0, 0, 0}, {0, 10, 0}, {0, 10, 10}, {0, 0, 10});
  hand.quad({0, 0, 0}, {0, 0, 10}, {10, 0, 10}, {10, 0, 0});
  const Solved solved = solve(hand, {1, 1, 2}, {3, 3, 6}, 2);
  ASSERT_EQ(solved.paths.size(), 4u);
  const Path& path = solved.paths[3];
  for (const Complex& value : path.transfer)
    EXPECT_TRUE(std::isfinite(value.real()) && std::isfinite(value.imag()));
  EXPECT_NEAR(std::norm(path.transfer[0]) + std::norm(path.transfer[2]),
              1.0 / (path.length_m * path.length_m), 1e-9);
}

TEST(PathField, OtherSideOfALayeredWall) {
  HandScene hand;
  const uint32_t wall = hand.material("plaster on concrete", 2.73, 0.0, 0.02);
  auto& layers = hand.scene.materials[wall].radio->layers;
  layers.push_back({*scene::itu_medium("concrete"), 0.1});
  hand.ground(100.0);
  const Complex eta = scene::relative_permittivity(*scene::itu_medium("concrete"), frequency_hz, "concrete");
  const double wavelength = speed_of_light / frequency_hz;
  const DielectricLayer plaster{2.73, 0.02}, concrete{eta, 0.1};
  const Path above = solve(hand, {0, 0, 3}, {8, 0, 3}, 1).paths[1],
             below = solve(hand, {0, 0, -3}, {8, 0, -3}, 1).paths[1];
  expect_near(above.transfer[0] * 10.0,
              multilayer(std::vector<DielectricLayer>{plaster, concrete}, wavelength, 0.6).r_tm, 1e-13);
  expect_near(below.transfer[0] * 10.0,
              multilayer(std::vector<DielectricLayer>{concrete, plaster}, wavelength, 0.6).r_tm, 1e-13);
}

TEST(PathFieldHardCase, N42_Doppler) {
  HandScene hand;
  hand.material("conductor", 1.0, 1e7);
  hand.ground(20'000.0);
  for (const double speed : {1e-5, 1.0, 7500.0}) {  // 28 GHz: 9.3e-4 Hz, 93 Hz, 700 kHz
    const double f = 28e9, unit = speed / speed_of_light * f;
    // The receiver approaches head on; the transmitter recedes; both move alike.
    EXPECT_NEAR(solve(hand, {0, 0, 10}, {800, 0, 10}, 0, f, {}, {-speed, 0, 0}).paths[0].doppler_hz / unit,
                1.0, 1e-14);
    EXPECT_NEAR(solve(hand, {0, 0, 10}, {800, 0, 10}, 0, f, {-speed, 0, 0}, {}).paths[0].doppler_hz / unit,
                -1.0, 1e-14);
    EXPECT_EQ(solve(hand, {0, 0, 10}, {800, 0, 10}, 0, f, {speed, 0, 0}, {speed, 0, 0}).paths[0].doppler_hz,
              0.0);
    EXPECT_EQ(solve(hand, {0, 0, 10}, {800, 0, 10}, 0, f, {}, {0, speed, 0}).paths[0].doppler_hz, 0.0);
    // The path by the ground has the factor cos of the angle of arrival, 800 m over 20 m.
    const Path path = solve(hand, {0, 0, 10}, {800, 0, 10}, 1, f, {}, {-speed, 0, 0}).paths[1];
    EXPECT_NEAR(path.doppler_hz / (unit * 800 / std::hypot(800, 20)), 1.0, 1e-14);
  }
}

TEST(PathField, DopplerIsTheRateOfThePhase) {
  // nu = -(f/c) dL/dt. The rate follows from the lengths half a millisecond before and after, while both ends
  // and the body move.
  HandScene hand;
  hand.material("conductor", 1.0, 1e7);
  hand.ground(200.0);
  const uint32_t body = hand.body();
  hand.quad({0, -9, -9}, {0, 9, -9}, {0, 9, 9}, {0, -9, 9}, 0, body);
  const dvec3 tx(0, -5, 6), rx(3, 7, 4), v_tx(1, 2, -3), v_rx(-4, 5, 0.5), velocity(-12, 1, 0.3),
      turn(0, 0, 0.2);
  const auto at = [&](double t) {
    Solved solved{FacetWorld(hand.scene), RadioSurfaces(hand.scene, frequency_hz), {}};
    Motion motion;
    motion.pose = {dvec3(20, 0, 5) + t * velocity, orientation_from_yaw_pitch_roll(pi + 0.1 + 0.2 * t, 0, 0)};
    motion.velocity = velocity;
    motion.angular_velocity = turn;
    solved.world.move(body, motion);
    for (const GeometricPath& path :
         solve_paths(solved.world, tx + t * v_tx, rx + t * v_rx, exhaustive_candidates(2, 2)))
      solved.paths.push_back(path_field(path, {&solved.world, &solved.surfaces}, v_tx, v_rx));
    return solved.paths;
  };
  const auto before = at(-5e-4), now = at(0.0), after = at(5e-4);
  ASSERT_EQ(now.size(), 4u);
  ASSERT_EQ(before.size(), now.size());
  ASSERT_EQ(after.size(), now.size());
  for (size_t i = 0; i < now.size(); ++i) {
    const double rate = (after[i].length_m - before[i].length_m) / 1e-3;
    EXPECT_NEAR(now[i].doppler_hz, -rate * frequency_hz / speed_of_light, 1e-4);
    EXPECT_GT(std::abs(now[i].doppler_hz), 1.0);
  }
}

TEST(PathField, EdgeDiffractionMovesWithItsEnds) {
  // nu = -(f/c) d(s' + s)/dt at the corner of a house that moves and turns. The diffraction point slides
  // along the edge, which does not change the length to first order.
  HandScene hand;
  hand.material("conductor", 1.0, 1e7);
  const uint32_t body = hand.body();
  hand.quad({0, 0, -5}, {0, 0, 5}, {0, -9, 5}, {0, -9, -5}, 0, body);
  hand.quad({0, 0, -5}, {-9, 0, -5}, {-9, 0, 5}, {0, 0, 5}, 0, body);
  const scene::Wedge wedge{.a = {0, 0, -5},
                           .b = {0, 0, 5},
                           .tangent_0 = {0, -1, 0},
                           .normal_0 = {1, 0, 0},
                           .n = 1.5,
                           .facet_0 = 0,
                           .facet_n = 1,
                           .body = body};
  const dvec3 tx(8, -6, 0.5), rx(-7, 6, 1.5), v_tx(1, 2, -3), v_rx(-4, 5, 0.5), velocity(-12, 1, 3),
      turn(0.3, 0, 0.2);
  const auto at = [&](double t) {
    FacetWorld world(hand.scene);
    Motion motion;
    motion.pose = {dvec3(0.1, 0, 0.2) + t * velocity,
                   glm::angleAxis(t * glm::length(turn), glm::normalize(turn))};
    motion.velocity = velocity;
    motion.angular_velocity = turn;
    world.move(body, motion);
    const RadioSurfaces surfaces(hand.scene, frequency_hz);
    FieldModel model{&world, &surfaces};
    model.wedges = {&wedge, 1};
    const dvec3 from = tx + t * v_tx, to = rx + t * v_rx;
    const dvec3 point = *keller_point(posed(wedge, world), from, to);
    return path_field({{{InteractionType::diffraction, 0}},
                       {from, point, to},
                       glm::length(point - from) + glm::length(to - point)},
                      model, v_tx, v_rx);
  };
  const double rate = (at(5e-4).length_m - at(-5e-4).length_m) / 1e-3;
  EXPECT_NEAR(at(0.0).doppler_hz, -rate * frequency_hz / speed_of_light, 1e-4);
  EXPECT_GT(std::abs(at(0.0).doppler_hz), 10.0);
}

TEST(PathField, DiffractionFillsTheShadowBoundary) {
  // A receiver crosses the shadow boundary of a conducting screen. The sum of the direct and the diffracted
  // field has no step there, and is half the free field on the boundary.
  HandScene hand;
  hand.itu_material("metal");
  const uint32_t screen = hand.quad({0, 0, -50}, {0, -50, -50}, {0, -50, 50}, {0, 0, 50});
  const dvec3 normal = FacetWorld(hand.scene).facet(screen).normal;
  const scene::Wedge wedge{.a = normal.x > 0 ? dvec3(0, 0, -50) : dvec3(0, 0, 50),
                           .b = normal.x > 0 ? dvec3(0, 0, 50) : dvec3(0, 0, -50),
                           .tangent_0 = {0, -1, 0},
                           .normal_0 = normal,
                           .n = 2.0,
                           .facet_0 = screen};
  const FacetWorld world(hand.scene);
  const RadioSurfaces surfaces(hand.scene, frequency_hz);
  FieldModel model{&world, &surfaces};
  model.wedges = {&wedge, 1};
  const dvec3 tx(10, 0, 1);
  const auto total = [&](double y) {
    const dvec3 rx(-10, y, 2), point = *keller_point(wedge, tx, rx);
    std::vector<Path> paths{path_field({{{InteractionType::diffraction, 0}},
                                        {tx, point, rx},
                                        glm::length(point - tx) + glm::length(rx - point)},
                                       model, {}, {})};
    if (y >= 0.0) paths.push_back(path_field({{}, {tx, rx}, glm::length(rx - tx)}, model, {}, {}));
    Complex sum = 0.0;
    for (const Path& path : paths)
      sum += path.transfer[0] * path.length_m * unit_phasor(-turns_of(frequency_hz, path.delay_s));
    return sum;
  };
  EXPECT_LT(std::abs(total(1e-6) - total(-1e-6)), 1e-4);
  // The terms of the other faces add a little to the half.
  EXPECT_NEAR(std::abs(total(0.0)), 0.5, 0.02);
  EXPECT_LT(std::abs(total(-3.0)), 0.15);
}

}  // namespace
}  // namespace greatx::rf
