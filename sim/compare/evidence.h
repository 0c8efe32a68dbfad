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

/// Holds a depth picture of a pinhole camera, with ids if they were rendered.
struct DepthEvidence {
  uint32_t node = 0;  ///< the node that carries the camera
  Pose mount;         ///< body_from_sensor
  const render::CameraDesc* camera = nullptr;
  const render::CameraImages* images = nullptr;
};

/// The noise of a LiDAR's ranges: normal, with the variance std_m^2 + (rise_m NEP / P)^2 at the power P.
struct RangeNoise {
  double std_m = 0.0, rise_m = 0.0, noise_equivalent_power = 0.0;
  /// Returns six standard deviations at a power, m. Two returns in a thousand million are farther off.
  double bound_m(double power) const;
};

/// Holds the returns of a LiDAR whose shots were all taken at the tick, along the axes of the beams.
struct ReturnEvidence {
  uint32_t node = 0;                               ///< the node that carries the LiDAR
  Pose mount;                                      ///< body_from_sensor
  std::span<const float> xyzi;                     ///< [4 n] in the LiDAR's frame
  std::span<const uint32_t> instances, materials;  ///< [n]
  double error_m = 0.0;          ///< largest distance between a point and its rounded coordinates
  RangeNoise noise;              ///< along the beams
  std::span<const float> power;  ///< [n], as in the record; empty if there is no noise
};

/// Holds everything by which the record collected last can be compared with those of other sensors. A sensor
/// leaves out what it does not have. Pointers and spans are valid until the sensor's next collect().
struct Evidence {
  std::optional<DepthEvidence> depth;
  std::optional<ReturnEvidence> returns;
  bool poses = false;       ///< the record holds the poses of all nodes
  bool detections = false;  ///< the record has the arrays range, power and instance of a radar
  bool sensed = false;      ///< the record has detections of a channel that senses targets
  /// Errors of the depth of a picture, which its camera checks.
  const ErrorStatistics* pixels_against_rays = nullptr;
  /// Errors of the delays of direct paths, which their channel checks.
  const ErrorStatistics* delays_against_distances = nullptr;
};

}  // namespace greatx::sim
