// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Panels of phase-shifting elements: array factor, near field, energy, reciprocity, mirror, steering.
#include "rf/targets/surface_target.h"

#include <cmath>
#include <complex>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "core/units.h"
#include "rf/targets/echo_path.h"
#include "tests/rf/channel_paths.h"

namespace greatx::rf {
namespace {

using testing::direction_at;

constexpr double wave_m = 0.01;

SurfaceLayout panel_of(uint32_t rows, uint32_t columns, double row_wl = 0.5, double column_wl = 0.5) {
  return {rows, columns, row_wl * wave_m, column_wl * wave_m, wave_m};
}
/// Returns the strength of both polarizations; the matrix is this times a rotation.
double strength(const ScatterMatrix& s) {
  double sum = 0.0;
  for (const Complex& entry : s) sum += std::norm(entry);
  return std::sqrt(0.5 * sum);
}
std::vector<double> random_phases(size_t count, uint32_t stream) {
  RandomStream random(77, stream);
  std::vector<double> phases(count);
  for (double& phase : phases) phase = random.uniform(-pi, pi);
  return phases;
}
dvec3 in_front(RandomStream& random) {
  return glm::normalize(dvec3(random.uniform(0.1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
}

TEST(Surface, IsTheArrayFactor) {
  const SurfaceLayout layout = panel_of(5, 8, 0.4, 0.5);
  const SurfaceTarget panel(layout, std::vector<double>(40, 0.3), 0.8);
  RandomStream random(3, 1);
  const auto factor = [](double x, double n) {
    return std::abs(std::sin(x)) < 1e-9 ? n : std::abs(std::sin(n * x) / std::sin(x));
  };
  for (int i = 0; i < 300; ++i) {
    const Aspect aspect{in_front(random), in_front(random)};
    const dvec3 sum = aspect.to_source + aspect.to_receiver;
    const double expected = 0.8 * 0.4 * 0.5 * wave_m * std::sqrt(aspect.to_source.x * aspect.to_receiver.x) *
                            factor(pi * 0.5 * sum.y, 8) * factor(pi * 0.4 * sum.z, 5);
    EXPECT_NEAR(strength(panel.scatter(aspect, {})), expected, 1e-12);
  }
  // From behind and to behind there is nothing.
  for (const Aspect& aspect : {Aspect{{-1, 0, 0}, {1, 0, 0}}, Aspect{{1, 0, 0}, {-0.6, 0.8, 0}}})
    EXPECT_EQ(strength(panel.scatter(aspect, {})), 0.0);
}

TEST(Surface, NearFieldIsTheSumOverElements) {
  using Wide = std::complex<long double>;
  const SurfaceLayout layout = panel_of(12, 9);
  const std::vector<double> phases = random_phases(layout.elements(), 2);
  const SurfaceTarget panel(layout, phases, 1.0);
  RandomStream random(3, 2);
  for (const double distance_wl : {2.0, 7.0, 40.0, 200.0})
    for (int i = 0; i < 20; ++i) {
      const dvec3 source = distance_wl * wave_m * in_front(random),
                  receiver = 3.1 * wave_m * in_front(random);
      const Aspect aspect{glm::normalize(source), glm::normalize(receiver), glm::length(source),
                          glm::length(receiver)};
      Wide sum = 0.0L;
      for (size_t n = 0; n < phases.size(); ++n) {
        const auto leg = [&](const dvec3& end) {
          const dvec3 d = end - layout.element(n);
          const long double there = std::sqrt(static_cast<long double>(d.x) * d.x +
                                              static_cast<long double>(d.y) * d.y +
                                              static_cast<long double>(d.z) * d.z),
                            centre = glm::length(end);
          return std::polar(std::sqrt(d.x / there) * centre / there,
                            -2.0L * testing::wide_pi * (there - centre) / static_cast<long double>(wave_m));
        };
        sum += std::polar(1.0L, static_cast<long double>(phases[n])) * leg(source) * leg(receiver);
      }
      const double expected = static_cast<double>(std::abs(sum)) * 0.25 * wave_m;
      EXPECT_NEAR(strength(panel.scatter(aspect, {})), expected, 1e-9 * wave_m);
    }
  // Far away the spheres are planes.
  const Aspect plane{in_front(random), in_front(random)};
  const Aspect far{plane.to_source, plane.to_receiver, 1e7, 1e7};
  EXPECT_NEAR(strength(panel.scatter(plane, {})), strength(panel.scatter(far, {})), 1e-6 * wave_m);
}

/// Returns the scattered over the intercepted power for a plane wave, by the midpoint rule.
double balance(const SurfaceLayout& layout, const std::vector<double>& phases, const dvec3& to_source) {
  const SurfaceTarget panel(layout, phases, 1.0);
  constexpr int zeniths = 120, azimuths = 120;
  double power = 0.0;
  for (int i = 0; i < zeniths; ++i)
    for (int j = 0; j < azimuths; ++j) {
      const double theta = pi * (i + 0.5) / zeniths, phi = pi * ((j + 0.5) / azimuths - 0.5);
      const double s = strength(panel.scatter({to_source, direction_at(theta, phi)}, {}));
      power += s * s * std::sin(theta);
    }
  power *= pi / zeniths * pi / azimuths;
  const double area_m2 = static_cast<double>(layout.elements()) * layout.element_area_m2();
  return power / (area_m2 * to_source.x);
}

TEST(Surface, KeepsEnergy) {
  RandomStream random(3, 3);
  for (const SurfaceLayout& layout :
       {panel_of(12, 12), panel_of(7, 12, 0.3, 0.5), panel_of(1, 1), panel_of(2, 5)})
    for (int i = 0; i < 4; ++i) {
      const dvec3 source = in_front(random);
      EXPECT_LE(balance(layout, random_phases(layout.elements(), 10 + i), source), 1.0);
      const SurfaceAim from{source}, to{in_front(random)};
      EXPECT_LE(balance(layout, steered_phases(layout, from, to), source), 1.0);
    }
  // One element of half a wavelength: pi/4, the part of the Brillouin zone that is visible. A large mirror
  // sends back all of what falls on it.
  EXPECT_NEAR(balance(panel_of(1, 1), {0.0}, {0.6, 0.8, 0.0}), pi / 4, 1e-3);
  const double mirror = balance(panel_of(20, 20), std::vector<double>(400, 0.0), {1, 0, 0});
  EXPECT_GT(mirror, 0.97);
  EXPECT_LE(mirror, 1.0);
}

TEST(Surface, IsReciprocal) {
  const SurfaceLayout layout = panel_of(6, 5);
  const SurfaceTarget panel(layout, random_phases(30, 4), 0.7);
  RandomStream random(3, 4);
  for (int i = 0; i < 200; ++i) {
    const Aspect there{in_front(random), in_front(random), i % 2 == 0 ? far_away : random.uniform(0.02, 1.0),
                       i % 3 == 0 ? far_away : random.uniform(0.02, 1.0)};
    const Aspect back{there.to_receiver, there.to_source, there.receiver_m, there.source_m};
    const ScatterMatrix s = panel.scatter(there, {}), t = transposed(panel.scatter(back, {}));
    for (size_t k = 0; k < 4; ++k) EXPECT_LT(std::abs(s[k] - t[k]), 1e-13);
  }
}

TEST(Surface, ALargePanelMirrorsItsImage) {
  // Some 120 wavelengths on each side, seen from 40 wavelengths. The edges of each size add 5 % of their own
  // with other phases; the mean over the sizes is the mirror.
  for (const auto& [source, receiver] :
       {std::pair(dvec3(30, 10, 0), dvec3(30, -10, 4)), std::pair(dvec3(25, 0, 12), dvec3(40, 15, 3)),
        std::pair(dvec3(35, -14, 5), dvec3(28, 2, 9))}) {
    const dvec3 from = wave_m * source, to = wave_m * receiver;
    const dvec3 image(-from.x, from.y, from.z);
    const double in_m = glm::length(from), out_m = glm::length(to), mirrored_m = glm::distance(image, to);
    // The panel's field has the phase of the way over its centre, the image's that of its own way.
    const Complex turn = std::polar(1.0, 2.0 * pi / wave_m * (mirrored_m - in_m - out_m));
    Complex mean = 0.0;
    constexpr int sizes = 24;
    for (uint32_t size = 0; size < sizes; ++size) {
      const SurfaceLayout layout = panel_of(210 + 2 * size, 256 - size);
      const SurfaceTarget panel(layout, std::vector<double>(layout.elements(), 0.0), 1.0);
      const ScatterMatrix s = panel.scatter({from / in_m, to / out_m, in_m, out_m}, {});
      // All entries have one phase but for their sign; s[0] keeps the vertical and is positive here.
      mean += std::polar(strength(s), std::arg(s[0])) * turn * mirrored_m / (in_m * out_m) / double{sizes};
    }
    EXPECT_LT(std::abs(mean - 1.0), 0.015) << mean.real() << ' ' << mean.imag();
  }
}

TEST(Surface, SteersAndFocuses) {
  const SurfaceLayout layout = panel_of(16, 16);
  RandomStream random(3, 5);
  for (int i = 0; i < 50; ++i) {
    const SurfaceAim from{in_front(random)}, to{in_front(random)};
    const SurfaceTarget panel(layout, steered_phases(layout, from, to), 1.0);
    const double most = 256 * 0.25 * wave_m * std::sqrt(from.direction.x * to.direction.x);
    EXPECT_NEAR(strength(panel.scatter({from.direction, to.direction}, {})) / most, 1.0, 1e-12);
    EXPECT_LT(strength(panel.scatter({from.direction, in_front(random)}, {})), most);
    // A focus at a distance is in step there, and out of step for plane waves.
    const SurfaceAim near_from{from.direction, 0.05}, near_to{to.direction, 0.08};
    const SurfaceTarget focus(layout, steered_phases(layout, near_from, near_to), 1.0);
    const Aspect at{from.direction, to.direction, 0.05, 0.08};
    double in_step = 0.0;
    for (size_t n = 0; n < layout.elements(); ++n) {
      const double in = glm::distance(0.05 * from.direction, layout.element(n)),
                   out = glm::distance(0.08 * to.direction, layout.element(n));
      const double cosines = 0.05 * from.direction.x / in * 0.08 * to.direction.x / out;
      in_step += std::sqrt(cosines) * 0.05 * 0.08 / (in * out);
    }
    EXPECT_NEAR(strength(focus.scatter(at, {})) / (0.25 * wave_m * in_step), 1.0, 1e-12);
    EXPECT_LT(strength(focus.scatter({from.direction, to.direction}, {})),
              0.9 * strength(focus.scatter(at, {})));
  }
}

TEST(Surface, RoundedPhasesLoseWhatTheyMust) {
  // The mean of e^{j error} over even errors of up to half a step is sinc(1/2^bits).
  const SurfaceLayout layout = panel_of(64, 64);
  RandomStream random(3, 6);
  for (const uint32_t bits : {1u, 2u, 3u}) {
    const double x = pi / static_cast<double>(1u << bits), expected = std::sin(x) / x;
    double sum = 0.0;
    constexpr int aims = 20;
    for (int i = 0; i < aims; ++i) {
      const SurfaceAim from{in_front(random)}, to{in_front(random)};
      std::vector<double> phases = steered_phases(layout, from, to);
      const Aspect aspect{from.direction, to.direction};
      const double exact = strength(SurfaceTarget(layout, phases, 1.0).scatter(aspect, {}));
      round_phases(phases, bits);
      for (const double phase : phases) {
        const double steps = phase / (2.0 * pi) * static_cast<double>(1u << bits);
        ASSERT_NEAR(steps, std::nearbyint(steps), 1e-12);
      }
      sum += strength(SurfaceTarget(layout, phases, 1.0).scatter(aspect, {})) / exact;
    }
    EXPECT_NEAR(sum / aims, expected, 0.025 * expected) << bits;
  }
}

TEST(Surface, KeepsThePolarizationOfLudwig) {
  const SurfaceTarget panel(panel_of(1, 1), {0.0}, 1.0);
  // In the horizontal plane the vertical stays the vertical, whatever the angle.
  for (const double in : {-70.0, 0.0, 40.0})
    for (const double out : {-30.0, 0.0, 75.0}) {
      const ScatterMatrix s =
          panel.scatter({direction_at(pi / 2, radians(in)), direction_at(pi / 2, radians(out))}, {});
      EXPECT_LT(std::abs(s[1]) + std::abs(s[2]), 1e-16);
      EXPECT_LT(std::abs(s[0] - s[3]), 1e-16);
      EXPECT_NEAR(s[0].imag(), 0.25 * wave_m * std::sqrt(std::cos(radians(in)) * std::cos(radians(out))),
                  1e-15);
    }
}

TEST(Surface, LegsAreSpheresOrPlanes) {
  Path leg = testing::plain_path(1e-7);
  EXPECT_EQ(sphere_of_leg(leg), leg.length_m);
  leg.interactions = {{InteractionType::reflection, 1}, {InteractionType::transmission, 2}};
  EXPECT_EQ(sphere_of_leg(leg), leg.length_m);
  leg.interactions.push_back({InteractionType::diffraction, 3});
  EXPECT_EQ(sphere_of_leg(leg), far_away);
}

TEST(Surface, BreaksOfTheContract) {
  EXPECT_THROW(SurfaceTarget(panel_of(2, 2), {0.0}, 1.0), ContractError);
  EXPECT_THROW(SurfaceTarget(panel_of(1, 1), {0.0}, 1.1), ContractError);
  EXPECT_THROW(SurfaceTarget(panel_of(1, 1, 0.6), {0.0}, 1.0), ContractError);
}

}  // namespace
}  // namespace greatx::rf
