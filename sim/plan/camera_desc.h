// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// From a camera of a scenario to what renderer/ is told to build.
#pragma once

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

}  // namespace greatx::sim
