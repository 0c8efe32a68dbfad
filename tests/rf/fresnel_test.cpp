// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/surface/fresnel.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "core/units.h"
#include "rf/surface/surfaces.h"
#include "tests/rf/scenes.h"

namespace greatx::rf {
namespace {

constexpr double wave_hz = 3.5e9;
const double wavelength_m = speed_of_light / wave_hz;

Complex conductive(double relative, double sigma, double f_hz) {
  return {relative, -sigma / (2.0 * pi * f_hz * vacuum_permittivity)};
}
Complex concrete() { return conductive(5.24, 0.0462 * std::pow(3.5, 0.7822), wave_hz); }

void expect_equal(Complex found, Complex expected, double tolerance) {
  EXPECT_NEAR(found.real(), expected.real(), tolerance);
  EXPECT_NEAR(found.imag(), expected.imag(), tolerance);
}

/// Paths and echoes use this share: rho of the roughness times sqrt(1 - S^2), each factor only if its effect
/// is on.
TEST(SpecularShare, IsOfRoughnessAndScatteringApartAndTogether) {
  RadioSurface surface;
  surface.roughness_m = 0.01;
  surface.scattering.coefficient = 0.6;
  const double cosine = 0.7, g = 4.0 * pi * 0.01 * cosine / wavelength_m;
  const double rho = std::exp(-0.5 * g * g);
  EXPECT_LT(rho, 0.8);
  const auto share = [&](std::optional<RoughnessModel> roughness, bool scattering) {
    return specular_share(surface, cosine, wavelength_m, roughness, scattering);
  };
  EXPECT_EQ(share(std::nullopt, false), 1.0);
  EXPECT_NEAR(share(RoughnessModel::ament, false), rho, 1e-15);
  EXPECT_NEAR(share(std::nullopt, true), 0.8, 1e-15);
  EXPECT_NEAR(share(RoughnessModel::ament, true), 0.8 * rho, 1e-15);
  EXPECT_GT(share(RoughnessModel::miller_brown, false), rho);
  EXPECT_NEAR(most_roughness_db(0.01, wavelength_m),
              -20.0 * std::log10(std::exp(-0.5 * std::pow(g / cosine, 2))), 1e-12);
  EXPECT_EQ(most_roughness_db(0.0, wavelength_m), 0.0);
  surface.roughness_m = 0.0;
  EXPECT_EQ(share(RoughnessModel::ament, false), 1.0);
}

TEST(Fresnel, ConcreteAt3500MHz) {
  expect_equal(concrete(), {5.24, -0.632143}, 5e-7);
  const FresnelCoefficients face = half_space(concrete(), std::sqrt(0.5));
  expect_equal(face.r_te, {-0.511723497, 0.024481843}, 6e-10);
  expect_equal(face.r_tm, {0.261261576, -0.025055869}, 6e-10);
  const FresnelCoefficients wall = slab({concrete(), 0.1}, wavelength_m, 1.0);
  expect_equal(wall.r_te, {-0.422222101, -0.007580311}, 6e-10);
  expect_equal(wall.t_te, {-0.136274648, 0.270959987}, 6e-10);
}

TEST(Fresnel, BoundaryConditionsHold) {
  // Tangential E and H are continuous: 1 + r = t, C(1 - r) = A t (TE); 1 + r = sqrt(eta) t, C(1 - r) =
  // (A/sqrt(eta)) t (TM).
  for (const double c : {1.0, 0.7, 0.2, 1e-3}) {
    const Complex eta = concrete(), a = normal_component(eta, c);
    const FresnelCoefficients face = half_space(eta, c);
    expect_equal(1.0 + face.r_te, face.t_te, 1e-15);
    expect_equal(c * (1.0 - face.r_te), a * face.t_te, 1e-15);
    expect_equal(1.0 + face.r_tm, std::sqrt(eta) * face.t_tm, 2e-15);            // H
    expect_equal(c * (1.0 - face.r_tm), a / std::sqrt(eta) * face.t_tm, 2e-15);  // E along the face
  }
}

TEST(FresnelHardCase, N26_NormalIncidenceKnowsNoPlane) {
  const FresnelCoefficients face = half_space(concrete(), 1.0),
                            wall = slab({concrete(), 0.1}, wavelength_m, 1.0);
  expect_equal(face.r_te, -face.r_tm, 1e-16);
  expect_equal(wall.r_te, -wall.r_tm, 1e-15);
  expect_equal(wall.t_te, wall.t_tm, 1e-15);
}

TEST(FresnelHardCase, N27_Grazing) {
  const Complex metal = conductive(1.0, 1e7, wave_hz);
  for (const Complex eta :
       {Complex(5.24, 0.0), concrete(), metal, Complex(0.5, 0.0), Complex(1.0 + 1e-9, 0.0)}) {
    for (const FresnelCoefficients& found :
         {half_space(eta, 0.0), slab({eta, 0.1}, wavelength_m, 0.0),
          multilayer(std::vector<DielectricLayer>{{eta, 0.1}, {2.0, 0.02}}, wavelength_m, 0.0)}) {
      expect_equal(found.r_te, -1.0, 1e-15);
      expect_equal(found.r_tm, -1.0, 1e-15);
      expect_equal(found.t_te, 0.0, 1e-15);
      expect_equal(found.t_tm, 0.0, 1e-15);
    }
    // The coefficients approach this limit.
    expect_equal(half_space(eta, 1e-14).r_te, -1.0, 1e-8);
    expect_equal(half_space(eta, 1e-14).r_tm, -1.0, 1e-8);
  }
}

TEST(FresnelHardCase, N28_Brewster) {
  EXPECT_LE(std::abs(half_space(5.24, std::cos(radians(66.401791))).r_tm), 1e-7);
  EXPECT_LE(std::abs(half_space(5.24, std::sqrt(1.0 / 6.24)).r_tm), 1e-16);
}

TEST(FresnelHardCase, N29_AlmostVacuum) {
  // To first order in the contrast d, r_TE = -d/4C^2 and r_TM = d(2C^2 - 1)/4C^2. The result is accurate to
  // 1e-9, although (C - A)/(C + A) would lose all digits.
  const double contrast = 0x1p-40, c = 0.6;
  const FresnelCoefficients face = half_space(1.0 + contrast, c);
  EXPECT_NEAR(face.r_te.real() / (-contrast / (4 * c * c)), 1.0, 1e-9);
  EXPECT_NEAR(face.r_tm.real() / (contrast * (2 * c * c - 1) / (4 * c * c)), 1.0, 1e-9);
}

TEST(FresnelHardCase, N30_ConductorNearGrazing) {
  const Complex r = half_space(conductive(1.0, 1e7, wave_hz), std::cos(radians(89.9))).r_tm;
  expect_equal(r, {0.8876, -0.1010}, 5e-5);
}

TEST(FresnelHardCase, N31_TotalReflectionAndThickSlabs) {
  const double c = std::cos(radians(60.0));
  for (const double eta : {0.2, 0.5, 0.7}) {  // sin^2 60 = 0.75: all beyond the critical angle
    const FresnelCoefficients face = half_space(eta, c);
    EXPECT_NEAR(std::abs(face.r_te), 1.0, 1e-12);
    EXPECT_NEAR(std::abs(face.r_tm), 1.0, 1e-12);
    EXPECT_LE(normal_component(eta, c).imag(), 0.0);  // decays inwards
    const FresnelCoefficients wall = slab({eta, 3.0}, wavelength_m, c);
    EXPECT_NEAR(std::abs(wall.r_te), 1.0, 1e-12);
    EXPECT_LT(std::abs(wall.t_te), 1e-10);
  }
  // Behind ten metres, a kilometre and a megametre of concrete only the front face reflects; nothing
  // overflows.
  for (const double thickness : {10.0, 1e3, 1e6}) {
    const FresnelCoefficients face = half_space(concrete(), c),
                              wall = slab({concrete(), thickness}, wavelength_m, c);
    const FresnelCoefficients layered = multilayer(
        std::vector<DielectricLayer>{{concrete(), thickness}, {{3.0, -1.0}, thickness}}, wavelength_m, c);
    for (const FresnelCoefficients& found : {wall, layered}) {
      expect_equal(found.r_te, face.r_te, 1e-14);
      expect_equal(found.r_tm, face.r_tm, 1e-14);
      EXPECT_LT(std::abs(found.t_te) + std::abs(found.t_tm), 1e-12);
    }
  }
}

TEST(FresnelHardCase, N32_HalfWaveSlabAtGrazing) {
  // With A = m lambda / 2d exactly, the slab is invisible except for a sign, even where r is close to -1.
  const double c = std::cos(radians(89.999));
  const Complex eta = 4.0;
  const double thickness = 0.5 * wavelength_m / normal_component(eta, c).real();
  for (const FresnelCoefficients& found :
       {slab({eta, thickness}, wavelength_m, c),
        multilayer(std::vector<DielectricLayer>{{eta, thickness}}, wavelength_m, c)}) {
    EXPECT_NEAR(std::abs(found.t_te), 1.0, 1e-9);
    EXPECT_NEAR(std::abs(found.t_tm), 1.0, 1e-9);
    EXPECT_LT(std::abs(found.r_te), 1e-9);
    EXPECT_LT(std::abs(found.r_tm), 1e-9);
  }
}

TEST(FresnelHardCase, N33_Energy) {
  for (const double c : {1.0, 0.9, 0.5, 0.1, 1e-2, 1e-4}) {
    for (const double thickness : {1e-4, 0.01, 0.1, 0.333}) {
      const FresnelCoefficients clear = slab({{6.31, 0.0}, thickness}, wavelength_m, c);
      EXPECT_NEAR(std::norm(clear.r_te) + std::norm(clear.t_te), 1.0, 1e-9);
      EXPECT_NEAR(std::norm(clear.r_tm) + std::norm(clear.t_tm), 1.0, 1e-9);
      const FresnelCoefficients lossy = slab({concrete(), thickness}, wavelength_m, c);
      EXPECT_LE(std::norm(lossy.r_te) + std::norm(lossy.t_te), 1.0);
      EXPECT_LE(std::norm(lossy.r_tm) + std::norm(lossy.t_tm), 1.0);
    }
    const FresnelCoefficients stack =
        multilayer(std::vector<DielectricLayer>{{6.31, 0.004}, {1.0, 0.016}, {6.31, 0.004}}, wavelength_m, c);
    EXPECT_NEAR(std::norm(stack.r_te) + std::norm(stack.t_te), 1.0, 1e-9);
    EXPECT_NEAR(std::norm(stack.r_tm) + std::norm(stack.t_tm), 1.0, 1e-9);
  }
}

TEST(FresnelHardCase, N33_EnergyOfRandomStacks) {
  // The stacks have one to six layers from films to walls, of thin and dense media, with total reflection,
  // from normal incidence to 89.99 degrees. The transmission is the same from either side.
  RandomStream random(33, 0);
  for (int i = 0; i < 4000; ++i) {
    const double c = i % 4 == 0 ? std::pow(10.0, random.uniform(-3.7, 0.0)) : random.uniform(0.01, 1.0);
    const bool lossless = i % 2 == 0;
    std::vector<DielectricLayer> stack(1 + random.below(6));
    for (DielectricLayer& layer : stack) {
      const double loss = lossless ? 0.0 : std::pow(10.0, random.uniform(-4.0, 3.0));
      layer = {{random.uniform(0.2, 12.0), -loss}, std::pow(10.0, random.uniform(-4.0, -0.3))};
    }
    const FresnelCoefficients front = multilayer(stack, wavelength_m, c);
    const double te = std::norm(front.r_te) + std::norm(front.t_te),
                 tm = std::norm(front.r_tm) + std::norm(front.t_tm);
    if (lossless) {
      EXPECT_NEAR(te, 1.0, 1e-6) << i;
      EXPECT_NEAR(tm, 1.0, 1e-6) << i;
    }
    EXPECT_LE(te, 1.0 + 1e-9) << i;
    EXPECT_LE(tm, 1.0 + 1e-9) << i;
    std::reverse(stack.begin(), stack.end());
    const FresnelCoefficients back = multilayer(stack, wavelength_m, c);
    EXPECT_LE(std::abs(front.t_te - back.t_te), 1e-9 * std::abs(front.t_te)) << i;
    EXPECT_LE(std::abs(front.t_tm - back.t_tm), 1e-9 * std::abs(front.t_tm)) << i;
    stack.back().thickness_m =
        0.0;  // with a half-space behind the other layers, reflection does not exceed incidence
    const FresnelCoefficients backed = multilayer(stack, wavelength_m, c);
    EXPECT_LE(std::abs(backed.r_te), 1.0 + 1e-9) << i;
    EXPECT_LE(std::abs(backed.r_tm), 1.0 + 1e-9) << i;
  }
}

TEST(FresnelHardCase, N34_VacuumSlabIsInvisible) {
  for (const double c : {1.0, 0.3, 0.0}) {
    const FresnelCoefficients one = slab({1.0, 0.2}, wavelength_m, c);
    const FresnelCoefficients two =
        multilayer(std::vector<DielectricLayer>{{1.0, 0.15}, {1.0, 0.05}}, wavelength_m, c);
    for (const FresnelCoefficients& found : {one, two}) {
      EXPECT_EQ(found.r_te, Complex(0.0));
      EXPECT_EQ(found.r_tm, Complex(0.0));
      // As a sheet without thickness, the slab must not add the free-space phase a second time.
      expect_equal(found.t_te * sheet_phase(0.2, wavelength_m, c), 1.0, 1e-14);
      expect_equal(found.t_tm * sheet_phase(0.2, wavelength_m, c), 1.0, 1e-14);
    }
  }
}

TEST(FresnelHardCase, N35_FrequencyInAGap) {
  testing::HandScene hand;
  hand.itu_material("brick");  // rows for 1-40 and 110-330 GHz
  hand.ground(10.0);
  EXPECT_NO_THROW(RadioSurfaces(hand.scene, 28e9));
  EXPECT_NO_THROW(RadioSurfaces(hand.scene, 140e9));
  try {
    RadioSurfaces(hand.scene, 77e9);
    FAIL() << "77 GHz lies in the gap";
  } catch (const UserError& error) {
    for (const char* part : {"brick", "77", "1", "40", "110", "330"})
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(Fresnel, LayersOfOneMediumAreOneSlab) {
  for (const double c : {1.0, 0.5, 0.02}) {
    const FresnelCoefficients one = slab({concrete(), 0.1}, wavelength_m, c);
    for (const auto& layers : {std::vector<DielectricLayer>{{concrete(), 0.1}},
                               std::vector<DielectricLayer>{{concrete(), 0.03}, {concrete(), 0.07}}}) {
      const FresnelCoefficients many = multilayer(layers, wavelength_m, c);
      expect_equal(many.r_te, one.r_te, 1e-13);
      expect_equal(many.r_tm, one.r_tm, 1e-13);
      expect_equal(many.t_te, one.t_te, 1e-13);
      expect_equal(many.t_tm, one.t_tm, 1e-13);
    }
    // With a half-space of the same medium behind it, a layer has no second face.
    const FresnelCoefficients backed =
        multilayer(std::vector<DielectricLayer>{{concrete(), 0.03}, {concrete(), 0.0}}, wavelength_m, c);
    expect_equal(backed.r_te, half_space(concrete(), c).r_te, 1e-13);
    expect_equal(backed.r_tm, half_space(concrete(), c).r_tm, 1e-13);
  }
}

TEST(Fresnel, QuarterWaveCoatingDoesNotReflect) {
  // With eta_coating = sqrt(eta), a coating of a quarter wavelength suppresses the reflection by the
  // half-space behind it.
  const double quarter = wavelength_m / 4.0 / std::pow(6.31, 0.25);
  const FresnelCoefficients found =
      multilayer(std::vector<DielectricLayer>{{std::sqrt(6.31), quarter}, {6.31, 0.0}}, wavelength_m, 1.0);
  EXPECT_LT(std::abs(found.r_te), 1e-15);
  EXPECT_LT(std::abs(found.r_tm), 1e-15);
  EXPECT_NEAR(std::norm(found.t_te) * std::sqrt(6.31), 1.0, 1e-14);  // all power enters the half-space
  EXPECT_NEAR(std::norm(found.t_tm) * std::sqrt(6.31), 1.0, 1e-14);
}

TEST(Fresnel, ReflectionAloneHasTheBitsOfAll) {
  // At the fourth permittivity the normal component is 0 at a cosine of 0.5 (the critical angle).
  for (const Complex eta : {concrete(), Complex(6.31), Complex(1.0), Complex(0.75), Complex(1.0, -1e14)})
    for (const double c : {1.0, 0.8, 0.5, 1e-2, 1e-9, 0.0}) {
      const FresnelCoefficients face = half_space(eta, c);
      const ReflectionCoefficients of_face = half_space_reflection(eta, c);
      EXPECT_EQ(of_face.r_te, face.r_te);
      EXPECT_EQ(of_face.r_tm, face.r_tm);
      for (const double thickness : {1e-4, 0.006, 0.2}) {
        const FresnelCoefficients wall = slab({eta, thickness}, wavelength_m, c);
        const ReflectionCoefficients of_wall = slab_reflection({eta, thickness}, wavelength_m, c);
        EXPECT_EQ(of_wall.r_te, wall.r_te);
        EXPECT_EQ(of_wall.r_tm, wall.r_tm);
      }
    }
  EXPECT_THROW(slab_reflection({Complex(1.0), 0.1}, wavelength_m, 1.5), ContractError);
}

TEST(RadioSurface, IsWhatTheMaterialSays) {
  testing::HandScene hand;
  const uint32_t ground = hand.material("ground", 4.0);
  const uint32_t pane = hand.material("pane", 6.31, 0.0, 0.006);
  const uint32_t plastered = hand.material("plastered", 2.73, 0.0, 0.02);
  auto& layers = hand.scene.materials[plastered].radio->layers;
  layers.push_back({hand.scene.materials[ground].radio->layers[0].medium, 0.0});
  for (const uint32_t material : {ground, pane, plastered}) hand.ground(1.0, material, material);

  const RadioSurfaces surfaces(hand.scene, wave_hz);
  const double c = 0.8;
  EXPECT_EQ(surfaces.reflect(ground, true, c).r_te, half_space(4.0, c).r_te);
  EXPECT_EQ(surfaces.reflect(ground, false, c).r_te, half_space(4.0, c).r_te);
  EXPECT_EQ(surfaces.reflect(pane, true, c).r_tm, slab({6.31, 0.006}, wavelength_m, c).r_tm);
  EXPECT_EQ(surfaces.reflect(plastered, true, c).r_te,
            multilayer(std::vector<DielectricLayer>{{2.73, 0.02}, {4.0, 0.0}}, wavelength_m, c).r_te);
  EXPECT_EQ(surfaces.reflect(plastered, false, c).r_te, half_space(4.0, c).r_te);
}

TEST(RadioSurface, PassesWhatHasNoHalfSpace) {
  testing::HandScene hand;
  const uint32_t ground = hand.material("ground", 4.0), pane = hand.material("pane", 6.31, 0.0, 0.006);
  const uint32_t plastered = hand.material("plastered", 2.73, 0.01, 0.02),
                 tiled = hand.material("tiled", 5.0, 0.0, 0.01);
  const uint32_t crown = hand.material("crown", 1.0), unused = hand.material("unused", 3.0, 0.0, 0.1);
  hand.scene.materials[plastered].radio->layers.push_back({*scene::itu_medium("concrete"), 0.1});
  hand.scene.materials[tiled].radio->layers.push_back(hand.scene.materials[ground].radio->layers[0]);
  hand.scene.materials[crown].radio->layers.clear();
  hand.scene.materials[crown].radio->foliage = scene::Foliage{};
  for (const uint32_t material : {ground, pane, plastered, tiled, crown})
    hand.ground(1.0, material, material);

  const RadioSurfaces surfaces(hand.scene, wave_hz);
  EXPECT_TRUE(surfaces.penetrable(pane));
  EXPECT_TRUE(surfaces.penetrable(plastered));
  for (const uint32_t material : {ground, tiled, crown, unused}) {
    EXPECT_FALSE(surfaces.penetrable(material));
    EXPECT_THROW(surfaces.transmit(material, true, 0.5), ContractError);
  }
  EXPECT_TRUE(surfaces.surface(crown).foliage);
  const double c = 0.8;
  const std::vector<DielectricLayer> layers{{conductive(2.73, 0.01, wave_hz), 0.02}, {concrete(), 0.1}};
  const FresnelCoefficients wall = multilayer(layers, wavelength_m, c);
  for (const bool from_front : {true, false}) {
    const SheetTransmission sheet = surfaces.transmit(plastered, from_front, c);
    expect_equal(sheet.te, wall.t_te * sheet_phase(0.12, wavelength_m, c), 1e-15);
    expect_equal(sheet.tm, wall.t_tm * sheet_phase(0.12, wavelength_m, c), 1e-15);
  }
}

TEST(RadioSurface, RefusesLayersThatMakeNoSense) {
  testing::HandScene hand;
  const uint32_t index = hand.material("odd", 4.0, 0.0, 0.0);
  auto& radio = *hand.scene.materials[index].radio;
  radio.layers.push_back(radio.layers[0]);
  EXPECT_THROW(radio_surface(radio, wave_hz, "odd"), UserError);  // a layer behind a half-space
  radio.layers[0].thickness_m = -0.1;
  EXPECT_THROW(radio_surface(radio, wave_hz, "odd"), UserError);
  radio.layers.clear();
  EXPECT_THROW(radio_surface(radio, wave_hz, "odd"), UserError);
  hand.ground(1.0);
  hand.scene.materials[index].radio.reset();
  EXPECT_THROW(RadioSurfaces(hand.scene, wave_hz), UserError);
}

}  // namespace
}  // namespace greatx::rf
