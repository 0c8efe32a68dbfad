// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Describes how the materials of the scene appear to a radio wave of one carrier.
//
// A wall is a stack of layers. A wall with windows is drawn as one face and has two stacks: that of the wall
// and that of the windows, which have the share p of its area. In the specular direction it has the mean of
// the fields of both, by area:
//   R = (1 - p) R_wall + p R_windows,   T = (1 - p) T_wall + p T_windows.
// This is the zeroth order of the Kirchhoff (physical-optics) approximation. The field right at the wall is
// that of an infinite wall or pane, and its mean is what goes on in the specular direction. The outer faces
// of wall and windows lie in one plane, and each part keeps its own thickness. What the windows' grid sends
// elsewhere, its side lobes, is left out. Its power is p(1 - p)(|R_wall - R_windows|^2 + |T_wall -
// T_windows|^2) of the incident power, so that |R|^2 + |T|^2 never exceeds 1. docs/materials.md says where
// the mean holds and gives its error, which tests/rf/windows_test.cpp measures.
//
// Data flow: scene::RadioMaterial -> radio_surface() -> RadioSurface -> RadioSurfaces::reflect(), transmit().
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

/// Describes the windows of a wall at one frequency. Every layer has a thickness.
template <typename R>
struct WindowSurfaceOf {
  double share = 0.0;                       ///< of the area of the wall, 0 to 1; 0: the wall has no windows
  std::vector<DielectricLayerOf<R>> front;  ///< as seen from the side of the normal; empty if `share` is 0
  std::vector<DielectricLayerOf<R>> back;   ///< as seen from the other side
};
using WindowSurface = WindowSurfaceOf<double>;

/// Describes a wall at one frequency, seen from both sides.
template <typename R>
struct RadioSurfaceOf {
  /// The layers as seen from the side that the normal of the facet points to, the outermost first. A last
  /// layer of thickness 0 is a half-space. Otherwise there is vacuum behind the layers.
  std::vector<DielectricLayerOf<R>> front;
  std::vector<DielectricLayerOf<R>> back;  ///< the layers as seen from the other side
  bool foliage = false;                    ///< true: no wall, but the boundary of an attenuating volume
  R roughness_m = 0.0;                     ///< rms height of either face, m
  DiffuseScatteringOf<R> scattering;       ///< of either face, at this frequency
  WindowSurfaceOf<R> windows;

  /// Returns whether no layer of the wall beside its windows is a half-space.
  bool wall_ends() const { return !front.empty() && front.back().thickness_m > 0.0; }
  /// Returns whether a wave can come out on the other side: through the wall, or through its windows. Windows
  /// in a half-space are openings in a thick wall and let waves through to its other side.
  bool penetrable() const { return wall_ends() || windows.share > 0.0; }
};
using RadioSurface = RadioSurfaceOf<double>;

/// Returns the factor, 0 to 1, by which a rough surface reduces the amplitude of the specular reflection: rho
/// of the model `roughness` (nullopt: the effect is off) times, if `scattering` is true, sqrt(1 - S^2). Paths
/// and echoes share this rule. `cosine` is that of the angle from the normal.
template <typename R = double>
R specular_share(const RadioSurfaceOf<Given<R>>& surface, const Given<R>& cosine,
                 const Given<R>& wavelength_m, std::optional<RoughnessModel> roughness, bool scattering);

/// Holds the ratios of transmitted to incident field of a wall that is drawn as a sheet without thickness.
/// They are relative to the free-space propagation that the length of the path already includes (P.2040-4,
/// 2.2.2). A wall of vacuum has 1.
template <typename R>
struct SheetTransmissionOf {
  ComplexOf<R> te{0.0}, tm{0.0};
};
using SheetTransmission = SheetTransmissionOf<double>;

/// Returns the wall that a radio material describes. The wave meets the layers that the material names:
/// - If the first layer has thickness 0, the wall is a half-space, the same from either side (ground, thick
///   walls, metal).
/// - Otherwise the wall is a slab or several layers with vacuum behind. A last layer of thickness 0 is the
///   half-space behind the others. Seen from the side of this half-space, the wall is the half-space alone.
/// - Windows of share 0 are left out, and with them the ranges of their media.
/// Throws UserError naming the material if it has no layer, if its permittivity is not known at
/// `frequency_hz`, if a layer other than the last has thickness 0, if a thickness is negative, if a layer
/// of its windows has no thickness, if their share is not from 0 to 1, or if a parameter of its scattering is
/// out of range (rf/surface/scattering.h). Messages about windows call the material "NAME (windows)".
RadioSurface radio_surface(const scene::RadioMaterial& material, double frequency_hz,
                           const std::string& material_name);

/// Returns the surfaces of a scene in the order of its materials. A material without a facet, and foliage,
/// have no layers. Throws UserError naming the material if a material of a facet of `scene` has no radio
/// properties or is not known at `carrier_hz`. In the second case the message also names the frequency and
/// the ranges of the material.
std::vector<RadioSurface> radio_surfaces(const scene::Scene& scene, double carrier_hz);

/// Holds one surface per material, or those of a few materials. RadioSurfaces has doubles;
/// RadioSurfacesOf<Dual> knows how they change with parameters.
template <typename R>
class RadioSurfacesOf {
 public:
  /// Takes the surfaces of radio_surfaces(). A template, so that there is none for dual numbers.
  template <typename S = R>
  requires std::is_same_v<S, double> RadioSurfacesOf(const scene::Scene& scene, double carrier_hz)
      : RadioSurfacesOf(radio_surfaces(scene, carrier_hz), carrier_hz) {}
  /// Takes `surfaces` in the order of material indices. If `materials` is not empty, they are the surfaces of
  /// these materials.
  RadioSurfacesOf(std::vector<RadioSurfaceOf<R>> surfaces, const R& carrier_hz,
                  std::vector<uint32_t> materials = {});

  const R& carrier_hz() const { return carrier_hz_; }
  const R& wavelength_m() const { return wavelength_m_; }
  /// Returns the reflection of the smooth wall, with windows the mean by area. `from_front` is true if the
  /// wave comes from the side that the normal of the facet points to.
  ReflectionCoefficientsOf<R> reflect(uint32_t material, bool from_front, const R& cos_theta) const;
  /// Returns the transmission through all layers of a wall, which must be penetrable, with windows the mean
  /// by area. A half-space around windows adds nothing. The result of a thick lossy wall underflows to 0.
  SheetTransmissionOf<R> transmit(uint32_t material, bool from_front, const R& cos_theta) const;
  size_t size() const { return surfaces_.size(); }
  bool penetrable(uint32_t material) const { return surface(material).penetrable(); }
  /// Returns the wall of a material by its index in the scene. The wall has no layers if no facet has this
  /// material or if the material is foliage.
  const RadioSurfaceOf<R>& surface(uint32_t material) const;

 private:
  size_t place_of(uint32_t material) const;
  const RadioSurfaceOf<R>& wall(uint32_t material) const;

  std::vector<RadioSurfaceOf<R>> surfaces_;  ///< [materials]
  std::vector<uint32_t> materials_;          ///< of the surfaces; empty: all, in their order
  R carrier_hz_, wavelength_m_;
};
using RadioSurfaces = RadioSurfacesOf<double>;
extern template class RadioSurfacesOf<double>;
extern template class RadioSurfacesOf<Dual>;

}  // namespace greatx::rf
