// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes how a path changes with the parameters of a channel, while its interactions stay what they are.
//
//   path, parameters ─► those that the path depends on, four at a time
//     positions ─► dual_vertices() ─┐
//     materials, carrier ───────────┴─► path_values<Dual>() ─► PathSlope
//
// The derivatives are exact, in fp64: path_values() of rf/field is computed with dual numbers (core/dual.h).
// There is one text of the physics, and the values beside the derivatives are those of path_field(), bit by
// bit. They cover every effect that path_field() knows: reflection, transmission, roughness, scattering,
// diffraction at one and two edges and at ends of edges, finite reflectors, gas, rain, fog.
//
// Where a derivative is one-sided, or is not what it seems:
// - Depth of foliage. GeometricPath holds it without the faces where the path enters and leaves. It counts as
//   a constant: slopes by positions lack what its change adds, (d depth) x (field per metre of foliage).
// - Branches follow the value. At the reflection or shadow boundary of an edge the derivative is that of the
//   side on which the path counts (EdgeSides), and so it is where Luebbers' choice of the nearer face
//   changes, where an angle is clamped, at 14 m of foliage, and where a reflection point lies on the outline
//   of a finite reflector.
// - At normal incidence, and for directions along +-z (where theta and phi are a convention), the basis is
//   held fixed. At normal incidence the field does not depend on it.
// - The draw of scattering patches, the panels of a facet and their areas do not move with an end.
// - Attitudes change antennas only: the slopes by them are 0.
// - K_x = 0 or 1 of a patch that scatters, and S = 1 where a reflection loses what scatters: the field goes
//   as a square root there, and its derivative is infinite. This is refused.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rf/field/field.h"
#include "rf/gradient/carrier_slopes.h"

namespace greatx::rf {

/// Names one real parameter on which a channel depends smoothly while its set of paths is fixed.
struct ChannelParameter {
  enum class Kind : uint8_t {
    // Of the material `index`; the first three of its layer `layer`, in the order of RadioMaterial::layers,
    // or of RadioWindows::layers if `windows`.
    permittivity,        ///< eta' at the carrier
    conductivity,        ///< at the carrier, S/m: eta'' = sigma/(eps_0 omega)
    thickness,           ///< m
    roughness,           ///< rms height, m
    scattering,          ///< S
    cross_polarization,  ///< K_x
    backscatter_share,   ///< 1 - Lambda
    // Of an end; `axis` 0, 1, 2 is x, y, z of the world.
    transmitter_position,  ///< m
    receiver_position,     ///< m
    transmitter_velocity,  ///< m/s; changes the Doppler shift only
    receiver_velocity,     ///< m/s
    transmitter_attitude,  ///< rad: a small turn about the world's axis, after the orientation
    receiver_attitude,     ///< rad
    carrier,               ///< Hz; materials, gas, rain, fog and foliage follow their models over frequency
  };
  Kind kind = Kind::permittivity;
  uint32_t index = 0, layer = 0, axis = 0;
  bool windows = false;
  friend bool operator==(const ChannelParameter&, const ChannelParameter&) = default;
};

/// Holds the derivatives of what Path holds by one parameter.
struct PathSlope {
  Complex transfer[4]{};  ///< of Path::transfer, which has no factor e^{-j 2 pi f tau}
  double length_m = 0.0;
  double doppler_hz = 0.0;
  dvec3 departure{0.0}, arrival{0.0};
};

/// Returns [parameters] the slopes of path_field() for a path that `model` and its world admit. `carrier`
/// says how the model changes with the carrier, and must be given if the carrier is a parameter.
///
/// Throws UserError naming the parameter if its material, layer or axis does not exist, if a thickness is
/// that of a half-space, if a derivative is infinite (see above), or if `carrier` is missing; and
/// ContractError for what path_field() refuses, such as a path over a target, whose legs are two paths.
std::vector<PathSlope> path_slopes(const GeometricPath& geometry, const FieldModel& model,
                                   const dvec3& transmitter_velocity, const dvec3& receiver_velocity,
                                   std::span<const ChannelParameter> parameters,
                                   const CarrierSlopes* carrier = nullptr);

}  // namespace greatx::rf
