// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/fit/materials.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/text.h"
#include "core/units.h"
#include "rf/surface/roughness.h"

namespace greatx::sim {
namespace {

[[noreturn]] void refuse(const FitParameter& parameter, const std::string& message) {
  throw_user_error_at(parameter.where, "{}: {}", name_of(parameter.property), message);
}

/// Returns the layer of a parameter in a material.
scene::RadioLayer& layer_of(const FitParameter& parameter, scene::RadioMaterial& radio,
                            const std::string& name) {
  if (parameter.windows && !radio.windows)
    refuse(parameter, fmt::format("expected a material with windows, found '{}' without", name));
  std::vector<scene::RadioLayer>& layers = parameter.windows ? radio.windows->layers : radio.layers;
  if (parameter.layer >= layers.size())
    refuse(parameter, fmt::format("layer: expected 0 to {}, a layer of '{}', found {}", layers.size() - 1,
                                  name, parameter.layer));
  return layers[parameter.layer];
}

bool is_of_layer(FitProperty property) {
  return property == FitProperty::permittivity || property == FitProperty::conductivity ||
         property == FitProperty::thickness;
}

/// eta'' of 1 S/m is 1/(omega epsilon_0), so this is the conductivity of eta'' = 1.
double conductivity_of_one(double carrier_hz) { return 2.0 * pi * carrier_hz * vacuum_permittivity; }

double value_of(const FitParameter& parameter, const scene::Material& material, double carrier_hz) {
  scene::RadioMaterial radio = *material.radio;
  if (is_of_layer(parameter.property)) {
    const scene::RadioLayer& layer = layer_of(parameter, radio, material.name);
    if (parameter.property == FitProperty::thickness) {
      if (layer.thickness_m == 0.0)
        refuse(parameter,
               fmt::format("expected a material with a thickness, found the half-space '{}'", material.name));
      return layer.thickness_m;
    }
    const std::complex<double> eta = scene::relative_permittivity(layer.medium, carrier_hz, material.name);
    return parameter.property == FitProperty::permittivity ? eta.real()
                                                           : -eta.imag() * conductivity_of_one(carrier_hz);
  }
  switch (parameter.property) {
    case FitProperty::roughness:
      return radio.roughness_m;
    case FitProperty::scattering:
      return radio.scattering_coefficient *
             rf::scattered_share(radio.deviation_m, speed_of_light / carrier_hz);
    case FitProperty::cross_polarization:
      return radio.cross_polarization;
    default:
      return radio.backscatter_share;
  }
}

/// Gives the medium a new value at the carrier. Its dependence on frequency stays.
void set_electric(scene::RadioMedium& medium, bool permittivity, double value, double carrier_hz,
                  const std::string& name) {
  scene::RadioRow row = scene::row_at(medium, carrier_hz, name);
  const double ghz = carrier_hz * 1e-9;
  if (permittivity)
    row.a = value / std::pow(ghz, row.b);
  else
    row.c = value / std::pow(ghz, row.d);
  medium.rows = {row};
  medium.source = "fitted";
}

void set_value(const FitParameter& parameter, double value, double carrier_hz, const std::string& name,
               scene::RadioMaterial& radio) {
  switch (parameter.property) {
    case FitProperty::permittivity:
    case FitProperty::conductivity:
      set_electric(layer_of(parameter, radio, name).medium, parameter.property == FitProperty::permittivity,
                   value, carrier_hz, name);
      break;
    case FitProperty::thickness:
      layer_of(parameter, radio, name).thickness_m = value;
      break;
    case FitProperty::roughness:
      radio.roughness_m = value;
      break;
    case FitProperty::scattering:
      radio.scattering_coefficient = value;
      radio.deviation_m = 0.0;  // the value is that at the carrier
      break;
    case FitProperty::cross_polarization:
      radio.cross_polarization = value;
      break;
    case FitProperty::backscatter_share:
      radio.backscatter_share = value;
      break;
  }
}

/// Returns the materials with the names of a parameter, by their indices.
std::vector<uint32_t> materials_called(const FitParameter& parameter, const scene::Scene& scene) {
  std::vector<uint32_t> found;
  for (const std::string& name : parameter.materials) {
    const size_t before = found.size();
    std::vector<std::string> names;
    for (uint32_t i = 0; i < scene.materials.size(); ++i) {
      const scene::Material& material = scene.materials[i];
      if (!material.radio) continue;
      names.push_back(material.name);
      if (material.name != name) continue;
      if (material.radio->foliage)
        refuse(parameter, fmt::format("expected the material of a wall, found foliage '{}'", name));
      found.push_back(i);
    }
    if (found.size() == before)
      throw_user_error_at(parameter.where, "material: expected one of the scene's, found '{}'{}", name,
                          suggestion(name, names));
  }
  std::ranges::sort(found);
  const auto repeated = std::ranges::unique(found);
  found.erase(repeated.begin(), repeated.end());
  return found;
}

}  // namespace

FitMaterials::FitMaterials(const scene::Scene& scene, double carrier_hz,
                           std::span<const FitParameter> parameters)
    : scene_(scene),
      carrier_hz_(carrier_hz),
      parameters_(parameters.begin(), parameters.end()),
      parameters_of_(scene.materials.size()) {
  const rf::RadioSurfaces as_they_are(scene, carrier_hz);
  for (uint32_t i = 0; i < scene.materials.size(); ++i) surfaces_.push_back(as_they_are.surface(i));
  for (uint32_t p = 0; p < parameters_.size(); ++p) {
    const FitParameter& parameter = parameters_[p];
    materials_.push_back(materials_called(parameter, scene));
    const double first = value_of(parameter, scene.materials[materials_[p][0]], carrier_hz);
    for (const uint32_t material : materials_[p]) {
      const double value = value_of(parameter, scene.materials[material], carrier_hz);
      if (value != first && !parameter.range.start)
        refuse(parameter, fmt::format("start: expected a value, since the materials start from {} and {}",
                                      first, value));
      parameters_of_[material].push_back(p);
    }
    const double start = parameter.range.start.value_or(first);
    if (!(start >= parameter.range.low && start <= parameter.range.high))
      refuse(parameter, fmt::format("bounds: expected bounds around the start {}, found [{}, {}]", start,
                                    parameter.range.low, parameter.range.high));
    if (parameter.property == FitProperty::scattering && start == 0.0)
      refuse(parameter, "start: expected a number above 0, since no path scatters from a material with 0");
    start_.push_back(start);
  }
}

scene::RadioMaterial FitMaterials::material(uint32_t index, std::span<const double> values) const {
  const scene::Material& material = scene_.materials[index];
  scene::RadioMaterial radio = *material.radio;
  for (const uint32_t p : parameters_of_[index])
    set_value(parameters_[p], values[p], carrier_hz_, material.name, radio);
  return radio;
}

rf::RadioSurfaces FitMaterials::surfaces(std::span<const double> values) const {
  std::vector<rf::RadioSurface> changed = surfaces_;
  for (uint32_t i = 0; i < changed.size(); ++i)
    if (!parameters_of_[i].empty() && !changed[i].front.empty())
      changed[i] = rf::radio_surface(material(i, values), carrier_hz_, scene_.materials[i].name);
  return {std::move(changed), carrier_hz_};
}

}  // namespace greatx::sim
