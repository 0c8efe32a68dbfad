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

ClutterTable::Roots effective_roughness(const RadioSurfaces& surfaces, uint32_t material, bool from_front,
                                        const dvec3& in, const dvec3& out, const dvec3& normal) {
  const DiffuseScattering& surface = surfaces.surface(material).scattering;
  const double cosine = std::clamp(-glm::dot(in, normal), 0.0, 1.0);
  const ReflectionCoefficients r = surfaces.reflect(material, from_front, cosine);
  const double share = 4.0 * pi * surface.coefficient * surface.coefficient * cosine *
                       scattering_pattern(surface, in, out, normal);
  const double te = share * std::norm(r.r_te), tm = share * std::norm(r.r_tm), k = surface.cross_polarization;
  return roots_of((1.0 - k) * te, (1.0 - k) * tm, 0.5 * k * (te + tm));
}

}  // namespace

ClutterTable::ClutterTable(const scene::Scene& scene, const RadioSurfaces& surfaces)
    : first_(scene.materials.size(), -1),
      by_coefficient_(scene.materials.size(), false),
      surfaces_(surfaces) {
  std::vector<bool> asked(scene.materials.size(), false);
  for (const scene::Facet& facet : scene.facets) asked[facet.material] = true;
  for (uint32_t material = 0; material < asked.size(); ++material) {
    if (!asked[material]) continue;
    const auto& radio = scene.materials[material].radio;
    const std::optional<scene::SurfaceClutter> clutter = radio ? radio->clutter : std::nullopt;
    const RadioSurface& surface = surfaces.surface(material);
    if (!clutter && (surface.foliage || surface.scattering.coefficient == 0.0)) continue;
    first_[material] = static_cast<int64_t>(roots_.size());
    by_coefficient_[material] = !clutter;
    for (const bool from_front : {true, false})
      for (uint32_t i = 0; i <= steps; ++i) {
        const double sine = double(i) / steps;
        if (!clutter) {
          const dvec3 in(std::sqrt(1.0 - sine * sine), 0.0, -sine);
          roots_.push_back(
              effective_roughness(surfaces, material, from_front, in, -in, dvec3(0.0, 0.0, 1.0)));
          continue;
        }
        const scene::Backscatter back = scene::backscatter(*clutter, sine, surfaces.carrier_hz());
        roots_.push_back(roots_of(back.hh, back.vv, back.hv));
      }
  }
}

ClutterTable::Roots ClutterTable::bistatic(uint32_t material, bool from_front, const dvec3& in,
                                           const dvec3& out, const dvec3& normal) const {
  return effective_roughness(surfaces_, material, from_front, in, out, normal);
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
