// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Declares, documents and fills the arrays of a radar.
#pragma once

#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/record.h"
#include "rf/radar/signal/radar_processor.h"
#include "sim/scenario/radar.h"

namespace greatx::sim {

/// Adds the arrays and files of a radar to the spec.
void describe_radar(const RadarConfig& config, const rf::RadarProcessor& processor, SensorSpec& spec);
/// Returns the arrays of one frame in the order described.
std::vector<Array> radar_arrays(const RadarConfig& config, const rf::RadarProcessor& processor,
                                const rf::RadarFrame& frame);
/// Returns the waveform, the arrays and the axes of a radar.
nlohmann::json radar_metadata(const RadarConfig& config, const rf::RadarProcessor& processor);

}  // namespace greatx::sim
