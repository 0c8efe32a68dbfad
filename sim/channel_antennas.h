// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// From a scenario's antennas to arrays at a carrier, and what a data set says of them.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "rf/antenna/antenna.h"
#include "sim/scenario.h"

namespace greatx::sim {

/// The antenna called "node/sensor" in a scenario, at this carrier. It must exist.
rf::AntennaArray antenna_array(const Scenario& scenario, const std::string& name, double carrier_hz);

/// All that recomputing the array's response takes.
nlohmann::json describe_array(const rf::AntennaArray& array);

}  // namespace greatx::sim
