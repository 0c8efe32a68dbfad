// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The scene's materials as a radio wave of one carrier sees them.
#pragma once

#include <cstdint>
#include <vector>

#include "rf/fresnel.h"
#include "scene/scene.h"

namespace greatx::rf {

/// A wall at one frequency, seen from both sides.
struct RadioSurface {
  /// Outermost first, as seen from the side that the facet's normal points to. A last layer of thickness 0 is
  /// a half-space; otherwise there is vacuum behind.
  std::vector<DielectricLayer> front;
  std::vector<DielectricLayer> back;  ///< the same wall from the other side
  bool foliage = false;               ///< no wall at all: the boundary of an attenuating volume
};

/// The wall that a radio material describes (what the material says is what the wave meets):
/// - first layer of thickness 0: a half-space, the same from either side (ground, thick walls, metal);
/// - otherwise one slab or several layers with vacuum behind; a last layer of thickness 0 stands for a
/// half-space behind
///   the others, and from its own side that half-space is all there is to see.
/// Throws UserError naming the material if its permittivity is not known at `frequency_hz`, if a layer that
/// is not the last has thickness 0 while the first has not, if layers follow a half-space, or if a thickness
/// is negative.
RadioSurface radio_surface(const scene::RadioMaterial& material, double frequency_hz,
                           const std::string& material_name);

/// One surface per material, permittivities worked out once.
class RadioSurfaces {
 public:
  /// Every material that a facet of `scene` has must be known at `carrier_hz`; throws UserError naming it if
  /// not. Foliage has no surface and is not asked.
  RadioSurfaces(const scene::Scene& scene, double carrier_hz);
  /// `surfaces` by material index.
  RadioSurfaces(std::vector<RadioSurface> surfaces, double carrier_hz);

  double carrier_hz() const { return carrier_hz_; }
  double wavelength_m() const { return wavelength_m_; }
  /// `from_front`: the wave comes from the side that the facet's normal points to.
  FresnelCoefficients reflect(uint32_t material, bool from_front, double cos_theta) const;
  /// The wall of a material, by its index in the scene; without layers if it is foliage or no facet has it.
  const RadioSurface& surface(uint32_t material) const;

 private:
  std::vector<RadioSurface> surfaces_;  ///< [materials]; no layers: no facet has it
  double carrier_hz_, wavelength_m_;
};

}  // namespace greatx::rf
