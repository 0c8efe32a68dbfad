// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/surface/band_change.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "core/units.h"
#include "rf/surface/surfaces.h"

namespace greatx::rf {
namespace {

constexpr double margin = 1.05, phase_step = pi / 16.0;
constexpr double least_cosine = 1e-6;  // metal at 0.1 GHz has its pseudo-Brewster angle at a cosine of 2e-5
constexpr uint32_t cosines_per_decade = 16;

/// Names a coefficient: reflection or transmission, on one side of the wall. Both polarizations belong to it.
enum Coefficient : size_t { reflected_front, reflected_back, through_front, through_back, coefficients };

/// Holds both polarizations of every coefficient at one angle and frequency.
using Values = std::array<std::array<Complex, 2>, coefficients>;

/// Holds the place of a value.
struct Place {
  double cosine = 0.0, frequency_hz = 0.0, change = -1.0;
};

class Wall {
 public:
  Wall(const scene::RadioMaterial& material, std::optional<RoughnessModel> roughness, bool scattering,
       const std::string& name)
      : material_(material), roughness_(roughness), scattering_(scattering), name_(name) {
    for (const scene::RadioLayer& layer : material.layers) thickness_m_ += layer.thickness_m;
  }

  double thickness_m() const { return thickness_m_; }
  RadioSurfaces at(double frequency_hz) const {
    return {{radio_surface(material_, frequency_hz, name_)}, frequency_hz};
  }

  Values values(const RadioSurfaces& surfaces, double cosine) const {
    const RadioSurface& surface = surfaces.surface(0);
    const double wavelength_m = surfaces.wavelength_m();
    const double kept = specular_share(surface, cosine, wavelength_m, roughness_, scattering_);
    const bool passes = surface.penetrable();
    const Complex sheet = passes ? sheet_phase(thickness_m_, wavelength_m, cosine) : Complex(0.0);
    Values values{};
    for (const bool back : {false, true}) {
      // One homogeneous layer looks the same from both sides.
      if (back && surface.front.size() == 1) break;
      const FresnelCoefficients found = surfaces.reflect(0, !back, cosine);
      values[back ? reflected_back : reflected_front] = {kept * found.r_te, kept * found.r_tm};
      values[back ? through_back : through_front] = {sheet * found.t_te, sheet * found.t_tm};
    }
    return values;
  }

 private:
  const scene::RadioMaterial& material_;
  std::optional<RoughnessModel> roughness_;
  bool scattering_;
  const std::string& name_;
  double thickness_m_ = 0.0;
};

double change_of(const Values& a, const Values& b, size_t which) {
  return std::max(std::abs(a[which][0] - b[which][0]), std::abs(a[which][1] - b[which][1]));
}

/// Returns the largest refractive index of the layers that have a thickness; 1 if there is none.
double largest_index(const RadioSurface& surface) {
  double largest = 1.0;
  for (const DielectricLayer& layer : surface.front)
    if (layer.thickness_m > 0.0) largest = std::max(largest, std::sqrt(std::abs(layer.eta)));
  return largest;
}

/// Returns the sampled cosines of the angle of incidence. `phase` is that of a wave that goes through all
/// layers and back along their normal. The normal component of its wave vector is sqrt(eta - 1 + C^2), about
/// linear in C^2, and takes at most all of the phase as C goes from 0 to 1.
std::vector<double> cosines(double phase) {
  std::vector<double> list;
  const uint32_t decades = 6, logarithmic = decades * cosines_per_decade;
  for (uint32_t i = 0; i <= logarithmic; ++i)
    list.push_back(least_cosine * std::pow(10.0, static_cast<double>(i) / cosines_per_decade));
  list.back() = 1.0;
  const uint32_t even = steps_over(phase, phase_step, 32, 512);
  for (uint32_t i = 1; i < even; ++i) list.push_back(std::sqrt(static_cast<double>(i) / even));
  return list;
}

/// Moves the place uphill by steps of the angle's cosine and of the frequency, which shrink where no step
/// leads up.
void climb(const Wall& wall, const Band& band, const RadioSurfaces& carrier, double frequency_step_hz,
           size_t which, Place& best) {
  double factor = 1.2, step_hz = frequency_step_hz;
  for (int shrunk = 0, tries = 0; shrunk < 20 && tries < 400; ++tries) {
    bool up = false;
    for (const auto& [times, add_hz] : {std::pair(factor, 0.0), std::pair(1.0 / factor, 0.0),
                                        std::pair(1.0, step_hz), std::pair(1.0, -step_hz)}) {
      const double cosine = std::clamp(best.cosine * times, least_cosine, 1.0);
      const double hz = std::clamp(best.frequency_hz + add_hz, band.lowest_hz, band.highest_hz);
      const double change = change_of(wall.values(wall.at(hz), cosine), wall.values(carrier, cosine), which);
      if (change > best.change) best = {cosine, hz, change}, up = true;
    }
    if (up) continue;
    ++shrunk;
    factor = std::sqrt(factor);
    step_hz *= 0.5;
  }
}

}  // namespace

BandChange most_band_change(const scene::RadioMaterial& material, const Band& band,
                            std::optional<RoughnessModel> roughness, bool scattering,
                            const std::string& material_name) {
  GREATX_CHECK(
      band.lowest_hz > 0.0 && band.lowest_hz <= band.carrier_hz && band.carrier_hz <= band.highest_hz,
      "band of {} to {} Hz around {} Hz", band.lowest_hz, band.highest_hz, band.carrier_hz);
  const Wall wall(material, roughness, scattering, material_name);
  const RadioSurfaces carrier = wall.at(band.carrier_hz);
  // Phase per Hz of a wave that goes through all layers and back.
  const double slope = 4.0 * pi * wall.thickness_m() * largest_index(carrier.surface(0)) / speed_of_light;
  const uint32_t steps = steps_over(slope * band.width_hz(), phase_step, 8, 256);
  std::vector<RadioSurfaces> samples;
  for (uint32_t i = 0; i <= steps; ++i) samples.push_back(wall.at(band.sample_hz(i, steps)));

  std::array<Place, coefficients> best;
  for (const double cosine : cosines(slope * band.carrier_hz)) {
    const Values reference = wall.values(carrier, cosine);
    for (const RadioSurfaces& sample : samples) {
      const Values values = wall.values(sample, cosine);
      for (size_t which = 0; which < coefficients; ++which) {
        const double change = change_of(values, reference, which);
        if (change > best[which].change) best[which] = {cosine, sample.carrier_hz(), change};
      }
    }
  }
  for (size_t which = 0; which < coefficients; ++which)
    if (best[which].change > 0.0) climb(wall, band, carrier, band.width_hz() / steps, which, best[which]);
  const auto bound = [&](Coefficient front, Coefficient back) {
    return std::min(2.0, margin * std::max(best[front].change, best[back].change));
  };
  return {bound(reflected_front, reflected_back), bound(through_front, through_back)};
}

}  // namespace greatx::rf
