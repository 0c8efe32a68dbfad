// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/gradient/changed_surfaces.h"

#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/units.h"

namespace greatx::rf {
namespace {

using Kind = ChannelParameter::Kind;

bool is_of_a_layer(Kind kind) {
  return kind == Kind::permittivity || kind == Kind::conductivity || kind == Kind::thickness;
}

/// Returns the layer in a stack as seen from the front, and from behind; null where it is not seen.
struct SeenLayer {
  DielectricLayer *front, *back;
};
SeenLayer seen_layer(std::vector<DielectricLayer>& front, std::vector<DielectricLayer>& back,
                     uint32_t layer) {
  const bool half_space = front.back().thickness_m == 0.0;
  DielectricLayer* behind = nullptr;
  if (!half_space)
    behind = &back[front.size() - 1 - layer];
  else if (layer + 1 == front.size())
    behind = &back[0];
  return {&front[layer], behind};
}

void set_layer(DielectricLayer& layer, Kind kind, double value, double carrier_hz) {
  if (kind == Kind::thickness) {
    layer.thickness_m = value;
  } else if (kind == Kind::permittivity) {
    layer.eta = {value, layer.eta.imag()};
  } else {
    layer.eta = {layer.eta.real(), -value / (2.0 * pi * carrier_hz * vacuum_permittivity)};
  }
}

/// The values that a parameter may have.
struct ValueRange {
  double least, most;
  const char* text;
};
ValueRange range_of(Kind kind) {
  constexpr double endless = std::numeric_limits<double>::max();
  switch (kind) {
    case Kind::permittivity:
      return {1e-3, endless, "a finite number from 0.001 up"};
    case Kind::thickness:
      return {std::numeric_limits<double>::min(), endless, "a finite number of metres above 0"};
    case Kind::conductivity:
    case Kind::roughness:
      return {0.0, endless, "a finite number from 0 up"};
    default:
      return {0.0, 1.0, "a number from 0 to 1"};
  }
}

}  // namespace

bool has_parameter(const RadioSurface& surface, const ChannelParameter& parameter) {
  if (surface.front.empty()) return false;
  if (!is_of_a_layer(parameter.kind)) return !parameter.windows && parameter.layer == 0;
  const std::vector<DielectricLayer>& layers = parameter.windows ? surface.windows.front : surface.front;
  if (parameter.layer >= layers.size()) return false;
  return parameter.kind != Kind::thickness || layers[parameter.layer].thickness_m > 0.0;
}

double parameter_value(const RadioSurface& surface, const ChannelParameter& parameter, double carrier_hz) {
  GREATX_CHECK(has_parameter(surface, parameter), "no parameter {}", static_cast<int>(parameter.kind));
  const auto layer = [&]() -> const DielectricLayer& {
    return (parameter.windows ? surface.windows.front : surface.front)[parameter.layer];
  };
  switch (parameter.kind) {
    case Kind::permittivity:
      return layer().eta.real();
    case Kind::conductivity:
      return -layer().eta.imag() * 2.0 * pi * carrier_hz * vacuum_permittivity;
    case Kind::thickness:
      return layer().thickness_m;
    case Kind::roughness:
      return surface.roughness_m;
    case Kind::scattering:
      return surface.scattering.coefficient;
    case Kind::cross_polarization:
      return surface.scattering.cross_polarization;
    case Kind::backscatter_share:
      return surface.scattering.backscatter_share;
    default:
      break;
  }
  GREATX_CHECK(false, "parameter {} is not of a material", static_cast<int>(parameter.kind));
}

RadioSurfaces changed_surfaces(const RadioSurfaces& surfaces, size_t materials,
                               std::span<const MaterialValue> values,
                               const std::function<std::string(const ChannelParameter&)>& name_of) {
  std::vector<RadioSurface> changed;
  for (uint32_t material = 0; material < materials; ++material) changed.push_back(surfaces.surface(material));
  for (const auto& [parameter, value] : values) {
    const ValueRange range = range_of(parameter.kind);
    if (!(value >= range.least && value <= range.most))
      throw_user_error("{}: expected {}, found {}", name_of(parameter), range.text, value);
    GREATX_CHECK(parameter.index < materials && has_parameter(changed[parameter.index], parameter),
                 "parameter {} of material {}", static_cast<int>(parameter.kind), parameter.index);
    RadioSurface& surface = changed[parameter.index];
    if (is_of_a_layer(parameter.kind)) {
      WindowSurface& windows = surface.windows;
      const SeenLayer layer = parameter.windows ? seen_layer(windows.front, windows.back, parameter.layer)
                                                : seen_layer(surface.front, surface.back, parameter.layer);
      set_layer(*layer.front, parameter.kind, value, surfaces.carrier_hz());
      if (layer.back != nullptr) set_layer(*layer.back, parameter.kind, value, surfaces.carrier_hz());
    } else if (parameter.kind == Kind::roughness) {
      surface.roughness_m = value;
    } else if (parameter.kind == Kind::scattering) {
      surface.scattering.coefficient = value;
    } else if (parameter.kind == Kind::cross_polarization) {
      surface.scattering.cross_polarization = value;
    } else {
      surface.scattering.backscatter_share = value;
    }
  }
  return {std::move(changed), surfaces.carrier_hz()};
}

}  // namespace greatx::rf
