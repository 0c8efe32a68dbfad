// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The whole tick of `greatx bench --suite`: all seven modalities over a scene of the suite, by the simulator
// that `greatx generate` runs, without files.
#pragma once

#include <cstdint>
#include <memory>

#include "apps/bench/suite_scene.h"
#include "gpu/device.h"

namespace greatx::apps {

/// Runs the ticks of a mast with a camera (320 x 240), an event camera that shares its pixels, a LiDAR
/// (64 x 1024 shots), a radar (77 GHz, 4 x 4 elements) and a channel to one receiver. The bodies of the scene
/// go to and fro.
class SuiteTick {
 public:
  static constexpr int64_t ticks_of_a_run = 2;

  /// Brings the scene to the device and finds the candidates of the channel. The device outlives this. Throws
  /// UserError where the device refuses.
  SuiteTick(gpu::Device& device, const SuiteScene& scene);
  ~SuiteTick();
  /// Runs `ticks_of_a_run` ticks; all of their packets are complete then.
  void run();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace greatx::apps
