// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads and changes the parameters of materials as a wave of one carrier meets them.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "rf/gradient/path_slopes.h"
#include "rf/surface/surfaces.h"

namespace greatx::rf {

/// Gives a parameter of a material another value.
struct MaterialValue {
  ChannelParameter parameter;  ///< of the kinds permittivity to backscatter_share
  double value = 0.0;
};

/// Tells whether a material has this parameter: whether it has the layer, a thickness if that is asked for (a
/// half-space has none), or windows.
bool has_parameter(const RadioSurface& surface, const ChannelParameter& parameter);
/// Returns the value. The surface must have the parameter.
double parameter_value(const RadioSurface& surface, const ChannelParameter& parameter, double carrier_hz);

/// Returns surfaces with other values, [materials] of them, from both sides of each wall. The permittivity of
/// a layer is eta' - j sigma/(eps_0 omega) at the carrier (P.2040-4, eq. 9b). Throws UserError, which calls
/// the parameter by `name_of`, if a value is out of range: eta' from 1e-3 up, sigma, thickness and roughness
/// from 0 (a thickness above 0), S, K_x and the share from 0 to 1.
RadioSurfaces changed_surfaces(const RadioSurfaces& surfaces, size_t materials,
                               std::span<const MaterialValue> values,
                               const std::function<std::string(const ChannelParameter&)>& name_of);

}  // namespace greatx::rf
