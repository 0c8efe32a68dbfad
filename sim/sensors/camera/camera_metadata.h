// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The metadata of what cameras deliver.
#pragma once

#include <nlohmann/json.hpp>

#include "core/vec.h"
#include "sim/scenario/scenario.h"

namespace greatx::sim {

/// Intrinsics, lens, frames and exposure: what a user needs to make sense of the pictures (docs/truth.md).
nlohmann::json camera_metadata(const CameraConfig& config, const Pose& body_from_sensor);
/// Of a camera or an event camera.
nlohmann::json pinhole_metadata(const PinholeConfig& config, const Pose& body_from_sensor);

}  // namespace greatx::sim
