// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/light/clouds.h"

#include <cmath>

#include <glm/gtc/packing.hpp>
#include <gtest/gtest.h>

#include "core/units.h"
#include "renderer/light/environment_map.h"
#include "renderer/light/panorama.h"
#include "renderer/light/sky.h"

namespace greatx::test {
namespace {

render::Lighting day(double clouds, double elevation_deg = 48.0) {
  render::Lighting lighting;
  lighting.sun_direction = render::Lighting::direction(radians(-60.0), radians(elevation_deg));
  lighting.sun_illuminance_lux = 95000.0;
  lighting.sky_illuminance_lux = 16000.0;
  lighting.clouds = clouds;
  return lighting;
}

/// Returns the illuminance of level ground by the sky, from its radiance along many directions.
double lux_of_sky(const render::Sky& sky) {
  constexpr int rings = 96, sectors = 128;  // the rule of the sky itself: clouds are rough
  double sum = 0.0;
  for (int i = 0; i < rings / 2; ++i)
    for (int k = 0; k < sectors; ++k) {
      const double z = 1.0 - (2.0 * i + 1.0) / rings, phi = 2.0 * pi * (k + 0.5) / sectors;
      const double r = std::sqrt(1.0 - z * z);
      sum += render::luminance(sky.radiance({r * std::cos(phi), r * std::sin(phi), z})) * z;
    }
  return sum * 4.0 * pi / (rings * sectors);
}

TEST(Clouds, CoverTheShareOfThePlaneThatIsAskedFor) {
  for (const double cover : {0.0, 0.1, 0.3, 0.7, 1.0})
    for (const uint64_t seed : {1u, 2u, 7u}) {
      const render::Clouds clouds(cover, seed, {0, 0, 1});
      size_t covered = 0;
      constexpr int side = 300;
      for (int i = 0; i < side; ++i)
        for (int k = 0; k < side; ++k)
          covered += clouds.covers(vec2(dvec2(i + 0.5, k + 0.5) * (16000.0 / side)));
      EXPECT_NEAR(double(covered) / (side * side), cover, 0.01) << seed;
    }
}

TEST(Clouds, HideTheSkyOverheadByAboutTheirCover) {
  // Heaps that are seen aslant hide a little more of the sky than they cover of the plane.
  for (const double cover : {0.0, 0.15, 0.4, 0.7}) {
    double hidden = 0.0;
    size_t looks = 0;
    for (uint64_t seed = 1; seed <= 12; ++seed) {
      const render::Clouds clouds(cover, seed, {1, 0, 0});
      for (int i = -20; i <= 20; ++i)
        for (int k = -20; k <= 20; ++k, ++looks)
          hidden += 1.0 - double(clouds.see(vec3(glm::normalize(dvec3(i / 20.0, k / 20.0, 1.0)))).passed);
    }
    const double share = hidden / double(looks);
    EXPECT_GT(share, cover - 0.12) << cover;
    EXPECT_LT(share, cover + 0.12) << cover;
  }
}

TEST(Clouds, LeaveTheKeyLightFreeAndAreTheSameForTheSameSeed) {
  const dvec3 key = render::Lighting::direction(1.0, radians(30.0));
  const render::Clouds clouds(0.9, 3, key), same(0.9, 3, key), other(0.9, 4, key);
  EXPECT_EQ(clouds.see(vec3(key)).passed, 1.0f);
  EXPECT_EQ(clouds.see(vec3(key)).direct, 0.0f);
  size_t differing = 0;
  for (int i = 0; i < 100; ++i) {
    const vec3 d(render::Lighting::direction(0.06 * i, radians(5.0 + 0.8 * i)));
    EXPECT_EQ(clouds.see(d).direct, same.see(d).direct);
    differing += clouds.see(d).direct != other.see(d).direct;
  }
  EXPECT_GT(differing, 50u);
}

TEST(Clouds, TheIlluminanceOfTheSkyStaysWhatItIs) {
  for (const double elevation : {48.0, 5.0, -3.0, -30.0})
    for (const double cover : {0.0, 0.3, 0.8}) {
      const render::Sky sky(day(cover, elevation), false, true);
      EXPECT_NEAR(lux_of_sky(sky) / 16000.0, 1.0, 1e-6) << elevation << " " << cover;
      const auto sh = render::sky_irradiance(sky);
      EXPECT_NEAR(render::luminance(sh[0] + sh[2] + 2.0 * sh[6]) * pi / 16000.0, 1.0, 1e-6);
    }
  render::Lighting overcast = day(0.0);
  overcast.sky_model = render::SkyModel::overcast;
  EXPECT_NEAR(lux_of_sky(render::Sky(overcast, false, true)) / 16000.0, 1.0, 1e-6);
}

TEST(Clouds, ThePanoramaHasTheSkysIlluminanceToo) {
  // It is finer than the rule by which the sky is scaled, and clouds are rough.
  for (const double cover : {0.0, 0.3, 0.8}) {
    const render::Sky sky(day(cover), false, true);
    constexpr uint32_t size = 192;
    const std::vector<uint16_t> texels = render::bake_panorama(sky, size, 1000.0);
    double lux = 0.0;
    for (uint32_t row = 0; row < size; ++row)
      for (uint32_t column = 0; column < size; ++column) {
        const uint16_t* texel = &texels[4 * (size_t{row} * size + column)];
        dvec3 radiance;
        for (int c = 0; c < 3; ++c) radiance[c] = 1000.0 * double(glm::unpackHalf1x16(texel[c]));
        const dvec3 d = render::panorama_direction((column + 0.5) / size, (row + 0.5) / size);
        // On an octahedron with |x| + |y| + z = 1 the solid angle of dx dy is |p|^-3 of them.
        const double length = 1.0 / (std::abs(d.x) + std::abs(d.y) + d.z);
        lux += render::luminance(radiance) * d.z * (2.0 / (double(size) * size)) / std::pow(length, 3.0);
      }
    EXPECT_NEAR(lux / 16000.0, 1.0, cover > 0.0 ? 0.03 : 0.005) << cover;
  }
}

TEST(Clouds, ThePanoramasPlacesAreThoseOfItsDirections) {
  for (int i = 0; i < 200; ++i) {
    const dvec3 d = render::Lighting::direction(0.3 * i, radians(0.45 * i));
    const dvec2 uv = render::panorama_uv(d);
    EXPECT_NEAR(glm::length(render::panorama_direction(uv.x, uv.y) - d), 0.0, 1e-12);
  }
}

TEST(Clouds, AreBrighterThanTheSkyByDayAndLitByTheCityAtNight) {
  const auto brightest = [](const render::Sky& sky) {
    double most = 0.0;
    for (int i = 0; i < 4000; ++i) {
      const dvec3 d = render::Lighting::direction(0.37 * i, radians(20.0 + 0.01 * i));
      if (sky.clouds(d).passed < 0.1) most = std::max(most, render::luminance(sky.radiance(d)));
    }
    return most;
  };
  const render::Sky sunny(day(0.4), false, true);
  EXPECT_GT(brightest(sunny), 2.5 * render::luminance(sunny.cloudless({0, 0, 1})));
  render::Lighting night = day(0.4, -40.0);
  night.sky_glow_cd_m2 = 0.01;
  night.sky_illuminance_lux = 0.05;
  const render::Sky city(night, false, true);
  EXPECT_GT(brightest(city), 1.5 * render::luminance(city.cloudless({0, 0, 1})));
}

}  // namespace
}  // namespace greatx::test
