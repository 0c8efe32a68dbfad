// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/surface/scattering.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "core/units.h"
#include "rf/field/field.h"
#include "tests/rf/scenes.h"

namespace greatx::rf {
namespace {

using scene::ScatteringPattern;
using testing::HandScene;

constexpr double scattered_hz = 3.5e9;

struct Direction {
  dvec3 out;
  double weight;  ///< sr
};

/// Returns directions of the hemisphere about `normal`, by Gauss-Legendre quadrature in the cosine and equal
/// steps of azimuth. The quadrature is exact for lobes up to the exponent `order`.
std::vector<Direction> hemisphere(const dvec3& normal, uint32_t order) {
  const uint32_t count = order / 2 + 2, turns = order + 2;
  const dvec3 aside = std::abs(normal.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
  const dvec3 u = glm::normalize(glm::cross(normal, aside)), v = glm::cross(normal, u);
  std::vector<Direction> directions;
  for (uint32_t i = 0; i < count; ++i) {
    double x = std::cos(pi * (i + 0.75) / (count + 0.5)), slope = 1.0;
    for (int step = 0; step < 50; ++step) {  // Newton's method on P_count
      double before = 1.0, here = x;
      for (uint32_t k = 2; k <= count; ++k) {
        const double next = ((2.0 * k - 1.0) * x * here - (k - 1.0) * before) / k;
        before = here, here = next;
      }
      slope = count * (x * here - before) / (x * x - 1.0);
      x -= here / slope;
    }
    const double cosine = 0.5 * (1.0 + x), sine = std::sqrt(1.0 - cosine * cosine);
    const double weight = 1.0 / ((1.0 - x * x) * slope * slope) * 2.0 * pi / turns;
    for (uint32_t k = 0; k < turns; ++k) {
      const double turn = 2.0 * pi * (k + 0.3) / turns;
      directions.push_back({cosine * normal + sine * (std::cos(turn) * u + std::sin(turn) * v), weight});
    }
  }
  return directions;
}

// The surface has the normal +z.
dvec3 incoming(double zenith, double azimuth) {
  return {std::sin(zenith) * std::cos(azimuth), std::sin(zenith) * std::sin(azimuth), -std::cos(zenith)};
}

TEST(Scattering, LobeNormalisationFigures) {
  // F_alpha(0) = 4 pi/(alpha + 1) (1 - 2^-(alpha + 1)); F_4(45 degrees) is known to eight decimals.
  for (const uint32_t alpha : {1u, 2u, 3u, 4u, 10u, 50u, 100u}) {
    const double expected = 4.0 * pi / (alpha + 1.0) * (1.0 - std::pow(0.5, alpha + 1.0));
    EXPECT_NEAR(lobe_normalisation(alpha, 1.0) / expected, 1.0, 1e-14) << alpha;
  }
  EXPECT_NEAR(lobe_normalisation(4, std::sqrt(0.5)), 2.15909766, 5e-9);
}

TEST(Scattering, LobeNormalisationIsTheIntegral) {
  const dvec3 normal(0, 0, 1);
  for (const uint32_t alpha : {1u, 2u, 5u, 8u, 31u, 100u})
    for (const double zenith : {0.0, 0.3, 0.8, 1.2, 1.5, 0.5 * pi}) {
      const dvec3 in = incoming(zenith, 0.4), specular(in.x, in.y, -in.z);
      double sum = 0.0;
      for (const Direction& direction : hemisphere(normal, alpha))
        sum += direction.weight * std::pow(0.5 * (1.0 + glm::dot(specular, direction.out)), alpha);
      EXPECT_NEAR(lobe_normalisation(alpha, std::cos(zenith)) / sum, 1.0, 1e-12) << alpha << " " << zenith;
    }
}

std::vector<DiffuseScattering> surfaces_of_all_patterns() {
  DiffuseScattering surface{.coefficient = 0.4, .cross_polarization = 0.3};
  std::vector<DiffuseScattering> list{surface};
  for (const uint32_t alpha : {1u, 4u, 13u}) {
    surface.pattern = ScatteringPattern::directive;
    surface.exponent = alpha;
    list.push_back(surface);
    surface.pattern = ScatteringPattern::backscattering;
    surface.backscatter_exponent = 2 * alpha + 1;
    for (const double share : {0.0, 0.25, 1.0}) {
      surface.backscatter_share = share;
      list.push_back(surface);
    }
  }
  return list;
}

TEST(Scattering, PatternsIntegrateToOne) {
  const dvec3 normal = glm::normalize(dvec3(0.3, -0.7, 0.4));
  for (const DiffuseScattering& surface : surfaces_of_all_patterns())
    for (const double aside : {0.0, 0.4, 2.0, 60.0}) {
      const dvec3 in = glm::normalize(-normal + aside * glm::normalize(glm::cross(normal, dvec3(1, 2, 3))));
      double sum = 0.0;
      for (const Direction& direction : hemisphere(normal, 27))
        sum += direction.weight * scattering_pattern(surface, in, direction.out, normal);
      EXPECT_NEAR(sum, 1.0, 1e-12);
    }
}

TEST(Scattering, LobesPointWhereTheyShould) {
  const dvec3 normal(0, 0, 1), in = incoming(0.9, 1.1), specular(in.x, in.y, -in.z);
  DiffuseScattering surface{.pattern = ScatteringPattern::directive, .exponent = 6};
  const double peak = scattering_pattern(surface, in, specular, normal);
  EXPECT_NEAR(peak, 1.0 / lobe_normalisation(6, std::cos(0.9)), 1e-14);
  for (const Direction& direction : hemisphere(normal, 12))
    EXPECT_LT(scattering_pattern(surface, in, direction.out, normal), peak);
  surface.pattern = ScatteringPattern::backscattering;
  surface.backscatter_exponent = 6;
  surface.backscatter_share = 0.5;  // two equal lobes
  EXPECT_NEAR(scattering_pattern(surface, in, specular, normal), scattering_pattern(surface, in, -in, normal),
              1e-14);
  surface.backscatter_share = 1.0;
  EXPECT_NEAR(scattering_pattern(surface, in, -in, normal), peak, 1e-14);
  // No power is scattered through the surface or along it.
  for (const DiffuseScattering& each : surfaces_of_all_patterns()) {
    EXPECT_EQ(scattering_pattern(each, in, in, normal), 0.0);
    EXPECT_EQ(scattering_pattern(each, in, {1, 0, 0}, normal), 0.0);
  }
}

TEST(Scattering, MatrixIsUnitaryAndAFunctionOfThePatch) {
  for (const double crossed : {0.0, 0.2, 0.5, 1.0}) {
    const ScatteringMatrix m = scattering_matrix(crossed, 7, 12, 34);
    EXPECT_NEAR(std::norm(m.ss), 1.0 - crossed, 1e-15);
    EXPECT_NEAR(std::norm(m.pp), 1.0 - crossed, 1e-15);
    EXPECT_NEAR(std::norm(m.sp), crossed, 1e-15);
    EXPECT_NEAR(std::norm(m.ps), crossed, 1e-15);
    EXPECT_LT(std::abs(std::conj(m.ss) * m.sp + std::conj(m.ps) * m.pp), 1e-15);
  }
  const ScatteringMatrix m = scattering_matrix(0.3, 7, 12, 34), again = scattering_matrix(0.3, 7, 12, 34);
  EXPECT_EQ(m.ss, again.ss);
  EXPECT_EQ(m.ps, again.ps);
  for (const ScatteringMatrix& other : {scattering_matrix(0.3, 8, 12, 34), scattering_matrix(0.3, 7, 13, 34),
                                        scattering_matrix(0.3, 7, 12, 35)})
    EXPECT_GT(std::abs(other.ss - m.ss), 1e-3);
}

TEST(Scattering, PhasesAreUniformAndIndependent) {
  // The squared magnitude of a sum of n independent unit phasors is distributed exponentially with mean n. It
  // exceeds 14 n with a probability of e^-14 = 8e-7. The test has six sums.
  constexpr uint32_t count = 20'000;
  Complex te{0.0}, tm{0.0}, crossed{0.0}, both{0.0}, apart{0.0}, neighbours{0.0};
  ScatteringMatrix before = scattering_matrix(0.5, 3, 99, 0);
  for (uint32_t patch = 0; patch < count; ++patch) {
    const ScatteringMatrix m = scattering_matrix(0.5, 3, patch / 100, patch % 100);
    te += m.ss / std::abs(m.ss);
    tm += m.pp / std::abs(m.pp);
    crossed += m.sp / std::abs(m.sp);
    both += 2.0 * m.ss * m.pp;
    apart += 2.0 * m.ss * std::conj(m.pp);
    neighbours += 2.0 * m.ss * std::conj(before.ss);
    before = m;
  }
  for (const Complex& sum : {te, tm, crossed, both, apart, neighbours})
    EXPECT_LT(std::norm(sum), 14.0 * count);
}

/// Holds a ground that scatters, and makes paths over a patch of it.
struct Patch {
  HandScene hand;
  double area_m2 = 0.02;
  Patch(const DiffuseScattering& surface, double eta, double thickness_m) {
    scene::RadioMaterial& radio = *hand.scene.materials[hand.material("rough", eta, 0.05, thickness_m)].radio;
    radio.scattering_coefficient = surface.coefficient;
    radio.pattern = surface.pattern;
    radio.pattern_exponent = surface.exponent;
    radio.backscatter_exponent = surface.backscatter_exponent;
    radio.backscatter_share = surface.backscatter_share;
    radio.cross_polarization = surface.cross_polarization;
    hand.ground(100.0);
  }
  GeometricPath over(const dvec3& tx, const dvec3& point, const dvec3& rx, uint32_t patch = 5) const {
    return {{{InteractionType::scattering, 0, patch}},
            {tx, point, rx},
            glm::length(point - tx) + glm::length(rx - point),
            0.0,
            area_m2};
  }
};

TEST(Scattering, EnergyBalanceOfAPatch) {
  // The integral of |E_s|^2 r^2 over the hemisphere is S^2 Gamma^2 |E_i|^2 cos(theta_i) dA for any
  // polarization.
  const dvec3 point(3, -2, 0);
  const struct {
    Complex theta, phi;
  } sent[]{
      {1.0, 0.0}, {0.0, 1.0}, {std::sqrt(0.5), Complex(0.0, std::sqrt(0.5))}, {0.6, Complex(-0.48, 0.64)}};
  for (const DiffuseScattering& surface : surfaces_of_all_patterns())
    for (const double zenith : {0.0, 0.5, 1.3}) {
      const Patch patch(surface, 5.0, 0.1);
      const FacetWorld world(patch.hand.scene);
      const RadioSurfaces surfaces(patch.hand.scene, scattered_hz);
      const dvec3 in = incoming(zenith, 0.8), tx = point - 4.0 * in;
      const ReflectionCoefficients fresnel = surfaces.reflect(0, true, std::cos(zenith));
      double received[4]{};
      for (const Direction& direction : hemisphere({0, 0, 1}, 27)) {
        const Path path = path_field(patch.over(tx, point, point + 7.0 * direction.out), {&world, &surfaces},
                                     dvec3(0.0), dvec3(0.0));
        const Complex* t = path.transfer;
        for (int i = 0; i < 4; ++i)
          received[i] += direction.weight * 49.0 *
                         (std::norm(t[0] * sent[i].theta + t[1] * sent[i].phi) +
                          std::norm(t[2] * sent[i].theta + t[3] * sent[i].phi));
      }
      for (int i = 0; i < 4; ++i) {
        // On a horizontal surface theta-hat lies in the plane of incidence (TM) and phi-hat is perpendicular
        // to it (TE).
        const double gamma2 = std::norm(sent[i].theta * fresnel.r_tm) + std::norm(sent[i].phi * fresnel.r_te);
        const double incident = 1.0 / 16.0;  // |E_i|^2 at 4 m
        const double expected = 0.16 * gamma2 * incident * std::cos(zenith) * patch.area_m2;
        EXPECT_NEAR(received[i] / expected, 1.0, 1e-9) << zenith << " " << i;
      }
    }
}

TEST(Scattering, CrossPolarizationTakesItsShare) {
  DiffuseScattering surface{.coefficient = 0.7, .cross_polarization = 0.2};
  const Patch patch(surface, 4.0, 0.0);
  const FacetWorld world(patch.hand.scene);
  const RadioSurfaces surfaces(patch.hand.scene, scattered_hz);
  const Path path = path_field(patch.over({-3, 1, 4}, {0, 0, 0}, {5, -2, 6}), {&world, &surfaces}, {}, {});
  EXPECT_NEAR(std::norm(path.transfer[2]) / std::norm(path.transfer[0]), 0.2 / 0.8, 1e-12);
  EXPECT_NEAR(std::norm(path.transfer[1]) / std::norm(path.transfer[3]), 0.2 / 0.8, 1e-12);
  // Lambertian: |T| = S |r| sqrt(cos theta_s cos theta_i dA / pi) / (s' s).
  const double before = std::sqrt(26.0), after = std::sqrt(65.0);
  const double cos_in = 4.0 / before, cos_out = 6.0 / after;
  const double expected =
      0.7 * std::abs(half_space({4.0, -0.05 / (2 * pi * scattered_hz * vacuum_permittivity)}, cos_in).r_tm) *
      std::sqrt(0.8 * cos_out * cos_in * patch.area_m2 / pi) / (before * after);
  EXPECT_NEAR(std::abs(path.transfer[0]) / expected, 1.0, 1e-12);
}

TEST(Scattering, BothSidesOfAWallScatter) {
  const Patch patch({.coefficient = 0.5}, 4.0, 0.0);
  const FacetWorld world(patch.hand.scene);
  const RadioSurfaces surfaces(patch.hand.scene, scattered_hz);
  const FieldModel model{&world, &surfaces};
  const Path above = path_field(patch.over({-3, 1, 4}, {0, 0, 0}, {5, -2, 6}), model, {}, {});
  const Path below = path_field(patch.over({-3, 1, -4}, {0, 0, 0}, {5, -2, -6}), model, {}, {});
  const Path through = path_field(patch.over({-3, 1, 4}, {0, 0, 0}, {5, -2, -6}), model, {}, {});
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(std::abs(above.transfer[i]), std::abs(below.transfer[i]), 1e-15);
    EXPECT_EQ(through.transfer[i], Complex(0.0));
  }
}

TEST(Scattering, ReflectionsBeforeAndAfterAreImages) {
  // With a conducting wall x = 10, a wave that reaches the patch over the wall comes from the mirrored
  // transmitter. A wave that leaves over the wall goes to the mirrored receiver.
  Patch patch({.coefficient = 0.5, .pattern = ScatteringPattern::directive, .cross_polarization = 0.1}, 4.0,
              0.0);
  const uint32_t conductor = patch.hand.material("conductor", 1.0, 1e30);
  const uint32_t wall = patch.hand.quad({10, -50, 0}, {10, -50, 50}, {10, 50, 50}, {10, 50, 0}, conductor);
  const FacetWorld world(patch.hand.scene);
  const RadioSurfaces surfaces(patch.hand.scene, scattered_hz);
  const FieldModel model{&world, &surfaces};
  const dvec3 tx(1, 2, 5), rx(4, 9, 3), point(2, 3, 0);
  const auto mirrored = [](const dvec3& p) { return dvec3(20 - p.x, p.y, p.z); };
  const auto on_wall = [](const dvec3& a, const dvec3& image) {
    return a + (10 - a.x) / (image.x - a.x) * (image - a);
  };
  const auto power = [](const Path& path) {
    double sum = 0.0;
    for (const Complex& value : path.transfer) sum += std::norm(value);
    return sum;
  };
  {
    const GeometricPath direct = patch.over(mirrored(tx), point, rx);
    GeometricPath over = direct;
    over.interactions.insert(over.interactions.begin(), {InteractionType::reflection, wall});
    over.vertices = {tx, on_wall(point, mirrored(tx)), point, rx};
    const Path a = path_field(direct, model, {}, {}), b = path_field(over, model, {}, {});
    EXPECT_NEAR(power(b) / power(a), 1.0, 1e-9);
    EXPECT_LT(glm::length(a.arrival - b.arrival), 1e-15);
    EXPECT_NEAR(a.departure.x, -b.departure.x, 1e-15);
  }
  {
    const GeometricPath direct = patch.over(tx, point, mirrored(rx));
    GeometricPath over = direct;
    over.interactions.push_back({InteractionType::reflection, wall});
    over.vertices = {tx, point, on_wall(point, mirrored(rx)), rx};
    const Path a = path_field(direct, model, {}, {}), b = path_field(over, model, {}, {});
    EXPECT_NEAR(power(b) / power(a), 1.0, 1e-9);
    EXPECT_LT(glm::length(a.departure - b.departure), 1e-15);
    EXPECT_NEAR(a.arrival.x, -b.arrival.x, 1e-15);
  }
}

TEST(Scattering, WhatIsScatteredIsNotReflected) {
  // A share S^2 of the reflected power is scattered into the hemisphere and 1 - S^2 is reflected. Together
  // they are the reflection of a smooth surface.
  Patch patch({.coefficient = 0.6}, 4.0, 0.0);
  const FacetWorld world(patch.hand.scene);
  const RadioSurfaces surfaces(patch.hand.scene, scattered_hz);
  const GeometricPath path{{{InteractionType::reflection, 0}}, {{-3, 0, 4}, {0, 0, 0}, {3, 0, 4}}, 10.0};
  FieldModel model{&world, &surfaces};
  const Path smooth = path_field(path, model, {}, {});
  model.effects.scattering = true;
  const Path left = path_field(path, model, {}, {});
  for (const int i : {0, 3}) EXPECT_NEAR(std::abs(left.transfer[i] / smooth.transfer[i]), 0.8, 1e-14);
}

TEST(Scattering, DopplerOfAMovingPatch) {
  // nu = -(f/c) d(s' + s)/dt. The rate follows from a difference of lengths while the ends and the patch
  // move.
  Patch patch({.coefficient = 0.5}, 4.0, 0.0);
  const uint32_t body = patch.hand.body();
  const uint32_t plate = patch.hand.quad({0, -1, -1}, {0, 1, -1}, {0, 1, 1}, {0, -1, 1}, 0, body);
  FacetWorld world(patch.hand.scene);
  const RadioSurfaces surfaces(patch.hand.scene, scattered_hz);
  const dvec3 tx(9, 5, 3), rx(7, -6, 2), v_tx(1, 2, -3), v_rx(-4, 5, 0.5), in_body(0, 0.4, -0.3);
  const auto at = [&](double t) {
    Motion motion;
    motion.pose = {dvec3(1, 0, 2) + t * dvec3(12, 1, 0.3),
                   orientation_from_yaw_pitch_roll(0.1 + 2.0 * t, 0, 0)};
    motion.velocity = {12, 1, 0.3};
    motion.angular_velocity = {0, 0, 2.0};
    world.move(body, motion);
    GeometricPath path = patch.over(tx + t * v_tx, motion.pose.apply(in_body), rx + t * v_rx);
    path.interactions[0].element = plate;
    return path_field(path, {&world, &surfaces}, v_tx, v_rx);
  };
  const double rate = (at(5e-5).length_m - at(-5e-5).length_m) / 1e-4;
  const double found = at(0.0).doppler_hz;
  EXPECT_NEAR(found, -rate * scattered_hz / speed_of_light, 1e-4);
  EXPECT_GT(std::abs(found), 10.0);
}

TEST(Scattering, RefusesWhatIsOutOfRange) {
  scene::RadioMaterial material;
  const auto refused = [&](const char* field) {
    try {
      diffuse_scattering(material, "render");
      return false;
    } catch (const UserError& error) {
      const std::string message = error.what();
      return message.find("render") != std::string::npos && message.find(field) != std::string::npos;
    }
  };
  material.scattering_coefficient = 1.01;
  EXPECT_TRUE(refused("scattering_coefficient"));
  material.scattering_coefficient = -0.1;
  EXPECT_TRUE(refused("scattering_coefficient"));
  material.scattering_coefficient = std::nan("");
  EXPECT_TRUE(refused("scattering_coefficient"));
  material.scattering_coefficient = 1.0;
  EXPECT_EQ(diffuse_scattering(material, "render").coefficient, 1.0);
  material.pattern_exponent = 2.5;
  EXPECT_TRUE(refused("pattern_exponent"));
  material.pattern_exponent = 4.0;
  material.cross_polarization = 2.0;
  EXPECT_TRUE(refused("cross_polarization"));
}

}  // namespace
}  // namespace greatx::rf
