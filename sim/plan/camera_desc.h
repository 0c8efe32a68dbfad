// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Converts a camera of a scenario to the descriptions that renderer/ takes.
#pragma once

#include "renderer/camera/camera.h"
#include "renderer/camera/truth.h"
#include "sim/scenario/scenario.h"

namespace greatx::sim {

/// Copies size and intrinsics, whose members have the same names in every description of a picture.
template <typename Picture>
void set_intrinsics(Picture& to, const PinholeConfig& from) {
  to.width = from.width;
  to.height = from.height;
  to.fx = from.fx;
  to.fy = from.fy;
  to.cx = from.cx;
  to.cy = from.cy;
}
/// Returns size, intrinsics and lens of a camera or an event camera; null for any other sensor.
const PinholeConfig* pinhole_config(const SensorConfig& sensor);
/// Sets the members that cameras and event cameras share: intrinsics, nearest depth, antialiasing, lens
/// distortion.
void set_pinhole(render::CameraDesc& desc, const PinholeConfig& config);

/// Returns the description of a camera. `body` is the body that carries the camera; 0: none.
render::CameraDesc camera_desc(const Scenario& scenario, const NodeConfig& node, const SensorConfig& sensor,
                               uint32_t body);
/// Returns the outputs of a camera that need a TruthPass: normals, depth along the ray, flow.
render::TruthOutputs truth_outputs(const CameraConfig& config);
/// Returns whether the event camera needs the instance that each pixel sees, or its motion.
bool needs_seen(const EventCameraConfig& config);
/// Returns whether the event camera reconstructs instants from its pictures.
bool needs_cells(const EventCameraConfig& config);

}  // namespace greatx::sim
