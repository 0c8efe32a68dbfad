// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rf/field/field.h"
#include "rf/geometry/path.h"

namespace greatx::rf {

/// Names one real parameter on which a channel depends smoothly while its set of paths is fixed.
struct ChannelParameter {
  enum class Kind : uint8_t {
    permittivity,
    conductivity,
    thickness,
    roughness,
    scattering,
    cross_polarization,
    backscatter_share,
    transmitter_position,
    receiver_position,
    transmitter_velocity,
    receiver_velocity,
    transmitter_attitude,
    receiver_attitude,
    carrier,
  };
  Kind kind;
  uint32_t index = 0, layer = 0, axis = 0;
  bool windows = false;
};

/// The derivative of what Path holds by one parameter.
struct PathSlope {
  Complex transfer[4]{};
  double length_m = 0.0;
  double doppler_hz = 0.0;
  dvec3 departure{0.0}, arrival{0.0};
};

std::vector<PathSlope> path_slopes(const GeometricPath& geometry, const FieldModel& model,
                                   const dvec3& transmitter_velocity, const dvec3& receiver_velocity,
                                   std::span<const ChannelParameter> parameters);

}  // namespace greatx::rf
