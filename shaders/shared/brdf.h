// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Describes how a surface reflects light: glTF 2.0 metallic-roughness (appendix B) with the height-correlated
// Smith term and compensation for multiple scattering. C++ tests and shaders read the same pure functions.
//
//   f = diffuse (1 - E) / pi + D V F k
//   E  directional albedo of the specular lobe; the diffuse part leaves out the light of the lobe
//   k  1 + F0 (1/E_ss - 1), for the loss of a single bounce off the microfacets (Fdez-Aguera, "A Multiple-
//      Scattering Microfacet Model for Real-Time Image-based Lighting", JCGT 8(1), 2019; Filament, section
//      4.7.2)
#ifndef GREATX_SHADERS_SHARED_BRDF_H
#define GREATX_SHADERS_SHARED_BRDF_H
#include "glsl.h"
#include "pane.h"

#ifdef __cplusplus
namespace greatx::shared {
using glm::clamp;
using glm::dot;
using glm::max;
using glm::min;
using glm::mix;
using std::sqrt;
}  // namespace greatx::shared
#endif

GREATX_SHARED_BEGIN

/// The reflectance at normal incidence of a dielectric with index 1.5 (glTF 2.0, 3.9.2).
const float dielectric_f0 = 0.04f;
const float inverse_pi = 0.31830988618f;
/// The least alpha. The highlight of the sun in a perfect mirror would not fit a half float.
const float least_alpha = 0.002f;

/// Returns alpha = perceptual roughness squared (glTF 2.0, appendix B.2.3).
GREATX_FUNCTION float alpha_from_roughness(float roughness) {
  return max(roughness * roughness, least_alpha);
}

/// Returns the GGX normal distribution, 1/sr (Walter et al., EGSR 2007, eq. 33).
GREATX_FUNCTION float ggx_distribution(float n_dot_h, float alpha) {
  float a2 = alpha * alpha;
  float f = (n_dot_h * a2 - n_dot_h) * n_dot_h + 1.0f;
  return a2 * inverse_pi / (f * f);
}

/// Returns G / (4 (n.v) (n.l)), height-correlated Smith (Heitz, JCGT 3(2), 2014, eq. 99).
GREATX_FUNCTION float smith_visibility(float n_dot_v, float n_dot_l, float alpha) {
  float a2 = alpha * alpha;
  float v = n_dot_l * sqrt(n_dot_v * n_dot_v * (1.0f - a2) + a2);
  float l = n_dot_v * sqrt(n_dot_l * n_dot_l * (1.0f - a2) + a2);
  return 0.5f / (v + l);
}

/// Returns Schlick's Fresnel term (1994) for 1 - cos of the half angle.
GREATX_FUNCTION vec3 schlick_fresnel(vec3 f0, float one_minus_cos) {
  float s = one_minus_cos * one_minus_cos;
  return f0 + (vec3(1.0f) - f0) * (s * s * one_minus_cos);
}

/// Returns the scale of F0 and the offset that give the directional albedo of a single bounce:
/// E_ss(F0) = F0 x + y (the split sum of Karis, "Real Shading in Unreal Engine 4", 2013). The polynomials
/// were fitted by least squares to this header's own lobe on n.v = .02, .05, .1 ... 1 and roughness .05 ...
/// 1. The rms error is .01, and the largest is .06 where both are small.
GREATX_FUNCTION vec2 specular_albedo_terms(float n_dot_v, float roughness) {
  float r = roughness, u = 1.0f - n_dot_v, u2 = u * u, u5 = u2 * u2 * u;
  vec4 p = vec4(1.0f, r, r * r, r * r * r);
  float e0 = dot(p, vec4(-4.898510f, 19.392632f, -25.271610f, 10.732605f));
  float e1 = dot(p, vec4(21.557946f, -109.687165f, 156.616098f, -70.463709f));
  float e2 = dot(p, vec4(-25.609111f, 154.674327f, -241.176599f, 114.568377f));
  float e3 = dot(p, vec4(8.961386f, -64.118487f, 106.530581f, -52.509684f));
  // the albedo of a white conductor
  float whole = 1.0f + r * r * (e0 + n_dot_v * (e1 + n_dot_v * (e2 + n_dot_v * e3)));
  float y5 = dot(p, vec4(1.616073f, -3.050597f, -0.256109f, 1.814167f));
  float y2 = dot(p, vec4(-0.261276f, 1.749049f, -2.617528f, 1.128633f));
  float y1 = dot(p, vec4(0.072480f, -0.461911f, 0.730696f, -0.340329f));
  float y9 = dot(p, vec4(-0.274115f, -1.779675f, 6.147730f, -4.179556f));
  float y = clamp(u * y1 + u2 * y2 + u5 * y5 + u5 * u2 * u2 * y9, 0.0f, 1.0f);
  return vec2(clamp(whole, 0.1f, 1.0f) - y, y);
}

