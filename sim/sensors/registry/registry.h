// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The table of the kinds of sensors that a run can have: which class makes each. The simulator sees its
// sensors through the interface of sim/sensors/sensor.h alone.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/error.h"
#include "scene/device/gpu_scene.h"
#include "sim/experiment/experiment.h"
#include "sim/sensors/registry/shared_passes.h"
#include "sim/sensors/sensor.h"

namespace greatx::sim {

/// A sensor of a run, and when it fires.
struct RunSensor {
  std::unique_ptr<Sensor> sensor;
  std::optional<Rational> rate_hz;  ///< none: it fires whenever another one does
  SourceLocation where;             ///< in the scenario; line 0: the scenario does not name it
};

/// Everything that sensors are made from. All of it outlives them.
struct SensorParts {
  scene::GpuScene& gpu_scene;
  SharedPasses& passes;
  const Experiment& experiment;
};

/// All sensors of a scenario in the order of their records: the poses, the sensors of the nodes as the
/// scenario lists them, the channels. Throws UserError, with the place in the scenario.
std::vector<RunSensor> make_sensors(const SensorParts& parts);

}  // namespace greatx::sim
