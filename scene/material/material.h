// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines one material with two sides: PBR for light and EM for radio, both read from the same glTF material.
#pragma once

#include <complex>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/vec.h"
#include "scene/material/clutter.h"

namespace greatx::scene {

enum class AlphaMode : uint32_t { opaque, mask };

/// Describes a material of glTF 2.0 metallic-roughness (section 3.9), linear light.
struct PbrMaterial {
  vec4 base_color{1.0f};
  float metallic = 1.0f;
  float roughness = 1.0f;
  vec3 emissive{0.0f};  ///< multiplied by KHR_materials_emissive_strength; 1.0 stands for 1000 cd/m^2
  float normal_scale = 1.0f;
  float alpha_cutoff = 0.5f;
  AlphaMode alpha_mode = AlphaMode::opaque;
  bool double_sided = false;
  /// For a pane, the part of the light that goes through (KHR_materials_transmission, or 1 - alpha of a BLEND
  /// material without a texture). Cameras and LiDARs see the objects behind it.
  float transmission = 0.0f;
  int32_t base_color_texture = -1;          ///< index into Scene::textures; -1: none
  int32_t metallic_roughness_texture = -1;  ///< G roughness, B metallic
  int32_t normal_texture = -1;
  int32_t emissive_texture = -1;
  friend bool operator==(const PbrMaterial&, const PbrMaterial&) = default;
};

/// Holds one row of a frequency-dependent material: eta' = a f^b, sigma = c f^d S/m, f in GHz (ITU-R
/// P.2040-4, eq. 28 and 29, Table 3).
struct RadioRow {
  double a = 1.0, b = 0.0, c = 0.0, d = 0.0;
  double min_hz = 0.0, max_hz = 0.0;  ///< the range in which the row holds
  friend bool operator==(const RadioRow&, const RadioRow&) = default;
};

/// Describes a homogeneous medium with its rows and their source.
struct RadioMedium {
  std::string source;  ///< "ITU-R P.2040-4 Table 3, concrete", "explicit a, b, c, d", "explicit permittivity"
  std::vector<RadioRow> rows;
  bool extrapolate = false;  ///< use the nearest row outside every range (asked for explicitly)
  friend bool operator==(const RadioMedium&, const RadioMedium&) = default;
};

enum class ScatteringPattern : uint32_t { lambertian, directive, backscattering };

/// Describes a layer of a wall. Layers are listed inwards from the outside (the side to which the normal
/// points).
struct RadioLayer {
  RadioMedium medium;
  double thickness_m = 0.0;
  friend bool operator==(const RadioLayer&, const RadioLayer&) = default;
};

/// Describes leaves and twigs in a closed mesh. Foliage neither reflects nor blocks waves, but attenuates
/// them by the depth that they pass (rf/atmosphere/foliage.h).
struct Foliage {
  std::optional<double> attenuation_db_per_m;  ///< at every frequency; empty: Weissberger's model
  friend bool operator==(const Foliage&, const Foliage&) = default;
};

/// Describes the windows of a wall that is drawn as one face. In the specular direction the wall reflects and
/// transmits the mean of the fields of its parts, by area (rf/surface/surfaces.h, docs/materials.md).
struct RadioWindows {
  double share = 0.0;              ///< part of the area of the face that is windows, 0 to 1
  std::vector<RadioLayer> layers;  ///< inwards from the outside; each has a thickness, so that waves get in
  friend bool operator==(const RadioWindows&, const RadioWindows&) = default;
};

struct RadioMaterial {
  /// At least one layer, or none for foliage. A single layer of thickness 0 is a half-space.
  std::vector<RadioLayer> layers;
  /// A volume instead of a surface. The fields below, except `clutter`, then have no meaning.
  std::optional<Foliage> foliage;
  double scattering_coefficient = 0.0;  ///< S in [0, 1]
  ScatteringPattern pattern = ScatteringPattern::lambertian;
  double pattern_exponent = 4.0;      ///< alpha_R of the directive pattern
  double backscatter_exponent = 4.0;  ///< alpha_I
  double backscatter_share = 0.5;     ///< 1 - Lambda, the part of the energy in the backscattering lobe
  double cross_polarization = 0.0;    ///< K_x in [0, 1]
  double roughness_m = 0.0;           ///< rms height
  /// Rms distance of the real surface from the plane of its facet, m, below which wavelengths see the plane:
  /// S falls with the wavelength as rf::scattered_share() does. 0: S holds at all frequencies.
  double deviation_m = 0.0;
  /// The power that the surface, or the outside of foliage, sends back to radars; empty: that which
  /// `scattering_coefficient` scatters back.
  std::optional<SurfaceClutter> clutter;
  std::optional<RadioWindows> windows;  ///< empty: the wall has none; never beside foliage
  friend bool operator==(const RadioMaterial&, const RadioMaterial&) = default;
};

struct Material {
  std::string name;
  PbrMaterial pbr;
  std::optional<RadioMaterial> radio;  ///< empty only in scenes loaded as optical only
  /// Lambertian reflectance at 905 nm and 1550 nm. Where the file gives none, it is the luminance of the base
  /// colour (documented, and printed by `greatx scene info`).
  std::optional<float> reflectance_905nm, reflectance_1550nm;
  friend bool operator==(const Material&, const Material&) = default;
};

/// Returns the row of `medium` that holds at `frequency_hz`: the narrowest range that contains it (ranges
/// overlap). Throws UserError naming `material_name`, the frequency and the ranges if no range contains it
/// and `extrapolate` is not set.
const RadioRow& row_at(const RadioMedium& medium, double frequency_hz, const std::string& material_name);

/// Returns eta = eta' - j sigma / (omega epsilon_0) (P.2040-4, eq. 9b; time convention e^{+j omega t}).
std::complex<double> relative_permittivity(const RadioMedium& medium, double frequency_hz,
                                           const std::string& material_name);

/// Returns the medium called `name` in P.2040-4 Table 3, or nothing if there is none. Names are such as
/// "concrete", "itu_concrete", "medium_dry_ground"; case does not matter, and '-' and ' ' count as '_'.
std::optional<RadioMedium> itu_medium(const std::string& name);
/// Returns every name that itu_medium understands, in canonical form.
std::vector<std::string> itu_names();

}  // namespace greatx::scene
