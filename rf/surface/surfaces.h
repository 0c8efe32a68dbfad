// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The scene's materials as a radio wave of one carrier sees them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "rf/surface/fresnel.h"
#include "rf/surface/roughness.h"
#include "rf/surface/scattering.h"
#include "scene/description/scene.h"

namespace greatx::rf {

/// A wall at one frequency, seen from both sides.
struct RadioSurface {
  /// Outermost first, as seen from the side that the facet's normal points to. A last layer of thickness 0 is
  /// a half-space; otherwise there is vacuum behind.
  std::vector<DielectricLayer> front;
  std::vector<DielectricLayer> back;  ///< the same wall from the other side
  bool foliage = false;               ///< no wall at all: the boundary of an attenuating volume
  double roughness_m = 0.0;           ///< rms height, of either face
  DiffuseScattering scattering;       ///< of either face

  /// Does the wave come out on the other side: no half-space among the layers?
  bool penetrable() const { return !front.empty() && front.back().thickness_m > 0.0; }
};

/// Amplitude that a rough surface leaves to the specular reflection, 0 to 1: rho of `roughness` (none: that
/// effect is off) times, with `scattering`, sqrt(1 - S^2). The one rule of paths and echoes. `cosine` of the
/// angle from the normal.
double specular_share(const RadioSurface& surface, double cosine, double wavelength_m,
                      std::optional<RoughnessModel> roughness, bool scattering);

/// Transmitted over incident field of a wall drawn as a sheet without thickness: what the wall does beyond
/// the free-space propagation that the path's length counts already (P.2040-4, 2.2.2). A wall of vacuum: 1.
struct SheetTransmission {
  Complex te{0.0}, tm{0.0};
};

/// The wall that a radio material describes (what the material says is what the wave meets):
/// - first layer of thickness 0: a half-space, the same from either side (ground, thick walls, metal);
/// - otherwise one slab or several layers with vacuum behind; a last layer of thickness 0 stands for a
///   half-space behind
///   the others, and from its own side that half-space is all there is to see.
/// Throws UserError naming the material if its permittivity is not known at `frequency_hz`, if a layer that
/// is not the last has thickness 0 while the first has not, if layers follow a half-space, if a thickness is
/// negative, or if a parameter of its scattering is out of range (rf/surface/scattering.h).
RadioSurface radio_surface(const scene::RadioMaterial& material, double frequency_hz,
                           const std::string& material_name);

/// One surface per material, permittivities worked out once.
class RadioSurfaces {
 public:
  /// Every material that a facet of `scene` has must be known at `carrier_hz`; throws UserError naming it,
  /// the frequency and the material's ranges if not.
  RadioSurfaces(const scene::Scene& scene, double carrier_hz);
  /// `surfaces` by material index.
  RadioSurfaces(std::vector<RadioSurface> surfaces, double carrier_hz);

  double carrier_hz() const { return carrier_hz_; }
  double wavelength_m() const { return wavelength_m_; }
  /// The smooth wall's. `from_front`: the wave comes from the side that the facet's normal points to.
  FresnelCoefficients reflect(uint32_t material, bool from_front, double cos_theta) const;
  /// Through all layers of a wall, which must be penetrable. A thick lossy one underflows to 0.
  SheetTransmission transmit(uint32_t material, bool from_front, double cos_theta) const;
  bool penetrable(uint32_t material) const { return surface(material).penetrable(); }
  /// The wall of a material, by its index in the scene; without layers if no facet has it or if it is
  /// foliage.
  const RadioSurface& surface(uint32_t material) const;

 private:
  const std::vector<DielectricLayer>& layers(uint32_t material, bool from_front) const;

  std::vector<RadioSurface> surfaces_;  ///< [materials]
  double carrier_hz_, wavelength_m_;
};

}  // namespace greatx::rf
