// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/daylight/atmosphere.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "renderer/daylight/spectrum.h"

namespace greatx::render {

namespace {

constexpr double earth_radius = 6360e3, thickness = 100e3;
constexpr double air_scale = 8e3, aerosol_scale = 1.2e3, asymmetry = 0.8, aerosol_albedo = 0.9;
constexpr double air_at_550 = 1.3558e-5;  // Rayleigh's scattering at sea level, 1/m
constexpr double disc_sine = 0.00465;     // half of the disc, for the edge of the Earth's shadow
constexpr double lowest = -11.0;          // degrees

/// Holds shares of the densities at sea level (for ozone, of the density at its peak).
struct Densities {
  double air = 0.0, aerosol = 0.0, ozone = 0.0;
  static Densities at(double height) {
    return {std::exp(-height / air_scale), std::exp(-height / aerosol_scale),
            std::max(0.0, 1.0 - std::abs(height - 25e3) / 15e3)};
  }
  void add(const Densities& d, double length) {
    air += d.air * length;
    aerosol += d.aerosol * length;
    ozone += d.ozone * length;
  }
};

double height_at(double height, double sine, double distance) {
  const double r = earth_radius + height;
  return std::sqrt(r * r + distance * distance + 2.0 * r * distance * sine) - earth_radius;
}

/// Returns the length to the top of the air, or to the ground if the direction meets it.
double path_length(double height, double sine, bool* ground = nullptr) {
  const double r = earth_radius + height, b = r * sine;
  const double to_ground = b * b - r * r + earth_radius * earth_radius;
  const bool hits = sine < 0.0 && to_ground >= 0.0;
  if (ground != nullptr) *ground = hits;
  if (hits) return -b - std::sqrt(to_ground);
  const double top = earth_radius + thickness;
  return -b + std::sqrt(b * b - r * r + top * top);
}

/// Visits `steps` points of a path, which are denser at its start: visit(distance, step length).
template <typename F>
void along(double length, int steps, F&& visit) {
  double from = 0.0;
  for (int i = 1; i <= steps; ++i) {
    const double t = double(i) / steps, to = length * t * t;
    visit(0.5 * (from + to), to - from);
    from = to;
  }
}

/// Returns the sine of the elevation at which the horizon lies, seen from a height.
double horizon_sine(double height) {
  const double ratio = earth_radius / (earth_radius + height);
  return -std::sqrt(std::max(0.0, 1.0 - ratio * ratio));
}

struct Blend {
  int i;
  double share;
  Blend(double x, int count)
      : i(std::clamp(static_cast<int>(x), 0, count - 2)), share(std::clamp(x - i, 0.0, 1.0)) {}
};

/// Represents the air, and the light that it scatters.
class Air {
 public:
  Air(double turbidity, double elevation) : elevation_(elevation) {
    air_ = Spectrum::of_wavelength([](double nm) { return air_at_550 * std::pow(550.0 / nm, 4.0); });
    // The exponent 1.3 is Angstrom's: A. Angstrom, Geografiska Annaler 11 (1929).
    aerosol_ = Spectrum::of_wavelength([&](double nm) {
      return (turbidity - 1.0) * air_at_550 * air_scale / aerosol_scale * std::pow(550.0 / nm, 1.3);
    });
    // The ozone is 300 Dobson units, with the cross sections of K. Bogumil et al., J. Photochem. Photobiol. A
    // 157 (2003), at 400, 440, ... 680 nm. The figures are 1/m at the peak of its density, at 25 km.
    ozone_.v = {8.2e-9, 8.5e-8, 4.16e-7, 1.149e-6, 2.291e-6, 2.695e-6, 1.430e-6, 6.49e-7};
    for (int i = 0; i < heights; ++i)
      for (int k = 0; k < sines; ++k) {
        const double height = node_height(i, heights), low = horizon_sine(height),
                     t = double(k) / (sines - 1);
        const double sine = low + (1.0 - low) * t * t;
        Densities& column = columns_[i * sines + k];
        // A ray that grazes the ground passes it: its start at height 0 is lifted by a hair.
        along(path_length(std::max(height, 1.0), sine), 40, [&](double s, double ds) {
          column.add(Densities::at(std::max(0.0, height_at(std::max(height, 1.0), sine, s))), ds);
        });
      }
  }

  Spectrum scattering_air(const Densities& d) const { return air_ * d.air; }
  Spectrum scattering_aerosol(const Densities& d) const { return aerosol_ * (aerosol_albedo * d.aerosol); }
  Spectrum extinction(const Densities& d) const {
    return air_ * d.air + aerosol_ * d.aerosol + ozone_ * d.ozone;
  }

