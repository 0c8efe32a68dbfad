// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/fit/transfer_slopes.h"

#include <algorithm>

namespace greatx::sim {
namespace {

rf::ChannelParameter channel_parameter(const FitParameter& parameter, uint32_t material) {
  using Kind = rf::ChannelParameter::Kind;
  constexpr Kind kinds[] = {Kind::permittivity,     Kind::conductivity, Kind::thickness,
                            Kind::roughness,        Kind::scattering,   Kind::cross_polarization,
                            Kind::backscatter_share};
  rf::ChannelParameter one;
  one.kind = kinds[static_cast<size_t>(parameter.property)];
  one.index = material;
  one.layer = parameter.layer;
  one.windows = parameter.windows;
  return one;
}

}  // namespace

TransferSlopes::TransferSlopes(const FitMaterials& materials, std::span<const FitParameter> parameters,
                               std::span<const double> values, bool slopes)
    : surfaces_(materials.surfaces(values)) {
  if (!slopes) return;
  for (size_t p = 0; p < parameters.size(); ++p) {
    std::vector<rf::ChannelParameter>& of = of_parameter_.emplace_back();
    for (const uint32_t material : materials.materials(p))
      of.push_back(channel_parameter(parameters[p], material));
  }
}

FitFields TransferSlopes::of(const FitLink& link) const {
  rf::FieldModel model = link.fields;
  model.surfaces = &surfaces_;
  FitFields fields;
  std::vector<rf::ChannelParameter> asked;
  for (const FitLink::Touched& touched : link.touched) {
    const rf::GeometricPath& path = link.paths[touched.path];
    rf::Complex transfer[4];
    rf::path_transfer(path, model, transfer);
    const rf::Complex& weight = touched.weight;
    fields.transfers.push_back(
        {weight * transfer[0], weight * transfer[1], weight * transfer[2], weight * transfer[3]});
    if (of_parameter_.empty()) continue;
    asked.clear();
    for (const uint32_t p : touched.parameters)
      asked.insert(asked.end(), of_parameter_[p].begin(), of_parameter_[p].end());
    const std::vector<rf::PathSlope> all = rf::path_slopes(path, model, dvec3(0.0), dvec3(0.0), asked);
    std::vector<FitTransfer>& slopes = fields.slopes.emplace_back();
    size_t next = 0;
    for (const uint32_t p : touched.parameters) {
      FitTransfer& sum = slopes.emplace_back();
      for (size_t m = 0; m < of_parameter_[p].size(); ++m, ++next)
        for (size_t e = 0; e < 4; ++e) sum[e] += weight * all[next].transfer[e];
    }
  }
  return fields;
}

}  // namespace greatx::sim
