// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks walls with windows (rf/surface/surfaces.h): the mean of the fields of two stacks of layers, what it
// keeps of the energy, and its error beside a wall with every window in its place.
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "core/units.h"
#include "rf/field/field.h"
#include "rf/paths/radio_model.h"
#include "rf/surface/surfaces.h"
#include "tests/rf/scenes.h"

namespace greatx::rf {
namespace {

using testing::HandScene;
using Layers = std::vector<scene::RadioLayer>;

constexpr double cosines[] = {1.0, 0.97, 0.8, 0.5, 0.2, 0.03};
constexpr double frequencies_hz[] = {1e9, 2.1e9, 3.5e9, 6e9, 10e9, 28e9, 60e9, 77e9, 100e9};

scene::RadioLayer layer(const std::string& itu, double thickness_m) {
  return {*scene::itu_medium(itu), thickness_m};
}
scene::RadioLayer air(double thickness_m) {
  return {{"explicit permittivity", {{1.0, 0.0, 0.0, 0.0, 0.0, INFINITY}}, false}, thickness_m};
}
Layers double_glazing() { return {layer("glass", 0.006), air(0.016), layer("glass", 0.004)}; }

scene::RadioMaterial wall_of(Layers layers) {
  scene::RadioMaterial wall;
  wall.layers = std::move(layers);
  return wall;
}
scene::RadioMaterial with_windows(Layers layers, double share, Layers windows = double_glazing()) {
  scene::RadioMaterial wall = wall_of(std::move(layers));
  wall.windows = scene::RadioWindows{share, std::move(windows)};
  return wall;
}

/// Returns these materials at a frequency, in their order.
RadioSurfaces surfaces_at(double frequency_hz, const std::vector<scene::RadioMaterial>& materials) {
  std::vector<RadioSurface> surfaces;
  for (const scene::RadioMaterial& material : materials)
    surfaces.push_back(radio_surface(material, frequency_hz, "wall"));
  return {std::move(surfaces), frequency_hz};
}

void expect_same(const ReflectionCoefficients& found, const ReflectionCoefficients& expected) {
  EXPECT_EQ(found.r_te, expected.r_te);
  EXPECT_EQ(found.r_tm, expected.r_tm);
}
void expect_same(const SheetTransmission& found, const SheetTransmission& expected) {
  EXPECT_EQ(found.te, expected.te);
  EXPECT_EQ(found.tm, expected.tm);
}

/// Returns walls that end, with layers that differ from side to side.
std::vector<Layers> thin_walls() {
  return {{layer("concrete", 0.2)},
          {layer("wood", 0.03), air(0.1), layer("plasterboard", 0.0125)},
          {layer("metal", 0.001), layer("concrete", 0.15)},
          {layer("chipboard", 0.02), layer("glass", 0.003)}};
}

TEST(Windows, ShareZeroIsTheWallAndShareOneTheWindowsToTheBit) {
  for (const Layers& layers : thin_walls())
    for (const double hz : frequencies_hz) {
      const RadioSurfaces s = surfaces_at(hz, {wall_of(layers), with_windows(layers, 0.0),
                                               wall_of(double_glazing()), with_windows(layers, 1.0)});
      for (const bool front : {true, false})
        for (const double cosine : cosines) {
          expect_same(s.reflect(1, front, cosine), s.reflect(0, front, cosine));
          expect_same(s.transmit(1, front, cosine), s.transmit(0, front, cosine));
          expect_same(s.reflect(3, front, cosine), s.reflect(2, front, cosine));
          expect_same(s.transmit(3, front, cosine), s.transmit(2, front, cosine));
        }
    }
}

TEST(Windows, FieldsAreLinearInTheShare) {
  const Layers layers = thin_walls()[1];
  for (const double share : {1e-6, 0.1, 0.22, 0.5, 0.9}) {
    const RadioSurfaces s =
        surfaces_at(5e9, {wall_of(layers), wall_of(double_glazing()), with_windows(layers, share)});
    for (const bool front : {true, false})
      for (const double cosine : cosines) {
        const ReflectionCoefficients a = s.reflect(0, front, cosine), b = s.reflect(1, front, cosine),
                                     r = s.reflect(2, front, cosine);
        EXPECT_LT(std::abs(r.r_te - (a.r_te + share * (b.r_te - a.r_te))), 1e-15);
        EXPECT_LT(std::abs(r.r_tm - (a.r_tm + share * (b.r_tm - a.r_tm))), 1e-15);
        const SheetTransmission c = s.transmit(0, front, cosine), d = s.transmit(1, front, cosine),
                                t = s.transmit(2, front, cosine);
        EXPECT_LT(std::abs(t.te - (c.te + share * (d.te - c.te))), 1e-15);
        EXPECT_LT(std::abs(t.tm - (c.tm + share * (d.tm - c.tm))), 1e-15);
      }
  }
}

TEST(Windows, TransmissionIsReciprocalAndNoEnergyIsMade) {
  RandomStream random(25, 0);
  for (const Layers& layers : thin_walls())
    for (const double hz : frequencies_hz) {
      const double share = random.uniform();
      const RadioSurfaces s = surfaces_at(hz, {with_windows(layers, share)});
      for (const double cosine : cosines) {
        const SheetTransmission in = s.transmit(0, true, cosine), out = s.transmit(0, false, cosine);
        EXPECT_LT(std::abs(in.te - out.te), 1e-12);
        EXPECT_LT(std::abs(in.tm - out.tm), 1e-12);
        for (const bool front : {true, false}) {
          const ReflectionCoefficients r = s.reflect(0, front, cosine);
          EXPECT_LE(std::norm(r.r_te) + std::norm(in.te), 1.0 + 1e-12) << hz << ' ' << cosine;
          EXPECT_LE(std::norm(r.r_tm) + std::norm(in.tm), 1.0 + 1e-12) << hz << ' ' << cosine;
        }
      }
    }
}

/// Without losses in wall and panes, what the mean lacks of the energy is what the side lobes have:
/// p (1 - p) (|R_wall - R_windows|^2 + |T_wall - T_windows|^2).
TEST(Windows, TheSideLobesHaveTheRestOfTheEnergy) {
  const auto clear = [](double relative, double thickness_m) {
    return scene::RadioLayer{{"test", {{relative, 0.0, 0.0, 0.0, 0.0, INFINITY}}, false}, thickness_m};
  };
  const Layers layers{clear(5.2, 0.2), clear(2.0, 0.03)}, panes{clear(6.3, 0.006), clear(1.0, 0.016)};
  const double share = 0.3;
  for (const double hz : frequencies_hz) {
    const RadioSurfaces s =
        surfaces_at(hz, {wall_of(layers), wall_of(panes), with_windows(layers, share, panes)});
    for (const double cosine : cosines) {
      const auto r = [&](uint32_t i) { return s.reflect(i, true, cosine); };
      const auto t = [&](uint32_t i) { return s.transmit(i, true, cosine); };
      const double lobes = share * (1.0 - share);
      EXPECT_NEAR(std::norm(r(2).r_te) + std::norm(t(2).te) +
                      lobes * (std::norm(r(0).r_te - r(1).r_te) + std::norm(t(0).te - t(1).te)),
                  1.0, 1e-12);
      EXPECT_NEAR(std::norm(r(2).r_tm) + std::norm(t(2).tm) +
                      lobes * (std::norm(r(0).r_tm - r(1).r_tm) + std::norm(t(0).tm - t(1).tm)),
                  1.0, 1e-12);
    }
  }
}

/// A first layer of air of d m sets windows back: their reflection gets e^{-2jkd cos(theta)}, and their
/// transmission stays.
TEST(Windows, AFirstLayerOfAirSetsThemBack) {
  const Layers thick{layer("concrete", 0.0)}, pane{layer("glass", 0.006)},
      deep{air(0.12), layer("glass", 0.006)};
  const RadioSurfaces s = surfaces_at(3.5e9, {wall_of(thick), wall_of(pane), with_windows(thick, 0.3, deep)});
  for (const double cosine : cosines) {
    const Complex turn = std::polar(1.0, -4.0 * pi / s.wavelength_m() * 0.12 * cosine);
    EXPECT_LT(std::abs(s.reflect(2, true, cosine).r_te - 0.7 * s.reflect(0, true, cosine).r_te -
                       0.3 * turn * s.reflect(1, true, cosine).r_te),
              1e-12);
    EXPECT_LT(std::abs(s.reflect(2, false, cosine).r_tm - 0.7 * s.reflect(0, false, cosine).r_tm -
                       0.3 * s.reflect(1, false, cosine).r_tm),
              1e-12);
    EXPECT_LT(std::abs(s.transmit(2, true, cosine).te - 0.3 * s.transmit(1, true, cosine).te), 1e-12);
  }
}

TEST(Windows, LetWavesThroughAHalfSpace) {
  const Layers thick{layer("concrete", 0.0)};
  const RadioSurfaces s =
      surfaces_at(3.5e9, {wall_of(thick), wall_of(double_glazing()), with_windows(thick, 0.22),
                          with_windows(thick, 0.0), with_windows(thick, 1.0)});
  EXPECT_FALSE(s.penetrable(0));
  EXPECT_TRUE(s.penetrable(2));
  EXPECT_FALSE(s.penetrable(3));
  EXPECT_TRUE(s.penetrable(4));
  for (const bool front : {true, false})
    for (const double cosine : cosines) {
      EXPECT_LT(std::abs(s.transmit(2, front, cosine).te - 0.22 * s.transmit(1, front, cosine).te), 1e-16);
      EXPECT_LT(std::abs(s.transmit(2, front, cosine).tm - 0.22 * s.transmit(1, front, cosine).tm), 1e-16);
      const Complex mean = 0.78 * s.reflect(0, front, cosine).r_te + 0.22 * s.reflect(1, front, cosine).r_te;
      EXPECT_LT(std::abs(s.reflect(2, front, cosine).r_te - mean), 1e-15);
    }
}

scene::Material named(scene::RadioMaterial radio) {
  scene::Material material;
  material.name = "facade";
  material.radio = std::move(radio);
  return material;
}

TEST(Windows, DecideWhatAFacetIs) {
  const auto kind = [](const scene::RadioMaterial& radio, bool transmission = true) {
    HandScene hand;
    hand.scene.materials.push_back(named(radio));
    hand.ground(10.0);
    return facet_kinds(hand.scene, {.transmission = transmission, .lowest_carrier_hz = 3.5e9}).at(0);
  };
  const Layers thick{layer("concrete", 0.0)}, dark{layer("metal", 0.002)};
  EXPECT_EQ(kind(wall_of(thick)), FacetKind::opaque);
  EXPECT_EQ(kind(wall_of(dark)), FacetKind::opaque);
  EXPECT_EQ(kind(with_windows(thick, 0.0)), FacetKind::opaque);
  EXPECT_EQ(kind(with_windows(thick, 0.22)), FacetKind::wall);
  EXPECT_EQ(kind(with_windows(dark, 0.22)), FacetKind::wall);
  EXPECT_EQ(kind(with_windows(thick, 1.0)), FacetKind::wall);
  EXPECT_EQ(kind(with_windows(thick, 0.22), false), FacetKind::opaque);
  EXPECT_EQ(kind(with_windows(thick, 0.22, {layer("metal", 0.002)})), FacetKind::opaque);
  EXPECT_EQ(kind(with_windows({layer("wood", 0.05)}, 1.0, dark)), FacetKind::opaque) << "nothing but metal";
}

TEST(Windows, LossOfAWallIsTheLeastThatItCanBe) {
  const auto loss = [](const scene::RadioMaterial& radio) { return wall_loss_db(named(radio), 3.5e9); };
  const double wood = std::pow(10.0, -loss(wall_of({layer("wood", 0.05)})) / 20.0),
               pane = std::pow(10.0, -loss(wall_of(double_glazing())) / 20.0);
  EXPECT_NEAR(loss(with_windows({layer("wood", 0.05)}, 0.4)), -20.0 * std::log10(0.6 * wood + 0.4 * pane),
              1e-12);
  EXPECT_NEAR(loss(with_windows({layer("concrete", 0.0)}, 0.4)), -20.0 * std::log10(0.4 * pane), 1e-12);
  EXPECT_EQ(loss(with_windows({layer("wood", 0.05)}, 0.0)), loss(wall_of({layer("wood", 0.05)})));
}

TEST(Windows, ErrorsNameTheWindows) {
  const auto refuse = [](const scene::RadioMaterial& radio, const std::vector<std::string>& parts,
                         double hz = 3.5e9) {
    try {
      radio_surface(radio, hz, "facade");
      ADD_FAILURE() << "expected an error with '" << parts.back() << "'";
    } catch (const UserError& error) {
      for (const std::string& part : parts) EXPECT_THAT(error.what(), ::testing::HasSubstr(part));
    }
  };
  const Layers thick{layer("metal", 0.0)};
  refuse(with_windows(thick, 0.2), {"'facade (windows)'", "glass", "500 GHz", "100 to 400 GHz"}, 500e9);
  EXPECT_NO_THROW(radio_surface(with_windows(thick, 0.0), 500e9, "facade")) << "there are none";
  refuse(with_windows(thick, 1.01), {"'facade (windows)'", "share", "from 0 to 1", "1.01"});
  refuse(with_windows(thick, NAN), {"'facade (windows)'", "share"});
  refuse(with_windows(thick, 0.2, {}), {"'facade (windows)'", "one radio layer"});
  refuse(with_windows(thick, 0.2, {layer("glass", 0.0)}), {"'facade (windows)', layer 1", "above 0 m"});
  refuse(with_windows(thick, 0.2, {layer("glass", 0.0), layer("glass", 0.1)}),
         {"'facade (windows)', layer 1", "half-space"});
}

/// The field along a path through a half-space with windows, and back.
TEST(Windows, APathThroughThemHasTheirFieldBothWays) {
  HandScene hand;
  hand.scene.materials.push_back(named(with_windows({layer("concrete", 0.0)}, 0.22)));
  const uint32_t facet = hand.quad({0, -10, 0}, {0, 10, 0}, {0, 10, 10}, {0, -10, 10});
  const FacetWorld world(hand.scene);
  const RadioSurfaces surfaces(hand.scene, 3.5e9);
  const dvec3 outside(30, 4, 6), inside(-6, -1, 2), at = outside + (inside - outside) * (30.0 / 36.0);
  const auto through = [&](const dvec3& from, const dvec3& to) {
    return path_field({{{InteractionType::transmission, facet}}, {from, at, to}, glm::length(to - from)},
                      {&world, &surfaces}, dvec3(0.0), dvec3(0.0));
  };
  const Path in = through(outside, inside), out = through(inside, outside);
  const double cosine = 36.0 / glm::length(inside - outside);
  const SheetTransmission panes = surfaces_at(3.5e9, {wall_of(double_glazing())}).transmit(0, true, cosine);
  const double power = std::norm(in.transfer[0]) + std::norm(in.transfer[1]) + std::norm(in.transfer[2]) +
                       std::norm(in.transfer[3]);
  EXPECT_NEAR(power * in.length_m * in.length_m / (0.22 * 0.22 * (std::norm(panes.te) + std::norm(panes.tm))),
              1.0, 1e-9);
  for (const auto& [a, b] : {std::pair(0, 0), std::pair(1, 2), std::pair(2, 1), std::pair(3, 3)})
    EXPECT_LT(std::abs(in.transfer[a] - out.transfer[b]), 1e-9 * std::sqrt(power));
}

double decibels(double power) { return 10.0 * std::log10(power); }

/// The examples of docs/materials.md: p = 0.22, glazing of 6/16/6 mm, normal incidence.
TEST(Windows, ExamplesOfTheDocumentation) {
  constexpr double p = 0.22;
  const Layers glazing{layer("glass", 0.006), air(0.016), layer("glass", 0.006)};
  const auto examples = [&](const Layers& wall, double hz) {
    const RadioSurfaces s =
        surfaces_at(hz, {wall_of(wall), wall_of(glazing), with_windows(wall, p, glazing)});
    const auto r = [&](uint32_t i) { return s.reflect(i, true, 1.0).r_te; };
    const auto t = [&](uint32_t i) { return s.penetrable(i) ? s.transmit(i, true, 1.0).te : Complex(0.0); };
    const auto by_powers = [&](const auto& of) { return (1 - p) * std::norm(of(0)) + p * std::norm(of(1)); };
    return std::array{std::sqrt(p * (1 - p)) * std::abs(r(0) - r(1)) / std::abs(r(2)),
                      decibels(by_powers(r) / std::norm(r(2))), -decibels(std::norm(t(2))),
                      -decibels(by_powers(t))};
  };
  const Layers brick{layer("brick", 0.3)};
  const auto at_1 = examples(brick, 1e9), at_3 = examples(brick, 3.5e9), at_28 = examples(brick, 28e9),
             thick = examples({layer("concrete", 0.0)}, 3.5e9);
  EXPECT_NEAR(at_1[0], 0.39, 0.005);
  EXPECT_NEAR(at_3[0], 0.74, 0.005);
  EXPECT_NEAR(at_28[0], 0.28, 0.005);
  EXPECT_NEAR(at_1[1], 0.6, 0.05);
  EXPECT_NEAR(at_3[1], 1.9, 0.05);
  EXPECT_NEAR(at_28[1], 0.3, 0.05);
  EXPECT_NEAR(at_3[2], 8.2, 0.05);
  EXPECT_NEAR(at_3[3], 7.8, 0.05);
  EXPECT_NEAR(thick[2], 20.1, 0.05);
  EXPECT_NEAR(thick[3], 13.5, 0.05);
}

/// A wall with every window in its place: windows of 1.5 m x 1.3 m, one in each field of 3 m x 3 m.
struct Facade {
  double width_m, height_m;
  static constexpr double period_m = 3.0, window_m = 1.5, window_height_m = 1.3, step_m = 0.05;
  static constexpr double share = window_m * window_height_m / (period_m * period_m);
  static bool in_window(double x, double y) {
    const auto within = [](double at) { return at - period_m * std::floor(at / period_m); };
    return within(x) < window_m && within(y) < window_height_m;
  }
};

/// Two ends, each `leg_m` from the specular point, in the horizontal plane.
struct Ends {
  double leg_m, cosine, wavelength_m;
  double beam_m = 0.0;  ///< where the amplitude of the receiver's beam has fallen to 1/e; 0: it sees all
  double zone_m() const { return std::sqrt(wavelength_m * leg_m / 2.0); }
};

/// Returns the Kirchhoff integral over the windows, and over all of the wall, for a specular point at (x, y).
/// For an endless mirror and no beam it is 1.
std::pair<Complex, Complex> kirchhoff(const Facade& facade, const Ends& ends, double x, double y) {
  const double sine = std::sqrt(1.0 - ends.cosine * ends.cosine), k = 2.0 * pi / ends.wavelength_m;
  const double step = Facade::step_m, beam = ends.beam_m;
  const double scale = 2.0 * ends.leg_m * ends.cosine * step * step / ends.wavelength_m;
  const double away = std::pow(ends.leg_m * ends.cosine, 2), reach = beam > 0.0 ? 3.0 * beam : 1e9;
  const auto first = [&](double at) { return std::lround(std::max(0.0, at - reach) / step); };
  const auto last = [&](double at, double size) { return std::lround(std::min(size, at + reach) / step); };
  Complex windows = 0.0, all = 0.0;
  for (long i = first(x); i < last(x, facade.width_m); ++i)
    for (long j = first(y); j < last(y, facade.height_m); ++j) {
      const double u = (double(i) + 0.5) * step, v = (double(j) + 0.5) * step;
      const double height = (v - y) * (v - y), out = u - x + ends.leg_m * sine,
                   home = out - 2.0 * ends.leg_m * sine;
      const double a = std::sqrt(out * out + height + away), b = std::sqrt(home * home + height + away);
      const double seen = beam > 0.0 ? std::exp(-((u - x) * (u - x) + height) / (beam * beam)) : 1.0;
      const Complex wave = Complex(0.0, scale) * std::polar(seen / (a * b), -k * (a + b - 2.0 * ends.leg_m));
      all += wave;
      if (Facade::in_window(u, v)) windows += wave;
    }
  return {windows, all};
}

/// Returns the rms difference between the field of the windows in their places and that of their mean, over
/// |R_wall - R_windows|, as the specular point moves over one period in the middle of the wall.
double rms_error(const Facade& facade, const Ends& ends) {
  constexpr int places = 8;
  const auto middle = [](double size) {
    return Facade::period_m * std::floor(0.5 * size / Facade::period_m);
  };
  double squares = 0.0;
  for (int i = 0; i < places; ++i)
    for (int j = 0; j < places; ++j) {
      const auto [windows, all] =
          kirchhoff(facade, ends, middle(facade.width_m) + (i + 0.37) * Facade::period_m / places,
                    middle(facade.height_m) + (j + 0.61) * Facade::period_m / places);
      const double scale = ends.beam_m > 0.0 ? std::norm(all) : 1.0;
      squares += std::norm(windows - Facade::share * all) / scale;
    }
  return std::sqrt(squares / (places * places));
}

constexpr double bound = 0.41204;  ///< sqrt(p (1 - p)) of Facade

/// The error of the mean beside the sum over a wall with all its windows: the table of docs/materials.md. The
/// orders of the windows' grid come from n r^2/P beside the specular point. As long as they come from the
/// wall, the rms error is about sqrt(p (1 - p)) |R_wall - R_windows|. It falls when they come from beyond it.
TEST(Windows, ErrorBesideAWallWithEveryWindowInItsPlace) {
  struct Row {
    Facade facade;
    double leg_m, cosine, zone_over_period, error;
  };
  EXPECT_NEAR(bound, std::sqrt(Facade::share * (1.0 - Facade::share)), 1e-4);
  const double wavelength_m = speed_of_light / 3.5e9;
  const Facade tower{30, 15}, house{15, 9};
  const Row rows[] = {
      {tower, 50, 1.0, 0.49, 0.453},   {tower, 200, 1.0, 0.98, 0.378},  {tower, 400, 1.0, 1.38, 0.337},
      {tower, 800, 1.0, 1.95, 0.203},  {tower, 1600, 1.0, 2.76, 0.059}, {house, 50, 1.0, 0.49, 0.417},
      {house, 200, 1.0, 0.98, 0.343},  {house, 400, 1.0, 1.38, 0.239},  {house, 800, 1.0, 1.95, 0.089},
      {house, 1600, 1.0, 2.76, 0.031}, {house, 800, 0.5, 1.95, 0.052},
  };
  for (const Row& row : rows) {
    const Ends ends{row.leg_m, row.cosine, wavelength_m};
    EXPECT_NEAR(ends.zone_m() / Facade::period_m, row.zone_over_period, 0.006);
    EXPECT_NEAR(rms_error(row.facade, ends), row.error, 0.003)
        << row.facade.width_m << " m wide, " << row.leg_m << " m, cosine " << row.cosine;
  }
}

/// The error of the mean beside the specular path alone, as a beam sees it that covers b = 0.75 of the radius
/// r of the zone on the wall. The beam weighs order n of a grid of period P by exp(-(pi n/P)^2 Re(1/a)), a =
/// 1/b^2 + j pi/r^2.
TEST(Windows, ErrorBesideTheSpecularPathOfAnEndlessWall) {
  struct Row {
    double leg_m, zone_over_period, error;
  };
  const double wavelength_m = speed_of_light / 3.5e9;
  for (const Row& row : {Row{20, 0.31, 0.305}, Row{50, 0.49, 0.238}, Row{200, 0.98, 0.083},
                         Row{400, 1.38, 0.023}, Row{800, 1.95, 0.002}}) {
    Ends ends{row.leg_m, 1.0, wavelength_m};
    const double r = ends.zone_m(), b = 0.75 * r, p = Facade::period_m;
    ends.beam_m = b;
    EXPECT_NEAR(r / p, row.zone_over_period, 0.006);
    const double error = rms_error({72, 72}, ends),
                 by_a = (1.0 / (b * b)) / (std::pow(b, -4) + pi * pi * std::pow(r, -4));
    EXPECT_NEAR(error, row.error, 0.002) << row.leg_m;
    const auto order = [&](double duty, int n) {
      return n == 0 ? duty : std::sin(pi * n * duty) / (pi * n) * std::exp(-std::pow(pi * n / p, 2) * by_a);
    };
    double squares = 0.0;
    for (int n = -30; n <= 30; ++n)
      for (int m = -30; m <= 30; ++m)
        if (n != 0 || m != 0)
          squares += std::pow(order(Facade::window_m / p, n) * order(Facade::window_height_m / p, m), 2);
    EXPECT_NEAR(error, std::sqrt(squares), 0.005) << row.leg_m << " closed " << std::sqrt(squares);
    EXPECT_LT(error, bound);
  }
}

}  // namespace
}  // namespace greatx::rf
