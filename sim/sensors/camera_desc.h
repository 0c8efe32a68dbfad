// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// From a camera of a scenario to what renderer/ is told to build, and to the metadata of its data.
#pragma once

#include <nlohmann/json.hpp>

#include "renderer/camera/camera.h"
#include "renderer/camera/truth.h"
#include "sim/scenario/scenario.h"

namespace greatx::sim {

/// Size and intrinsics, which every description of a picture calls the same.
template <typename Picture>
void set_intrinsics(Picture& to, const PinholeConfig& from) {
  to.width = from.width;
  to.height = from.height;
  to.fx = from.fx;
  to.fy = from.fy;
  to.cx = from.cx;
  to.cy = from.cy;
}
/// Of a camera or an event camera: size, intrinsics, lens; null: another sensor.
const PinholeConfig* pinhole_config(const SensorConfig& sensor);
/// What cameras and event cameras share: intrinsics, the nearest depth, antialiasing, the lens's distortion.
void set_pinhole(render::CameraDesc& desc, const PinholeConfig& config);

/// `body`: that carries the camera; 0: none.
render::CameraDesc camera_desc(const Scenario& scenario, const NodeConfig& node, const SensorConfig& sensor,
                               uint32_t body);
render::TruthOutputs truth_outputs(const CameraConfig& config);
/// Whether events need what pixels see: their instances, or how it moves.
bool needs_seen(const EventCameraConfig& config);

/// Intrinsics, lens, frames and exposure: what a user needs to make sense of the pictures (docs/truth.md).
nlohmann::json camera_metadata(const CameraConfig& config, const Pose& body_from_sensor);
/// Of a camera or an event camera.
nlohmann::json pinhole_metadata(const PinholeConfig& config, const Pose& body_from_sensor);

}  // namespace greatx::sim
