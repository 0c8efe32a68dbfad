// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/light/atmosphere.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace greatx::render {

namespace {

constexpr double earth_radius = 6360e3, thickness = 100e3;
constexpr double air_scale = 8e3, aerosol_scale = 1.2e3, asymmetry = 0.8;
constexpr double aerosol_albedo = 0.9;
const dvec3 air_scattering(5.802e-6, 13.558e-6, 33.1e-6);  // 1/m at sea level
const dvec3 ozone_absorption(0.650e-6, 1.881e-6, 0.085e-6);
/// The sun above the air in linear Rec. 709, relative to D65: a black body of 5800 K.
const dvec3 sun_above(1.0, 0.97, 0.93);

double height_at(double height, double sine, double distance) {
  const double r = earth_radius + height;
  return std::sqrt(r * r + distance * distance + 2.0 * r * distance * sine) - earth_radius;
}

/// To the top of the air, or to the ground if the direction meets it.
double path_length(double height, double sine, bool* ground = nullptr) {
  const double r = earth_radius + height, b = r * sine;
  const double to_ground = b * b - r * r + earth_radius * earth_radius;
  const bool hits = sine < 0.0 && to_ground >= 0.0;
  if (ground != nullptr) *ground = hits;
  if (hits) return -b - std::sqrt(to_ground);
  const double top = earth_radius + thickness;
  return -b + std::sqrt(b * b - r * r + top * top);
}

/// Visits `steps` points of a path, denser at its start: visit(distance, step length).
template <typename F>
void along(double length, int steps, F&& visit) {
  double from = 0.0;
  for (int i = 1; i <= steps; ++i) {
    const double t = double(i) / steps, to = length * t * t;
    visit(0.5 * (from + to), to - from);
    from = to;
  }
}

}  // namespace

Atmosphere::Atmosphere(double turbidity, double sun_elevation, double ground_albedo)
    : sun_sine_(std::sin(sun_elevation)) {
  aerosol_extinction_ = (turbidity - 1.0) * air_scattering.y * air_scale / aerosol_scale;
  aerosol_scattering_ = aerosol_albedo * aerosol_extinction_;
  for (int i = 0; i < heights; ++i)
    sun_[i] =
        sun_above * transmittance_to_top(thickness * i * i / ((heights - 1.0) * (heights - 1.0)), sun_sine_);
  sun_on_ground_ = sun_[0];
  scatter_many_times(ground_albedo);
  integrate_views();
}

Atmosphere::Density Atmosphere::density(double height) const {
  return {std::exp(-height / air_scale), std::exp(-height / aerosol_scale),
          std::max(0.0, 1.0 - std::abs(height - 25e3) / 15e3)};
}

dvec3 Atmosphere::extinction(const Density& d) const {
  return air_scattering * d.air + dvec3(aerosol_extinction_ * d.aerosol) + ozone_absorption * d.ozone;
}

dvec3 Atmosphere::transmittance_to_top(double height, double sin_elevation) const {
  dvec3 depth(0.0);
  along(path_length(height, sin_elevation), 64,
        [&](double s, double ds) { depth += extinction(density(height_at(height, sin_elevation, s))) * ds; });
  return glm::exp(-depth);
}

dvec3 Atmosphere::at_height(const std::array<dvec3, heights>& table, double height) {
  const double x = std::sqrt(std::clamp(height / thickness, 0.0, 1.0)) * (heights - 1);
  const int i = std::min(static_cast<int>(x), heights - 2);
  return glm::mix(table[i], table[i + 1], x - i);
}

void Atmosphere::scatter_many_times(double ground_albedo) {
  constexpr int sines = 48;
  std::array<dvec3, heights> result{};
  for (int i = 0; i < heights; ++i) {
    const double height = std::max(1.0, thickness * i * i / ((heights - 1.0) * (heights - 1.0)));
    dvec3 second(0.0), share(0.0);  // Hillaire's L_2nd and f_ms, averaged over the sphere
    for (int k = 0; k < sines; ++k) {
      const double sine = -1.0 + (2.0 * k + 1.0) / sines;
      bool ground = false;
      const double length = path_length(height, sine, &ground);
      dvec3 transmittance(1.0);
      along(length, 24, [&](double s, double ds) {
        const double h = std::max(0.0, height_at(height, sine, s));
        const Density d = density(h);
        const dvec3 scattering = air_scattering * d.air + dvec3(aerosol_scattering_ * d.aerosol);
        const dvec3 e = extinction(d), step = glm::exp(-e * ds);
        const dvec3 weight = transmittance * scattering * (dvec3(1.0) - step) / e;
        second += weight * at_height(sun_, h) / (4.0 * pi);
        share += weight;
        transmittance *= step;
      });
      if (ground) second += transmittance * ground_albedo / pi * sun_[0] * std::max(sun_sine_, 0.0);
    }
    result[i] = second / double(sines) / (dvec3(1.0) - share / double(sines));
  }
  multiple_ = result;
}

void Atmosphere::integrate_views() {
  for (int i = 0; i < elevations; ++i) {
    const double t = double(i) / (elevations - 1), sine = t * t;
    dvec3 transmittance(1.0);
    along(path_length(0.0, sine), 96, [&](double s, double ds) {
      const double h = height_at(0.0, sine, s);
      const Density d = density(h);
      const dvec3 e = extinction(d), step = glm::exp(-e * ds);
      const dvec3 weight = transmittance * (dvec3(1.0) - step) / e;
      const dvec3 air = air_scattering * d.air, aerosol(aerosol_scattering_ * d.aerosol);
      air_[i] += weight * air * at_height(sun_, h);
      aerosol_[i] += weight * aerosol * at_height(sun_, h);
      rest_[i] += weight * (air + aerosol) * at_height(multiple_, h);
      transmittance *= step;
    });
  }
}

dvec3 Atmosphere::radiance(double sin_elevation, double cos_to_sun) const {
  const double x = std::sqrt(std::clamp(sin_elevation, 0.0, 1.0)) * (elevations - 1);
  const int i = std::min(static_cast<int>(x), elevations - 2);
  const auto at = [&](const std::array<dvec3, elevations>& table) {
    return glm::mix(table[i], table[i + 1], x - i);
  };
  const double c2 = cos_to_sun * cos_to_sun, g2 = asymmetry * asymmetry;
  const double rayleigh = 3.0 / (16.0 * pi) * (1.0 + c2);
  // Cornette and Shanks 1992.
  const double mie = 3.0 / (8.0 * pi) * (1.0 - g2) * (1.0 + c2) /
                     ((2.0 + g2) * std::pow(1.0 + g2 - 2.0 * asymmetry * cos_to_sun, 1.5));
  return rayleigh * at(air_) + mie * at(aerosol_) + at(rest_);
}

}  // namespace greatx::render
