// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/vec.h"
#include "sim/compare/error_statistics.h"

namespace greatx::render {
struct CameraDesc;
struct CameraImages;
}  // namespace greatx::render

namespace greatx::sim {

/// A depth picture of a pinhole camera, with ids where they were rendered.
struct DepthEvidence {
  uint32_t node = 0;  ///< that carries the camera
  Pose mount;         ///< body_from_sensor
  const render::CameraDesc* camera = nullptr;
  const render::CameraImages* images = nullptr;
};

/// The returns of a LiDAR whose shots were all taken at the tick, along the beams' axes and without noise.
struct ReturnEvidence {
  uint32_t node = 0;                               ///< that carries the LiDAR
  Pose mount;                                      ///< body_from_sensor
  std::span<const float> xyzi;                     ///< [4 n] in the LiDAR's frame
  std::span<const uint32_t> instances, materials;  ///< [n]
};

/// Everything about the record collected last by which a sensor can be compared with another one. A sensor
/// leaves out what it does not have. Pointers and spans hold until the sensor's next collect().
struct Evidence {
  std::optional<DepthEvidence> depth;
  std::optional<ReturnEvidence> returns;
  bool poses = false;       ///< the record is that of the poses of all nodes
  bool detections = false;  ///< the record has a radar's arrays range, power and instance
  const ErrorStatistics* pixels_against_rays = nullptr;  ///< of a picture, checked by its own camera
  const ErrorStatistics* delays_against_distances =
      nullptr;  ///< of direct paths, checked by their own channel
};

}  // namespace greatx::sim
