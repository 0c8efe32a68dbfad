// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/surface/surfaces.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/units.h"

namespace greatx::rf {
namespace {

FresnelCoefficients fresnel(const std::vector<DielectricLayer>& layers, double wavelength_m,
                            double cos_theta) {
  if (layers.size() == 1 && layers[0].thickness_m == 0.0) return half_space(layers[0].eta, cos_theta);
  if (layers.size() == 1) return slab(layers[0], wavelength_m, cos_theta);
  return multilayer(layers, wavelength_m, cos_theta);
}

}  // namespace

double specular_share(const RadioSurface& surface, double cosine, double wavelength_m,
                      std::optional<RoughnessModel> roughness, bool scattering) {
  double kept = 1.0;
  if (roughness && surface.roughness_m > 0.0)
    kept = roughness_factor(*roughness, roughness_parameter(surface.roughness_m, cosine, wavelength_m));
  const double scattered = surface.scattering.coefficient;
  if (scattering) kept *= std::sqrt((1.0 - scattered) * (1.0 + scattered));
  return kept;
}

RadioSurface radio_surface(const scene::RadioMaterial& material, double frequency_hz,
                           const std::string& material_name) {
  if (material.layers.empty())
    throw_user_error("material '{}': expected one radio layer at least", material_name);
  RadioSurface surface;
  surface.roughness_m = material.roughness_m;
  surface.scattering = diffuse_scattering(material, material_name);
  for (size_t i = 0; i < material.layers.size(); ++i) {
    const scene::RadioLayer& layer = material.layers[i];
    const bool last = i + 1 == material.layers.size();
    if (!(layer.thickness_m >= 0.0))
      throw_user_error("material '{}', layer {}: expected a thickness >= 0 m, found {}", material_name, i + 1,
                       layer.thickness_m);
    if (layer.thickness_m == 0.0 && !last)
      throw_user_error(
          "material '{}', layer {}: thickness 0 makes it a half-space, so expected no layer behind it, "
          "found {}",
          material_name, i + 1, material.layers.size() - i - 1);
    surface.front.push_back(
        {scene::relative_permittivity(layer.medium, frequency_hz, material_name), layer.thickness_m});
  }
  surface.back.assign(surface.front.rbegin(), surface.front.rend());
  if (surface.back.front().thickness_m == 0.0) surface.back.resize(1);
  return surface;
}

RadioSurfaces::RadioSurfaces(const scene::Scene& scene, double carrier_hz)
    : surfaces_(scene.materials.size()), carrier_hz_(carrier_hz), wavelength_m_(speed_of_light / carrier_hz) {
  GREATX_CHECK(carrier_hz > 0.0, "carrier {} Hz", carrier_hz);
  for (const scene::Facet& facet : scene.facets) {
    GREATX_CHECK(facet.material < surfaces_.size(), "material {} of {}", facet.material, surfaces_.size());
    RadioSurface& surface = surfaces_[facet.material];
    if (!surface.front.empty() || surface.foliage) continue;
    const scene::Material& material = scene.materials[facet.material];
    if (!material.radio)
      throw_user_error("material '{}' of scene '{}' has no radio properties", material.name, scene.name);
    if (material.radio->foliage) {
      surface.foliage = true;
      continue;
    }
    surface = radio_surface(*material.radio, carrier_hz, material.name);
  }
}

RadioSurfaces::RadioSurfaces(std::vector<RadioSurface> surfaces, double carrier_hz)
    : surfaces_(std::move(surfaces)), carrier_hz_(carrier_hz), wavelength_m_(speed_of_light / carrier_hz) {
  GREATX_CHECK(carrier_hz > 0.0, "carrier {} Hz", carrier_hz);
}

const RadioSurface& RadioSurfaces::surface(uint32_t material) const {
  GREATX_CHECK(material < surfaces_.size(), "material {} of {}", material, surfaces_.size());
  return surfaces_[material];
}

const std::vector<DielectricLayer>& RadioSurfaces::layers(uint32_t material, bool from_front) const {
  GREATX_CHECK(material < surfaces_.size() && !surfaces_[material].front.empty(),
               "material {} of {} has no surface", material, surfaces_.size());
  return from_front ? surfaces_[material].front : surfaces_[material].back;
}

ReflectionCoefficients RadioSurfaces::reflect(uint32_t material, bool from_front, double cos_theta) const {
  const std::vector<DielectricLayer>& wall = layers(material, from_front);
  if (wall.size() > 1) return multilayer(wall, wavelength_m_, cos_theta);
  if (wall[0].thickness_m == 0.0) return half_space_reflection(wall[0].eta, cos_theta);
  return slab_reflection(wall[0], wavelength_m_, cos_theta);
}

SheetTransmission RadioSurfaces::transmit(uint32_t material, bool from_front, double cos_theta) const {
  GREATX_CHECK(penetrable(material), "material {} lets nothing through", material);
  const std::vector<DielectricLayer>& wall = layers(material, from_front);
  double thickness_m = 0.0;
  for (const DielectricLayer& layer : wall) thickness_m += layer.thickness_m;
  const FresnelCoefficients through = fresnel(wall, wavelength_m_, cos_theta);
  const Complex phase = sheet_phase(thickness_m, wavelength_m_, cos_theta);
  return {through.t_te * phase, through.t_tm * phase};
}

}  // namespace greatx::rf
