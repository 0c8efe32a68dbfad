// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks whole paths against closed forms. The requirements are 0.01 dB and 1e-3 rad; where possible, the
// tests demand nine digits. Friis' equation and the two-ray ground are in channel_test.cpp, the shoe-box room
// in geometry_test.cpp.
#include <array>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "core/phase.h"
#include "core/random.h"
#include "core/units.h"
#include "rf/atmosphere/foliage.h"
#include "rf/channel/frequency_response.h"
#include "rf/edges/diffraction.h"
#include "rf/field/field.h"
#include "rf/geometry/geometry.h"
#include "tests/rf/exhaustive.h"
#include "tests/rf/scenes.h"

namespace greatx::rf {
namespace {

using testing::exhaustive_candidates;
using testing::HandScene;
using testing::solve_paths;

constexpr double frequency_hz = 3.5e9;
constexpr double wavelength_m = speed_of_light / frequency_hz;
const dvec3 at_rest(0.0);

struct Model {
  FacetWorld world;
  RadioSurfaces surfaces;
  FieldModel field;
  explicit Model(const HandScene& hand, double f_hz = frequency_hz)
      : world(hand.scene), surfaces(hand.scene, f_hz), field{&world, &surfaces} {}
};

GeometricPath line(const dvec3& tx, const dvec3& rx) { return {{}, {tx, rx}, glm::length(rx - tx)}; }

GeometricPath through(const dvec3& tx, const dvec3& wall, const dvec3& rx, uint32_t facet = 0) {
  return {{{InteractionType::transmission, facet}}, {tx, wall, rx}, glm::length(rx - tx)};
}

double decibels(Complex ratio) { return 20.0 * std::log10(std::abs(ratio)); }

void expect_same(Complex found, Complex expected, double relative = 1e-9) {
  static_assert(sizeof(Complex) == 16);
  EXPECT_LT(std::abs(found - expected), relative * std::abs(expected)) << found << " " << expected;
}

void expect_near(Complex found, Complex expected, double tolerance) {
  EXPECT_NEAR(found.real(), expected.real(), tolerance);
  EXPECT_NEAR(found.imag(), expected.imag(), tolerance);
}

TEST(ClosedForms, SlabAtNormalIncidence) {
  // Concrete of 10 cm at 3.5 GHz: R = -.422222101 - .007580311j and T = -.136274648 + .270959987j. T is the
  // field at the rear face; the free path behind the wall is shorter by the thickness of the wall.
  HandScene hand;
  hand.itu_material("concrete", 0.1);
  hand.ground(50.0);
  const Model model(hand);
  const Complex transmitted(-0.136274648, 0.270959987), reflected(-0.422222101, -0.007580311);
  const Complex free_way = unit_phasor(0.1 / wavelength_m);
  const Path below = path_field(through({1, 2, 3}, {1, 2, 0}, {1, 2, -4}), model.field, at_rest, at_rest);
  // On the z axis (phi = 0), theta-hat changes its sign when the direction is reversed; phi-hat does not.
  expect_same(below.transfer[0] * 7.0, -transmitted * free_way, 5e-9);
  expect_same(below.transfer[3] * 7.0, transmitted * free_way, 5e-9);
  const Path back = path_field({{{InteractionType::reflection, 0}}, {{1, 2, 3}, {1, 2, 0}, {1, 2, 4}}, 7.0},
                               model.field, at_rest, at_rest);
  EXPECT_NEAR(std::abs(back.transfer[0] * 7.0), std::abs(reflected), 1e-9);
}

TEST(ClosedForms, ConcreteAt45Degrees) {
  HandScene hand;
  hand.itu_material("concrete");
  hand.ground(50.0);
  const Model model(hand);
  const GeometricPath path{
      {{InteractionType::reflection, 0}}, {{-2, 0, 2}, {0, 0, 0}, {2, 0, 2}}, 4 * std::sqrt(2.0)};
  const Path found = path_field(path, model.field, at_rest, at_rest);
  expect_same(found.transfer[0] * path.length_m, {0.261261576, -0.025055869}, 5e-9);
  expect_same(-found.transfer[3] * path.length_m, {-0.511723497, 0.024481843}, 5e-9);
}

TEST(ClosedForms, BrewstersAngle) {
  HandScene hand;
  hand.material("lossless", 5.24);
  hand.ground(50.0);
  const Model model(hand);
  const double run = std::tan(radians(66.401791));
  const Path found = path_field(
      {{{InteractionType::reflection, 0}}, {{-run, 0, 1}, {0, 0, 0}, {run, 0, 1}}, 2 * std::hypot(run, 1.0)},
      model.field, at_rest, at_rest);
  EXPECT_LE(std::abs(found.transfer[0]) * found.length_m, 1e-7);
  EXPECT_GT(std::abs(found.transfer[3]) * found.length_m, 0.6);
}

TEST(ClosedForms, SlabAtAnyAngle) {
  // Evaluates eq. 43 and 44 directly for both polarizations, at the angle between the path and the wall.
  HandScene hand;
  hand.itu_material("brick", 0.24);
  hand.ground(1e4);
  const Model model(hand);
  const Complex eta(3.91, -0.0238 * std::pow(3.5, 0.16) / (2 * pi * frequency_hz * vacuum_permittivity));
  const Complex j(0.0, 1.0);
  for (const double zenith : {0.1, 0.6, 1.1, 1.4, 1.55}) {
    const double cosine = std::cos(zenith), reach = 5.0 / cosine;
    const dvec3 down(std::sin(zenith), 0, -cosine);
    const Path found =
        path_field(through(-reach * down, {0, 0, 0}, reach * down), model.field, at_rest, at_rest);
    const Complex a = std::sqrt(eta - 1.0 + cosine * cosine),
                  once = std::exp(-j * (2 * pi * 0.24 / wavelength_m) * a);
    const Complex sheet = std::exp(j * (2 * pi * 0.24 / wavelength_m) * cosine);
    const auto through_slab = [&](Complex r) {
      return (1.0 - r * r) * once / (1.0 - r * r * once * once) * sheet;
    };
    expect_same(found.transfer[0] * found.length_m, through_slab((eta * cosine - a) / (eta * cosine + a)));
    expect_same(-found.transfer[3] * found.length_m, through_slab((cosine - a) / (cosine + a)));
  }
}

TEST(ClosedForms, WallsInARow) {
  // The path passes through two walls at an angle to each other. The field vector passes through each in
  // turn.
  HandScene hand;
  const uint32_t brick = hand.itu_material("brick", 0.24), glass = hand.itu_material("glass", 0.006);
  const uint32_t first = hand.quad({2, -9, -9}, {2, 9, -9}, {2, 9, 9}, {2, -9, 9}, brick);
  const uint32_t second = hand.quad({6, -9, -9}, {7, 9, -9}, {7, 9, 9}, {6, -9, 9}, glass);
  const Model model(hand);
  const dvec3 tx(0, 0, 1), rx(10, 3, 2), along = glm::normalize(rx - tx);
  const GeometricPath path{{{InteractionType::transmission, first}, {InteractionType::transmission, second}},
                           {tx, tx + 0.2 * (rx - tx), tx + 0.65 * (rx - tx), rx},
                           glm::length(rx - tx)};
  const Path found = path_field(path, model.field, at_rest, at_rest);
  // Expected for each wall: E -> t_TE (s . E) s + t_TM (p . E) p.
  FieldVector field;
  field.add(1.0, theta_hat(along));
  for (const auto& [facet, material] : {std::pair{first, brick}, std::pair{second, glass}}) {
    const dvec3 normal = model.world.facet(facet).normal;
    const dvec3 s = glm::normalize(glm::cross(along, normal)), p = glm::cross(along, s);
    const SheetTransmission sheet =
        model.surfaces.transmit(material, false, std::abs(glm::dot(along, normal)));
    FieldVector next;
    next.add(sheet.te * field.along(s), s);
    next.add(sheet.tm * field.along(p), p);
    field = next;
  }
  expect_same(found.transfer[0] * path.length_m, field.along(theta_hat(-along)));
  EXPECT_NEAR(std::abs(found.transfer[2] * path.length_m - field.along(phi_hat(-along))), 0.0, 1e-14);
  EXPECT_GT(std::abs(field.along(phi_hat(-along))), 1e-4);  // the second wall turns the polarization
}

TEST(ClosedFormsHardCase, N34_VacuumWallsAreInvisible) {
  // Moving walls of vacuum stand in the way of all paths of a room. Directions, delay and Doppler shift
  // remain the same to the bit; the field differs by the rounding of the phase of 0.2 m of vacuum.
  HandScene hand;
  hand.itu_material("concrete", 0.1);
  const uint32_t vacuum = hand.material("vacuum", 1.0, 0.0, 0.2);
  hand.room({7, 5, 3});
  const uint32_t body = hand.body();
  const uint32_t curtain = hand.quad({0, -1, -1}, {0, 1, -1}, {0, 1, 1}, {0, -1, 1}, vacuum, body);
  Model model(hand);
  Motion motion;
  motion.pose = {{3, 2, 1}, orientation_from_yaw_pitch_roll(0.3, 0.4, 0.1)};
  motion.velocity = {3, -20, 1};
  motion.angular_velocity = {1, 2, 3};
  model.world.move(body, motion);
  RandomStream random(34, 0);
  const dvec3 v_tx(1, -2, 0.3), v_rx(-7, 0.1, 2);
  const auto paths = solve_paths(model.world, {1.1, 2.2, 0.7}, {5.3, 3.1, 2.2}, exhaustive_candidates(6, 3));
  ASSERT_EQ(paths.size(), 63u);
  for (const GeometricPath& path : paths) {
    GeometricPath walls{{}, {path.vertices.front()}, path.length_m};
    for (size_t i = 0; i + 1 < path.vertices.size(); ++i) {
      const uint32_t count = random.below(3);
      for (uint32_t k = 1; k <= count; ++k) {
        walls.interactions.push_back({InteractionType::transmission, curtain});
        walls.vertices.push_back(glm::mix(path.vertices[i], path.vertices[i + 1], k / 3.0));
      }
      if (i < path.interactions.size()) walls.interactions.push_back(path.interactions[i]);
      walls.vertices.push_back(path.vertices[i + 1]);
    }
    const Path free = path_field(path, model.field, v_tx, v_rx),
               passed = path_field(walls, model.field, v_tx, v_rx);
    EXPECT_EQ(free.departure, passed.departure);
    EXPECT_EQ(free.arrival, passed.arrival);
    EXPECT_EQ(free.delay_s, passed.delay_s);
    EXPECT_EQ(free.doppler_hz, passed.doppler_hz);
    for (int i = 0; i < 4; ++i) expect_near(free.transfer[i], passed.transfer[i], 1e-13);
  }
}

TEST(ClosedFormsHardCase, N31_TotalReflectionAndThickWallsOnAPath) {
  HandScene hand;
  const uint32_t plasma = hand.material("plasma", 0.5, 0.0, 3.0), thick = hand.itu_material("concrete", 1e6);
  const uint32_t first = hand.ground(50.0, 0.0, plasma), second = hand.ground(50.0, -1.0, thick);
  const Model model(hand);
  const double run = 2.0 * std::sqrt(3.0);  // 60 degrees from the normal; the critical angle is 45
  const Path back =
      path_field({{{InteractionType::reflection, first}}, {{-run, 0, 2}, {0, 0, 0}, {run, 0, 2}}, 8.0},
                 model.field, at_rest, at_rest);
  for (const int i : {0, 3}) EXPECT_NEAR(std::abs(back.transfer[i]) * 8.0, 1.0, 1e-6);
  const Path evanescent =
      path_field(through({-run, 0, 2}, {0, 0, 0}, {run, 0, -2}, first), model.field, at_rest, at_rest);
  const Path dark =
      path_field(through({-run, 0, 1}, {0, 0, -1}, {run, 0, -3}, second), model.field, at_rest, at_rest);
  for (int i = 0; i < 4; ++i) {
    EXPECT_LT(std::abs(evanescent.transfer[i]), 1e-10);
    EXPECT_EQ(dark.transfer[i], Complex(0.0));
  }
  // At grazing incidence nothing passes through the wall (r -> -1, t -> 0), and no value is NaN.
  const Path grazing =
      path_field(through({-5, 0, 0}, {0, 0, 0}, {5, 0, 0}, first), model.field, at_rest, at_rest);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(std::abs(grazing.transfer[i]), 0.0);
}

TEST(ClosedForms, RoughWallsReflectLess) {
  HandScene hand;
  const uint32_t rough = hand.material("rough", 4.0, 0.0, 0.1);
  hand.scene.materials[rough].radio->roughness_m = 0.008;
  hand.scene.materials[rough].radio->scattering_coefficient = 0.6;
  hand.ground(50.0);
  Model model(hand);
  const GeometricPath path{{{InteractionType::reflection, 0}}, {{-3, 0, 4}, {0, 0, 0}, {3, 0, 4}}, 10.0};
  const GeometricPath passed = through({-3, 0, 4}, {0, 0, 0}, {3, 0, -4});
  const Path smooth = path_field(path, model.field, at_rest, at_rest);
  const Path clear = path_field(passed, model.field, at_rest, at_rest);
  const double g = 4.0 * pi * 0.008 * 0.8 / wavelength_m;  // 0.94
  const auto kept = [&] {
    const Path found = path_field(path, model.field, at_rest, at_rest);
    expect_same(found.transfer[0] / smooth.transfer[0], found.transfer[3] / smooth.transfer[3]);
    return std::abs(found.transfer[0] / smooth.transfer[0]);
  };
  model.field.effects.roughness = true;
  EXPECT_NEAR(kept(), std::exp(-0.5 * g * g), 1e-12);
  model.field.effects.roughness_model = RoughnessModel::miller_brown;
  EXPECT_NEAR(kept(), std::exp(-0.5 * g * g) * std::cyl_bessel_i(0.0, 0.5 * g * g), 1e-12);
  model.field.effects.scattering = true;
  EXPECT_NEAR(kept(), 0.8 * std::exp(-0.5 * g * g) * std::cyl_bessel_i(0.0, 0.5 * g * g), 1e-12);
  model.field.effects.roughness = false;
  EXPECT_NEAR(kept(), 0.8, 1e-12);
  // Roughness and scattering do not change the transmitted field.
  model.field.effects.roughness = true;
  EXPECT_EQ(path_field(passed, model.field, at_rest, at_rest).transfer[0], clear.transfer[0]);
}

TEST(ClosedForms, FriisInRainAndFog) {
  // A level path of 1 km at 28 GHz, 15 degrees C and 7.5 g/m3: gas 0.1017560 dB/km, rain of 25 mm/h 4.6236
  // dB/km (H) and 3.8911 dB/km (V), fog of 0.5 g/m3 0.459530 (dB/km)/(g/m3).
  HandScene hand;
  Model model(hand, 28e9);
  const Weather weather{.rain_mm_h = 25.0, .fog_g_m3 = 0.5};
  model.field.attenuation = path_attenuation(weather, 28e9);
  const Path wet = path_field(line({0, 0, 10}, {600, 800, 10}), model.field, at_rest, at_rest);
  const double gas_and_fog = 0.1017560 + 0.5 * 0.459530;
  EXPECT_NEAR(decibels(wet.transfer[0] * 1000.0), -(gas_and_fog + 3.8911), 2e-4);
  EXPECT_NEAR(decibels(wet.transfer[3] * 1000.0), -(gas_and_fog + 4.6236), 2e-4);
  // On a vertical path rain attenuates both polarizations equally, by the mean of H and V.
  const Path up = path_field(line({0, 0, 0}, {0, 0, 1000}), model.field, at_rest, at_rest);
  EXPECT_NEAR(decibels(up.transfer[0] * 1000.0), decibels(up.transfer[3] * 1000.0), 1e-9);
  // On a path with a reflection, the whole length counts.
  model.field.attenuation = path_attenuation({}, 28e9);
  hand.material("conductor", 1.0, 1e30);
  hand.ground(1000.0);
  Model over(hand, 28e9);
  over.field.attenuation = model.field.attenuation;
  const Path echo =
      path_field({{{InteractionType::reflection, 0}}, {{-300, 0, 400}, {0, 0, 0}, {300, 0, 400}}, 1000.0},
                 over.field, at_rest, at_rest);
  EXPECT_NEAR(decibels(echo.transfer[0] * 1000.0), -0.1017560, 2e-6);
}

TEST(ClosedForms, FoliageTakesItsDepth) {
  HandScene hand;
  Model model(hand);
  GeometricPath path = line({0, 0, 2}, {100, 0, 2});
  path.foliage_m = 10.0;
  EXPECT_NEAR(decibels(path_field(path, model.field, at_rest, at_rest).transfer[0] * 100.0), 0.0, 1e-12);
  model.field.effects.foliage = true;
  model.field.foliage = scene::Foliage{};
  EXPECT_NEAR(decibels(path_field(path, model.field, at_rest, at_rest).transfer[0] * 100.0),
              -0.45 * std::pow(3.5, 0.284) * 10.0, 1e-9);
  model.field.foliage->attenuation_db_per_m = 0.7;
  EXPECT_NEAR(decibels(path_field(path, model.field, at_rest, at_rest).transfer[3] * 100.0), -7.0, 1e-9);
}

}  // namespace
}  // namespace greatx::rf
