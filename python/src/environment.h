// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A scenario's `environment`, changed field by field.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "sim/scenario/scenario.h"

namespace greatx::python {

/// Copies what `key` names, "fog_g_m3" or "sun.azimuth_deg". A place and a time say where sun and moon are,
/// so a sun by hand takes their place, and the other way round: whoever names one of the sun's angles names
/// both.
void change_environment(sim::Environment& to, const sim::Environment& from, const std::string& key);

/// place and time as a scenario writes them, {latitude_deg, longitude_deg, height_m, time}; null: none.
nlohmann::ordered_json place_facts(const sim::Environment& environment);

}  // namespace greatx::python
