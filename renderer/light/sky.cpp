// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/light/sky.h"

#include <cmath>

#include <glm/gtc/packing.hpp>

#include "core/units.h"

namespace greatx::render {

namespace {

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
dvec3 blurred(const std::vector<dvec3>& base, uint32_t size, const dvec3& direction, double roughness,
              uint32_t samples) {
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

namespace {
/// What the sky looks like when the sun is below a degree is outside the model: it keeps the colours of sunset.
double modelled_elevation(const Lighting& lighting) {
  return std::max(std::asin(glm::clamp(lighting.sun_direction.z, -1.0, 1.0)), radians(1.0));
}

/// What the air scatters onto level ground, per channel, for a sun of illuminance 1 above it.
dvec3 on_level_ground(const Atmosphere& air, const dvec3& to_sun) {
  dvec3 sum(0.0);
  over_sphere([&](const dvec3& d, double solid_angle) {
    if (d.z > 0.0) sum += air.radiance(d.z, glm::clamp(glm::dot(d, to_sun), -1.0, 1.0)) * (d.z * solid_angle);
  });
  return sum;
}

/// The colour that pictures show as white: of a white card on the ground under a clear sky, the sun 45 degrees high.
/// Daylight thus looks neutral, evening warm and shade blue.
dvec3 daylight() {
  static const dvec3 white = [] {
    const double sine = std::sqrt(0.5);
    const Atmosphere air(2.0, 0.25 * pi, 0.15);
    const dvec3 total = air.sun_transmittance() * sine + on_level_ground(air, {sine, 0.0, sine});
    return total / luminance(total);
  }();
  return white;
}
}  // namespace

Sky::Sky(const Lighting& lighting)
    : model_(lighting.sky_model),
      illuminance_(lighting.sky_illuminance_lux),
      atmosphere_(lighting.turbidity, modelled_elevation(lighting), lighting.ground_albedo),
      white_(daylight()) {
  const double elevation = modelled_elevation(lighting);
  const dvec2 ground(lighting.sun_direction);
  const dvec2 heading = glm::length(ground) > 1e-9 ? glm::normalize(ground) : dvec2(1.0, 0.0);
  sun_direction_ = dvec3(heading * std::cos(elevation), std::sin(elevation));
  if (lighting.sun_direction.z > 0.0) {
    const dvec3 color = model_ == SkyModel::clear ? atmosphere_.sun_transmittance() / white_ : dvec3(1.0);
    sun_illuminance_ = lighting.sun_illuminance_lux / luminance(color) * color;
  }
  if (model_ == SkyModel::uniform) {
    ground_ = dvec3(illuminance_ / pi);
    return;
  }
  const dvec3 on_ground = on_level_ground(atmosphere_, sun_direction_) / white_;
  scale_ = illuminance_ / luminance(on_ground);
  ground_ = lighting.ground_albedo / pi *
            (sun_illuminance_ * std::max(lighting.sun_direction.z, 0.0) + scale_ * on_ground);
}

dvec3 Sky::above(const dvec3& direction) const {
  return atmosphere_.radiance(direction.z, glm::clamp(glm::dot(direction, sun_direction_), -1.0, 1.0)) /
         white_;
}

dvec3 Sky::radiance(const dvec3& direction) const {
  if (model_ == SkyModel::uniform) return ground_;
  if (direction.z > 0.0) return scale_ * above(direction);
  // Haze over the horizon: the sky's lowest ring fades into the ground over twelve degrees.
  const double fade = glm::smoothstep(0.0, 0.2, -direction.z);
  const double level = std::hypot(direction.x, direction.y);
  const dvec3 horizon = level > 1e-6 ? dvec3(direction.x / level, direction.y / level, 0.0) : dvec3(1, 0, 0);
  return glm::mix(scale_ * above(horizon), ground_, fade);
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
      const dvec3 value =
          level == 0 ? base[i]
                     : blurred(base, size, direction, double(level) / (levels - 1), level == 1 ? 24 : 64);
      for (int c = 0; c < 3; ++c) texels.push_back(glm::packHalf1x16(float(std::min(value[c], 65504.0))));
      texels.push_back(glm::packHalf1x16(1.0f));
    }
    map.levels.push_back(std::move(texels));
  }
  return map;
}

}  // namespace greatx::render
