// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// STAND-IN by differences until helper G's exact slopes are merged. Never ships.
#include "rf/gradient/path_slopes.h"

#include "rf/gradient/changed_surfaces.h"
#include "rf/gradient/path_continuation.h"

namespace greatx::rf {

std::vector<PathSlope> path_slopes(const GeometricPath& geometry, const FieldModel& model,
                                   const dvec3& transmitter_velocity, const dvec3& receiver_velocity,
                                   std::span<const ChannelParameter> parameters) {
  using Kind = ChannelParameter::Kind;
  std::vector<PathSlope> out;
  for (const ChannelParameter& p : parameters) {
    uint32_t materials = 0;
    for (uint32_t f = 0; f < model.world->facet_count(); ++f)
      materials = std::max(materials, model.world->facet(f).material + 1);
    double step = 1e-3;
    if (p.kind <= Kind::backscatter_share)
      step = 1e-3 * std::max(1e-3, parameter_value(model.surfaces->surface(p.index), p,
                                                   model.surfaces->carrier_hz()));
    const auto at = [&](double by) {
      FieldModel changed = model;
      std::optional<RadioSurfaces> surfaces;
      dvec3 tx = geometry.vertices.front(), rx = geometry.vertices.back(), vt = transmitter_velocity,
            vr = receiver_velocity;
      const int x = static_cast<int>(p.axis);
      if (p.kind <= Kind::backscatter_share) {
        const MaterialValue value{
            p, by + parameter_value(model.surfaces->surface(p.index), p, model.surfaces->carrier_hz())};
        surfaces = changed_surfaces(*model.surfaces, materials, {&value, 1},
                                    [](const auto&) { return std::string(); });
        changed.surfaces = &*surfaces;
      }
      if (p.kind == Kind::transmitter_position) tx[x] += by;
      if (p.kind == Kind::receiver_position) rx[x] += by;
      if (p.kind == Kind::transmitter_velocity) vt[x] += by;
      if (p.kind == Kind::receiver_velocity) vr[x] += by;
      return path_field(continued_path(geometry, *model.world, model.wedges, tx, rx).path, changed, vt, vr);
    };
    const auto central = [&](double h) {
      const Path a = at(h), b = at(-h);
      PathSlope s;
      for (int i = 0; i < 4; ++i) s.transfer[i] = (a.transfer[i] - b.transfer[i]) / (2 * h);
      s.length_m = (a.length_m - b.length_m) / (2 * h);
      s.doppler_hz = (a.doppler_hz - b.doppler_hz) / (2 * h);
      s.departure = (a.departure - b.departure) / (2 * h);
      s.arrival = (a.arrival - b.arrival) / (2 * h);
      return s;
    };
    const PathSlope wide = central(step), half = central(step / 2);
    PathSlope s;
    for (int i = 0; i < 4; ++i) s.transfer[i] = (4.0 * half.transfer[i] - wide.transfer[i]) / 3.0;
    s.length_m = (4 * half.length_m - wide.length_m) / 3;
    s.doppler_hz = (4 * half.doppler_hz - wide.doppler_hz) / 3;
    s.departure = (4.0 * half.departure - wide.departure) / 3.0;
    s.arrival = (4.0 * half.arrival - wide.arrival) / 3.0;
    out.push_back(s);
  }
  return out;
}

}  // namespace greatx::rf
