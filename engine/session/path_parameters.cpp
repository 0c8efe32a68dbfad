// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/session/path_parameters.h"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include "core/error.h"
#include "core/expected.h"
#include "rf/gradient/changed_surfaces.h"

namespace greatx::engine {
namespace {

using Kind = rf::ChannelParameter::Kind;

struct MaterialField {
  Kind kind;
  const char *name, *unit, *description;
};
constexpr MaterialField layer_fields[] = {
    {Kind::permittivity, "permittivity", "1", "real part of the relative permittivity at the carrier"},
    {Kind::conductivity, "conductivity", "S/m", "conductivity at the carrier"},
    {Kind::thickness, "thickness", "m", "thickness"}};
constexpr MaterialField surface_fields[] = {
    {Kind::roughness, "roughness", "m", "rms height"},
    {Kind::scattering, "scattering", "1", "scattering coefficient S"},
    {Kind::cross_polarization, "cross_polarization", "1", "cross-polarization K_x of scattering"},
    {Kind::backscatter_share, "backscatter_share", "1", "share 1 - Lambda of the lobe back to the source"}};

/// Returns whether an effect that is off keeps the channel from depending on the parameter.
bool is_off(Kind kind, const rf::RadioEffects& effects) {
  if (kind == Kind::roughness) return !effects.field.roughness;
  if (kind == Kind::scattering) return !effects.scattering && !effects.field.scattering;
  return (kind == Kind::cross_polarization || kind == Kind::backscatter_share) && !effects.scattering;
}

class MaterialLister {
 public:
  MaterialLister(const rf::RadioModel& model, std::vector<PathParameter>& list)
      : model_(model), list_(list) {}

  void add_all() {
    std::set<uint32_t> met;
    for (size_t i = 0; i < model_.scene->facets.size(); ++i)
      if (model_.kinds[i] == rf::FacetKind::opaque || model_.kinds[i] == rf::FacetKind::wall)
        met.insert(model_.scene->facets[i].material);
    for (const uint32_t material : met) {
      const rf::RadioSurface& surface = model_.surfaces.surface(material);
      if (surface.front.empty()) continue;
      std::string name = model_.scene->materials[material].name;
      if (const int before = seen_[name]++; before > 0) name += fmt::format("#{}", before + 1);
      add_layers(name + ".", material, surface.front.size(), false);
      add_layers(name + ".windows.", material, surface.windows.front.size(), true);
      for (const MaterialField& field : surface_fields) add(name + ".", field, {field.kind, material});
    }
  }

 private:
  void add_layers(const std::string& name, uint32_t material, size_t layers, bool windows) {
    for (uint32_t layer = 0; layer < layers; ++layer) {
      const std::string prefix = layer == 0 ? name : fmt::format("{}layer{}.", name, layer + 1);
      for (const MaterialField& field : layer_fields)
        add(prefix, field, {.kind = field.kind, .index = material, .layer = layer, .windows = windows});
    }
  }
  void add(const std::string& prefix, const MaterialField& field, const rf::ChannelParameter& parameter) {
    const rf::RadioSurface& surface = model_.surfaces.surface(parameter.index);
    if (!rf::has_parameter(surface, parameter)) return;
    const bool off = is_off(field.kind, model_.effects);
    list_.push_back({fmt::format("material:{}{}", prefix, field.name),
                     field.unit,
                     fmt::format("{}{}", field.description, off ? "; its effect is off" : ""),
                     {},
                     PathParameter::Role::material,
                     false,
                     parameter,
                     {rf::parameter_value(surface, parameter, model_.surfaces.carrier_hz())}});
  }

  const rf::RadioModel& model_;
  std::vector<PathParameter>& list_;
  std::map<std::string, int> seen_;
};

std::vector<double> flat(const std::vector<dvec3>& rows) {
  std::vector<double> values;
  for (const dvec3& row : rows) values.insert(values.end(), {row.x, row.y, row.z});
  return values;
}

void add_end(const std::vector<dvec3>& positions, const std::vector<dvec3>& velocities,
             const std::vector<rf::AntennaArray>& arrays, bool receiver, std::vector<PathParameter>& list) {
  using Role = PathParameter::Role;
  if (positions.empty()) return;
  const std::string end = receiver ? "receiver" : "transmitter", axis = receiver ? "rx" : "tx";
  const auto count = static_cast<int64_t>(positions.size());
  const int64_t polarizations = arrays[0].polarization_count(), ports = arrays[0].port_count();
  const bool alike = std::ranges::all_of(arrays, [&](const rf::AntennaArray& array) {
    return array.polarization_count() == arrays[0].polarization_count();
  });
  list.push_back({end + ".position",
                  "m",
                  fmt::format("[{}, xyz] place of the antenna, world", axis),
                  {count, 3},
                  Role::position,
                  receiver,
                  {},
                  flat(positions)});
  list.push_back({end + ".velocity",
                  "m/s",
                  fmt::format("[{}, xyz] velocity, for the Doppler shift", axis),
                  {count, 3},
                  Role::velocity,
                  receiver,
                  {},
                  flat(velocities)});
  list.push_back(
      {end + ".attitude",
       "rad",
       fmt::format("[{}, xyz] turn of the antenna after its orientation, a vector along the axis", axis),
       {count, 3},
       Role::attitude,
       receiver,
       {},
       std::vector<double>(3 * positions.size())});
  std::vector<double> slants, gains;
  for (const rf::AntennaArray& array : arrays) {
    for (uint32_t p = 0; p < array.polarization_count(); ++p) slants.push_back(array.slant(p));
    for (uint32_t p = 0; p < array.port_count(); ++p) gains.insert(gains.end(), {1.0, 0.0});
  }
  if (alike)
    list.push_back({end + ".slant",
                    "rad",
                    fmt::format("[{}, polarization] slant of the polarization", axis),
                    {count, polarizations},
                    Role::slant,
                    receiver,
                    {},
                    slants});
  list.push_back({end + ".gain",
                  "1",
                  fmt::format("[{}, port] complex amplitude gain of the port", axis),
                  {count, ports, 2},
                  Role::gain,
                  receiver,
                  {},
                  gains});
}

}  // namespace

size_t PathParameter::row() const {
  size_t count = 1;
  for (size_t axis = 1; axis < shape.size(); ++axis) count *= static_cast<size_t>(shape[axis]);
  return count;
}

std::vector<PathParameter> path_parameters(const rf::RadioModel& model, const ChannelEndsAt& ends) {
  std::vector<PathParameter> list;
  MaterialLister(model, list).add_all();
  list.push_back({"carrier",
                  "Hz",
                  "carrier; materials and air follow their models",
                  {},
                  PathParameter::Role::carrier,
                  false,
                  {},
                  {model.surfaces.carrier_hz()}});
  add_end(ends.transmitter_positions, ends.transmitter_velocities, ends.transmitter_arrays, false, list);
  add_end(ends.receiver_positions, ends.receiver_velocities, ends.receiver_arrays, true, list);
  return list;
}

const PathParameter& find_parameter(const std::vector<PathParameter>& parameters, const std::string& name) {
  const auto at = std::ranges::find(parameters, name, &PathParameter::name);
  if (at != parameters.end()) return *at;
  std::vector<std::string> names;
  for (const PathParameter& parameter : parameters) names.push_back(parameter.name);
  throw_user_error("parameters: {}", expected_one_of(names, name));
}

std::string column_name(const PathParameter& parameter, size_t column) {
  return parameter.columns() == 3 ? fmt::format("{}.{}", parameter.name, "xyz"[column]) : parameter.name;
}

}  // namespace greatx::engine
