// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "shaders/shared/brdf.h"

#include <array>
#include <cmath>
#include <span>

#include <gtest/gtest.h>

#include "core/units.h"
#include "renderer/camera/camera.h"
#include "renderer/light/sky.h"
#include "shaders/shared/develop.h"

namespace greatx {
namespace {

using shared::Reflectance;

struct Sums {
  double specular = 0.0, with_diffuse = 0.0;
};

/// Returns the integral of the BRDF times the cosine over the hemisphere. This is the share of light that the
/// surface reflects in a white world.
Sums directional_albedo(const Reflectance& r) {
  constexpr int rings = 1000, sectors = 96;
  const double sin_v = std::sqrt(1.0 - double(r.n_dot_v) * r.n_dot_v);
  Sums sums;
  for (int i = 0; i < rings; ++i) {
    // Equal steps of the angle are dense in solid angle near the normal, where the lobe of a smooth surface
    // is narrow.
    const double theta = 0.5 * pi * (i + 0.5) / rings, sine = std::sin(theta), cosine = std::cos(theta);
    for (int k = 0; k < sectors; ++k) {
      const double phi = pi * (k + 0.5) / sectors;  // the other half is the mirror image of this one
      const dvec3 l(sine * std::cos(phi), sine * std::sin(phi), cosine), v(-sin_v, 0.0, r.n_dot_v);
      const dvec3 h = glm::normalize(l + v);
      const float f = shared::specular_brdf(r, float(cosine), float(h.z), float(glm::dot(l, h))).x;
      sums.specular += f * cosine * sine * (0.5 * pi / rings) * (2.0 * pi / sectors);
    }
  }
  sums.with_diffuse = sums.specular + r.diffuse.x;
  return sums;
}

TEST(Brdf, DistributionIsNormalised) {
  for (const float roughness : {0.2f, 0.5f, 1.0f}) {
    double sum = 0.0;
    constexpr int steps = 20000;
    for (int i = 0; i < steps; ++i) {
      const double theta = 0.5 * pi * (i + 0.5) / steps;
      sum += shared::ggx_distribution(float(std::cos(theta)), shared::alpha_from_roughness(roughness)) *
             std::cos(theta) * std::sin(theta) * 2.0 * pi * (0.5 * pi / steps);
    }
    EXPECT_NEAR(sum, 1.0, 1e-3) << roughness;
  }
}

TEST(Brdf, SendsOnNoMoreThanItReceives) {
  // The albedo is an analytic fit with errors of a few per cent. Apart from these, no angle and roughness may
  // gain energy, and white surfaces lose little because the BRDF includes multiple scattering.
  for (const float metallic : {0.0f, 1.0f})
    for (const float roughness : {0.3f, 0.5f, 0.8f, 1.0f})
      for (const float n_dot_v : {0.2f, 0.5f, 0.8f, 1.0f}) {
        const Sums sums =
            directional_albedo(shared::reflectance_of(vec3(1.0f), metallic, roughness, n_dot_v));
        EXPECT_LE(sums.with_diffuse, 1.03) << metallic << " " << roughness << " " << n_dot_v;
        EXPECT_GE(sums.with_diffuse, 0.93) << metallic << " " << roughness << " " << n_dot_v;
      }
}

TEST(Brdf, FitOfTheAlbedoAgreesWithTheIntegral) {
  for (const float roughness : {0.3f, 0.6f, 1.0f})
    for (const float n_dot_v : {0.3f, 0.7f, 1.0f}) {
      const Reflectance r = shared::reflectance_of(vec3(1.0f), 0.0f, roughness, n_dot_v);
      EXPECT_NEAR(directional_albedo(r).specular, r.albedo.x, 0.03) << roughness << " " << n_dot_v;
    }
}

TEST(Brdf, FresnelEndsAtOne) {
  EXPECT_FLOAT_EQ(shared::schlick_fresnel(vec3(0.04f), 0.0f).x, 0.04f);
  EXPECT_FLOAT_EQ(shared::schlick_fresnel(vec3(0.04f), 1.0f).x, 1.0f);
}

TEST(Develop, IsMonotoneAndEndsBelowWhite) {
  float before = -1.0f;
  for (float x = 0.0f; x < 100.0f; x += 0.01f) {
    const vec3 y = shared::tone_map(vec3(x));
    EXPECT_GE(y.x, before - 1e-6f);
    EXPECT_LE(y.x, 1.0f);
    EXPECT_EQ(y.x, y.z);
    before = y.x;
  }
}

TEST(Develop, ALampOfOneColorKeepsThreeQuartersOfItsSaturation) {
  for (float x = 0.01f; x < 1e5f; x *= 1.5f) {
    const vec3 y = shared::tone_map(vec3(x, 0.0f, 0.0f));
    EXPECT_GE(y.x - y.y, 0.75f * y.x - 1e-6f) << x;
    EXPECT_EQ(y.y, y.z);
  }
  EXPECT_NEAR(shared::tone_map(vec3(1e4f, 0.0f, 0.0f)).y, 0.25f, 1e-6f);
}

TEST(Develop, SrgbBytes) {
  // IEC 61966-2-1: 18 % grey is code 118, and the linear segment ends at code 10.
  EXPECT_EQ(shared::srgb_byte(0.18f), 118u);
  EXPECT_EQ(shared::srgb_byte(0.0031308f), 10u);
  EXPECT_EQ(shared::srgb_byte(0.0f), 0u);
  EXPECT_EQ(shared::srgb_byte(1.0f), 255u);
}

TEST(Exposure, SaturationOfSunnySixteen) { EXPECT_DOUBLE_EQ(render::saturation_luminance(15.0), 39321.6); }

}  // namespace
}  // namespace greatx
