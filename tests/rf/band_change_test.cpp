// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds the bound of what a band changes in the coefficients of materials against closed forms and against
// random materials, angles and frequencies.
#include "rf/surface/band_change.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "core/units.h"
#include "rf/surface/surfaces.h"

namespace greatx::rf {
namespace {

constexpr double bound_margin = 1.05;  // of most_band_change()

scene::RadioMedium medium_of(double a, double b, double c, double d) {
  return {"test", {{a, b, c, d, 0.0, std::numeric_limits<double>::infinity()}}, false};
}
scene::RadioMaterial material_of(std::vector<scene::RadioLayer> layers) {
  scene::RadioMaterial material;
  material.layers = std::move(layers);
  return material;
}
scene::RadioMaterial itu(const char* name, double thickness_m = 0.0) {
  return material_of({{*scene::itu_medium(name), thickness_m}});
}
Band band_around(double carrier_hz, double width_hz) {
  return {carrier_hz, carrier_hz - 0.5 * width_hz, carrier_hz + 0.5 * width_hz};
}
BandChange change_of_band(const scene::RadioMaterial& material, const Band& band, bool scattering = false) {
  return most_band_change(material, band, RoughnessModel::ament, scattering, "test");
}

/// Returns the change at one angle and frequency, from the classes that the field of a path uses.
BandChange change_at(const scene::RadioMaterial& material, const Band& band, double frequency_hz,
                     double cosine, bool scattering) {
  const RadioSurfaces here({radio_surface(material, band.carrier_hz, "test")}, band.carrier_hz),
      there({radio_surface(material, frequency_hz, "test")}, frequency_hz);
  const auto kept = [&](const RadioSurfaces& surfaces) {
    return specular_share(surfaces.surface(0), cosine, surfaces.wavelength_m(), RoughnessModel::ament,
                          scattering);
  };
  BandChange change;
  for (const bool front : {true, false}) {
    const FresnelCoefficients a = here.reflect(0, front, cosine), b = there.reflect(0, front, cosine);
    change.reflection = std::max({change.reflection, std::abs(kept(here) * a.r_te - kept(there) * b.r_te),
                                  std::abs(kept(here) * a.r_tm - kept(there) * b.r_tm)});
    if (!here.penetrable(0)) continue;
    const SheetTransmission s = here.transmit(0, front, cosine), t = there.transmit(0, front, cosine);
    change.transmission = std::max({change.transmission, std::abs(s.te - t.te), std::abs(s.tm - t.tm)});
  }
  return change;
}

TEST(BandChange, OfAMaterialThatDoesNotDependOnFrequencyIsZero) {
  // eta' is constant and nothing conducts: a half-space reflects all frequencies equally.
  const BandChange none =
      change_of_band(material_of({{medium_of(5.0, 0, 0, 0), 0.0}}), band_around(3e9, 2e9));
  EXPECT_EQ(none.reflection, 0.0);
  EXPECT_EQ(none.transmission, 0.0);
  const Band point{3e9, 3e9, 3e9};
  EXPECT_EQ(change_of_band(itu("glass", 0.01), point).reflection, 0.0);
}

TEST(BandChange, OfAGoodConductorHasAClosedForm) {
  // With x = sqrt(eta) C of phase -45 degrees, r_TM = (x - 1)/(x + 1), and x falls as f^-1/2. The change per
  // relative change of x is |2 x/(x + 1)^2|, largest at |x| = 1: 1/(1 + cos 45 degrees).
  for (const double carrier : {3.5e9, 28e9, 90e9}) {
    const Band band = band_around(carrier, 1e-3 * carrier);
    const double expected = 0.5 * 0.5e-3 / (1.0 + std::sqrt(0.5));
    const double found = change_of_band(itu("metal"), band).reflection;
    EXPECT_NEAR(found, bound_margin * expected, 0.01 * expected) << carrier;
  }
}

TEST(BandChange, OfAResonantSlabIsThatOfAFabryPerotPlate) {
  // A lossless plate of half a wave reflects nothing at normal incidence. A quarter of a wave reflects
  // |R| = 2 r/(1 + r^2). Oblique angles and the phase may add to that.
  const double index = 2.0, carrier = 10e9, thickness = 0.5 * speed_of_light / carrier / index;
  const scene::RadioMaterial plate = material_of({{medium_of(index * index, 0, 0, 0), thickness}});
  const double r = (index - 1.0) / (index + 1.0), largest = 2.0 * r / (1.0 + r * r);
  const BandChange wide =
      change_of_band(plate, band_around(carrier, carrier));  // down to a quarter of a wave
  EXPECT_GT(wide.reflection, largest);
  EXPECT_LE(wide.reflection, 2.0);
  EXPECT_LT(change_of_band(plate, band_around(carrier, 1e-3 * carrier)).reflection, 0.01);
  // Close to grazing incidence resonances are as sharp as one likes: the plate of half a wave across at that
  // angle reflects nothing at the carrier and all beside it.
  const double across = 0.5 * speed_of_light / carrier / std::sqrt(index * index - 1.0);
  const scene::RadioMaterial sharp = material_of({{medium_of(index * index, 0, 0, 0), across}});
  EXPECT_GT(change_of_band(sharp, band_around(carrier, 1e-3 * carrier)).reflection, 0.99);
}

scene::RadioMaterial random_material(RandomStream& random) {
  const auto between = [&](double low, double high) { return low + (high - low) * random.uniform(); };
  const auto medium = [&] {
    return medium_of(between(1.2, 12.0), between(-0.1, 0.1), std::pow(10.0, between(-4.0, 0.5)),
                     between(0.0, 1.5));
  };
  const auto thickness = [&] { return std::pow(10.0, between(-3.0, -0.6)); };
  std::vector<scene::RadioLayer> layers;
  const auto count = static_cast<uint32_t>(between(0.0, 2.999));
  for (uint32_t i = 0; i < count; ++i) layers.push_back({medium(), thickness()});
  if (count == 0 || random.uniform() < 0.3) layers.push_back({medium(), 0.0});
  scene::RadioMaterial material = material_of(layers);
  material.roughness_m = random.uniform() < 0.5 ? 0.0 : std::pow(10.0, between(-4.0, -2.0));
  material.scattering_coefficient = 0.5 * random.uniform();
  return material;
}

TEST(BandChange, HoldsForRandomMaterialsAnglesAndBandsAndIsNotLoose) {
  RandomStream random(1, 2, 3);
  constexpr int materials = 60, samples = 4000;
  int tight = 0;
  for (int m = 0; m < materials; ++m) {
    const scene::RadioMaterial material = random_material(random);
    const double carrier = std::pow(10.0, 9.0 + 2.0 * random.uniform());
    const Band band = band_around(carrier, carrier * std::pow(10.0, -3.0 + 2.5 * random.uniform()));
    const bool scattering = random.uniform() < 0.5;
    const BandChange bound = change_of_band(material, band, scattering);
    BandChange found;
    for (int i = 0; i < samples; ++i) {
      const double u = random.uniform();
      const double cosine = i % 2 == 0 ? u : std::pow(10.0, -5.0 * u);
      const double hz = i % 3 == 0   ? band.lowest_hz
                        : i % 3 == 1 ? band.highest_hz
                                     : band.lowest_hz + band.width_hz() * random.uniform();
      const BandChange at = change_at(material, band, hz, cosine, scattering);
      ASSERT_LE(at.reflection, bound.reflection) << m << ": " << hz << " Hz, cosine " << cosine;
      ASSERT_LE(at.transmission, bound.transmission) << m << ": " << hz << " Hz, cosine " << cosine;
      found.reflection = std::max(found.reflection, at.reflection);
      found.transmission = std::max(found.transmission, at.transmission);
    }
    // A plate with little loss changes in so few angles and frequencies that random ones miss most of it.
    tight += bound.reflection <= 1.2 * found.reflection && bound.transmission <= 1.2 * found.transmission;
    EXPECT_LE(bound.reflection, 4.0 * found.reflection) << m;
    EXPECT_LE(bound.transmission, 4.0 * found.transmission) << m;
  }
  EXPECT_GE(tight, materials * 3 / 4);
}

TEST(BandChange, WideBandsChangeMoreThanNarrowOnes) {
  const double narrow = change_of_band(itu("concrete"), band_around(3.5e9, 20e6)).reflection;
  const double wide = change_of_band(itu("concrete"), band_around(28e9, 2e9)).reflection;
  EXPECT_LT(narrow, 2e-4);
  EXPECT_GT(wide, 2.0 * narrow);
  // Echoes within 30 cm of concrete die away; those in a pane do not.
  EXPECT_LT(change_of_band(itu("concrete", 0.3), band_around(3.5e9, 100e6)).reflection, 2e-3);
  EXPECT_GT(change_of_band(itu("glass", 0.02), band_around(3.5e9, 100e6)).reflection, 0.01);
}

TEST(BandChange, ABandThatLeavesTheRowsOfAMaterialIsRefused) {
  EXPECT_THROW(change_of_band(itu("brick"), band_around(39.5e9, 2e9)), UserError);
  EXPECT_THROW(change_of_band(itu("glass"), Band{3e9, 3.1e9, 3.2e9}), ContractError);
}

}  // namespace
}  // namespace greatx::rf
