// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/surface/surfaces.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/units.h"

namespace greatx::rf {
namespace {

/// A wall or its windows as seen from one side.
template <typename R>
using StackOf = std::vector<DielectricLayerOf<R>>;
using Stack = StackOf<double>;

template <typename R>
FresnelCoefficientsOf<R> fresnel(const StackOf<R>& layers, const R& wavelength_m, const R& cos_theta) {
  if (layers.size() == 1 && layers[0].thickness_m == 0.0) return half_space<R>(layers[0].eta, cos_theta);
  if (layers.size() == 1) return slab<R>(layers[0], wavelength_m, cos_theta);
  return multilayer<R>(layers, wavelength_m, cos_theta);
}

template <typename R>
ReflectionCoefficientsOf<R> reflection(const StackOf<R>& layers, const R& wavelength_m, const R& cos_theta) {
  if (layers.size() > 1) return multilayer<R>(layers, wavelength_m, cos_theta);
  if (layers[0].thickness_m == 0.0) return half_space_reflection<R>(layers[0].eta, cos_theta);
  return slab_reflection<R>(layers[0], wavelength_m, cos_theta);
}

template <typename R>
SheetTransmissionOf<R> transmission(const StackOf<R>& layers, const R& wavelength_m, const R& cos_theta) {
  R thickness_m = 0.0;
  for (const DielectricLayerOf<R>& layer : layers) thickness_m += layer.thickness_m;
  const FresnelCoefficientsOf<R> through = fresnel(layers, wavelength_m, cos_theta);
  const ComplexOf<R> phase = sheet_phase<R>(thickness_m, wavelength_m, cos_theta);
  return {through.t_te * phase, through.t_tm * phase};
}

template <typename C>
C mean(const C& wall, const C& windows, double share) {
  return (1.0 - share) * wall + share * windows;
}

/// Returns the layers of `material_name` at one frequency, as seen from the outside.
Stack stack_of(const std::vector<scene::RadioLayer>& layers, double frequency_hz,
               const std::string& material_name) {
  if (layers.empty()) throw_user_error("material '{}': expected one radio layer at least", material_name);
  Stack stack;
  for (size_t i = 0; i < layers.size(); ++i) {
    const scene::RadioLayer& layer = layers[i];
    const bool last = i + 1 == layers.size();
    if (!(layer.thickness_m >= 0.0))
      throw_user_error("material '{}', layer {}: expected a thickness >= 0 m, found {}", material_name, i + 1,
                       layer.thickness_m);
    if (layer.thickness_m == 0.0 && !last)
      throw_user_error(
          "material '{}', layer {}: thickness 0 makes it a half-space, so expected no layer behind it, "
          "found {}",
          material_name, i + 1, layers.size() - i - 1);
    stack.push_back(
        {scene::relative_permittivity(layer.medium, frequency_hz, material_name), layer.thickness_m});
  }
  return stack;
}

/// Returns the layers as seen from behind.
Stack reversed(const Stack& front) {
  Stack back(front.rbegin(), front.rend());
  if (back.front().thickness_m == 0.0) back.resize(1);
  return back;
}

WindowSurface windows_of(const scene::RadioWindows& windows, double frequency_hz,
                         const std::string& material_name) {
  const std::string name = material_name + " (windows)";
  if (!(windows.share >= 0.0 && windows.share <= 1.0))
    throw_user_error("material '{}': expected a share of the wall's area from 0 to 1, found {}", name,
                     windows.share);
  if (windows.share == 0.0) return {};
  WindowSurface surface;
  surface.share = windows.share;
  surface.front = stack_of(windows.layers, frequency_hz, name);
  if (surface.front.back().thickness_m == 0.0)
    throw_user_error("material '{}', layer {}: expected a thickness above 0 m, found 0", name,
                     surface.front.size());
  surface.back = reversed(surface.front);
  return surface;
}

}  // namespace

template <typename R>
R specular_share(const RadioSurfaceOf<Given<R>>& surface, const Given<R>& cosine,
                 const Given<R>& wavelength_m, std::optional<RoughnessModel> roughness, bool scattering) {
  using std::sqrt;
  R kept = 1.0;
  if (roughness && !always_zero(surface.roughness_m))
    kept = roughness_factor<R>(*roughness, roughness_parameter<R>(surface.roughness_m, cosine, wavelength_m));
  const R& scattered = surface.scattering.coefficient;
  if (scattering) kept *= sqrt((1.0 - scattered) * (1.0 + scattered));
  return kept;
}
template double specular_share<double>(const RadioSurface&, const double&, const double&,
                                       std::optional<RoughnessModel>, bool);
template Dual specular_share<Dual>(const RadioSurfaceOf<Dual>&, const Dual&, const Dual&,
                                   std::optional<RoughnessModel>, bool);

RadioSurface radio_surface(const scene::RadioMaterial& material, double frequency_hz,
                           const std::string& material_name) {
  RadioSurface surface;
  surface.front = stack_of(material.layers, frequency_hz, material_name);
  surface.back = reversed(surface.front);
  surface.roughness_m = material.roughness_m;
  surface.scattering = diffuse_scattering(material, material_name);
  if (!(material.deviation_m >= 0.0))
    throw_user_error("material '{}', deviation_m: expected 0 m or more, found {}", material_name,
                     material.deviation_m);
  surface.scattering.coefficient *= scattered_share(material.deviation_m, speed_of_light / frequency_hz);
  if (material.windows) surface.windows = windows_of(*material.windows, frequency_hz, material_name);
  return surface;
}

std::vector<RadioSurface> radio_surfaces(const scene::Scene& scene, double carrier_hz) {
  GREATX_CHECK(carrier_hz > 0.0, "carrier {} Hz", carrier_hz);
  std::vector<RadioSurface> surfaces(scene.materials.size());
  for (const scene::Facet& facet : scene.facets) {
    GREATX_CHECK(facet.material < surfaces.size(), "material {} of {}", facet.material, surfaces.size());
    RadioSurface& surface = surfaces[facet.material];
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
  return surfaces;
}

template <typename R>
RadioSurfacesOf<R>::RadioSurfacesOf(std::vector<RadioSurfaceOf<R>> surfaces, const R& carrier_hz,
                                    std::vector<uint32_t> materials)
    : surfaces_(std::move(surfaces)),
      materials_(std::move(materials)),
      carrier_hz_(carrier_hz),
      wavelength_m_(speed_of_light / carrier_hz) {
  GREATX_CHECK(carrier_hz > 0.0, "carrier {} Hz", value_of(carrier_hz));
  GREATX_CHECK(materials_.empty() || materials_.size() == surfaces_.size(), "{} surfaces of {} materials",
               surfaces_.size(), materials_.size());
}

template <typename R>
size_t RadioSurfacesOf<R>::place_of(uint32_t material) const {
  if (materials_.empty()) return material;
  return static_cast<size_t>(std::ranges::find(materials_, material) - materials_.begin());
}

template <typename R>
const RadioSurfaceOf<R>& RadioSurfacesOf<R>::surface(uint32_t material) const {
  const size_t place = place_of(material);
  GREATX_CHECK(place < surfaces_.size(), "material {} of {}", material, surfaces_.size());
  return surfaces_[place];
}

template <typename R>
const RadioSurfaceOf<R>& RadioSurfacesOf<R>::wall(uint32_t material) const {
  const size_t place = place_of(material);
  GREATX_CHECK(place < surfaces_.size() && !surfaces_[place].front.empty(),
               "material {} of {} has no surface", material, surfaces_.size());
  return surfaces_[place];
}

template <typename R>
ReflectionCoefficientsOf<R> RadioSurfacesOf<R>::reflect(uint32_t material, bool from_front,
                                                        const R& cos_theta) const {
  const RadioSurfaceOf<R>& surface = wall(material);
  const auto of_wall = [&] {
    return reflection(from_front ? surface.front : surface.back, wavelength_m_, cos_theta);
  };
  const double share = surface.windows.share;
  if (share == 0.0) return of_wall();
  const WindowSurfaceOf<R>& windows = surface.windows;
  const ReflectionCoefficientsOf<R> panes =
      reflection(from_front ? windows.front : windows.back, wavelength_m_, cos_theta);
  if (share == 1.0) return panes;
  const ReflectionCoefficientsOf<R> around = of_wall();
  return {mean(around.r_te, panes.r_te, share), mean(around.r_tm, panes.r_tm, share)};
}

template <typename R>
SheetTransmissionOf<R> RadioSurfacesOf<R>::transmit(uint32_t material, bool from_front,
                                                    const R& cos_theta) const {
  const RadioSurfaceOf<R>& surface = wall(material);
  GREATX_CHECK(surface.penetrable(), "material {} lets nothing through", material);
  const auto of_wall = [&] {
    return transmission(from_front ? surface.front : surface.back, wavelength_m_, cos_theta);
  };
  const double share = surface.windows.share;
  if (share == 0.0) return of_wall();
  const WindowSurfaceOf<R>& windows = surface.windows;
  const SheetTransmissionOf<R> panes =
      transmission(from_front ? windows.front : windows.back, wavelength_m_, cos_theta);
  if (share == 1.0) return panes;
  const SheetTransmissionOf<R> around = surface.wall_ends() ? of_wall() : SheetTransmissionOf<R>{};
  return {mean(around.te, panes.te, share), mean(around.tm, panes.tm, share)};
}

template class RadioSurfacesOf<double>;
template class RadioSurfacesOf<Dual>;

}  // namespace greatx::rf
