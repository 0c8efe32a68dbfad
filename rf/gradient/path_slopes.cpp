// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/gradient/path_slopes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/error.h"
#include "core/units.h"
#include "rf/gradient/dual_vertices.h"
#include "rf/surface/surfaces.h"

namespace greatx::rf {
namespace {

using Kind = ChannelParameter::Kind;

constexpr size_t slots = Dual::count;

bool of_material(Kind kind) { return kind <= Kind::backscatter_share; }
bool of_position(Kind kind) { return kind == Kind::transmitter_position || kind == Kind::receiver_position; }

const char* name_of(Kind kind) {
  constexpr const char* names[] = {"permittivity",      "conductivity",
                                   "thickness",         "roughness",
                                   "scattering",        "cross_polarization",
                                   "backscatter_share", "transmitter_position",
                                   "receiver_position", "transmitter_velocity",
                                   "receiver_velocity", "transmitter_attitude",
                                   "receiver_attitude", "carrier"};
  return names[static_cast<size_t>(kind)];
}

/// Holds the parameters whose slopes are computed at once, by their slots; empty slots at the end.
using Chunk = std::span<const ChannelParameter>;

std::vector<DielectricLayerOf<Dual>> dual_stack(const std::vector<DielectricLayer>& layers) {
  std::vector<DielectricLayerOf<Dual>> stack;
  for (const DielectricLayer& layer : layers) stack.push_back({layer.eta, layer.thickness_m});
  return stack;
}

/// Adds a slope to a layer of both stacks of a wall. Seen from the side of a half-space, the wall is that
/// half-space alone.
template <typename Add>
void change_layer(std::vector<DielectricLayerOf<Dual>>& front, std::vector<DielectricLayerOf<Dual>>& back,
                  size_t layer, const Add& add) {
  add(front[layer]);
  const size_t behind = front.size() - 1 - layer;
  if (behind < back.size()) add(back[behind]);
}

void add_slope(DualComplex& z, int slot, const Complex& slope) {
  z.re.set_slope(slot, z.re.slope(slot) + slope.real());
  z.im.set_slope(slot, z.im.slope(slot) + slope.imag());
}

/// Returns the surface of a material with its slopes by the parameters of a chunk.
RadioSurfaceOf<Dual> dual_surface(const RadioSurface& surface, uint32_t material, Chunk chunk,
                                  double carrier_hz, const CarrierSlopes* carrier) {
  RadioSurfaceOf<Dual> result;
  result.front = dual_stack(surface.front);
  result.back = dual_stack(surface.back);
  result.foliage = surface.foliage;
  result.roughness_m = surface.roughness_m;
  const DiffuseScattering& scattering = surface.scattering;
  result.scattering = {scattering.coefficient,       scattering.pattern,
                       scattering.exponent,          scattering.backscatter_exponent,
                       scattering.backscatter_share, scattering.cross_polarization};
  result.windows = {surface.windows.share, dual_stack(surface.windows.front),
                    dual_stack(surface.windows.back)};
  const auto layers = [&](bool windows, size_t layer, const auto& add) {
    windows ? change_layer(result.windows.front, result.windows.back, layer, add)
            : change_layer(result.front, result.back, layer, add);
  };
  const Complex by_conductivity(0.0, -1.0 / (2.0 * pi * carrier_hz * vacuum_permittivity));
  for (int slot = 0; slot < static_cast<int>(chunk.size()); ++slot) {
    const ChannelParameter& p = chunk[static_cast<size_t>(slot)];
    if (p.kind == Kind::carrier) {
      const CarrierSlopes::Layers& of = carrier->materials.at(material);
      for (size_t i = 0; i < of.wall.size() && i < result.front.size(); ++i)
        layers(false, i, [&](auto& layer) { add_slope(layer.eta, slot, of.wall[i]); });
      for (size_t i = 0; i < of.windows.size() && i < result.windows.front.size(); ++i)
        layers(true, i, [&](auto& layer) { add_slope(layer.eta, slot, of.windows[i]); });
      result.scattering.coefficient.set_slope(slot, of.scattering);
    }
    if (!of_material(p.kind) || p.index != material) continue;
    const auto eta = [&](const Complex& slope) {
      layers(p.windows, p.layer, [&](auto& layer) { add_slope(layer.eta, slot, slope); });
    };
    if (p.kind == Kind::permittivity) eta(1.0);
    if (p.kind == Kind::conductivity) eta(by_conductivity);
    if (p.kind == Kind::thickness)
      layers(p.windows, p.layer, [&](auto& layer) { layer.thickness_m.set_slope(slot, 1.0); });
    if (p.kind == Kind::roughness) result.roughness_m.set_slope(slot, 1.0);
    if (p.kind == Kind::scattering) result.scattering.coefficient.set_slope(slot, 1.0);
    if (p.kind == Kind::cross_polarization) result.scattering.cross_polarization.set_slope(slot, 1.0);
    if (p.kind == Kind::backscatter_share) result.scattering.backscatter_share.set_slope(slot, 1.0);
  }
  return result;
}

/// Throws if a parameter names nothing of the model.
void check(const ChannelParameter& p, const FieldModel& model, const CarrierSlopes* carrier) {
  const char* name = name_of(p.kind);
  if (p.kind == Kind::carrier) {
    if (!carrier) throw_user_error("parameter '{}': expected the slopes of the model by the carrier", name);
    return;
  }
  if (!of_material(p.kind)) {
    if (p.axis > 2) throw_user_error("parameter '{}': expected an axis from 0 to 2, found {}", name, p.axis);
    return;
  }
  if (p.index >= model.surfaces->size())
    throw_user_error("parameter '{}': expected a material below {}, found {}", name, model.surfaces->size(),
                     p.index);
  const RadioSurface& surface = model.surfaces->surface(p.index);
  const bool unused = surface.front.empty();
  if (p.kind > Kind::thickness || unused) return;
  const std::vector<DielectricLayer>& layers = p.windows ? surface.windows.front : surface.front;
  if (p.layer >= layers.size())
    throw_user_error("parameter '{}' of material {}: expected a layer below {}{}, found {}", name, p.index,
                     layers.size(), p.windows ? " of its windows" : "", p.layer);
  if (p.kind == Kind::thickness && layers[p.layer].thickness_m == 0.0)
    throw_user_error("parameter '{}' of material {}: expected a layer with a thickness, found a half-space",
                     name, p.index);
}

/// Lists the materials that the field of a path depends on.
std::vector<uint32_t> materials_of(const GeometricPath& path, const FieldModel& model) {
  std::vector<uint32_t> materials;
  const auto add = [&](uint32_t facet) {
    if (facet == scene::no_facet) return;
    const uint32_t material = model.world->facet(facet).material;
    if (std::ranges::find(materials, material) == materials.end()) materials.push_back(material);
  };
  for (const Interaction& interaction : path.interactions) {
    GREATX_CHECK(interaction.type != InteractionType::target,
                 "slopes of a path over a target: expected its two legs, each by itself");
    if (interaction.type != InteractionType::diffraction) {
      add(interaction.element);
      continue;
    }
    GREATX_CHECK(interaction.element < model.wedges.size(), "wedge {} of {}", interaction.element,
                 model.wedges.size());
    add(model.wedges[interaction.element].facet_0);
    add(model.wedges[interaction.element].facet_n);
  }
  return materials;
}

/// Tells whether a path scatters at a material, and whether it loses there what is scattered.
struct ScatteringUse {
  bool scatters = false, loses = false;
};
ScatteringUse scattering_use(const GeometricPath& path, const FieldModel& model, uint32_t material) {
  ScatteringUse use;
  const auto is_it = [&](uint32_t facet) {
    return facet != scene::no_facet && model.world->facet(facet).material == material;
  };
  for (const Interaction& interaction : path.interactions) {
    if (interaction.type == InteractionType::diffraction) {
      const scene::Wedge& wedge = model.wedges[interaction.element];
      use.loses = use.loses || is_it(wedge.facet_0) || is_it(wedge.facet_n);
    } else if (is_it(interaction.element)) {
      use.scatters = use.scatters || interaction.type == InteractionType::scattering;
      use.loses = use.loses || interaction.type == InteractionType::reflection;
    }
  }
  return use;
}

/// Tells whether the field of a path depends on a parameter of a material that it meets. Throws if it goes as
/// a square root of the parameter.
bool depends_on(const ChannelParameter& p, const GeometricPath& path, const FieldModel& model) {
  if (p.kind <= Kind::thickness) return true;
  if (p.kind == Kind::roughness) return model.effects.roughness;
  const ScatteringUse use = scattering_use(path, model, p.index);
  if (p.kind == Kind::backscatter_share) return use.scatters;
  const DiffuseScattering& surface = model.surfaces->surface(p.index).scattering;
  const bool crossed = p.kind == Kind::cross_polarization, loses = use.loses && model.effects.scattering;
  const double value = crossed ? surface.cross_polarization : surface.coefficient;
  if (crossed ? use.scatters && (value == 0.0 || value == 1.0) : loses && value == 1.0)
    throw_user_error(
        "parameter '{}' of material {}: the field has no finite derivative at {}; expected a value between 0 "
        "and 1",
        name_of(p.kind), p.index, value);
  return use.scatters || (!crossed && loses);
}

Dual moved_to(const Dual& of, int slot) {
  Dual result = of.value;
  result.set_slope(slot, of.slope(0));
  return result;
}

PathAttenuationOf<Dual> dual_attenuation(const PathAttenuation& attenuation, Chunk chunk,
                                         const CarrierSlopes* carrier) {
  const auto by_carrier = std::ranges::find(chunk, Kind::carrier, &ChannelParameter::kind);
  PathAttenuationOf<Dual> result;
  result.rain_mm_h = attenuation.rain_mm_h;
  if (by_carrier == chunk.end()) {
    result.gas = attenuation.gas, result.fog = attenuation.fog;
    result.rain_h = attenuation.rain_h, result.rain_v = attenuation.rain_v;
    const RainCoefficients& rain = attenuation.rain;
    result.rain = {rain.k_h, rain.alpha_h, rain.k_v, rain.alpha_v};
    return result;
  }
  const auto slot = static_cast<int>(by_carrier - chunk.begin());
  const PathAttenuationOf<Dual>& of = carrier->attenuation;
  GREATX_CHECK(of.gas == attenuation.gas && of.fog == attenuation.fog &&
                   of.rain_mm_h == attenuation.rain_mm_h && of.rain_h == attenuation.rain_h,
               "slopes by the carrier of another weather or carrier");
  result.gas = moved_to(of.gas, slot), result.fog = moved_to(of.fog, slot);
  result.rain_h = moved_to(of.rain_h, slot), result.rain_v = moved_to(of.rain_v, slot);
  result.rain = {moved_to(of.rain.k_h, slot), moved_to(of.rain.alpha_h, slot), moved_to(of.rain.k_v, slot),
                 moved_to(of.rain.alpha_v, slot)};
  return result;
}

/// Computes the values of a path with their slopes by the parameters of a chunk.
class ChunkSlopes {
 public:
  ChunkSlopes(const GeometricPath& path, const FieldModel& model, const std::vector<uint32_t>& materials,
              const dvec3& transmitter_velocity, const dvec3& receiver_velocity, const CarrierSlopes* carrier)
      : path_(path),
        model_(model),
        materials_(materials),
        velocities_{transmitter_velocity, receiver_velocity},
        carrier_(carrier) {}

