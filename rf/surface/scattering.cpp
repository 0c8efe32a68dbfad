// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/surface/scattering.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/phase.h"
#include "core/random.h"
#include "core/units.h"

namespace greatx::rf {
namespace {

/// Separates these draws from every other use of the seed of the run.
constexpr uint64_t patch_phases = 0x7363617474657231ull;

uint32_t whole_exponent(double value, const char* field, const std::string& material_name) {
  if (!(value >= 1.0 && value <= 100.0 && value == std::floor(value)))
    throw_user_error("material '{}', {}: expected a whole number from 1 to 100, found {}", material_name,
                     field, value);
  return static_cast<uint32_t>(value);
}

double share(double value, const char* field, const std::string& material_name) {
  if (!(value >= 0.0 && value <= 1.0))
    throw_user_error("material '{}', {}: expected a number from 0 to 1, found {}", material_name, field,
                     value);
  return value;
}

/// Returns ((1 + cos psi)/2)^alpha, where psi is the angle between two unit vectors. The form |a + b|^2/4
/// does not cancel at psi = pi.
template <typename R, typename V>
R lobe(const V& a, const V& b, uint32_t exponent) {
  using std::pow;
  const V sum = a + b;
  return pow(std::min(R(1.0), R(0.25 * dot(sum, sum))), exponent);
}

/// Returns the lobes of a pattern that has some, without their normalisation.
template <typename R>
R lobes(const DiffuseScatteringOf<R>& surface, const Vec3Of<R>& in, const Vec3Of<R>& out, const R& cos_in,
        const dvec3& normal) {
  const Vec3Of<R> specular = in + 2.0 * cos_in * normal;
  const R forward = lobe<R>(specular, out, surface.exponent);
  if (surface.pattern == scene::ScatteringPattern::directive) return forward;
  const R& back = surface.backscatter_share;
  return (1.0 - back) * forward + back * lobe<R, Vec3Of<R>>(-in, out, surface.backscatter_exponent);
}

}  // namespace

DiffuseScattering diffuse_scattering(const scene::RadioMaterial& material, const std::string& material_name) {
  return {
      .coefficient = share(material.scattering_coefficient, "scattering_coefficient", material_name),
      .pattern = material.pattern,
      .exponent = whole_exponent(material.pattern_exponent, "pattern_exponent", material_name),
      .backscatter_exponent =
          whole_exponent(material.backscatter_exponent, "backscatter_exponent", material_name),
      .backscatter_share = share(material.backscatter_share, "backscatter_share", material_name),
      .cross_polarization = share(material.cross_polarization, "cross_polarization", material_name),
  };
}

template <typename R>
R lobe_normalisation(uint32_t exponent, const Given<R>& cos_incidence) {
  GREATX_CHECK(cos_incidence >= 0.0 && cos_incidence <= 1.0 && exponent <= 100, "cosine {}, exponent {}",
               value_of(cos_incidence), exponent);
  const R quarter_sine2 = 0.25 * (1.0 - cos_incidence) * (1.0 + cos_incidence);
  double binomial = std::ldexp(1.0, -static_cast<int>(exponent));  // C(alpha, k) / 2^alpha
  R term = 1.0, series = 0.0;                                      // C(2w, w) (sin/2)^{2w} and its sum
  R sum = 0.0;
  for (uint32_t k = 0; k <= exponent; ++k) {
    R moment = 2.0 * pi / (k + 1.0);
    if (k % 2 == 1) {  // the sum has one term more than that of the previous odd k
      series += term;
      const double w = (k - 1) / 2;
      term *= quarter_sine2 * 2.0 * (2.0 * w + 1.0) / (w + 1.0);
      moment *= cos_incidence * series;
    }
    sum += binomial * moment;
    binomial *= (exponent - k) / (k + 1.0);
  }
  return sum;
}

template <typename R>
R scattering_pattern(const DiffuseScatteringOf<Given<R>>& surface, const Vec3Of<R>& in, const Vec3Of<R>& out,
                     const dvec3& normal) {
  const R cos_in = std::min(R(1.0), R(-dot(in, normal))), cos_out = dot(out, normal);
  GREATX_CHECK(cos_in >= 0.0, "the wave comes from behind: cosine {}", value_of(cos_in));
  if (cos_out <= 0.0) return 0.0;
  if (surface.pattern == scene::ScatteringPattern::lambertian) return cos_out / pi;
  const R shape = lobes<R>(surface, in, out, cos_in, normal);
  const R forward_norm = lobe_normalisation<R>(surface.exponent, cos_in);
  if (surface.pattern == scene::ScatteringPattern::directive) return shape / forward_norm;
  const R& back = surface.backscatter_share;
  return shape /
         ((1.0 - back) * forward_norm + back * lobe_normalisation<R>(surface.backscatter_exponent, cos_in));
}

double scattering_shape(const DiffuseScattering& surface, const dvec3& in, const dvec3& out,
                        const dvec3& normal) {
  const double cos_in = std::min(1.0, -glm::dot(in, normal));
  if (glm::dot(out, normal) <= 0.0) return 0.0;
  if (surface.pattern == scene::ScatteringPattern::lambertian) return 1.0;
  return lobes<double>(surface, in, out, cos_in, normal);
}

template <typename R>
ScatteringMatrixOf<R> scattering_matrix(const Given<R>& cross_polarization, uint64_t seed, uint32_t facet,
                                        uint32_t patch) {
  using std::sqrt;
  RandomStream random(seed ^ patch_phases, facet, patch);
  const double a = random.uniform(), b = random.uniform(), c = random.uniform();
  const R kept = sqrt(1.0 - cross_polarization), crossed = sqrt(cross_polarization);
  return {kept * unit_phasor(a), crossed * unit_phasor(c), crossed * unit_phasor(a + b - c + 0.5),
          kept * unit_phasor(b)};
}

// The templates of this file, for doubles and for dual numbers.
#define GREATX_FOR(R)                                                                                 \
  template R lobe_normalisation<R>(uint32_t, const R&);                                               \
  template R scattering_pattern<R>(const DiffuseScatteringOf<R>&, const Vec3Of<R>&, const Vec3Of<R>&, \
                                   const dvec3&);                                                     \
  template ScatteringMatrixOf<R> scattering_matrix<R>(const R&, uint64_t, uint32_t, uint32_t);
GREATX_FOR(double)
GREATX_FOR(Dual)
#undef GREATX_FOR

}  // namespace greatx::rf
