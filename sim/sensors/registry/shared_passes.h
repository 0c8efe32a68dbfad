// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "renderer/light/lighting.h"
#include "renderer/probe/probe.h"
#include "rf/paths/crossings.h"
#include "scene/device/gpu_scene.h"
#include "sim/experiment/experiment.h"
#include "sim/world/posed_scene.h"

namespace greatx::sim {

/// Holds the passes that several sensors use. Only those that the plan needs exist; the others are null.
struct SharedPasses {
  /// The scene and the experiment outlive the passes.
  SharedPasses(scene::GpuScene& gpu_scene, const Experiment& experiment);

  std::unique_ptr<render::SceneLighting> lighting;  ///< for cameras of any kind
  std::unique_ptr<PosedScene> posed;                ///< exists if `lighting` does
  std::unique_ptr<render::ProbePass> probe;         ///< for the comparison of depth pictures with rays
  std::unique_ptr<rf::CrossingPass> crossings;      ///< for channels
};

}  // namespace greatx::sim
