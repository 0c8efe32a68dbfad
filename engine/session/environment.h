// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Changes a scenario's `environment` field by field.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "sim/scenario/scenario.h"

namespace greatx::engine {

/// Copies the field that `key` names, e.g. "fog_g_m3" or "sun.azimuth_deg". Place and time determine the
/// positions of the sun and the moon, so angles of the sun replace place and time, and place and time replace
/// the angles. A caller that names one angle of the sun must name both.
void change_environment(sim::Environment& to, const sim::Environment& from, const std::string& key);

/// Returns place and time as a scenario states them, {latitude_deg, longitude_deg, height_m, time}, or null
/// if the environment has none.
nlohmann::ordered_json place_facts(const sim::Environment& environment);

/// Returns the georeference of the scene, {latitude_deg, longitude_deg, height_m, undulation_m,
/// vertical_datum}, or null if it has none.
nlohmann::ordered_json reference_facts(const sim::SceneConfig& scene);

}  // namespace greatx::engine
