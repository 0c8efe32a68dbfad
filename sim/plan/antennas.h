// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Converts the antennas of a scenario to arrays at a carrier, and describes the arrays in the metadata of a
// data set.
#pragma once

#include <initializer_list>
#include <span>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "rf/antenna/antenna.h"
#include "sim/scenario/scenario.h"

namespace greatx::sim {

/// Returns the array of the antenna called "node/sensor" in a scenario, at this carrier. The antenna must
/// exist.
rf::AntennaArray antenna_array(const Scenario& scenario, const std::string& name, double carrier_hz);

/// Describes an array for a data set. The description suffices to compute the response of the array again; an
/// imported pattern is named by the hash of its table, which describe_pattern_tables() describes.
nlohmann::json describe_array(const rf::AntennaArray& array);

/// Describes the pattern tables of all arrays at these ends that have imported patterns, by hash. The result
/// is an empty map if there are none.
nlohmann::json describe_pattern_tables(std::initializer_list<std::span<const rf::AntennaArray>> ends);

}  // namespace greatx::sim
