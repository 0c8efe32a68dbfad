// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Describes how the materials of the scene appear to a radio wave of one carrier.
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

/// Describes a wall at one frequency, seen from both sides.
struct RadioSurface {
  /// The layers as seen from the side that the normal of the facet points to, the outermost first. A last
  /// layer of thickness 0 is a half-space. Otherwise there is vacuum behind the layers.
  std::vector<DielectricLayer> front;
  std::vector<DielectricLayer> back;  ///< the layers as seen from the other side
  bool foliage = false;               ///< true: no wall, but the boundary of an attenuating volume
  double roughness_m = 0.0;           ///< rms height of either face, m
  DiffuseScattering scattering;       ///< of either face

  /// Returns whether a wave can come out on the other side, that is, whether no layer is a half-space.
  bool penetrable() const { return !front.empty() && front.back().thickness_m > 0.0; }
};

/// Returns the factor, 0 to 1, by which a rough surface reduces the amplitude of the specular reflection: rho
/// of the model `roughness` (nullopt: the effect is off) times, if `scattering` is true, sqrt(1 - S^2). Paths
/// and echoes share this rule. `cosine` is that of the angle from the normal.
double specular_share(const RadioSurface& surface, double cosine, double wavelength_m,
                      std::optional<RoughnessModel> roughness, bool scattering);

/// Holds the ratios of transmitted to incident field of a wall that is drawn as a sheet without thickness.
/// They are relative to the free-space propagation that the length of the path already includes (P.2040-4,
/// 2.2.2). A wall of vacuum has 1.
struct SheetTransmission {
  Complex te{0.0}, tm{0.0};
};

/// Returns the wall that a radio material describes. The wave meets the layers that the material names:
/// - If the first layer has thickness 0, the wall is a half-space, the same from either side (ground, thick
///   walls, metal).
/// - Otherwise the wall is a slab or several layers with vacuum behind. A last layer of thickness 0 is the
///   half-space behind the others. Seen from the side of this half-space, the wall is the half-space alone.
/// Throws UserError naming the material if it has no layer, if its permittivity is not known at
/// `frequency_hz`, if a layer other than the last has thickness 0, if a thickness is negative, or if a
/// parameter of its scattering is out of range (rf/surface/scattering.h).
RadioSurface radio_surface(const scene::RadioMaterial& material, double frequency_hz,
                           const std::string& material_name);

/// Holds one surface per material. The permittivities are computed once.
class RadioSurfaces {
 public:
  /// Throws UserError naming the material if a material of a facet of `scene` has no radio properties or is
  /// not known at `carrier_hz`. In the second case the message also names the frequency and the ranges of the
  /// material.
  RadioSurfaces(const scene::Scene& scene, double carrier_hz);
  /// Takes `surfaces` in the order of material indices.
  RadioSurfaces(std::vector<RadioSurface> surfaces, double carrier_hz);

  double carrier_hz() const { return carrier_hz_; }
  double wavelength_m() const { return wavelength_m_; }
  /// Returns the reflection of the smooth wall. `from_front` is true if the wave comes from the side that the
  /// normal of the facet points to.
  ReflectionCoefficients reflect(uint32_t material, bool from_front, double cos_theta) const;
  /// Returns the transmission through all layers of a wall, which must be penetrable. The result of a thick
  /// lossy wall underflows to 0.
  SheetTransmission transmit(uint32_t material, bool from_front, double cos_theta) const;
  bool penetrable(uint32_t material) const { return surface(material).penetrable(); }
  /// Returns the wall of a material by its index in the scene. The wall has no layers if no facet has this
  /// material or if the material is foliage.
  const RadioSurface& surface(uint32_t material) const;

 private:
  const std::vector<DielectricLayer>& layers(uint32_t material, bool from_front) const;

  std::vector<RadioSurface> surfaces_;  ///< [materials]
  double carrier_hz_, wavelength_m_;
};

}  // namespace greatx::rf
