// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tabulates the backscatter of the materials of a scene at one carrier. A material with a clutter model
// (scene/material/clutter.h) has that model's; any other has that of its scattering coefficient,
//   sigma0 = 4 pi S^2 |r|^2 cos(theta_i) f_s(back),
// from the effective-roughness model (rf/surface/scattering.h): the power that is scattered into a unit of
// solid angle back to the source, times 4 pi.
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "rf/surface/surfaces.h"
#include "scene/description/scene.h"

namespace greatx::rf {

class ClutterTable {
 public:
  /// Square roots of sigma0.
  struct Roots {
    float hh = 0.0f, vv = 0.0f, hv = 0.0f;
  };

  /// `surfaces` are those of the scene at the carrier, and outlive this.
  ClutterTable(const scene::Scene& scene, const RadioSurfaces& surfaces);
  /// Returns whether a material scatters anything.
  bool rough(uint32_t material) const { return first_[material] >= 0; }
  /// Interpolates between 513 sines of the grazing angle; 0.2 % of the amplitude at 1 degree, less above.
  /// `from_front` as in RadioSurfaces::reflect().
  Roots at(uint32_t material, bool from_front, double sine) const;
  /// Returns whether a material has no model of its clutter, but a scattering coefficient.
  bool by_coefficient(uint32_t material) const { return by_coefficient_[material]; }
  /// Returns the roots of such a material for a wave along `in` that is scattered along `out`, both unit
  /// vectors; `normal` is on the side of the wave. There is no table for these.
  Roots bistatic(uint32_t material, bool from_front, const dvec3& in, const dvec3& out,
                 const dvec3& normal) const;

 private:
  static constexpr uint32_t steps = 512;
  std::vector<int64_t> first_;  ///< [materials] into roots_: front, then back; -1: smooth
  std::vector<Roots> roots_;
  std::vector<bool> by_coefficient_;  ///< [materials]
  const RadioSurfaces& surfaces_;
};

}  // namespace greatx::rf
