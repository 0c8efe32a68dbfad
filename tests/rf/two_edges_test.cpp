// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/edges/two_edges.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/random.h"
#include "core/units.h"
#include "rf/edges/double_fresnel.h"
#include "tests/rf/boundary_integral.h"
#include "tests/rf/edge_contributions.h"

namespace greatx::rf {
namespace {

using namespace testing;

/// Integrates over both variables by Gauss and Legendre's rule, from the definition.
DoubleFresnel by_definition(double w_1, double w_2, double rho) {
  constexpr int panels = 250;
  const Complex diagonal = std::polar(1.0, 0.25 * pi);
  const double node[3] = {0.0, std::sqrt(0.6), -std::sqrt(0.6)},
               weight[3] = {8.0 / 9.0, 5.0 / 9.0, 5.0 / 9.0};
  const double end = 6.5 / std::sqrt(1.0 - std::max(rho, 0.0)), width = end / panels;
  DoubleFresnel sum{0.0, 0.0, 0.0};
  for (int p = 0; p < panels * 3; ++p)
    for (int q = 0; q < panels * 3; ++q) {
      const auto place = [&](int i) { return (i / 3 + 0.5 + 0.5 * node[i % 3]) * width; };
      const double u = place(p), v = place(q), dudv = 0.25 * width * width * weight[p % 3] * weight[q % 3];
      const Complex value =
          dudv * std::exp(-u * u - v * v + 2.0 * rho * u * v - 2.0 * diagonal * (w_1 * u + w_2 * v));
      sum.value += value, sum.moment_1 += u * value, sum.moment_2 += v * value;
    }
  const double scale = 4.0 * std::sqrt(1.0 - rho * rho) / pi;
  return {scale * sum.value, scale * sum.moment_1, scale * sum.moment_2};
}

DoubleFresnel at(double w_1, double w_2, double rho) {
  return double_fresnel(w_1, w_2, rho, std::sqrt((1.0 - rho) * (1.0 + rho)));
}

TEST(DoubleFresnel, IsItsDefinition) {
  for (const double rho : {-0.9, -0.4, 0.0, 0.3, 0.8})
    for (const double w_1 : {0.0, 0.4, 2.0})
      for (const double w_2 : {0.0, 0.7, 3.0}) {
        const DoubleFresnel found = at(w_1, w_2, rho), expected = by_definition(w_1, w_2, rho);
        EXPECT_LT(std::abs(found.value - expected.value), 1e-6) << rho << ' ' << w_1 << ' ' << w_2;
        EXPECT_LT(std::abs(found.moment_1 - expected.moment_1), 1e-6);
        EXPECT_LT(std::abs(found.moment_2 - expected.moment_2), 1e-6);
      }
}

TEST(DoubleFresnel, ClosedForms) {
  for (const double w_1 : {0.0, 1e-3, 0.3, 1.7, 9.0, 400.0, 1e5})
    for (const double w_2 : {0.0, 0.2, 5.0, 1e4}) {
      const Complex product = erfcx_on_diagonal(w_1) * erfcx_on_diagonal(w_2);
      EXPECT_LT(std::abs(at(w_1, w_2, 0.0).value - product), 2e-8 * std::abs(product)) << w_1 << ' ' << w_2;
    }
  for (const double rho : {-0.9999, -0.99, -0.5, 0.0, 0.7, 0.97, 0.9999})
    EXPECT_NEAR(at(0.0, 0.0, rho).value.real(), 1.0 + 2.0 / pi * std::asin(rho), 1e-12) << rho;
  // Far out, with the next term of the expansion in rho.
  for (const double rho : {-0.9, 0.5, 0.99}) {
    const double w_1 = 2e3, w_2 = 5e3;
    const Complex b1b2(0.0, w_1 * w_2);
    const Complex expected = std::sqrt(1.0 - rho * rho) / (pi * b1b2) * (1.0 + rho / (2.0 * b1b2));
    EXPECT_LT(std::abs(at(w_1, w_2, rho).value - expected), 1e-6 * std::abs(expected)) << rho;
  }
}

TEST(DoubleFresnel, PassesABoundaryOfEitherEdge) {
  // Lit: the wave of the other edge alone, less the pair; the correlation changes its sign.
  for (const double rho : {-0.8, 0.3, 0.95}) {
    const double w_2 = 1.3, sine = std::sqrt(1.0 - rho * rho);
    const Complex dark = 0.25 * at(0.0, w_2, rho).value, lit = -0.25 * at(0.0, w_2, -rho).value;
    // The other edge alone has L (r_1 + r_2) r_3/R, without 1 - rho^2.
    EXPECT_LT(std::abs(dark - lit - 0.5 * erfcx_on_diagonal(w_2 / sine)), 1e-9) << rho;
  }
}

TEST(ErrorFunction, OfComplexArguments) {
  for (const double x : {0.0, 0.1, 1.0, 4.0, 20.0}) {
    EXPECT_NEAR(erfcx(x).real() / (x < 20.0 ? std::exp(x * x) * std::erfc(x) : 0.0281743487410513), 1.0,
                1e-10);
    const Complex on_diagonal = erfcx(std::polar(x, 0.25 * pi));
    EXPECT_LT(std::abs(on_diagonal - erfcx_on_diagonal(x)), 1e-11);
    // On the imaginary axis the real part is a Gaussian.
    EXPECT_NEAR(erfcx(Complex(0.0, x)).real(), std::exp(-x * x), 1e-11);
  }
  const Complex z(-1.2, 0.7);
  EXPECT_LT(std::abs(erfcx(z) + erfcx(-z) - 2.0 * std::exp(z * z)), 1e-11);
}

TEST(GrazingReflection, FromHardToSoft) {
  EXPECT_LT(std::abs(grazing_reflection(0.0, wave_number, 10.0).steady() - 1.0), 1e-12);
  EXPECT_LT(std::abs(grazing_reflection(0.0, wave_number, 10.0).slope), 1e-12);
  EXPECT_LT(std::abs(grazing_reflection(1e9, wave_number, 10.0).steady() + 1.0), 1e-12);
  EXPECT_EQ(grazing_reflection(std::numeric_limits<double>::infinity(), wave_number, 10.0).steady(), -1.0);
  // A long way over an absorbing surface: 1 + R = 2 theta/D.
  const GrazingReflection far = grazing_reflection(0.4, wave_number, 1e4);
  EXPECT_LT(std::abs(far.steady() + 1.0), 1e-4);
  EXPECT_LT(std::abs(far.slope - 2.0 / 0.4), 1e-3);
  // Both forms of F meet.
  const double length = 2.0 * 1e6 / wave_number / 0.16;
  EXPECT_LT(std::abs(grazing_reflection(0.4, wave_number, length * 0.999).slope -
                     grazing_reflection(0.4, wave_number, length * 1.001).slope),
            1e-5);
}

struct Shadow {
  dvec2 from, to;  ///< wavelengths
};

/// Returns the error of the sum over one and two edges against the boundary integral, dB, and the field
/// behind the block, dB against free space.
struct Compared {
  double error_db, field_db;
};
Compared compare(const Setting& setting, ImpedanceBlock& reference, const Shadow& shadow, bool hard) {
  reference.solve(shadow.from);
  const Complex expected = reference.field(shadow.to);
  const dvec3 tx(wavelength * shadow.from, 0.0), rx(wavelength * shadow.to, 0.0), z(0, 0, 1);
  Complex sum = 0.0;
  for (const Contribution& path : contributions(setting, tx, rx)) {
    const TwoEdgeMatrix& m = path.map;
    // In a plane across the edges: E along the edges is soft, H along them hard.
    const dvec3 in = glm::cross(m.beta_in, m.phi_in), out = glm::cross(m.beta_out, m.phi_out);
    const double turned =
        hard ? glm::dot(glm::cross(in, m.phi_in), z) * glm::dot(glm::cross(out, m.phi_out), z)
             : glm::dot(m.beta_in, z) * glm::dot(m.beta_out, z);
    sum += m.matrix[hard ? 3 : 0] * turned * ImpedanceBlock::ray(path.length_m / wavelength);
  }
  return {20.0 * std::log10(std::abs(sum / expected)),
          20.0 * std::log10(std::abs(expected / ImpedanceBlock::ray(glm::distance(shadow.from, shadow.to))))};
}

constexpr double width = 2.0, depth = 8.0;
const Shadow shadows[] = {{{-15, -3}, {width + 15, -3}},  // both hidden
                          {{-15, -3}, {width + 4, -5}},
                          {{-6, -3}, {width + 6, -3}},
                          {{-15, -0.02}, {width + 15, -2}},  // beside the plane of the roof
                          {{-15, 0.02}, {width + 15, -2}},
                          {{-15, 1}, {width + 10, -5}},
                          {{-15, 2}, {width + 15, -2 - 4 * width / 15}},  // in line with the second edge
                          {{-15, 4}, {width + 10, -5}}};

uint32_t conductor(HandScene& hand) { return hand.material("conductor", 1.0, 1e30); }
uint32_t dense(HandScene& hand) { return hand.material("dense", 25.0); }
uint32_t denser(HandScene& hand) { return hand.material("denser", 400.0); }
uint32_t light(HandScene& hand) { return hand.material("light", 6.6); }

TEST(TwoEdges, ConductingBlock) {
  const Setting setting(block(width, depth, conductor));
  ASSERT_EQ(setting.wedges.size(), 4);
  ImpedanceBlock soft(width, depth, true, 0.0), hard(width, depth, false, 0.0);
  for (const Shadow& shadow : shadows) {
    const Compared of_soft = compare(setting, soft, shadow, false),
                   of_hard = compare(setting, hard, shadow, true);
    EXPECT_NEAR(of_soft.error_db, 0.0, 0.4) << shadow.from.y << ' ' << shadow.to.x << ' ' << of_soft.field_db;
    EXPECT_NEAR(of_hard.error_db, 0.0, 0.25)
        << shadow.from.y << ' ' << shadow.to.x << ' ' << of_hard.field_db;
  }
}

/// Returns the largest errors in both polarizations, dB.
dvec2 worst_errors(uint32_t (*material)(HandScene&), double eta) {
  const Setting setting(block(width, depth, material));
  // D at grazing incidence; at the angles of the other faces it differs by 1/(2 eta) at most.
  ImpedanceBlock te(width, depth, true, 1.0 / std::sqrt(eta - 1.0)),
      tm(width, depth, false, std::sqrt(eta - 1.0) / eta);
  dvec2 most(0.0);
  for (const Shadow& shadow : shadows) {
    most.x = std::max(most.x, std::abs(compare(setting, te, shadow, false).error_db));
    most.y = std::max(most.y, std::abs(compare(setting, tm, shadow, true).error_db));
  }
  return most;
}

TEST(TwoEdges, BlockWithASurfaceImpedance) {
  const dvec2 of_light = worst_errors(light, 6.6), of_dense = worst_errors(dense, 25.0),
              of_denser = worst_errors(denser, 400.0);
  EXPECT_LT(of_light.x, 0.45);
  EXPECT_LT(of_dense.x, 0.45);
  EXPECT_LT(of_denser.x, 0.45);
  EXPECT_LT(of_light.y, 1.1);
  EXPECT_LT(of_dense.y, 1.1);
  EXPECT_LT(of_denser.y, 1.1);
}

/// Returns two screens, at y = 0 with the edge at x = 0, and at y = gap with the edge at x = height; edges
/// run along z.
HandScene screens(double gap, double height) {
  HandScene hand;
  const uint32_t of_plates = conductor(hand);
  hand.quad({0, 0, -900}, {0, 0, 900}, {900, 0, 900}, {900, 0, -900}, of_plates);
  hand.quad({height, gap, -900}, {height, gap, 900}, {900, gap, 900}, {900, gap, -900}, of_plates);
  return hand;
}

const scene::Wedge& edge_at(const Setting& setting, double x, double y) {
  for (const scene::Wedge& wedge : setting.wedges)
    if (glm::length(dvec2(wedge.a) - dvec2(x, y)) + glm::length(dvec2(wedge.b) - dvec2(x, y)) < 1e-9)
      return wedge;
  throw std::logic_error("no such edge");
}

TEST(TwoEdges, KnifeEdgesAreVoglers) {
  // Vogler, eq. 3 and 4, by quadrature: beta_m = theta_m sqrt(j k r_m r_{m+1}/(2 (r_m + r_{m+1}))).
  const double gap = 60.0, height = 0.8, before = 100.0, after = 140.0;
  const Setting setting(screens(gap, height), true);
  const scene::Wedge &first = edge_at(setting, 0.0, 0.0), &second = edge_at(setting, height, gap);
  for (const double drop_1 : {1e-6, 1.0, 4.0})
    for (const double drop_2 : {1e-6, 2.0, 5.0}) {
      const double lean = std::atan2(height, gap), lean_1 = lean - drop_1 / before,
                   lean_2 = lean + drop_2 / after;
      const dvec3 tx(-std::tan(lean_1) * before, -before, 0.0),
          rx(height + std::tan(lean_2) * after, gap + after, 0.0);
      std::vector<Contribution> one;
      add_pair(setting, first, second, tx, rx, one);
      ASSERT_EQ(one.size(), 1);
      const double r_1 = std::hypot(tx.x, tx.y), r_2 = std::hypot(gap, height),
                   r_3 = std::hypot(rx.x - height, rx.y - gap);
      const double w_1 = (lean - lean_1) * std::sqrt(0.5 * wave_number * r_1 * r_2 / (r_1 + r_2)),
                   w_2 = (lean_2 - lean) * std::sqrt(0.5 * wave_number * r_2 * r_3 / (r_2 + r_3));
      const Complex expected =
          0.25 * by_definition(w_1, w_2, std::sqrt(r_1 * r_3 / ((r_1 + r_2) * (r_2 + r_3)))).value;
      // The mean of both polarizations of a conductor has no reflection.
      const Complex found = 0.5 * (one[0].map.matrix[0] + one[0].map.matrix[3]);
      EXPECT_NEAR(std::abs(found) / std::abs(expected), 1.0, 0.005) << drop_1 << ' ' << drop_2;
    }
  // Three equal spans in line: a third of the field.
  const Setting equal(screens(100.0, 0.0), true);
  std::vector<Contribution> one;
  add_pair(equal, edge_at(equal, 0, 0), edge_at(equal, 0, 100), {0, -100, 0}, {0, 200, 0}, one);
  ASSERT_EQ(one.size(), 1);
  EXPECT_NEAR(std::abs(one[0].map.matrix[0]), 1.0 / 3.0, 0.01);
}

TEST(TwoEdges, SquareToEachOtherTheyAreTwoSingleEdges) {
  // rho = 0: each edge sees the other as a part of the way.
  HandScene hand;
  const uint32_t of_walls = hand.itu_material("concrete");
  hand.quad({0, 0, -90}, {0, 0, 90}, {90, 0, 90}, {90, 0, -90}, of_walls);  // the corner on the z axis
  hand.quad({0, 0, -90}, {0, -90, -90}, {0, -90, 90}, {0, 0, 90}, of_walls);
  hand.quad({-50, 60, 0}, {50, 60, 0}, {50, 99, 0}, {-50, 99, 0}, of_walls);  // a roof edge along x
  hand.quad({-50, 60, 0}, {-50, 60, -30}, {50, 60, -30}, {50, 60, 0}, of_walls);
  const Setting setting(hand);
  ASSERT_EQ(setting.wedges.size(), 2);
  const bool is_first = setting.wedges[0].a.x == setting.wedges[0].b.x;
  const scene::Wedge &first = setting.wedges[is_first ? 0 : 1], &second = setting.wedges[is_first ? 1 : 0];
  const dvec3 tx(30.0, 20.0, -4.0), rx(-20.0, 90.0, 17.0);
  const auto points = keller_points(first, second, tx, rx);
  ASSERT_TRUE(points.has_value());
  TwoEdgeRays rays;
  const double r[3] = {glm::distance(tx, points->first), glm::distance(points->first, points->second),
                       glm::distance(points->second, rx)};
  rays.before_m = r[0], rays.between_m = r[1], rays.after_m = r[2];
  rays.in = (points->first - tx) / r[0], rays.between = (points->second - points->first) / r[1];
  rays.out = (rx - points->second) / r[2];
  const TwoEdgeMatrix both = two_edge_matrix(first, second, rays, setting.world, setting.surfaces);
  const EdgeDyadic one = edge_dyadic(first, rays.in, rays.between, r[0], r[1] + r[2], setting.world,
                                     setting.surfaces),
                   two = edge_dyadic(second, rays.between, rays.out, r[0] + r[1], r[2], setting.world,
                                     setting.surfaces);
  const double turn = std::abs(glm::dot(one.phi_out, two.phi_in));
  EXPECT_LT(turn, 0.35);
  FieldVector field;
  field.add(1.0, one.beta_in);
  const FieldVector expected = two.apply(one.apply(field)), found = both.apply(field);
  // The edges are not quite square as seen along the ray: rho = 0.03.
  EXPECT_LT(glm::length(expected.re - found.re) + glm::length(expected.im - found.im),
            0.02 * (glm::length(expected.re) + glm::length(expected.im)));
}

TEST(KellerPoints, AreTheShortestWay) {
  RandomStream random(31, 0);
  const Setting setting(block(60.0, 40.0, conductor));
  int found = 0;
  for (int i = 0; i < 400; ++i) {
    const auto draw = [&] {
      return dvec3(random.uniform(-20, 25), random.uniform(-20, 20), random.uniform(-400, 400));
    };
    const dvec3 tx = draw(), rx = draw();
    const scene::Wedge &first = setting.wedges[i % 4], &second = setting.wedges[(i / 4) % 4];
    if (&first == &second) continue;
    const auto points = keller_points(first, second, tx, rx);
    const auto back = keller_points(second, first, rx, tx);
    ASSERT_EQ(points.has_value(), back.has_value());
    if (!points) continue;
    ++found;
    EXPECT_LT(glm::distance(points->first, back->second), 1e-9);
    const auto length = [&](double z_1, double z_2) {
      const dvec3 p = points->first + dvec3(0, 0, z_1), q = points->second + dvec3(0, 0, z_2);
      return glm::distance(tx, p) + glm::distance(p, q) + glm::distance(q, rx);
    };
    const double least = length(0, 0);
    for (const double step : {1e-3, 1.0, 30.0})
      for (int turn = 0; turn < 8; ++turn)
        EXPECT_GE(length(step * std::cos(turn * 0.25 * pi), step * std::sin(turn * 0.25 * pi)),
                  least * (1.0 - 1e-15));
  }
  EXPECT_GT(found, 40);
}

}  // namespace
}  // namespace greatx::rf
