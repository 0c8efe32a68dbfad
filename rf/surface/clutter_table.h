// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tabulates the backscatter of the materials of a scene at one carrier. A material with a clutter model
// (scene/material/clutter.h) has that model's; any other has that of its scattering coefficient,
//   sigma0 = 4 pi S^2 |r|^2 cos(theta_i) f_s(out),
// from the effective-roughness model (rf/surface/scattering.h): the power that is scattered into a unit of
// solid angle, times 4 pi. For two ends it is not reciprocal where the lobe does not point to the receiver,
// while surfaces are: sigma0 is the geometric mean of both ways here. That is the model itself for
// backscatter and for Lambert's law on metal. It keeps the scattered power within 0.3 dB for directive lobes
// with exponents of 14 and more up to 75 degrees of incidence, and adds 0.7 dB (exponent 80) to 1.7 dB (14)
// at 85 degrees.
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

  /// `surfaces` are those of the scene at the carrier, and outlive this. `bistatic`: for two ends, so that
  /// materials without a clutter model have lobes.
  ClutterTable(const scene::Scene& scene, const RadioSurfaces& surfaces, bool bistatic);
  /// Returns whether a material scatters anything.
  bool rough(uint32_t material) const { return first_[material] >= 0; }
  /// Interpolates between 513 sines of the grazing angle; 0.2 % of the amplitude at 1 degree, less above.
  /// `from_front` as in RadioSurfaces::reflect(). Of a material that has a lobe it is that of the mirror
  /// direction, where the lobe is largest.
  Roots at(uint32_t material, bool from_front, double sine) const;
  /// Returns whether the material scatters by its scattering coefficient between two ends.
  bool has_lobe(uint32_t material) const { return lobes_[material]; }
  /// Returns the roots of such a material for a wave along `in` that is scattered along `out`, both unit
  /// vectors; `normal` is on the side of the wave.
  Roots lobe(uint32_t material, bool from_front, const dvec3& in, const dvec3& out,
             const dvec3& normal) const;

 private:
  /// Returns the root without a clutter model: back to the source, or, of has_lobe(), that of one of both
  /// ways, without its shape.
  Roots of_a_lobe(uint32_t material, bool from_front, double sine) const;

  static constexpr uint32_t steps = 512;
  const RadioSurfaces& surfaces_;
  std::vector<int64_t> first_;  ///< [materials] into roots_: front, then back; -1: smooth
  std::vector<Roots> roots_;
  std::vector<bool> lobes_;  ///< [materials] has_lobe()
};

}  // namespace greatx::rf
