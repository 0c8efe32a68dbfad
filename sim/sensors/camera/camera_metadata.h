// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes the metadata of cameras.
#pragma once

#include <nlohmann/json.hpp>

#include "core/vec.h"
#include "sim/scenario/scenario.h"

namespace greatx::sim {

/// Returns intrinsics, lens, frames and exposure, which a user needs to interpret the pictures
/// (docs/truth.md).
nlohmann::json camera_metadata(const CameraConfig& config, const Pose& body_from_sensor);
/// Returns the metadata that cameras and event cameras share.
nlohmann::json pinhole_metadata(const PinholeConfig& config, const Pose& body_from_sensor);

}  // namespace greatx::sim
