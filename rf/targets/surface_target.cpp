// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/targets/surface_target.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/phase.h"
#include "core/units.h"

namespace greatx::rf {
namespace {

/// Describes the wave at one element relative to that at the panel's centre.
struct ElementWave {
  double further_m;  ///< the distance to the element less that to the centre
  double strength;   ///< root of the cosine, times the distance to the centre over that to the element
};

ElementWave wave_at(const SurfaceAim& aim, const dvec3& element) {
  if (std::isinf(aim.distance_m))
    return {-glm::dot(aim.direction, element), std::sqrt(std::max(aim.direction.x, 0.0))};
  const double square = glm::dot(element, element), along = glm::dot(aim.direction, element);
  const double distance = std::sqrt(aim.distance_m * (aim.distance_m - 2.0 * along) + square);
  // (distance^2 - L^2)/(distance + L), which does not cancel.
  const double further = (square - 2.0 * aim.distance_m * along) / (distance + aim.distance_m);
  const double cosine = aim.direction.x * aim.distance_m / distance;
  return {further, std::sqrt(std::max(cosine, 0.0)) * aim.distance_m / distance};
}

/// Returns a vector of the panel's plane, turned by the least rotation from +x to `direction`.
dvec3 turned_with(const dvec3& direction, const dvec3& in_plane) {
  const dvec3 sum = dvec3(1.0, 0.0, 0.0) + direction;
  return in_plane - glm::dot(direction, in_plane) / sum.x * sum;
}

}  // namespace

dvec3 SurfaceLayout::element(size_t index) const {
  const auto row = static_cast<double>(index / columns), column = static_cast<double>(index % columns);
  return {0.0, (column - 0.5 * (columns - 1.0)) * column_spacing_m,
          (row - 0.5 * (rows - 1.0)) * row_spacing_m};
}

std::vector<double> steered_phases(const SurfaceLayout& layout, const SurfaceAim& from,
                                   const SurfaceAim& to) {
  std::vector<double> phases(layout.elements());
  for (size_t n = 0; n < phases.size(); ++n) {
    const dvec3 element = layout.element(n);
    const double further_m = wave_at(from, element).further_m + wave_at(to, element).further_m;
    phases[n] = 2.0 * pi * fraction_of_turn(further_m / layout.wavelength_m);
  }
  return phases;
}

void round_phases(std::vector<double>& phases, uint32_t bits) {
  GREATX_CHECK(bits >= 1 && bits <= 30, "{} bits", bits);
  const double step = 2.0 * pi / static_cast<double>(1u << bits);
  for (double& phase : phases) phase = step * std::nearbyint(phase / step);
}

SurfaceTarget::SurfaceTarget(const SurfaceLayout& layout, const std::vector<double>& phases, double amplitude)
    : layout_(layout) {
  GREATX_CHECK(phases.size() == layout.elements(), "{} phases of {} elements", phases.size(),
               layout.elements());
  GREATX_CHECK(amplitude >= 0.0 && amplitude <= 1.0 && layout.wavelength_m > 0.0,
               "amplitude {}, wavelength {}", amplitude, layout.wavelength_m);
  const double most = 0.5 * layout.wavelength_m * (1.0 + 1e-9);
  GREATX_CHECK(layout.row_spacing_m <= most && layout.column_spacing_m <= most, "spacings {} and {} of {}",
               layout.row_spacing_m, layout.column_spacing_m, layout.wavelength_m);
  reflections_.reserve(phases.size());
  for (const double phase : phases) reflections_.push_back(std::polar(amplitude, phase));
}

ScatterMatrix SurfaceTarget::scatter(const Aspect& aspect, const EchoKey&) const {
  if (!(aspect.to_source.x > 0.0 && aspect.to_receiver.x > 0.0)) return {};
  const SurfaceAim source{aspect.to_source, aspect.source_m}, receiver{aspect.to_receiver, aspect.receiver_m};
  Complex sum = 0.0;
  for (size_t n = 0; n < reflections_.size(); ++n) {
    const dvec3 element = layout_.element(n);
    const ElementWave in = wave_at(source, element), out = wave_at(receiver, element);
    const double turns = -(in.further_m + out.further_m) / layout_.wavelength_m;
    sum += reflections_[n] * (in.strength * out.strength * unit_phasor(fraction_of_turn(turns)));
  }
  sum *= Complex(0.0, layout_.element_area_m2() / layout_.wavelength_m);
  ScatterMatrix s{};
  for (const dvec3& axis : {dvec3(0.0, 0.0, 1.0), dvec3(0.0, 1.0, 0.0)}) {
    const dvec3 in = turned_with(aspect.to_source, axis), out = turned_with(aspect.to_receiver, axis);
    const dvec2 from{glm::dot(in, theta_hat(aspect.to_source)), glm::dot(in, phi_hat(aspect.to_source))},
        to{glm::dot(out, theta_hat(aspect.to_receiver)), glm::dot(out, phi_hat(aspect.to_receiver))};
    s[0] += to.x * from.x * sum;
    s[1] += to.x * from.y * sum;
    s[2] += to.y * from.x * sum;
    s[3] += to.y * from.y * sum;
  }
  return s;
}

}  // namespace greatx::rf
