// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/edges/diffraction.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/phase.h"
#include "core/random.h"
#include "core/units.h"
#include "rf/field/field.h"
#include "rf/geometry/geometry.h"
#include "tests/rf/edge_contributions.h"
#include "tests/rf/exhaustive.h"
#include "tests/rf/scenes.h"

namespace greatx::rf {
namespace {

using testing::exhaustive_candidates;
using testing::HandScene;
using testing::solve_paths;

constexpr double frequency_hz = 3.5e9;
constexpr double wave_number = 2.0 * pi * frequency_hz / speed_of_light;

dvec3 at(double radius, double angle, double z) {
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

double norm(const FieldVector& field) {
  return std::sqrt(glm::dot(field.re, field.re) + glm::dot(field.im, field.im));
}
FieldVector operator-(const FieldVector& a, const FieldVector& b) { return {a.re - b.re, a.im - b.im}; }
FieldVector operator+(const FieldVector& a, const FieldVector& b) { return {a.re + b.re, a.im + b.im}; }
FieldVector operator*(Complex factor, const FieldVector& field) {
  return {factor.real() * field.re - factor.imag() * field.im,
          factor.real() * field.im + factor.imag() * field.re};
}

struct Setting : testing::Setting {
  using testing::Setting::Setting;

  bool visible(const dvec3& a, const dvec3& b, uint32_t skipped) const {
    for (uint32_t facet = 0; facet < world.facet_count(); ++facet) {
      const PosedFacet& plane = world.facet(facet);
      const double from = plane.distance(a), to = plane.distance(b);
      if (facet == skipped || from * to >= 0.0) continue;
      if (world.contains(facet, plane.plane_coordinates(a + from / (from - to) * (b - a)))) return false;
    }
    return true;
  }

  /// Returns the direct and the reflected field at `rx` of a source with polarization `sent`, with phases.
  FieldVector geometrical(const dvec3& tx, const dvec3& rx, const dvec3& sent) const {
    FieldVector sum;
    for (const GeometricPath& geometry :
         solve_paths(world, tx, rx, exhaustive_candidates(world.facet_count(), 1))) {
      const uint32_t facet = geometry.facets().empty() ? ~0u : geometry.facets()[0];
      bool lit = true;
      for (size_t i = 0; i + 1 < geometry.vertices.size(); ++i)
        lit = lit && visible(geometry.vertices[i], geometry.vertices[i + 1], facet);
      if (!lit) continue;
      const Path path = path_field(geometry, {&world, &surfaces}, dvec3(0.0), dvec3(0.0));
      const Complex theta_in = glm::dot(theta_hat(path.departure), sent),
                    phi_in = glm::dot(phi_hat(path.departure), sent);
      const Complex phase = unit_phasor(-turns_of(frequency_hz, path.delay_s));
      sum.add(phase * (path.transfer[0] * theta_in + path.transfer[1] * phi_in), theta_hat(path.arrival));
      sum.add(phase * (path.transfer[2] * theta_in + path.transfer[3] * phi_in), phi_hat(path.arrival));
    }
    return sum;
  }

  /// Returns the field that one wedge diffracts, or zero if the wedge has no diffraction point for these
  /// ends.
  FieldVector diffracted(const scene::Wedge& wedge, const dvec3& tx, const dvec3& rx,
                         const dvec3& sent) const {
    const auto point = keller_point(wedge, tx, rx);
    if (!point || !in_exterior(wedge, tx) || !in_exterior(wedge, rx)) return {};
    const double before = glm::distance(tx, *point), after = glm::distance(*point, rx),
                 length = before + after;
    const dvec3 in = (*point - tx) / before, out = (rx - *point) / after;
    FieldVector field;
    field.add(1.0, sent - glm::dot(sent, in) * in);
    const Complex spread = unit_phasor(-turns_of(frequency_hz, length / speed_of_light)) / length;
    return spread * edge_dyadic(wedge, in, out, before, after, world, surfaces).apply(field);
  }

  FieldVector total(const dvec3& tx, const dvec3& rx, const dvec3& sent) const {
    FieldVector sum = geometrical(tx, rx, sent);
    for (const scene::Wedge& wedge : wedges) sum = sum + diffracted(wedge, tx, rx, sent);
    return sum;
  }
};

/// Returns the corner of a house: the walls y = 0 (x > 0) and x = 0 (y < 0), whose common edge is the z axis.
/// If `turned` is set, the back of the second wall faces outwards.
HandScene corner(uint32_t (*material)(HandScene&), bool turned = false) {
  HandScene hand;
  const uint32_t of_walls = material(hand);
  hand.quad({0, 0, -80}, {0, 0, 80}, {90, 0, 80}, {90, 0, -80}, of_walls);
  if (turned) {
    hand.quad({0, 0, -80}, {0, 0, 80}, {0, -90, 80}, {0, -90, -80}, of_walls);
  } else {
    hand.quad({0, 0, -80}, {0, -90, -80}, {0, -90, 80}, {0, 0, 80}, of_walls);
  }
  return hand;
}
uint32_t conductor(HandScene& hand) { return hand.material("conductor", 1.0, 1e30); }
uint32_t concrete(HandScene& hand) { return hand.itu_material("concrete"); }
uint32_t slab(HandScene& hand) { return hand.itu_material("concrete", 0.2); }
uint32_t layered(HandScene& hand) {
  const uint32_t wall = hand.material("metal foil on brick", 1.0, 1e7, 1e-3);
  hand.scene.materials[wall].radio->layers.push_back({*scene::itu_medium("brick"), 0.1});
  return wall;
}

/// Returns the half-plane y = 0, x > 0. Its other borders are far away.
HandScene screen(uint32_t (*material)(HandScene&), bool flipped = false) {
  HandScene hand;
  const uint32_t of_plate = material(hand);
  if (flipped) {
    hand.quad({0, 0, -1000}, {1000, 0, -1000}, {1000, 0, 1000}, {0, 0, 1000}, of_plate);
  } else {
    hand.quad({0, 0, -1000}, {0, 0, 1000}, {1000, 0, 1000}, {1000, 0, -1000}, of_plate);
  }
  return hand;
}
/// Returns the edge of the half-plane on the z axis.
const scene::Wedge& near_edge(const Setting& setting) {
  for (const scene::Wedge& wedge : setting.wedges)
    if (std::abs(wedge.a.x) + std::abs(wedge.b.x) == 0.0) return wedge;
  throw std::logic_error("no edge on the z axis");
}

TEST(KellerPoint, IsTheShortestWay) {
  RandomStream random(21, 0);
  const Setting setting(corner(conductor));
  const scene::Wedge& wedge = setting.wedges.at(0);
  for (int i = 0; i < 200; ++i) {
    const dvec3 a = at(random.uniform(0.01, 50), random.uniform(0, 1.5 * pi), random.uniform(-40, 40));
    const dvec3 b = at(random.uniform(0.01, 50), random.uniform(0, 1.5 * pi), random.uniform(-40, 40));
    const auto point = keller_point(wedge, a, b);
    ASSERT_TRUE(point.has_value());
    const auto length = [&](double z) {
      return glm::distance(a, dvec3(0, 0, z)) + glm::distance(dvec3(0, 0, z), b);
    };
    // Finds the minimum by golden section.
    double low = -80.0, high = 80.0;
    const double ratio = 0.5 * (std::sqrt(5.0) - 1.0);
    while (high - low > 1e-7) {
      const double left = high - ratio * (high - low), right = low + ratio * (high - low);
      (length(left) < length(right) ? high : low) = length(left) < length(right) ? right : left;
    }
    EXPECT_NEAR(point->z, 0.5 * (low + high), 1e-5);
    EXPECT_LE(length(point->z), length(0.5 * (low + high)) * (1.0 + 1e-15));
    // In the unfolded plane, the length is the hypotenuse over the sum of both distances from the edge.
    EXPECT_NEAR(length(point->z) / std::hypot(a.z - b.z, std::hypot(a.x, a.y) + std::hypot(b.x, b.y)), 1.0,
                1e-14);
    const dvec3 in = glm::normalize(*point - a), out = glm::normalize(b - *point);
    EXPECT_NEAR(in.z, out.z, 1e-12);  // Keller's cone: equal angles with the edge
  }
}

TEST(KellerPoint, EndsOfTheEdge) {
  const Setting setting(corner(conductor));
  const scene::Wedge& wedge = setting.wedges.at(0);
  KellerRefusal why = KellerRefusal::none;
  EXPECT_TRUE(keller_point(wedge, {3, 4, 80}, {-3, 4, 80}, &why));  // the end point of the edge
  EXPECT_EQ(why, KellerRefusal::none);
  EXPECT_FALSE(keller_point(wedge, {3, 4, 80}, {-3, 4, 80.0001}, &why));
  EXPECT_EQ(why, KellerRefusal::beyond_the_edge);
  EXPECT_FALSE(keller_point(wedge, {3, 4, -200}, {-3, 4, 0}, &why));
  EXPECT_EQ(why, KellerRefusal::beyond_the_edge);
}

TEST(KellerPoint, Exterior) {
  const Setting setting(corner(conductor));
  const scene::Wedge& wedge = setting.wedges.at(0);
  EXPECT_NEAR(wedge.n, 1.5, 1e-15);
  EXPECT_TRUE(in_exterior(wedge, {1, 1, 7}));
  EXPECT_TRUE(in_exterior(wedge, {-1, 1, 200}));
  EXPECT_TRUE(in_exterior(wedge, {-1, -1, 0}));
  EXPECT_FALSE(in_exterior(wedge, {1, -1, 0}));
  EXPECT_TRUE(in_exterior(wedge, {1, 0, 0}));  // on the walls
  EXPECT_TRUE(in_exterior(wedge, {0, -1, 0}));
  EXPECT_TRUE(in_exterior(wedge, {1, -1e-12, 0}));
  EXPECT_FALSE(in_exterior(wedge, {1, -1e-3, 0}));
  KellerRefusal why = KellerRefusal::none;
  EXPECT_FALSE(keller_point(wedge, {1, 1, 7}, {1, -1, 0}, &why));
  EXPECT_EQ(why, KellerRefusal::not_outside);
  EXPECT_TRUE(in_shadow(wedge, at(5, 0.3, 0), at(9, 0.3 + pi + 1e-9, 3)) !=
              in_shadow(wedge, at(5, 0.3, 0), at(9, 0.3 + pi - 1e-9, 3)));
  EXPECT_FALSE(in_shadow(wedge, at(5, 2.0, 0), at(9, 1.0, 3)));
}

TEST(EdgeDyadic, ConductorFarFromTheBoundariesIsKellers) {
  // Keller's coefficient of a half-plane is D_{s,h} = -e^{-j pi/4}/(2 sqrt(2 pi k) sin(beta_0)) (sec((phi -
  // phi')/2) -+ sec((phi + phi')/2)), here with the unit vectors and the spreading of Balanis. The uniform
  // factor is 1 + O(1/kL) there.
  const Setting setting(screen(conductor), true);
  const scene::Wedge& wedge = near_edge(setting);
  RandomStream random(22, 0);
  int compared = 0;
  for (int i = 0; i < 300; ++i) {
    const double incident = random.uniform(0.2, pi - 0.2), observed = random.uniform(0.2, 2 * pi - 0.2);
    if (std::abs(std::cos(0.5 * (observed - incident))) < 0.3 ||
        std::abs(std::cos(0.5 * (observed + incident))) < 0.3)
      continue;
    const dvec3 tx = at(random.uniform(100, 300), incident, random.uniform(-300, 300));
    const dvec3 rx = at(random.uniform(100, 300), observed, random.uniform(-300, 300));
    const dvec3 point = keller_point(wedge, tx, rx).value();
    const double before = glm::distance(tx, point), after = glm::distance(point, rx);
    const dvec3 in = (point - tx) / before, out = (rx - point) / after, edge(0, 0, 1);
    const double sine = glm::length(glm::cross(edge, in));
    const dvec3 phi_in = -glm::cross(edge, in) / sine, phi_out = glm::cross(edge, out) / sine;
    const dvec3 beta_in = glm::cross(phi_in, in), beta_out = glm::cross(phi_out, out);
    const Complex factor = -std::polar(1.0, -0.25 * pi) / (2.0 * std::sqrt(2.0 * pi * wave_number) * sine);
    const double minus = 1.0 / std::cos(0.5 * (observed - incident)),
                 plus = 1.0 / std::cos(0.5 * (observed + incident));
    const double spreading = std::sqrt(before / (after * (before + after)));
    const dvec3 sent = glm::normalize(dvec3(0.3, -0.5, 0.8));
    const dvec3 field = sent - glm::dot(sent, in) * in;
    FieldVector expected;
    expected.add(-factor * (minus - plus) * spreading / before * glm::dot(field, beta_in), beta_out);
    expected.add(-factor * (minus + plus) * spreading / before * glm::dot(field, phi_in), phi_out);
    const Complex phase = unit_phasor(-turns_of(frequency_hz, (before + after) / speed_of_light));
    const FieldVector found = setting.diffracted(wedge, tx, rx, sent);
    EXPECT_LT(norm(found - phase * expected), 3e-3 * norm(expected));
    ++compared;
  }
  EXPECT_GT(compared, 100);
}

TEST(EdgeDyadic, ScreenIsAKnifeEdge) {
  // Directly behind the edge of a distant screen of any material, half of the field remains: 6.02 dB.
  for (const auto material : {conductor, concrete}) {
    const Setting setting(screen(material), true);
    const dvec3 tx(0, 900, 3), rx(0, -800, -2);
    const FieldVector field = setting.diffracted(near_edge(setting), tx, rx, {0, 0, 1});
    EXPECT_NEAR(20.0 * std::log10(norm(field) * glm::distance(tx, rx)), -6.0206, 0.1);
  }
}

TEST(EdgeDyadic, ConductorIsReciprocal) {
  const Setting setting(corner(conductor));
  const scene::Wedge& wedge = setting.wedges.at(0);
  RandomStream random(23, 0);
  const dvec3 sent(0.6, 0.0, 0.8), heard(0.0, 0.6, -0.8);
  for (int i = 0; i < 100; ++i) {
    const dvec3 a = at(random.uniform(1, 50), random.uniform(0, 1.5 * pi), random.uniform(-20, 20));
    const dvec3 b = at(random.uniform(1, 50), random.uniform(0, 1.5 * pi), random.uniform(-20, 20));
    const Complex there = setting.diffracted(wedge, a, b, sent).along(heard);
    const Complex back = setting.diffracted(wedge, b, a, heard).along(sent);
    EXPECT_LT(std::abs(there - back), 1e-10 / (glm::length(a) + glm::length(b)));
  }
}

TEST(EdgeDyadic, MovesWithItsBody) {
  HandScene still, moving;
  for (HandScene* hand : {&still, &moving}) {
    concrete(*hand);
    const uint32_t body = hand == &moving ? hand->body() : 0;
    hand->quad({0, 0, -80}, {0, 0, 80}, {90, 0, 80}, {90, 0, -80}, 0, body);
    hand->quad({0, 0, -80}, {0, -90, -80}, {0, -90, 80}, {0, 0, 80}, 0, body);
  }
  const Setting before(still);
  Setting after(moving);
  Motion motion;
  motion.pose = {dvec3(300, -200, 50), orientation_from_yaw_pitch_roll(0.7, -0.4, 1.9)};
  after.world.move(1, motion);
  const scene::Wedge wedge = posed(after.wedges.at(0), after.world);
  const dvec3 tx = at(12, 0.5, 3), rx = at(9, 4.0, -5), sent(0.6, 0.0, 0.8);
  const FieldVector expected = before.diffracted(before.wedges.at(0), tx, rx, sent);
  const FieldVector found =
      after.diffracted(wedge, motion.pose.apply(tx), motion.pose.apply(rx), motion.pose.rotate(sent));
  const FieldVector turned{motion.pose.rotate(expected.re), motion.pose.rotate(expected.im)};
  EXPECT_LT(norm(found - turned), 1e-9 * norm(expected));
}

TEST(EdgeDyadic, FaceThatAnEndLiesInDoesNotReflect) {
  // As in rf/geometry/geometry.h, such a face does not reflect. Only the direct wave remains, with half its
  // field on the shadow boundary.
  const Setting setting(corner(concrete));
  const dvec3 tx(20, 0, 1), sent(0, 0, 1);
  const FieldVector above = setting.total(tx, at(10, pi - 1e-6, 1), sent),
                    below = setting.total(tx, at(10, pi + 1e-6, 1), sent);
  EXPECT_LT(norm(above - below), 1e-2 * norm(above));
  // The result does not depend on which end lies in the face.
  const Setting conducting(corner(conductor));
  const scene::Wedge& wedge = conducting.wedges.at(0);
  const dvec3 rx = at(10, 2.0, -4);
  EXPECT_LT(std::abs(conducting.diffracted(wedge, tx, rx, sent).along(sent) -
                     conducting.diffracted(wedge, rx, tx, sent).along(sent)),
            1e-12);
}

struct Boundary {
  const char* name;
  double incident, observed;
};

/// Returns the step of the total field across a boundary minus the mean slope on both sides, relative to the
/// direct wave.
double step(const Setting& setting, const Boundary& boundary, double z, const dvec3& sent) {
  const double epsilon = 1e-6;  // 9 um: more than the tolerance of the facets
  const dvec3 tx = at(12, boundary.incident, 3);
  FieldVector field[4];
  for (int i = 0; i < 4; ++i)
    field[i] = setting.total(tx, at(9, boundary.observed + (2 * i - 3) * epsilon, z), sent);
  const FieldVector across = field[2] - field[1], beside = (field[1] - field[0]) + (field[3] - field[2]);
  return norm(across - Complex(0.5) * beside) * glm::distance(tx, at(9, boundary.observed, z));
}

constexpr Boundary boundaries[] = {{"shadow", 0.5, 0.5 + pi},
                                   {"shadow", 1.2, 1.2 + pi},
                                   {"shadow behind n", 4.2, 4.2 - pi},
                                   {"reflection in 0", 0.5, pi - 0.5},
                                   {"reflection in 0", 1.2, pi - 1.2},
                                   {"reflection in 0", 2.2, pi - 2.2},
                                   {"reflection in n", 2.2, 2 * pi - 2.2},
                                   {"reflection in n", 3.9, 2 * pi - 3.9}};

TEST(EdgeDyadicHardCase, N44_TotalFieldIsContinuousAtTheCornerOfAHouse) {
  struct Case {
    uint32_t (*material)(HandScene&);
    bool turned;
  };
  for (const auto& [material, turned] : {Case{conductor, false}, Case{concrete, false}, Case{slab, true},
                                         Case{layered, false}, Case{layered, true}}) {
    const Setting setting(corner(material, turned));
    ASSERT_EQ(setting.wedges.size(), 1u);
    for (const Boundary& boundary : boundaries) {
      for (const double z : {3.0, -5.0, 30.0}) {  // perpendicular and oblique incidence
        for (const dvec3& sent : {dvec3(0, 0, 1), dvec3(0.6, 0.8, 0), dvec3(0.48, -0.6, 0.64)}) {
          EXPECT_LT(step(setting, boundary, z, sent), 1e-5)
              << boundary.name << ' ' << boundary.incident << ' ' << z;
        }
      }
    }
  }
}

TEST(EdgeDyadic, WithoutDiffractionTheFieldSteps) {
  // This test shows that the previous one can fail: the step is the direct or the reflected wave.
  Setting setting(corner(conductor));
  setting.wedges.clear();
  for (const Boundary& boundary : boundaries)
    EXPECT_GT(step(setting, boundary, -5.0, {0.48, -0.6, 0.64}), 0.3) << boundary.name;
}

TEST(EdgeDyadicHardCase, N44_ExactlyOnTheShadowBoundary) {
  const Setting setting(corner(concrete));
  const scene::Wedge& wedge = setting.wedges.at(0);
  const dvec3 tx(6, 8, 2), rx(-3, -4, 2), sent(0, 0, 1);
  EXPECT_FALSE(in_shadow(wedge, tx, rx));  // a point on the boundary counts as lit
  const FieldVector on = setting.diffracted(wedge, tx, rx, sent);
  ASSERT_TRUE(std::isfinite(norm(on)));
  const Complex direct = unit_phasor(-turns_of(frequency_hz, 15.0 / speed_of_light)) / 15.0;
  const FieldVector past = setting.diffracted(wedge, tx, rx + dvec3(1e-12, 0, 0), sent);
  FieldVector lit = on;
  lit.add(direct, sent);
  // The diffracted direct wave is -1/2 on the lit side and 1/2 in the shadow; the tails of the reflections
  // are on both sides.
  EXPECT_LT(norm(lit - past), 1e-9 * std::abs(direct));
}

TEST(EdgeDyadicHardCase, N45_NearTheEdgesLine) {
  const Setting setting(corner(concrete));
  const scene::Wedge& wedge = setting.wedges.at(0);
  KellerRefusal why = KellerRefusal::none;
  EXPECT_FALSE(keller_point(wedge, {0, 0, 200}, {3, 4, 0}, &why));
  EXPECT_EQ(why, KellerRefusal::on_the_line);
  EXPECT_FALSE(keller_point(wedge, {3, 4, 0}, {0, 0, 5}, &why));
  EXPECT_EQ(why, KellerRefusal::on_the_line);
  EXPECT_FALSE(keller_point(wedge, {0, 0, 5}, {0, 0, 5}, &why));
  EXPECT_EQ(why, KellerRefusal::on_the_line);
  // For beta_0 -> 0 and for s -> 0 the field remains finite and does not exceed a few direct waves.
  for (const double aside : {1.0, 1e-3, 1e-6}) {
    const FieldVector grazing = setting.diffracted(wedge, at(aside, 1.0, -60), at(aside, 4.0, 60), {1, 0, 0});
    EXPECT_TRUE(std::isfinite(norm(grazing)));
    EXPECT_LT(norm(grazing), 3.0 / 120.0);
    const FieldVector close = setting.diffracted(wedge, at(30, 1.0, 0), at(aside, 4.0, 0), {0, 0, 1});
    EXPECT_TRUE(std::isfinite(norm(close)));
    EXPECT_LT(norm(close), 3.0 / 30.0);
  }
}

TEST(EdgeDyadicHardCase, N46_WhichSideOfAPlateIsItsFrontDoesNotMatter) {
  for (const auto material : {conductor, concrete, slab}) {
    const Setting front(screen(material), true), back(screen(material, true), true);
    const scene::Wedge &one = near_edge(front), &other = near_edge(back);
    EXPECT_LT(glm::dot(one.normal_0, other.normal_0), -0.99);
    EXPECT_EQ(one.n, 2.0);
    RandomStream random(24, 0);
    for (int i = 0; i < 100; ++i) {
      const dvec3 tx = at(random.uniform(1, 50), random.uniform(0, 2 * pi), random.uniform(-50, 50));
      const dvec3 rx = at(random.uniform(1, 50), random.uniform(0, 2 * pi), random.uniform(-50, 50));
      const dvec3 sent(0.48, -0.6, 0.64);
      const FieldVector field = front.diffracted(one, tx, rx, sent),
                        again = back.diffracted(other, tx, rx, sent);
      EXPECT_LT(norm(field - again), 1e-9 * norm(field));
    }
  }
}

TEST(EdgeDyadicHardCase, N47_SplitEdgeDiffractsOnce) {
  // The edge consists of two pieces on one wall and of three on the other, and diagonals cut the walls. The
  // result is one wedge with one diffraction point.
  HandScene hand;
  concrete(hand);
  hand.scene.facets.clear();
  const auto wall = [&](const dvec3& along, std::vector<double> cuts) {
    uint32_t first = ~0u;
    for (size_t i = 0; i + 1 < cuts.size(); ++i) {
      const dvec3 low(0, 0, cuts[i]), high(0, 0, cuts[i + 1]);
      const uint32_t facet = hand.quad(low, high, high + along, low + along);
      if (first == ~0u) first = facet;
    }
    scene::Facet& merged = hand.scene.facets[first];
    merged.triangle_count = 2 * static_cast<uint32_t>(cuts.size() - 1);
    hand.scene.facets.resize(first + 1);
  };
  wall({90, 0, 0}, {-80, 1.25, 80});
  wall({0, -90, 0}, {-80, -20, 1.3, 80});
  const Setting setting(hand), plain(corner(concrete));
  ASSERT_EQ(setting.wedges.size(), 1u);
  for (const double z : {1.25, 1.3, 1.27, -20.0, 7.0}) {
    const dvec3 tx = at(12, 0.5, z), rx = at(9, 4.0, z), sent(0, 0, 1);
    const FieldVector field = setting.diffracted(setting.wedges[0], tx, rx, sent);
    EXPECT_GT(norm(field), 0.0);
    EXPECT_LT(norm(field - plain.diffracted(plain.wedges[0], tx, rx, sent)), 1e-12);
  }
}

}  // namespace
}  // namespace greatx::rf
