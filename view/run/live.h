// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs a scenario for the viewer. A tick that it shows has the bytes that `greatx generate` writes.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "gpu/device.h"
#include "sim/experiment/experiment.h"
#include "view/run/record_store.h"
#include "view/run/run.h"

namespace greatx::view {

struct LiveOptions {
  /// Returns the scenario. It is called once, on the run's thread; what it throws becomes status().error.
  std::function<sim::Scenario()> scenario;
  /// The experiment before a change of its scenario; its world is used again if it is the same one. Null:
  /// none.
  std::shared_ptr<const sim::Experiment> before;
  gpu::DeviceOptions device;
  bool paused = false;  ///< shows the first tick and waits; otherwise it plays from the beginning
  uint64_t kept_bytes = most_kept_bytes;  ///< of the records that it keeps, to show them again
};

/// A live run. `newest` of a ShownTick holds a record that is older than the tick only if no newer one of its
/// sensor is due up to the tick, and the run has seen it and still keeps it. A tick that it keeps is shown
/// again without simulating it.
class LiveRun : public Run {
 public:
  /// Returns the experiment as soon as its scene is loaded, before the simulator is ready; null before that.
  /// Constant afterwards.
  virtual std::shared_ptr<const sim::Experiment> experiment() const = 0;
};

/// Starts the run's thread. The destructor stops it: at once while it searches paths or waits, else when the
/// present tick, or the present step of loading, is done.
std::unique_ptr<LiveRun> live_run(LiveOptions options);

}  // namespace greatx::view