  /// Returns the part that reaches a height of a light whose elevation there has the given sine. In the
  /// Earth's shadow it is nothing.
  Spectrum light(double height, double sine) const {
    const double low = horizon_sine(height), visible = (sine - low) / (2.0 * disc_sine) + 0.5;
    if (visible <= 0.0) return {};
    const Blend h(std::sqrt(std::clamp(height / thickness, 0.0, 1.0)) * (heights - 1), heights);
    const Blend s(std::sqrt(std::clamp((sine - low) / (1.0 - low), 0.0, 1.0)) * (sines - 1), sines);
    Densities column;
    column.add(columns_[h.i * sines + s.i], (1.0 - h.share) * (1.0 - s.share));
    column.add(columns_[h.i * sines + s.i + 1], (1.0 - h.share) * s.share);
    column.add(columns_[(h.i + 1) * sines + s.i], h.share * (1.0 - s.share));
    column.add(columns_[(h.i + 1) * sines + s.i + 1], h.share * s.share);
    return exp_of(extinction(column) * -1.0) * std::min(visible, 1.0);
  }

  /// Visits the air along a view from `height` above the axes' origin: visit(height, sine of the light's
  /// elevation there, densities, weight). The weight is the radiance that a unit of source per metre adds.
  /// Returns the share of light that passes the whole way.
  template <typename F>
  Spectrum look(double height, const dvec3& direction, const dvec3& to_light, double length, int steps,
                F&& visit) const {
    Spectrum transmittance = Spectrum::all(1.0);
    along(length, steps, [&](double s, double ds) {
      const dvec3 p = direction * s + dvec3(0.0, 0.0, earth_radius + height);
      const double r = glm::length(p), h = std::max(0.0, r - earth_radius);
      const Densities d = Densities::at(h);
      const Spectrum e = extinction(d);
      Spectrum passed = exp_of(e * -ds), weight = transmittance;
      for (int i = 0; i < bands; ++i) weight.v[i] *= e.v[i] * ds > 1e-6 ? (1.0 - passed.v[i]) / e.v[i] : ds;
      visit(h, glm::dot(p, to_light) / r, d, weight);
      transmittance *= passed;
    });
    return transmittance;
  }

  /// Sums Hillaire's second order and its series, averaged over the sphere, by height and by the light's
  /// elevation.
  void scatter_many_times(double ground_albedo) {
    for (int i = 0; i < many_heights; ++i)
      for (int k = 0; k < many_sines; ++k) {
        const double elevation = many_elevation(k);
        many_[i * many_sines + k] =
            scattered_at(std::max(1.0, node_height(i, many_heights)),
                         {std::cos(elevation), 0.0, std::sin(elevation)}, ground_albedo);
      }
  }

  /// Returns the mean radiance of the light scattered twice and more.
  Spectrum many(double height, double sine) const {
    const Blend h(std::sqrt(std::clamp(height / thickness, 0.0, 1.0)) * (many_heights - 1), many_heights);
    const double elevation = std::asin(std::clamp(sine, -1.0, 1.0));
    const Blend s((elevation - elevation_ + many_range) / (2.0 * many_range) * (many_sines - 1), many_sines);
    const auto at = [&](int i, int k) { return many_[(h.i + i) * many_sines + s.i + k]; };
    return (at(0, 0) * (1.0 - s.share) + at(0, 1) * s.share) * (1.0 - h.share) +
           (at(1, 0) * (1.0 - s.share) + at(1, 1) * s.share) * h.share;
  }

 private:
  static constexpr int heights = 32, sines = 48, many_heights = 9, many_sines = 7;
  /// The light's elevation changes by at most this within a view.
  static constexpr double many_range = radians(10.0);
  static double node_height(int i, int count) { return thickness * i * i / ((count - 1.0) * (count - 1.0)); }
  double many_elevation(int k) const {
    return std::clamp(elevation_ + many_range * (2.0 * k / (many_sines - 1) - 1.0), -0.5 * pi, 0.5 * pi);
  }

