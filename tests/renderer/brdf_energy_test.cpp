// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks that no surface reflects more light than it receives, whatever its material. The test integrates the
// BRDF of shaders/shared/brdf.h on the host over roughness, metalness, colour and angle.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"
#include "core/vec.h"
#include "shaders/shared/brdf.h"

namespace greatx {
namespace {

using shared::Reflectance;

/// Returns the directional albedo of the specular lobe. The half vectors are sampled in proportion to the
/// distribution, so that narrow lobes of smooth surfaces need no finer grid: dl = 4 (l.h) dh, and D (n.h) dh
/// is uniform in u and phi with tan^2 theta_h = alpha^2 u / (1 - u) (Walter et al., EGSR 2007, eq. 35).
double specular_albedo(const Reflectance& r) {
  constexpr int rings = 400, sectors = 64;
  const dvec3 v(std::sqrt(1.0 - double(r.n_dot_v) * r.n_dot_v), 0.0, r.n_dot_v);
  double sum = 0.0;
  for (int i = 0; i < rings; ++i) {
    const double u = (i + 0.5) / rings, tan2 = double(r.alpha) * r.alpha * u / (1.0 - u);
    const double cosine = 1.0 / std::sqrt(1.0 + tan2), sine = std::sqrt(1.0 - cosine * cosine);
    for (int k = 0; k < sectors; ++k) {
      const double phi = pi * (k + 0.5) / sectors;  // the other half is the mirror image of this one
      const dvec3 h(sine * std::cos(phi), sine * std::sin(phi), cosine), l = 2.0 * glm::dot(v, h) * h - v;
      const double l_dot_h = glm::dot(l, h);
      if (l.z <= 0.0 || l_dot_h <= 0.0) continue;
      // The integrand without the distribution, which the sampling includes.
      const double f = shared::schlick_fresnel(r.f0, float(1.0 - l_dot_h)).x * r.gain.x *
                       shared::smith_visibility(r.n_dot_v, float(l.z), r.alpha);
      sum += f * l.z * 4.0 * l_dot_h / (cosine * rings * sectors);
    }
  }
  return sum;
}

TEST(BrdfEnergy, SendsOnNoMoreThanItReceivesAnywhere) {
  // The albedo may exceed 1 by the error of its fit: brdf.h states 0.01 rms and at most 0.06, at grazing
  // angles.
  double largest = 0.0, squares = 0.0;
  int count = 0;
  for (const float color : {0.0f, 0.2f, 0.5f, 0.8f, 1.0f})
    for (const float metallic : {0.0f, 0.25f, 0.5f, 0.75f, 1.0f})
      for (const float roughness : {0.05f, 0.1f, 0.2f, 0.3f, 0.45f, 0.6f, 0.8f, 1.0f})
        for (const float n_dot_v : {0.02f, 0.05f, 0.1f, 0.2f, 0.35f, 0.5f, 0.7f, 0.85f, 1.0f}) {
          const Reflectance r = shared::reflectance_of(vec3(color), metallic, roughness, n_dot_v);
          const double albedo = specular_albedo(r) + r.diffuse.x;
          EXPECT_GE(r.diffuse.x, 0.0f);
          EXPECT_LE(albedo, n_dot_v < 0.2f ? 1.06 : 1.03) << "color " << color << " metallic " << metallic
                                                          << " roughness " << roughness << " n.v " << n_dot_v;
          largest = std::max(largest, albedo);
          // Light is lost between dielectric and metal: glTF mixes f0 into one lobe, which reduces the
          // diffuse part twice.
          if (color == 1.0f && (metallic == 0.0f || metallic == 1.0f))
            squares += (albedo - 1.0) * (albedo - 1.0), ++count;
        }
  RecordProperty("largest_albedo", std::to_string(largest));
  EXPECT_LT(std::sqrt(squares / count), 0.02) << "of white surfaces, which should keep all of it";
}

TEST(BrdfEnergy, IntegralAgreesWithThatOverTheHemisphere) {
  // Integrates the same BRDF by equal steps of solid angle; the lobe is wide enough for these steps.
  const Reflectance r = shared::reflectance_of(vec3(0.6f), 1.0f, 0.7f, 0.5f);
  const dvec3 v(std::sqrt(0.75), 0.0, 0.5);
  constexpr int rings = 600, sectors = 128;
  double sum = 0.0;
  for (int i = 0; i < rings; ++i)
    for (int k = 0; k < sectors; ++k) {
      const double z = (i + 0.5) / rings, s = std::sqrt(1.0 - z * z), phi = pi * (k + 0.5) / sectors;
      const dvec3 l(s * std::cos(phi), s * std::sin(phi), z), h = glm::normalize(l + v);
      sum += shared::specular_brdf(r, float(z), float(h.z), float(glm::dot(l, h))).x * z * 2.0 * pi /
             (rings * sectors);
    }
  EXPECT_NEAR(specular_albedo(r), sum, 2e-3);
}

TEST(BrdfEnergy, IsReciprocal) {
  // Only the specular lobe is reciprocal. The diffuse part is scaled by the light that the lobe leaves in the
  // direction of the eye alone.
  for (const float roughness : {0.1f, 0.4f, 1.0f}) {
    const float a = 0.3f, b = 0.8f, h = 0.9f, d = 0.7f;
    Reflectance one = shared::reflectance_of(vec3(0.6f), 1.0f, roughness, a), other = one;
    other.n_dot_v = b;
    EXPECT_NEAR(shared::specular_brdf(one, b, h, d).x / shared::specular_brdf(other, a, h, d).x, 1.0, 1e-5);
  }
}

}  // namespace
}  // namespace greatx
