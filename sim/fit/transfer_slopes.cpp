// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/fit/transfer_slopes.h"

#include <algorithm>
#include <cmath>

namespace greatx::sim {
namespace {

constexpr double relative_step = 1e-5, least_step = 1e-7;

/// The range in which a property has a meaning.
std::pair<double, double> range_of(FitProperty property) {
  switch (property) {
    case FitProperty::permittivity: return {1.0, INFINITY};
    case FitProperty::thickness: return {1e-9, INFINITY};
    case FitProperty::conductivity:
    case FitProperty::roughness: return {0.0, INFINITY};
    default: return {0.0, 1.0};
  }
}

FitTransfer transfer_of(const rf::GeometricPath& path, rf::FieldModel& model,
                        const rf::RadioSurfaces& surfaces) {
  rf::Complex transfer[4];
  model.surfaces = &surfaces;
  rf::path_transfer(path, model, transfer);
  return {transfer[0], transfer[1], transfer[2], transfer[3]};
}

}  // namespace

TransferSlopes::TransferSlopes(const FitMaterials& materials, std::span<const FitProperty> properties,
                               std::span<const double> values, bool slopes)
    : surfaces_(materials.surfaces(values)) {
  if (!slopes) return;
  std::vector<double> moved(values.begin(), values.end());
  for (size_t p = 0; p < values.size(); ++p) {
    const auto [low, high] = range_of(properties[p]);
    const double step = std::max(least_step, relative_step * std::abs(values[p]));
    const double below = std::max(low, values[p] - step), above = std::min(high, values[p] + step);
    moved[p] = below;
    rf::RadioSurfaces at_below = materials.surfaces(moved);
    moved[p] = above;
    steps_.push_back({std::move(at_below), materials.surfaces(moved), above - below});
    moved[p] = values[p];
  }
}

FitFields TransferSlopes::of(const FitLink& link) const {
  rf::FieldModel model = link.fields;
  FitFields fields;
  for (const FitLink::Touched& touched : link.touched) {
    const rf::GeometricPath path = geometry_of(link.paths[touched.path]);
    fields.transfers.push_back(transfer_of(path, model, surfaces_));
    if (steps_.empty()) continue;
    std::vector<FitTransfer>& slopes = fields.slopes.emplace_back();
    for (const uint32_t p : touched.parameters) {
      const FitTransfer below = transfer_of(path, model, steps_[p].below),
                        above = transfer_of(path, model, steps_[p].above);
      FitTransfer& slope = slopes.emplace_back();
      for (size_t e = 0; e < 4; ++e) slope[e] = (above[e] - below[e]) / steps_[p].width;
    }
  }
  return fields;
}

}  // namespace greatx::sim
