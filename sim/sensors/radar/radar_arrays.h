// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What a radar writes: its arrays, what they mean, and how they are filled.
#pragma once

#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/record.h"
#include "rf/radar/signal/radar_processor.h"
#include "sim/scenario/radar.h"

namespace greatx::sim {

/// Adds arrays and files.
void describe_radar(const RadarConfig& config, const rf::RadarProcessor& processor, SensorSpec& spec);
/// The arrays of one frame, in the order described.
std::vector<Array> radar_arrays(const RadarConfig& config, const rf::RadarProcessor& processor,
                                const rf::RadarFrame& frame);
nlohmann::json radar_metadata(const RadarConfig& config, const rf::RadarProcessor& processor);

}  // namespace greatx::sim
