// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Names the parameters by which the paths of a channel and their sums are differentiated.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/vec.h"
#include "rf/antenna/antenna.h"
#include "rf/gradient/path_slopes.h"
#include "rf/paths/path_solver.h"
#include "rf/paths/radio_model.h"
#include "rf/surface/surfaces.h"

namespace greatx::engine {

/// Describes a parameter as callers see it: a number, or an array with a row for each end.
struct PathParameter {
  enum class Role : uint8_t { material, carrier, position, velocity, attitude, slant, gain };
  std::string name;  ///< "material:concrete.permittivity", "receiver.position", ...
  std::string unit, description;
  std::vector<int64_t> shape;  ///< [] or [ends, ...]; a gain has a last axis of (re, im)
  Role role = Role::material;
  bool of_receiver = false;
  rf::ChannelParameter of_material{};  ///< for Role::material
  std::vector<double> values;          ///< of the channel as it was solved, C order

  /// Returns the number of values of one end, or of the number: 3 for a position.
  size_t row() const;
  /// Returns the number of columns in a Jacobian: those of the link's own end. A slant has one column, that
  /// of the port's own polarization, and a gain one, that of the port itself.
  size_t columns() const { return role == Role::slant || role == Role::gain ? 1 : row(); }
};

/// Describes the ends of all links of a channel.
struct ChannelEndsAt {
  std::vector<dvec3> transmitter_positions, receiver_positions;    ///< world, m
  std::vector<dvec3> transmitter_velocities, receiver_velocities;  ///< m/s, world axes
  std::vector<rf::AntennaArray> transmitter_arrays, receiver_arrays;
};

/// Returns every parameter of a channel. Of the materials, those of facets that waves meet are listed. Slants
/// are left out if the antennas of one side differ in their number of polarizations.
std::vector<PathParameter> path_parameters(const rf::RadioModel& model, const ChannelEndsAt& ends);

/// Returns the parameter of a name. Throws UserError, which names the nearest one.
const PathParameter& find_parameter(const std::vector<PathParameter>& parameters, const std::string& name);

/// Returns the name of column `column` of a Jacobian: the parameter's, with ".x" for a component.
std::string column_name(const PathParameter& parameter, size_t column);

}  // namespace greatx::engine