  Spectrum scattered_at(double height, const dvec3& to_light, double ground_albedo) const {
    constexpr int rings = 8, sectors = 4;  // half of the sphere: the other half is its mirror image
    Spectrum second, share;
    for (int i = 0; i < rings; ++i)
      for (int k = 0; k < sectors; ++k) {
        const double z = -1.0 + (2.0 * i + 1.0) / rings, phi = pi * (k + 0.5) / sectors;
        const double level = std::sqrt(1.0 - z * z);
        const dvec3 direction(level * std::cos(phi), level * std::sin(phi), z);
        bool ground = false;
        const double length = path_length(height, z, &ground);
        const Spectrum passed = look(height, direction, to_light, length, 12,
                                     [&](double h, double sine, const Densities& d, const Spectrum& weight) {
                                       const Spectrum scattered =
                                           weight * (scattering_air(d) + scattering_aerosol(d));
                                       second += scattered * light(h, sine) * (1.0 / (4.0 * pi));
                                       share += scattered;
                                     });
        if (!ground) continue;
        const dvec3 foot = direction * length + dvec3(0.0, 0.0, earth_radius + height);
        const double sine = glm::dot(foot, to_light) / glm::length(foot);
        if (sine > 0.0) second += passed * light(0.0, sine) * (ground_albedo / pi * sine);
      }
    for (int i = 0; i < bands; ++i)
      second.v[i] = second.v[i] / (rings * sectors) / (1.0 - share.v[i] / (rings * sectors));
    return second;
  }

  double elevation_;
  Spectrum air_, aerosol_, ozone_;
  std::vector<Densities> columns_ = std::vector<Densities>(heights * sines);
  std::vector<Spectrum> many_ = std::vector<Spectrum>(many_heights * many_sines);
};

dvec3 displayable(const Spectrum& spectrum) { return glm::max(color_of(spectrum), dvec3(0.0)); }

}  // namespace

Atmosphere::Atmosphere(double turbidity, double elevation, double ground_albedo)
    : cells_(elevations * azimuths) {
  const double used = std::max(elevation, radians(lowest));
  light_ = {std::cos(used), 0.0, std::sin(used)};
  Air air(turbidity, used);
  air.scatter_many_times(ground_albedo);
  direct_illuminance_ = displayable(air.light(0.0, std::max(light_.z, disc_sine)));
  for (int i = 0; i < elevations; ++i)
    for (int k = 0; k < azimuths; ++k) {
      const double t = double(i) / (elevations - 1), sine = t * t, level = std::sqrt(1.0 - sine * sine);
      const double phi = pi * k / (azimuths - 1);
      Spectrum by_air, by_aerosol, rest;
      air.look(0.0, {level * std::cos(phi), level * std::sin(phi), sine}, light_, path_length(0.0, sine), 36,
               [&](double h, double light_sine, const Densities& d, const Spectrum& weight) {
                 const Spectrum a = weight * air.scattering_air(d), b = weight * air.scattering_aerosol(d);
                 const Spectrum light = air.light(h, light_sine);
                 by_air += a * light;
                 by_aerosol += b * light;
                 rest += (a + b) * air.many(h, light_sine);
               });
      cells_[i * azimuths + k] = {displayable(by_air), displayable(by_aerosol), displayable(rest)};
    }
  constexpr int rings = 256, sectors = 48;
  for (int i = 0; i < rings; ++i)
    for (int k = 0; k < sectors; ++k) {
      const double z = (i + 0.5) / rings, level = std::sqrt(1.0 - z * z), phi = pi * (k + 0.5) / sectors;
      sky_illuminance_ +=
          radiance({level * std::cos(phi), level * std::sin(phi), z}) * (z * 2.0 * pi / (rings * sectors));
    }
}

dvec3 Atmosphere::radiance(const dvec3& direction) const {
  const Blend e(std::sqrt(std::clamp(direction.z, 0.0, 1.0)) * (elevations - 1), elevations);
  const Blend a(std::abs(std::atan2(direction.y, direction.x)) / pi * (azimuths - 1), azimuths);
  const Cell* row = &cells_[e.i * azimuths + a.i];
  const auto at = [&](dvec3 Cell::*part) {
    return glm::mix(glm::mix(row[0].*part, row[1].*part, a.share),
                    glm::mix(row[azimuths].*part, row[azimuths + 1].*part, a.share), e.share);
  };
  const double cosine = glm::clamp(glm::dot(direction, light_), -1.0, 1.0), c2 = cosine * cosine,
               g2 = asymmetry * asymmetry;
  const double rayleigh = 3.0 / (16.0 * pi) * (1.0 + c2);
  // This is the phase function of Cornette and Shanks 1992.
  const double base = 1.0 + g2 - 2.0 * asymmetry * cosine;
  const double mie = 3.0 / (8.0 * pi) * (1.0 - g2) * (1.0 + c2) / ((2.0 + g2) * base * std::sqrt(base));
  return rayleigh * at(&Cell::air) + mie * at(&Cell::aerosol) + at(&Cell::rest);
}

}  // namespace greatx::render
