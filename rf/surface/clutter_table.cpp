// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/surface/clutter_table.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace greatx::rf {
namespace {

ClutterTable::Roots roots_of(double hh, double vv, double hv) {
  return {static_cast<float>(std::sqrt(hh)), static_cast<float>(std::sqrt(vv)),
          static_cast<float>(std::sqrt(hv))};
}

/// Returns 4 pi S^2 |r|^2 cos(theta_i) f for a share `f` of the scattered power, 1/sr.
ClutterTable::Roots effective_roughness(const RadioSurfaces& surfaces, uint32_t material, bool from_front,
                                        double sine, double f) {
  const DiffuseScattering& surface = surfaces.surface(material).scattering;
  const ReflectionCoefficients r = surfaces.reflect(material, from_front, sine);
  const double share = 4.0 * pi * surface.coefficient * surface.coefficient * sine * f;
  const double te = share * std::norm(r.r_te), tm = share * std::norm(r.r_tm), k = surface.cross_polarization;
  return roots_of((1.0 - k) * te, (1.0 - k) * tm, 0.5 * k * (te + tm));
}

}  // namespace

ClutterTable::ClutterTable(const scene::Scene& scene, const RadioSurfaces& surfaces, bool bistatic)
    : surfaces_(surfaces), first_(scene.materials.size(), -1), lobes_(scene.materials.size(), false) {
  std::vector<bool> asked(scene.materials.size(), false);
  for (const scene::Facet& facet : scene.facets) asked[facet.material] = true;
  for (uint32_t material = 0; material < asked.size(); ++material) {
    if (!asked[material]) continue;
    const auto& radio = scene.materials[material].radio;
    const std::optional<scene::SurfaceClutter> clutter = radio ? radio->clutter : std::nullopt;
    const RadioSurface& surface = surfaces.surface(material);
    if (!clutter && (surface.foliage || surface.scattering.coefficient == 0.0)) continue;
    first_[material] = static_cast<int64_t>(roots_.size());
    lobes_[material] = bistatic && !clutter;
    for (const bool from_front : {true, false})
      for (uint32_t i = 0; i <= steps; ++i) {
        const double sine = double(i) / steps;
        if (!clutter) {
          roots_.push_back(of_a_lobe(material, from_front, sine));
          continue;
        }
        const scene::Backscatter back = scene::backscatter(*clutter, sine, surfaces.carrier_hz());
        roots_.push_back(roots_of(back.hh, back.vv, back.hv));
      }
  }
}

ClutterTable::Roots ClutterTable::of_a_lobe(uint32_t material, bool from_front, double sine) const {
  const DiffuseScattering& scattering = surfaces_.surface(material).scattering;
  const dvec3 normal(0.0, 0.0, 1.0), in(std::sqrt(1.0 - sine * sine), 0.0, -sine);
  if (!lobes_[material])
    return effective_roughness(surfaces_, material, from_front, sine,
                               scattering_pattern(scattering, in, -in, normal));
  const dvec3 mirror(in.x, 0.0, sine);
  const double f = scattering_pattern(scattering, in, mirror, normal);
  return effective_roughness(surfaces_, material, from_front, sine,
                             f > 0.0 ? f / scattering_shape(scattering, in, mirror, normal) : 0.0);
}

ClutterTable::Roots ClutterTable::lobe(uint32_t material, bool from_front, const dvec3& in, const dvec3& out,
                                       const dvec3& normal) const {
  const Roots a = at(material, from_front, -glm::dot(in, normal)),
              b = at(material, from_front, glm::dot(out, normal));
  const double shape = scattering_shape(surfaces_.surface(material).scattering, in, out, normal);
  const auto both = [&](float first, float second) {
    return static_cast<float>(std::sqrt(double(first) * second * shape));
  };
  return {both(a.hh, b.hh), both(a.vv, b.vv), both(a.hv, b.hv)};
}

ClutterTable::Roots ClutterTable::at(uint32_t material, bool from_front, double sine) const {
  const double place = std::clamp(sine, 0.0, 1.0) * steps;
  const uint32_t below = std::min(static_cast<uint32_t>(place), steps - 1);
  const float part = static_cast<float>(place - below);
  const Roots* row = roots_.data() + first_[material] + (from_front ? 0 : steps + 1) + below;
  const auto between = [part](float a, float b) { return a + part * (b - a); };
  return {between(row[0].hh, row[1].hh), between(row[0].vv, row[1].vv), between(row[0].hv, row[1].hv)};
}

}  // namespace greatx::rf
