// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/sky.h"

#include <cmath>

#include <glm/gtc/packing.hpp>

#include "core/units.h"

namespace greatx::render {

namespace {

/// Perez et al.'s five coefficients, linear in the turbidity (Preetham et al. 1999, appendix A.2).
struct Perez {
  double a, b, c, d, e;
  double operator()(double cos_theta, double gamma) const {
    const double cos_gamma = std::cos(gamma);
    return (1.0 + a * std::exp(b / cos_theta)) * (1.0 + c * std::exp(d * gamma) + e * cos_gamma * cos_gamma);
  }
};

Perez perez_luminance(double t) {
  return {0.1787 * t - 1.4630, -0.3554 * t + 0.4275, -0.0227 * t + 5.3251, 0.1206 * t - 2.5771,
          -0.0670 * t + 0.3703};
}
Perez perez_x(double t) {
  return {-0.0193 * t - 0.2592, -0.0665 * t + 0.0008, -0.0004 * t + 0.2125, -0.0641 * t - 0.8989,
          -0.0033 * t + 0.0452};
}
Perez perez_y(double t) {
  return {-0.0167 * t - 0.2608, -0.0950 * t + 0.0092, -0.0079 * t + 0.2102, -0.0441 * t - 1.6537,
          -0.0109 * t + 0.0529};
}

/// Chromaticity at the zenith (Preetham et al. 1999, appendix A.2), sun at zenith angle s.
double zenith_x(double t, double s) {
  return t * t * (((0.00166 * s - 0.00375) * s + 0.00209) * s) +
         t * (((-0.02903 * s + 0.06377) * s - 0.03202) * s + 0.00394) +
         (((0.11693 * s - 0.21196) * s + 0.06052) * s + 0.25886);
}
double zenith_y(double t, double s) {
  return t * t * (((0.00275 * s - 0.00610) * s + 0.00317) * s) +
         t * (((-0.04214 * s + 0.08970) * s - 0.04153) * s + 0.00516) +
         (((0.15346 * s - 0.26756) * s + 0.06670) * s + 0.26688);
}

/// CIE xyY to linear Rec. 709 (IEC 61966-2-1), kept at luminance Y where the colour is out of gamut.
dvec3 from_xy_luminance(double x, double y, double luminance_y) {
  const double big_x = x / y * luminance_y, big_z = (1.0 - x - y) / y * luminance_y;
  const dvec3 rgb = glm::max(dvec3(3.2406 * big_x - 1.5372 * luminance_y - 0.4986 * big_z,
                                   -0.9689 * big_x + 1.8758 * luminance_y + 0.0415 * big_z,
                                   0.0557 * big_x - 0.2040 * luminance_y + 1.0570 * big_z),
                             dvec3(0.0));
  const double now = luminance(rgb);
  return now > 0.0 ? rgb * (luminance_y / now) : dvec3(luminance_y);
}

/// Colour of the sun through the atmosphere, luminance 1: Rayleigh and aerosol attenuation along Kasten's air mass
/// (Preetham et al. 1999, appendix A.1) at 610, 550 and 465 nm, of a source of 5800 K.
dvec3 sun_color(double turbidity, double elevation) {
  const double mass = 1.0 / (std::sin(elevation) + 0.15 * std::pow(degrees(elevation) + 3.885, -1.253));
  const double beta = 0.04608 * turbidity - 0.04586;
  const dvec3 micrometres(0.610, 0.550, 0.465), source(1.00, 0.97, 0.93);
  dvec3 color;
  for (int i = 0; i < 3; ++i)
    color[i] = source[i] * std::exp(-mass * (0.008735 * std::pow(micrometres[i], -4.08) +
                                             beta * std::pow(micrometres[i], -1.3)));
  return color / luminance(color);
}

/// Calls visit(direction, solid angle) over a product rule of the sphere that has the horizon on a cell border.
template <typename F>
void over_sphere(F&& visit) {
  constexpr int rings = 128, sectors = 256;
  for (int i = 0; i < rings; ++i) {
    // Equal steps of z: every cell has the same solid angle.
    const double z = 1.0 - (2.0 * i + 1.0) / rings, r = std::sqrt(1.0 - z * z);
    for (int k = 0; k < sectors; ++k) {
      const double phi = 2.0 * pi * (k + 0.5) / sectors;
      visit(dvec3(r * std::cos(phi), r * std::sin(phi), z), 4.0 * pi / (rings * sectors));
    }
  }
}

dvec3 octahedral_direction(double u, double v) {
  dvec2 p = 2.0 * dvec2(u, v) - 1.0;
  const double z = 1.0 - std::abs(p.x) - std::abs(p.y);
  if (z < 0.0)
    p = dvec2((1.0 - std::abs(p.y)) * (p.x >= 0.0 ? 1.0 : -1.0),
              (1.0 - std::abs(p.x)) * (p.y >= 0.0 ? 1.0 : -1.0));
  return glm::normalize(dvec3(p, z));
}

dvec2 octahedral_uv(const dvec3& d) {
  dvec2 p = dvec2(d) / (std::abs(d.x) + std::abs(d.y) + std::abs(d.z));
  if (d.z < 0.0)
    p = dvec2((1.0 - std::abs(p.y)) * (p.x >= 0.0 ? 1.0 : -1.0),
              (1.0 - std::abs(p.x)) * (p.y >= 0.0 ? 1.0 : -1.0));
  return p * 0.5 + 0.5;
}

double radical_inverse(uint32_t bits) {
  double value = 0.0, digit = 0.5;
  for (; bits != 0; bits >>= 1, digit *= 0.5)
    if (bits & 1u) value += digit;
  return value;
}

/// Radiance around `direction`, weighted as GGX reflects it when looked at head-on (Karis, "Real Shading in Unreal
/// Engine 4", 2013: n = v = r).
dvec3 blurred(const std::vector<dvec3>& base, uint32_t size, const dvec3& direction, double roughness) {
  constexpr uint32_t samples = 64;
  const double alpha = roughness * roughness;
  const dvec3 up = std::abs(direction.z) < 0.99 ? dvec3(0, 0, 1) : dvec3(1, 0, 0);
  const dvec3 x = glm::normalize(glm::cross(up, direction)), y = glm::cross(direction, x);
  dvec3 sum(0.0);
  double weights = 0.0;
  for (uint32_t i = 0; i < samples; ++i) {
    const double u = (i + 0.5) / samples, phi = 2.0 * pi * radical_inverse(i);
    const double cos_half = std::sqrt((1.0 - u) / (1.0 + (alpha * alpha - 1.0) * u));
    const double sin_half = std::sqrt(std::max(0.0, 1.0 - cos_half * cos_half));
    const dvec3 half = x * (sin_half * std::cos(phi)) + y * (sin_half * std::sin(phi)) + direction * cos_half;
    const dvec3 light = 2.0 * cos_half * half - direction;
    const double weight = glm::dot(light, direction);
    if (weight <= 0.0) continue;
    const dvec2 uv = octahedral_uv(glm::normalize(light)) * double(size);
    const auto column = std::min(static_cast<uint32_t>(uv.x), size - 1);
    const auto row = std::min(static_cast<uint32_t>(uv.y), size - 1);
    sum += weight * base[row * size + column];
    weights += weight;
  }
  return sum / weights;
}

}  // namespace

double luminance(const dvec3& color) { return glm::dot(color, dvec3(0.2126, 0.7152, 0.0722)); }

Sky::Sky(const Lighting& lighting)
    : model_(lighting.sky_model), turbidity_(lighting.turbidity), illuminance_(lighting.sky_illuminance_lux) {
  // The model's clear sky ends at sunset; a lower sun keeps the colours of the horizon.
  const double elevation = std::max(std::asin(glm::clamp(lighting.sun_direction.z, -1.0, 1.0)), radians(1.0));
  const dvec2 ground(lighting.sun_direction);
  const dvec2 heading = glm::length(ground) > 1e-9 ? glm::normalize(ground) : dvec2(1.0, 0.0);
  sun_direction_ = dvec3(heading * std::cos(elevation), std::sin(elevation));
  if (lighting.sun_direction.z > 0.0) {
    const dvec3 color = model_ == SkyModel::preetham ? sun_color(turbidity_, elevation) : dvec3(1.0);
    sun_illuminance_ = lighting.sun_illuminance_lux * color;
  }
  if (model_ == SkyModel::uniform) {
    ground_ = dvec3(illuminance_ / pi);
    return;
  }
  double on_ground = 0.0;
  over_sphere([&](const dvec3& d, double solid_angle) {
    if (d.z > 0.0) on_ground += luminance(preetham(d)) * d.z * solid_angle;
  });
  scale_ = illuminance_ / on_ground;
  dvec3 total = sun_illuminance_ * std::max(lighting.sun_direction.z, 0.0);
  over_sphere([&](const dvec3& d, double solid_angle) {
    if (d.z > 0.0) total += scale_ * preetham(d) * d.z * solid_angle;
  });
  ground_ = lighting.ground_albedo / pi * total;
}

dvec3 Sky::preetham(const dvec3& direction) const {
  const double sun_zenith = std::acos(glm::clamp(sun_direction_.z, -1.0, 1.0));
  const double gamma = std::acos(glm::clamp(glm::dot(direction, sun_direction_), -1.0, 1.0));
  const double cos_theta = std::max(direction.z, 0.01);
  const auto relative = [&](const Perez& perez) { return perez(cos_theta, gamma) / perez(1.0, sun_zenith); };
  const double x = zenith_x(turbidity_, sun_zenith) * relative(perez_x(turbidity_));
  const double y = zenith_y(turbidity_, sun_zenith) * relative(perez_y(turbidity_));
  return from_xy_luminance(x, y, std::max(relative(perez_luminance(turbidity_)), 0.0));
}

dvec3 Sky::radiance(const dvec3& direction) const {
  if (model_ == SkyModel::uniform) return ground_;
  if (direction.z > 0.0) return scale_ * preetham(direction);
  // Haze over the horizon: the sky's lowest ring fades into the ground over four degrees.
  const double fade = glm::smoothstep(0.0, 0.07, -direction.z);
  const double level = std::hypot(direction.x, direction.y);
  const dvec3 horizon = level > 1e-6 ? dvec3(direction.x / level, direction.y / level, 0.0) : dvec3(1, 0, 0);
  return glm::mix(scale_ * preetham(horizon), ground_, fade);
}

std::array<dvec3, 9> sky_irradiance(const Sky& sky) {
  // Y_lm without their polynomials, and the cosine lobe's A_l / pi = 1, 2/3, 1/4 (Ramamoorthi and Hanrahan,
  // "An Efficient Representation for Irradiance Environment Maps", SIGGRAPH 2001, eq. 3 and 9).
  constexpr double y[9] = {0.282095, 0.488603, 0.488603, 0.488603, 1.092548,
                           1.092548, 0.315392, 1.092548, 0.546274};
  constexpr double lobe[9] = {1.0, 2.0 / 3, 2.0 / 3, 2.0 / 3, 0.25, 0.25, 0.25, 0.25, 0.25};
  const auto polynomial = [](int i, const dvec3& n) {
    switch (i) {
      case 0:
        return 1.0;
      case 1:
        return n.y;
      case 2:
        return n.z;
      case 3:
        return n.x;
      case 4:
        return n.x * n.y;
      case 5:
        return n.y * n.z;
      case 6:
        return 3.0 * n.z * n.z - 1.0;
      case 7:
        return n.x * n.z;
      default:
        return n.x * n.x - n.y * n.y;
    }
  };
  std::array<dvec3, 9> result{};
  over_sphere([&](const dvec3& d, double solid_angle) {
    const dvec3 weighted = sky.radiance(d) * solid_angle;
    for (int i = 0; i < 9; ++i) result[i] += weighted * polynomial(i, d);
  });
  double upwards = 0.0;
  for (int i = 0; i < 9; ++i) {
    result[i] *= y[i] * y[i] * lobe[i];
    upwards += luminance(result[i]) * polynomial(i, dvec3(0, 0, 1));
  }
  // Order 2 is a few per cent off; level ground shall be exact.
  if (upwards > 0.0)
    for (dvec3& coefficient : result) coefficient *= sky.illuminance() / pi / upwards;
  return result;
}

EnvironmentMap bake_environment(const Sky& sky, uint32_t size, uint32_t levels) {
  EnvironmentMap map;
  map.scale = sky.illuminance() > 0.0 ? sky.illuminance() : 1.0;
  std::vector<dvec3> base(size_t(size) * size);
  for (uint32_t row = 0; row < size; ++row)
    for (uint32_t column = 0; column < size; ++column)
      base[row * size + column] =
          sky.radiance(octahedral_direction((column + 0.5) / size, (row + 0.5) / size)) / map.scale;
  for (uint32_t level = 0; level < levels; ++level) {
    const uint32_t edge = std::max(size >> level, 1u);
    std::vector<uint16_t> texels;
    texels.reserve(size_t(edge) * edge * 4);
    for (uint32_t i = 0; i < edge * edge; ++i) {
      const dvec3 direction = octahedral_direction((i % edge + 0.5) / edge, (i / edge + 0.5) / edge);
      const dvec3 value = level == 0 ? base[i] : blurred(base, size, direction, double(level) / (levels - 1));
      for (int c = 0; c < 3; ++c) texels.push_back(glm::packHalf1x16(float(std::min(value[c], 65504.0))));
      texels.push_back(glm::packHalf1x16(1.0f));
    }
    map.levels.push_back(std::move(texels));
  }
  return map;
}

}  // namespace greatx::render
