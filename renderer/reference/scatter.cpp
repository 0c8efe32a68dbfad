// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/reference/scatter.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "renderer/light/sky.h"

namespace greatx::render {

void complete_frame(const dvec3& z, dvec3& x, dvec3& y) {
  const double sign = z.z >= 0.0 ? 1.0 : -1.0, a = -1.0 / (sign + z.z), b = z.x * z.y * a;
  x = {1.0 + sign * z.x * z.x * a, sign * b, -sign * z.x};
  y = {b, sign + z.y * z.y * a, -z.y};
}

Scatter::Scatter(const RaySurface& surface, const dvec3& to_eye, bool specular)
    : normal_(surface.normal), geometric_(surface.geometric), to_eye_(to_eye) {
  const auto cosine = float(glm::dot(normal_, to_eye)), roughness = float(surface.roughness);
  if (!specular)
    reflectance_ = shared::lambertian_reflectance(vec3(surface.base_color));
  else if (surface.passes)
    reflectance_ = shared::pane_reflectance_of(vec3(surface.base_color), roughness, cosine);
  else
    reflectance_ =
        shared::reflectance_of(vec3(surface.base_color), float(surface.metallic), roughness, cosine);
  complete_frame(normal_, x_, y_);
  if (!specular) return;
  const double diffuse = luminance(dvec3(reflectance_.diffuse)),
               mirrored = luminance(dvec3(reflectance_.albedo));
  lobe_share_ = diffuse + mirrored > 0.0 ? std::clamp(mirrored / (diffuse + mirrored), 0.1, 1.0) : 0.5;
  if (diffuse > 0.0) lobe_share_ = std::min(lobe_share_, 0.9);
}

bool Scatter::above(const dvec3& to_light) const {
  return glm::dot(to_light, normal_) > 0.0 && glm::dot(to_light, geometric_) > 0.0;
}

double Scatter::lobe(double n_dot_h, const dvec3& half) const {
  // 1 - (n.h)^2 is the square of a cross product, which keeps the digits of a narrow lobe.
  const double alpha2 = double(reflectance_.alpha) * double(reflectance_.alpha);
  const dvec3 across = glm::cross(normal_, half);
  const double f = alpha2 * n_dot_h * n_dot_h + glm::dot(across, across);
  return alpha2 / (pi * f * f);
}

dvec3 Scatter::reflected(const dvec3& to_light) const {
  if (!above(to_light)) return dvec3(0.0);
  const double n_dot_l = glm::dot(normal_, to_light);
  dvec3 f = dvec3(reflectance_.diffuse) / pi;
  if (lobe_share_ > 0.0) {
    const dvec3 half = glm::normalize(to_light + to_eye_);
    const double n_dot_h = glm::dot(normal_, half);
    if (n_dot_h > 0.0) {
      const float l_dot_h = float(std::clamp(glm::dot(to_light, half), 0.0, 1.0));
      const vec3 rest = shared::schlick_fresnel(reflectance_.f0, 1.0f - l_dot_h) * reflectance_.gain *
                        shared::smith_visibility(reflectance_.n_dot_v, float(n_dot_l), reflectance_.alpha);
      f += dvec3(rest) * lobe(n_dot_h, half);
    }
  }
  return f * n_dot_l;
}

dvec3 Scatter::draw(double choice, double u, double v) const {
  const double phi = 2.0 * pi * v;
  if (choice >= lobe_share_) {
    const double level = std::sqrt(u);
    return x_ * (level * std::cos(phi)) + y_ * (level * std::sin(phi)) + normal_ * std::sqrt(1.0 - u);
  }
  const double tangent2 = double(reflectance_.alpha) * double(reflectance_.alpha) * u / (1.0 - u);
  const double cosine = 1.0 / std::sqrt(1.0 + tangent2), level = std::sqrt(tangent2) * cosine;
  const dvec3 half = x_ * (level * std::cos(phi)) + y_ * (level * std::sin(phi)) + normal_ * cosine;
  return glm::normalize(2.0 * glm::dot(to_eye_, half) * half - to_eye_);
}

double Scatter::density(const dvec3& to_light) const {
  double density = (1.0 - lobe_share_) * std::max(glm::dot(normal_, to_light), 0.0) / pi;
  if (lobe_share_ > 0.0) {
    const dvec3 sum = to_light + to_eye_;
    const double length = glm::length(sum);
    if (length > 1e-12) {
      const dvec3 half = sum / length;
      const double n_dot_h = glm::dot(normal_, half), v_dot_h = std::abs(glm::dot(to_eye_, half));
      if (n_dot_h > 0.0 && v_dot_h > 0.0)
        density += lobe_share_ * lobe(n_dot_h, half) * n_dot_h / (4.0 * v_dot_h);
    }
  }
  return density;
}

}  // namespace greatx::render
