// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Estimates what a camera sees, by rays on the host.
#pragma once

#include <string>
#include <vector>

#include "sim/experiment/experiment.h"
#include "sim/world/tick_context.h"

namespace greatx::sim {

struct CameraView {
  std::string name;
  uint32_t node = 0, body = 0;
  Pose mount;
  std::vector<dvec3> directions;  ///< of the rays, in the frame of the sensor
};

/// Shares of the rays, 0 to 1, exactly 1 if every ray is one.
struct ViewShares {
  double sky = 0.0;
  /// On ground, road, pavement, marking or water, or on a surface without a class that faces up.
  double ground = 0.0;
};

/// Returns the cameras and event cameras of an experiment, with rays through a grid of 24 x 18 places of
/// their pictures, as if the lens did not distort.
std::vector<CameraView> camera_views(const Experiment& experiment);
ViewShares view_shares(const World& world, const CameraView& view, const TickContext& context);

}  // namespace greatx::sim
