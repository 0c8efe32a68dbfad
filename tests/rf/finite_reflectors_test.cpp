// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks the weights of finite reflectors against physical optics of plates by quadrature over their area,
// against closed forms, against the exact series of a conducting cylinder, and beside UTD.
#include "rf/field/finite_reflectors.h"

#include <array>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "core/phase.h"
#include "core/random.h"
#include "core/units.h"
#include "rf/edges/diffraction.h"
#include "rf/edges/utd.h"
#include "rf/field/boundary_wave.h"
#include "rf/field/field.h"
#include "scene/description/wedges.h"
#include "tests/rf/scenes.h"

namespace greatx::rf {
namespace {

using testing::HandScene;

constexpr double wavelength_m = 1.0, wave_number = 2.0 * pi / wavelength_m;  // lengths in wavelengths

/// Gauss-Legendre with eight points on [0, 1] (Abramowitz and Stegun, table 25.4).
constexpr std::array<double, 4> gauss_node = {0.183434642495650, 0.525532409916329, 0.796666477413627,
                                              0.960289856497536};
constexpr std::array<double, 4> gauss_weight = {0.362683783378362, 0.313706645877887, 0.222381034453374,
                                                0.101228536290376};
double node(int i) { return 0.5 + 0.5 * (i < 4 ? -gauss_node[3 - i] : gauss_node[i - 4]); }
double weight_at(int i) { return 0.5 * gauss_weight[i < 4 ? 3 - i : i - 4]; }

/// A rectangle in the plane z = 0.
struct Rectangle {
  double x0, x1, y0, y1;
};

/// A reflection at the origin in the plane z = 0, in the plane of incidence at `azimuth`.
ReflectionSight reflection(double theta, double azimuth, double before_m, double after_m) {
  const dvec3 out(std::sin(theta) * std::cos(azimuth), std::sin(theta) * std::sin(azimuth), std::cos(theta));
  return {dvec3(0.0), dvec3(out.x, out.y, -out.z), out, before_m, after_m};
}

/// Kirchhoff's integral over a rectangle in units of the field of an endless wall, by quadrature over the
/// area with `cells` cells per wavelength: (1/4 pi) int e^{-jk(r+s)}/(r s) ((jk + 1/r) cos_r + (jk + 1/s)
/// cos_s) dA.
Complex kirchhoff(const Rectangle& plate, const ReflectionSight& sight, double cells) {
  const dvec3 source = -sight.before_m * sight.out, receiver = sight.after_m * sight.out;
  const double whole = sight.before_m + sight.after_m;
  const int columns = static_cast<int>(std::ceil((plate.x1 - plate.x0) * cells)),
            rows = static_cast<int>(std::ceil((plate.y1 - plate.y0) * cells));
  const double dx = (plate.x1 - plate.x0) / columns, dy = (plate.y1 - plate.y0) / rows;
  Complex sum = 0.0;
  for (int i = 0; i < 8 * columns; ++i)
    for (int j = 0; j < 8 * rows; ++j) {
      const dvec3 at(plate.x0 + dx * (i / 8 + node(i % 8)), plate.y0 + dy * (j / 8 + node(j % 8)), 0.0);
      const dvec3 r = at - source, s = receiver - at;
      const double rr = glm::length(r), ss = glm::length(s);
      const double excess = 2.0 * (rr * ss - glm::dot(r, s)) / (rr + ss + whole);
      sum += weight_at(i % 8) * weight_at(j % 8) * std::polar(1.0 / (rr * ss), -wave_number * excess) *
             Complex(r.z / (rr * rr) + s.z / (ss * ss), wave_number * (r.z / rr + s.z / ss));
    }
  return sum * (dx * dy * whole / (4.0 * pi));
}

struct Plates {
  HandScene hand;
  Plates() { hand.material("metal", 1.0, 1e9); }
  uint32_t add(const Rectangle& r) {
    return hand.quad({r.x0, r.y0, 0}, {r.x1, r.y0, 0}, {r.x1, r.y1, 0}, {r.x0, r.y1, 0});
  }
  FacetKinds kinds() const { return FacetKinds(hand.scene.facets.size(), FacetKind::opaque); }
  Complex weight(const ReflectionSight& sight, uint32_t facet = 0, double k = wave_number) const {
    return FiniteReflectors(hand.scene, kinds(), {}).weight(FacetWorld(hand.scene), facet, sight, k, false);
  }
};

Complex weight_of(const Rectangle& plate, const ReflectionSight& sight) {
  Plates plates;
  plates.add(plate);
  return plates.weight(sight);
}

TEST(FiniteReflectors, PlatesFromATenthToAHundredWavelengths) {
  double worst = 0.0;
  for (const double side : {0.1, 0.5, 1.0, 3.0, 10.0, 100.0})
    for (const double degrees : {0.0, 45.0, 80.0})
      for (const double before : {5.0, 300.0, 1e5})
        for (const double off : {0.0, 0.4, 0.5}) {  // in the middle, near an edge, on a corner
          if (side == 100.0 && (off == 0.4 || degrees == 45.0)) continue;  // seconds each
          const Rectangle plate{-side * (0.5 - off), side * (0.5 + off), -0.8 * side * (0.5 - off),
                                0.8 * side * (0.5 + off)};
          const ReflectionSight sight = reflection(radians(degrees), 0.3, before, 200.0);
          const Complex expected = kirchhoff(plate, sight, side < 1.0 ? 2.0 / side : 2.0);
          const Complex found = weight_of(plate, sight);
          worst = std::max(worst, std::abs(found - expected));
          // On the outline the reflection point is moved inwards by 1e-7.
          const double bound =
              off == 0.5 ? 1e-6 * std::abs(expected) + 1e-9 : 1e-9 * std::abs(expected) + 1e-15;
          EXPECT_LT(std::abs(found - expected), std::max(1.0, side) * bound)
              << side << " " << degrees << " " << before << " " << off << ": " << found << " " << expected;
        }
  RecordProperty("worst", std::to_string(worst));
}

TEST(FiniteReflectors, TinyPlatesReflectByTheirArea) {
  // j A cos(theta) D/(lambda d_1 d_2), the radar equation of a plate.
  for (const double side : {1e-3, 1e-2, 0.1})
    for (const double degrees : {0.0, 30.0, 60.0}) {
      const ReflectionSight sight = reflection(radians(degrees), 1.0, 70.0, 110.0);
      const Complex expected(0.0, side * side * std::cos(radians(degrees)) * 180.0 / (70.0 * 110.0));
      const Complex found = weight_of({-0.5 * side, 0.5 * side, -0.5 * side, 0.5 * side}, sight);
      EXPECT_LT(std::abs(found - expected), (0.02 * side + 3e-3) * std::abs(expected))
          << side << " " << degrees;
    }
}

TEST(FiniteReflectors, LongEdgesGiveOneHalfAndOneQuarter) {
  const ReflectionSight sight = reflection(0.7, 0.2, 60.0, 90.0);
  const double far = 1e8;
  EXPECT_LT(std::abs(weight_of({0.0, far, -far, far}, sight) - 0.5), 1e-6);
  // At normal incidence. Elsewhere the zones are ellipses, for which the angle is not right.
  EXPECT_LT(std::abs(weight_of({0.0, 1e5, 0.0, 1e5}, reflection(0.0, 0.0, 60.0, 90.0)) - 0.25), 1e-4);
  EXPECT_LT(std::abs(weight_of({-far, far, -far, far}, sight) - 1.0), 1e-6);
  // Beside the edge it is Fresnel's integral with nu = h cos(theta) sqrt(2 D/(lambda d_1 d_2)), in the plane
  // across the edge; far away the two only agree to the order of the angle.
  const ReflectionSight remote = reflection(0.0, 0.0, 6e5, 9e5);
  for (const double nu : {0.2, 0.78, 1.0, 1.22, 2.0, 4.0}) {
    const double h = nu * std::sqrt(6e5 * 9e5 / (2.0 * 1.5e6));
    const Complex expected =
        1.0 - 0.5 * std::polar(1.0, -0.5 * pi * nu * nu) * erfcx_on_diagonal(nu * std::sqrt(0.5 * pi));
    EXPECT_LT(std::abs(weight_of({-h, far, -far, far}, remote) - expected), 1e-5) << nu;
  }
}

TEST(FiniteReflectors, OutlinesOfAnyShape) {
  // An L of two rectangles, and a plate with a hole, against the sum and the difference of rectangles. Facets
  // are triangles that share corners, as scene::build makes them.
  const ReflectionSight sight = reflection(0.6, 0.9, 40.0, 25.0);
  const auto triangles = [](const Rectangle& r) {
    const dvec3 a(r.x0, r.y0, 0), b(r.x1, r.y0, 0), c(r.x1, r.y1, 0), d(r.x0, r.y1, 0);
    return std::vector<scene::FacetTriangle>{{{a, b, c}}, {{a, c, d}}};
  };
  const auto weight = [&](const std::vector<Rectangle>& parts) {
    Plates plates;
    std::vector<scene::FacetTriangle> all;
    for (const Rectangle& part : parts)
      for (const scene::FacetTriangle& triangle : triangles(part)) all.push_back(triangle);
    plates.hand.facet(all, 0, 0);
    return plates.weight(sight);
  };
  const auto expected = [&](const std::vector<Rectangle>& parts) {
    Complex sum = 0.0;
    for (const Rectangle& part : parts) sum += kirchhoff(part, sight, 2.0);
    return sum;
  };
  const std::vector<Rectangle> l = {{-1, 3, -2, 1}, {-1, 1, 1, 6}};
  EXPECT_LT(std::abs(weight(l) - expected(l)), 1e-8);
  // With the reflection point near the inner corner of the L.
  const std::vector<Rectangle> inner = {{-2, 0, -3, 0.01}, {-2, 5, 0.01, 4}, {0, 5, -0.5, 0.01}};
  EXPECT_LT(std::abs(weight(inner) - expected(inner)), 1e-8);
  const std::vector<Rectangle> frame = {
      {-2, 4, -5, -1}, {-2, -0.5, -1, 3}, {0.5, 4, -1, 3}, {-2, 4, 3, 4}, {-0.5, 0.5, -1, 1}};
  EXPECT_LT(std::abs(weight(frame) - expected(frame)), 1e-8);
}

TEST(FiniteReflectors, WhatGoesOnInItsPlaneHasNoEdge) {
  // Two materials side by side, and a floor that ends at walls: no edge counts where the surface goes on.
  const ReflectionSight sight = reflection(0.5, 0.1, 30.0, 20.0);
  Plates two;
  two.add({-1, 1, -4, 4});
  const uint32_t paint = two.hand.material("concrete", 5.24, 0.1);
  two.hand.quad({1, -4, 0}, {9, -4, 0}, {9, 4, 0}, {1, 4, 0}, paint);
  two.hand.quad({-9, -4, 0}, {-1, -4, 0}, {-1, 4, 0}, {-9, 4, 0}, paint);
  const Complex striped = two.weight(sight);
  // Only the ends of the strip are left.
  const UnfoldedRay ray{sight.out, sight.before_m, sight.after_m};
  const Complex ends = boundary_wave(ray, {dvec3(-1, -4, 0), dvec3(1, 0, 0), 0.0, 2.0}, wave_number) +
                       boundary_wave(ray, {dvec3(-1, 4, 0), dvec3(1, 0, 0), 0.0, 2.0}, wave_number);
  EXPECT_LT(std::abs(striped - (1.0 - ends)), 1e-12);
  EXPECT_GT(std::abs(ends), 0.01);
  EXPECT_LT(std::abs(weight_of({-1, 1, -4, 4}, sight)), 0.8);
  Plates closed;
  closed.hand.room({5, 4, 3});
  ReflectionSight floor = sight;
  floor.point = {2, 3, 0};
  EXPECT_EQ(closed.weight(floor, 4), 1.0);
}

TEST(FiniteReflectors, SwappedEndsGiveTheSameWeight) {
  RandomStream random(7, 1, 0);
  const auto between = [&](double a, double b) { return a + (b - a) * random.uniform(); };
  for (int i = 0; i < 200; ++i) {
    Plates plates;
    const double x = std::exp(between(-2, 6)), y = std::exp(between(-2, 6));
    plates.hand.quad({-x * between(0, 1), -y, 0}, {x, -y * between(0, 1), 0}, {x, y, 0}, {-x, y, 0});
    const ReflectionSight sight =
        reflection(between(0, 1.5), between(0, 6), std::exp(between(0, 9)), std::exp(between(0, 9)));
    const ReflectionSight back{sight.point, -sight.out, -sight.in, sight.after_m, sight.before_m};
    EXPECT_LT(std::abs(plates.weight(sight) - plates.weight(back)), 1e-12) << i;
  }
}

TEST(BoundaryWave, HardCaseContinuousInEveryParameter) {
  // The two forms of the integral meet at k (L - D) = 16, pieces are cut, and the ray crosses the edge's line
  // outside of the edge: nothing may step.
  const ReflectionSight sight = reflection(0.9, 0.4, 35.0, 80.0);
  const UnfoldedRay ray{sight.out, sight.before_m, sight.after_m};
  const auto sum = [&](double x, double length) {
    const EdgePiece piece{dvec3(-x, -0.3 * length, 0), dvec3(0, 1, 0), 0.0, length};
    return boundary_wave(ray, piece, wave_number);
  };
  for (int i = 1; i < 4000; ++i) {
    const double x = 0.01 * i;
    EXPECT_LT(std::abs(sum(x + 1e-7, 50.0) - sum(x, 50.0)), 1e-6) << x;
    EXPECT_LT(std::abs(sum(3.0, x + 1e-7) - sum(3.0, x)), 1e-6) << x;
  }
  // A piece is the sum of its parts.
  RandomStream random(3, 2, 0);
  for (int i = 0; i < 500; ++i) {
    const double end = std::exp(8.0 * random.uniform()), cut = end * random.uniform();
    EdgePiece piece{dvec3(-std::exp(6.0 * random.uniform() - 3.0), -end * random.uniform(), 0),
                    dvec3(0, 1, 0), 0.0, end};
    const Complex whole = boundary_wave(ray, piece, wave_number);
    piece.to = cut;
    const Complex first = boundary_wave(ray, piece, wave_number);
    piece.from = cut, piece.to = end;
    EXPECT_LT(std::abs(first + boundary_wave(ray, piece, wave_number) - whole), 1e-8) << i;
  }
}

/// Physical optics of a conducting plate in z = 0: the field at the receiver of the currents 2 n x H that a
/// short dipole induces, along `receive`, in units of what the endless plate reflects.
Complex vector_physical_optics(const Rectangle& plate, const ReflectionSight& sight, const dvec3& dipole,
                               const dvec3& receive, double cells) {
  const dvec3 source = -sight.before_m * sight.in, receiver = sight.after_m * sight.out;
  const double whole = sight.before_m + sight.after_m, k = wave_number;
  const int columns = static_cast<int>(std::ceil((plate.x1 - plate.x0) * cells)),
            rows = static_cast<int>(std::ceil((plate.y1 - plate.y0) * cells));
  const double dx = (plate.x1 - plate.x0) / columns, dy = (plate.y1 - plate.y0) / rows;
  Complex sum = 0.0;
  for (int i = 0; i < 8 * columns; ++i)
    for (int j = 0; j < 8 * rows; ++j) {
      const dvec3 at(plate.x0 + dx * (i / 8 + node(i % 8)), plate.y0 + dy * (j / 8 + node(j % 8)), 0.0);
      const dvec3 to = at - source, from = receiver - at;
      const double r = glm::length(to), s = glm::length(from);
      // H = j k/(4 pi) (u x p) e^{-jkr}/r, J = 2 n x H; E = -j k eta/(4 pi) (J - s (s . J)) e^{-jks}/s.
      const dvec3 current = 2.0 * glm::cross(dvec3(0, 0, 1), glm::cross(to / r, dipole));
      const dvec3 u = from / s;
      const double along = glm::dot(current - u * glm::dot(u, current), receive);
      sum += weight_at(i % 8) * weight_at(j % 8) * along / (r * s) * std::polar(1.0, -k * (r + s - whole));
    }
  // The mirrored dipole's field: a perfect conductor turns the horizontal components about.
  const dvec3 image(-dipole.x, -dipole.y, dipole.z), u = sight.out;
  const double mirrored = glm::dot(image - u * glm::dot(u, image), receive);
  return sum * (dx * dy) * Complex(0.0, -k) / (4.0 * pi) * whole / mirrored;
}

TEST(FiniteReflectors, VectorPhysicalOpticsOfAConductor) {
  // The currents of a conducting plate, both polarizations. Bound: the angle over which the ends see the
  // plate, squared and with tan^2(theta), times the part of the plate that matters.
  for (const double side : {0.1, 1.0, 5.0, 20.0})
    for (const double degrees : {0.0, 30.0, 60.0})
      for (const bool across : {true, false}) {
        const ReflectionSight sight = reflection(radians(degrees), 0.0, 150.0, 100.0);
        const Rectangle plate{-0.6 * side, 0.4 * side, -0.45 * side, 0.55 * side};
        const dvec3 te(0, 1, 0), tm_in = glm::cross(te, sight.in), tm_out = glm::cross(te, sight.out);
        const Complex expected = vector_physical_optics(plate, sight, across ? te : tm_in,
                                                        across ? te : tm_out, side < 1.0 ? 2.0 / side : 2.0);
        const Complex found = weight_of(plate, sight);
        // Beyond its first zones a plate adds nothing more: the angle is that of plate or zone.
        const double zone = std::sqrt(wavelength_m * 60.0) / std::cos(radians(degrees));
        const double angle = std::min(side, zone) / 100.0;
        const double near = 1.5 / (wave_number * sight.after_m);  // Kirchhoff's 1/(k d) of near fields
        EXPECT_LT(std::abs(found - expected), (0.5 * angle + near) * std::abs(found))
            << side << " " << degrees << " " << across << ": " << found << " " << expected;
      }
}

/// A prism of n sides about the z axis, with conducting walls and without lids, turned by half a side so that
/// a side faces +x.
void add_prism(HandScene& hand, int sides, double radius, double half_height) {
  for (int i = 0; i < sides; ++i) {
    const double a = 2.0 * pi * (i - 0.5) / sides, b = 2.0 * pi * (i + 0.5) / sides;
    const dvec3 p(radius * std::cos(a), radius * std::sin(a), 0),
        q(radius * std::cos(b), radius * std::sin(b), 0);
    const dvec3 up(0, 0, half_height);
    hand.quad(p - up, q - up, q + up, p + up);
  }
}

TEST(FiniteReflectors, SwappedEndsGiveTheSameWeightOnRoundSurfaces) {
  RandomStream random(9, 1, 0);
  for (int i = 0; i < 50; ++i) {
    const int sides = 6 + static_cast<int>(random.below(40));
    const double radius = std::exp(random.uniform(-2.0, 3.0)), apothem = radius * std::cos(pi / sides);
    HandScene hand;
    hand.material("metal", 1.0, 1e9);
    add_prism(hand, sides, radius, 30.0);
    const FiniteReflectors reflectors(hand.scene, FacetKinds(sides, FacetKind::opaque), {});
    const FacetWorld world(hand.scene);
    const double azimuth = random.uniform(-1.2, 1.2), height = random.uniform(-0.5, 0.5);
    const dvec3 out = glm::normalize(dvec3(std::cos(azimuth), std::sin(azimuth), height));
    const ReflectionSight sight{{apothem, 0, random.uniform(-29.0, 29.0)},
                                {-out.x, out.y, out.z},
                                out,
                                random.uniform(30.0, 900.0),
                                random.uniform(30.0, 900.0)};
    const ReflectionSight back{sight.point, -sight.out, -sight.in, sight.after_m, sight.before_m};
    const Complex there = reflectors.weight(world, 0, sight, wave_number, false);
    EXPECT_LT(std::abs(there - reflectors.weight(world, 0, back, wave_number, false)), 1e-12) << i;
    // On the inner side of the walls nothing bends away, and the neighbours are seen from inside, too.
    ReflectionSight inside = sight;
    inside.in.x = -sight.in.x, inside.out.x = -sight.out.x;
    inside.before_m = inside.after_m = 0.3 * radius;
    EXPECT_TRUE(std::isfinite(std::abs(reflectors.weight(world, 0, inside, wave_number, false))));
  }
}

/// |f| of the far field f e^{-jk rho}/sqrt(rho) that a conducting circular cylinder sends at the angle `phi`
/// from where a plane wave comes (R. F. Harrington, "Time-Harmonic Electromagnetic Fields", 5-9, E along the
/// axis).
double cylinder_series(double ka, double phi) {
  Complex sum = 0.0;
  for (int n = 0; n < static_cast<int>(ka) + 30; ++n) {
    const double jn = std::cyl_bessel_j(n, ka), yn = std::cyl_neumann(n, ka);
    const double sign = n % 2 == 0 ? 1.0 : -1.0;
    sum += (n == 0 ? 1.0 : 2.0) * sign * jn / Complex(jn, -yn) * std::cos(n * phi);
  }
  return std::abs(sum) * std::sqrt(2.0 / (pi * wave_number));
}

TEST(FiniteReflectors, APolygonOfNarrowFacetsReflectsLikeTheCylinder) {
  // A source and a receiver at right angles before a tall pole: 2 pi a = 5 to 30 wavelengths. Where a facet
  // has a reflection point, its weight with the neighbours' share is the reflection by the cylinder: exact
  // series, and geometrical optics with its divergence, sqrt(a cos(theta)/2).
  const double height = 4000.0, distance = 400.0;
  for (const double radius : {0.8, 2.0, 5.0})
    for (const int sides : {12, 24, 48}) {
      const double facet = 2.0 * radius * std::sin(pi / sides);
      if (facet * facet > 0.5 * radius) continue;  // facets must not stand out by more than an eighth
      HandScene hand;
      hand.material("metal", 1.0, 1e9);
      add_prism(hand, sides, radius, height);
      const double half = radians(45.0), apothem = radius * std::cos(pi / sides);
      const ReflectionSight sight{{apothem, 0, 0},
                                  {-std::cos(half), std::sin(half), 0},
                                  {std::cos(half), std::sin(half), 0},
                                  distance,
                                  distance};
      const FiniteReflectors reflectors(hand.scene, FacetKinds(hand.scene.facets.size(), FacetKind::opaque),
                                        {});
      const Complex found = reflectors.weight(FacetWorld(hand.scene), 0, sight, wave_number, false);
      const double spread = std::sqrt(2.0 * distance) / distance;  // of the wall's 1/D to sqrt(1/(d_1 d_2 D))
      const double optics = std::sqrt(0.5 * radius * std::cos(half)) * spread;
      const double exact = cylinder_series(wave_number * radius, pi - 2.0 * half) * spread;
      EXPECT_NEAR(20.0 * std::log10(optics / exact), 0.0, 0.6);
      EXPECT_NEAR(20.0 * std::log10(std::abs(found) / exact), 0.0, 1.5)
          << radius << " " << sides << " " << std::abs(found) << " " << optics;
      // The facet alone is far from that where it is narrow.
      EXPECT_LT(std::abs(found), 0.2);
      // Neighbours, too, are reciprocal.
      const ReflectionSight back{sight.point, -sight.out, -sight.in, distance, distance};
      EXPECT_LT(std::abs(reflectors.weight(FacetWorld(hand.scene), 0, back, wave_number, false) - found),
                1e-12);
    }
}

TEST(FiniteReflectors, TwoSmallPlatesAreTooWeakByTheKnownFactor) {
  // Two plates of 0.2 wavelengths, one after the other: the waves of the points of the first one, received by
  // the points of the second one. Weighed one by one they lack the factor 1 - c^2.
  for (const double between : {20.0, 100.0, 500.0}) {
    const double before = 100.0, after = 150.0, whole = before + between + after, area = 0.04;
    const Complex exact = Complex(0.0, area) * Complex(0.0, area) * whole / (before * between * after);
    const Rectangle plate{-0.1, 0.1, -0.1, 0.1};
    const Complex first = weight_of(plate, reflection(0.0, 0.0, before, between + after));
    const Complex second = weight_of(plate, reflection(0.0, 0.0, before + between, after));
    const double c2 = before * after / ((before + between) * (between + after));
    EXPECT_LT(std::abs(first * second / exact / (1.0 - c2) - 1.0), 0.01) << between;
  }
}

struct Solved {
  HandScene hand;
  std::optional<FacetWorld> world;
  std::optional<RadioSurfaces> surfaces;
  std::optional<FiniteReflectors> reflectors;
  std::vector<scene::Wedge> wedges;
  FieldModel model;
  static constexpr double frequency_hz = speed_of_light / wavelength_m;
  void build(bool free_edges) {
    world.emplace(hand.scene);
    surfaces.emplace(hand.scene, frequency_hz);
    reflectors.emplace(hand.scene, FacetKinds(hand.scene.facets.size(), FacetKind::opaque),
                       DiffractingEdges{.free = free_edges});
    wedges = scene::find_wedges(hand.scene, {.free_edges = free_edges});
    model = {&*world, &*surfaces};
    model.effects.finite_reflectors = true;
    model.reflectors = &*reflectors;
    model.wedges = wedges;
  }
};

TEST(FiniteReflectors, FieldsCarryTheWeights) {
  Solved solved;
  solved.hand.material("concrete", 5.24, 0.1);
  solved.hand.ground(3.0);
  solved.build(false);
  const GeometricPath path{
      {{InteractionType::reflection, 0}}, {{-20, 0, 20}, {0, 0, 0}, {20, 0, 20}}, 40.0 * std::sqrt(2.0)};
  const Path weighed = path_field(path, solved.model, {}, {});
  solved.model.reflectors = nullptr;
  const Path endless = path_field(path, solved.model, {}, {});
  const Complex weight =
      solved.reflectors->weight(*solved.world, 0,
                                {dvec3(0.0), glm::normalize(dvec3(1, 0, -1)), glm::normalize(dvec3(1, 0, 1)),
                                 0.5 * path.length_m, 0.5 * path.length_m},
                                wave_number, false);
  EXPECT_LT(std::abs(weight), 2.0);
  EXPECT_GT(std::abs(weight - 1.0), 0.1);
  for (int i = 0; i < 4; ++i)
    EXPECT_LT(std::abs(weighed.transfer[i] - weight * endless.transfer[i]),
              1e-14 * std::abs(endless.transfer[3]));
}

TEST(FiniteReflectors, DiffractedPathsAreNotCountedTwice) {
  // A receiver moves over a conducting strip of 4 wavelengths. Once the reflection is weighed alone; once its
  // edges diffract as paths of their own and the weight leaves their waves out. Both give the same field, to
  // what separates Kirchhoff's edges from UTD's, and both are continuous along the strip.
  Solved solved;
  solved.hand.material("metal", 1.0, 1e9);
  solved.hand.quad({-2, -4000, 0}, {2, -4000, 0}, {2, 4000, 0}, {-2, 4000, 0});
  solved.build(true);
  ASSERT_EQ(solved.wedges.size(), 4u);
  const dvec3 tx(-3, 0, 60);
  // E along y: phi-hat is y for directions with x > 0 and -y for the others.
  const auto field = [&](const Path& path, double whole) {
    const double sign = std::copysign(1.0, path.departure.x) * std::copysign(1.0, path.arrival.x);
    return sign * path.transfer[3] * unit_phasor(-turns_of(Solved::frequency_hz, path.delay_s)) * whole;
  };
  double worst = 0.0, worst_twice = 0.0;
  for (double x = -0.55; x <= 6.9; x += 0.3) {
    const dvec3 rx(x, 0, 60), image(tx.x, tx.y, -tx.z);
    const dvec3 point = 0.5 * (rx + image);
    ASSERT_LE(std::abs(point.x), 2.0);
    const double whole = glm::length(rx - image);
    GeometricPath path{{{InteractionType::reflection, 0}}, {tx, point, rx}, whole};
    const Complex alone = field(path_field(path, solved.model, {}, {}), whole);
    path.edges_diffract = 1;
    const Complex rest = field(path_field(path, solved.model, {}, {}), whole);
    Complex edges = 0.0;
    for (uint32_t i = 0; i < solved.wedges.size(); ++i) {
      const auto keller = keller_point(solved.wedges[i], tx, rx);
      if (!keller) continue;
      const GeometricPath bent{{{InteractionType::diffraction, i}},
                               {tx, *keller, rx},
                               glm::length(*keller - tx) + glm::length(rx - *keller)};
      edges += field(path_field(bent, solved.model, {}, {}), whole);
    }
    const double size = std::abs(alone);
    worst = std::max(worst, std::abs(rest + edges - alone) / size);
    worst_twice = std::max(worst_twice, std::abs(alone + edges - alone) / size);
  }
  EXPECT_LT(worst, 0.12);
  EXPECT_GT(worst_twice, 0.5);
}

TEST(FiniteReflectors, BoundHoldsInTheMiddleOfEveryFacet) {
  HandScene hand;
  hand.material("metal", 1.0, 1e9);
  for (int i = 0; i < 6; ++i) {
    const double side = 0.2 * (i + 1);
    hand.quad({10.0 * i, 0, 0}, {10.0 * i + side, 0, 0}, {10.0 * i + side, side, 0}, {10.0 * i, side, 0});
  }
  const double longest = 400.0;
  const FiniteReflectorBound bound = finite_reflector_bound(hand.scene, wavelength_m, longest);
  ASSERT_TRUE(bound.edges);
  EXPECT_EQ(bound.facet, 0u);
  EXPECT_EQ(bound.facets, 6u);
  EXPECT_EQ(bound.below_a_zone, 6u);
  const FiniteReflectors reflectors(hand.scene, FacetKinds(6, FacetKind::opaque), {});
  const FacetWorld world(hand.scene);
  double most = 0.0;
  for (uint32_t facet = 0; facet < 6; ++facet) {
    ReflectionSight sight = reflection(0.0, 0.0, 0.5 * longest, 0.5 * longest);
    sight.point = world.facet(facet).centroid;
    most = std::max(most,
                    -20.0 * std::log10(std::abs(reflectors.weight(world, facet, sight, wave_number, false))));
  }
  EXPECT_LE(most, bound.most_db + 0.01);
  EXPECT_GT(most, bound.most_db - 0.1);
  HandScene closed;
  closed.material("metal", 1.0, 1e9);
  closed.room({5, 4, 3});
  EXPECT_FALSE(finite_reflector_bound(closed.scene, wavelength_m, longest).edges);
}

}  // namespace
}  // namespace greatx::rf
