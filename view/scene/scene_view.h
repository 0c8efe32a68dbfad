// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The picture of the main view: the same scene, lights and camera pass as those of the sensors, on a thread
// and a device of its own. A tick of a rig may take the simulation's device for longer than a frame of the
// window, so the picture does not wait in its queue; the price is a second upload of the scene.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "draw/paths/view.h"
#include "gpu/device.h"
#include "sim/experiment/experiment.h"
#include "sim/world/moment.h"

namespace greatx::view {

/// Asks for a picture.
struct SceneRequest {
  apps::PictureView view;
  uint32_t sequence = 0;
  int64_t tick = 0;
  std::optional<uint32_t> excluded_body;  ///< that the camera sits on, if it does not see it
  bool fine = false;  ///< antialiased; otherwise one sample for each pixel, for a view that moves
};

/// Holds a picture and the request that it answers. Nobody changes it once it is published.
struct ScenePicture {
  SceneRequest request;
  std::vector<uint8_t> rgb;        ///< [height, width, 3]
  std::vector<float> depth;        ///< [height, width] planar, m; infinity: sky
  std::vector<uint32_t> instance;  ///< [height, width] index into the scene's instances + 1; 0: sky
  std::vector<uint16_t> material;  ///< [height, width] index into the scene's materials + 1; 0: sky
  std::vector<Pose> bodies;        ///< local coordinates, at the tick
  std::vector<Motion> nodes;       ///< world, at the tick
  double milliseconds = 0.0;       ///< wall time of the picture
};

class SceneView {
 public:
  /// Starts the thread, which uploads the scene. The experiment has a picture plan of its own. If the device
  /// fails, it is opened anew, once for each picture. `lost_at`, for tests: the device is lost on purpose
  /// when it is to draw for the n-th time, counted from 0.
  SceneView(std::shared_ptr<const sim::Experiment> experiment, gpu::DeviceOptions device,
            std::vector<uint64_t> lost_at = {});
  ~SceneView();
  SceneView(const SceneView&) = delete;
  SceneView& operator=(const SceneView&) = delete;

  /// Replaces the request that waits, if there is one: the newest wins.
  void look(const SceneRequest& request);
  /// Returns the newest picture; null before the first one.
  std::shared_ptr<const ScenePicture> picture() const;
  /// Returns the message of the error that ended the thread; empty if it works.
  std::string error() const;
  /// Returns a number that changes whenever picture() or error() would return something new.
  uint64_t version() const;

 private:
  class Worker;
  std::unique_ptr<Worker> worker_;
};

}  // namespace greatx::view
