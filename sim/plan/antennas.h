// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// From a scenario's antennas to arrays at a carrier, and what a data set says of them.
#pragma once

#include <initializer_list>
#include <span>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "rf/antenna/antenna.h"
#include "sim/scenario/scenario.h"

namespace greatx::sim {

/// The antenna called "node/sensor" in a scenario, at this carrier. It must exist.
rf::AntennaArray antenna_array(const Scenario& scenario, const std::string& name, double carrier_hz);

/// An array as data sets describe it: all that recomputing its response takes, but for the table of an
/// imported pattern, which is named by its hash.
nlohmann::json describe_array(const rf::AntennaArray& array);

/// The tables of those arrays at some ends that have imported patterns, by their hashes; an empty map if
/// there are none.
nlohmann::json describe_pattern_tables(std::initializer_list<std::span<const rf::AntennaArray>> ends);

}  // namespace greatx::sim