  void compute(Chunk chunk, std::span<PathSlope* const> slopes) const {
    Dual carrier_hz = model_.surfaces->carrier_hz();
    Vec3Of<Dual> ends[2] = {path_.vertices.front(), path_.vertices.back()};
    for (int slot = 0; slot < static_cast<int>(chunk.size()); ++slot) {
      const ChannelParameter& p = chunk[static_cast<size_t>(slot)];
      if (p.kind == Kind::carrier) carrier_hz.set_slope(slot, 1.0);
      if (of_position(p.kind))
        ends[p.kind == Kind::receiver_position][static_cast<int>(p.axis)].set_slope(slot, 1.0);
    }
    std::vector<RadioSurfaceOf<Dual>> of_materials;
    for (const uint32_t material : materials_)
      of_materials.push_back(
          dual_surface(model_.surfaces->surface(material), material, chunk, carrier_hz.value, carrier_));
    const RadioSurfacesOf<Dual> surfaces(std::move(of_materials), carrier_hz, materials_);
    const DualVertices places = dual_vertices(path_, *model_.world, model_.wedges, ends[0], ends[1]);
    const FieldModelOf<Dual> model{model_.world,
                                   &surfaces,
                                   model_.effects,
                                   model_.wedges,
                                   dual_attenuation(model_.attenuation, chunk, carrier_),
                                   model_.foliage,
                                   model_.reflectors};
    const PathValuesOf<Dual> values =
        path_values<Dual>(path_, {places.vertices, places.length_m, velocities_[0], velocities_[1]}, model);
    for (int slot = 0; slot < static_cast<int>(chunk.size()); ++slot) {
      PathSlope& slope = *slopes[static_cast<size_t>(slot)];
      for (int i = 0; i < 4; ++i)
        slope.transfer[i] = {values.transfer[i].re.slope(slot), values.transfer[i].im.slope(slot)};
      slope.length_m = places.length_m.slope(slot);
      slope.doppler_hz = values.doppler_hz.slope(slot);
      const auto of = [&](const Vec3Of<Dual>& v) {
        return dvec3(v.x.slope(slot), v.y.slope(slot), v.z.slope(slot));
      };
      slope.departure = of(values.departure);
      slope.arrival = of(values.arrival);
    }
  }

