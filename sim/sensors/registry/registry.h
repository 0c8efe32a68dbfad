// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the table of the kinds of sensors in a run, which names the class of each kind. The simulator uses
// sensors only through the interface of sim/sensors/sensor.h.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/error.h"
#include "scene/device/gpu_scene.h"
#include "sim/experiment/experiment.h"
#include "sim/sensors/registry/radio_ahead.h"
#include "sim/sensors/registry/shared_passes.h"
#include "sim/sensors/sensor.h"

namespace greatx::sim {

/// Holds a sensor of a run with its rate.
struct RunSensor {
  std::unique_ptr<Sensor> sensor;
  std::optional<Rational> rate_hz;  ///< none: the sensor fires whenever another one does
  SourceLocation where;             ///< the place in the scenario; line 0: the scenario does not name it
};

/// Holds everything from which sensors are made. All but `radio` outlives them.
struct SensorParts {
  scene::GpuScene& gpu_scene;
  SharedPasses& passes;
  const Experiment& experiment;
  RadioAhead& radio;
};

/// Makes all sensors of a scenario in the order of their records: the poses, the sensors of the nodes in the
/// order of the scenario, and the channels. Throws UserError with the place in the scenario.
std::vector<RunSensor> make_sensors(const SensorParts& parts);

}  // namespace greatx::sim