/// Describes the material of a surface at a point, and its response in the direction of the eye.
struct Reflectance {
  vec3 diffuse;  ///< albedo of the diffuse part, with E taken off
  vec3 f0;
  vec3 albedo;  ///< E: directional albedo of the specular lobe with its multiple scattering
  vec3 gain;    ///< k
  float alpha;
  float n_dot_v;
};

/// Returns the reflectance of a surface whose dielectric part has the reflectance `f0` at normal incidence.
GREATX_FUNCTION Reflectance reflectance_below(vec3 base_color, float metallic, float roughness, float n_dot_v,
                                              float f0) {
  Reflectance r;
  r.n_dot_v = max(n_dot_v, 1e-3f);
  r.alpha = alpha_from_roughness(roughness);
  r.f0 = mix(vec3(f0), base_color, metallic);
  vec2 terms = specular_albedo_terms(r.n_dot_v, roughness);
  r.gain = vec3(1.0f) + r.f0 * (1.0f / (terms.x + terms.y) - 1.0f);
  r.albedo = (r.f0 * terms.x + vec3(terms.y)) * r.gain;
  // The dielectric's lobe lies over the diffuse part, whatever fraction of the surface is metal.
  float dielectric = (f0 * terms.x + terms.y) * (1.0f + f0 * (1.0f / (terms.x + terms.y) - 1.0f));
  r.diffuse = base_color * ((1.0f - metallic) * (1.0f - dielectric));
  return r;
}

GREATX_FUNCTION Reflectance reflectance_of(vec3 base_color, float metallic, float roughness, float n_dot_v) {
  return reflectance_below(base_color, metallic, roughness, n_dot_v, dielectric_f0);
}

/// Returns the reflectance of a smooth pane of glass with both of its faces. `base_color` is the albedo of
/// what neither reflects nor passes. Its lobe is that of a surface with the Fresnel term of the pane in the
/// mirror's direction.
GREATX_FUNCTION Reflectance pane_reflectance_of(vec3 base_color, float roughness, float n_dot_v) {
  Reflectance r;
  r.n_dot_v = max(n_dot_v, 1e-3f);
  r.alpha = alpha_from_roughness(roughness);
  float mirrored = pane_reflectance(r.n_dot_v, pane_index, 1.0f);
  float s = (1.0f - r.n_dot_v) * (1.0f - r.n_dot_v);
  float schlick = s * s * (1.0f - r.n_dot_v);
  r.f0 = vec3(max(mirrored - schlick, 0.0f) / (1.0f - schlick));
  r.gain = vec3(1.0f);
  r.albedo = vec3(mirrored);
  r.diffuse = base_color * (1.0f - mirrored);
  return r;
}

/// Returns the reflectance of a Lambertian surface, without a specular lobe.
GREATX_FUNCTION Reflectance lambertian_reflectance(vec3 base_color) {
  Reflectance r;
  r.n_dot_v = 1.0f;
  r.alpha = 1.0f;
  r.f0 = vec3(0.0f);
  r.albedo = vec3(0.0f);
  r.gain = vec3(0.0f);
  r.diffuse = base_color;
  return r;
}

/// Returns the specular lobe, 1/sr. All cosines are in (0, 1].
GREATX_FUNCTION vec3 specular_brdf(Reflectance r, float n_dot_l, float n_dot_h, float l_dot_h) {
  float dv = ggx_distribution(n_dot_h, r.alpha) * smith_visibility(r.n_dot_v, n_dot_l, r.alpha);
  return schlick_fresnel(r.f0, 1.0f - l_dot_h) * r.gain * dv;
}

GREATX_SHARED_END
#endif