 private:
  const GeometricPath& path_;
  const FieldModel& model_;
  const std::vector<uint32_t>& materials_;
  dvec3 velocities_[2];
  const CarrierSlopes* carrier_;
};

}  // namespace

std::vector<PathSlope> path_slopes(const GeometricPath& geometry, const FieldModel& model,
                                   const dvec3& transmitter_velocity, const dvec3& receiver_velocity,
                                   std::span<const ChannelParameter> parameters,
                                   const CarrierSlopes* carrier) {
  std::vector<PathSlope> result(parameters.size());
  const std::vector<uint32_t> materials = materials_of(geometry, model);
  const ChunkSlopes slopes(geometry, model, materials, transmitter_velocity, receiver_velocity, carrier);
  std::array<ChannelParameter, slots> chunk;
  std::array<PathSlope*, slots> to{};
  size_t used = 0;
  const auto flush = [&] {
    if (used > 0) slopes.compute(Chunk(chunk).first(used), std::span(to).first(used));
    used = 0;
  };
  std::vector<size_t> by_velocity;
  for (size_t i = 0; i < parameters.size(); ++i) {
    const ChannelParameter& p = parameters[i];
    check(p, model, carrier);
    if (p.kind == Kind::transmitter_velocity || p.kind == Kind::receiver_velocity) by_velocity.push_back(i);
    const bool touched = of_material(p.kind) && std::ranges::find(materials, p.index) != materials.end() &&
                         depends_on(p, geometry, model);
    if (!touched && !of_position(p.kind) && p.kind != Kind::carrier) continue;
    chunk[used] = p;
    to[used] = &result[i];
    if (++used == slots) flush();
  }
  flush();
  if (by_velocity.empty()) return result;
  // doppler = (f/c) (v_tx . departure + v_rx . arrival + ...).
  const PathDirections ends = path_directions(geometry, *model.world);
  for (const size_t i : by_velocity) {
    const bool sends = parameters[i].kind == Kind::transmitter_velocity;
    const dvec3& direction = sends ? ends.departure : ends.arrival;
    result[i].doppler_hz = direction[static_cast<int>(parameters[i].axis)] / model.surfaces->wavelength_m();
  }
  return result;
}

}  // namespace greatx::rf
