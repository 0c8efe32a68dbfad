// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A camera's picture by path tracing (path_tracer.h), and its comparison with the camera's own picture.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "renderer/camera/camera.h"
#include "renderer/light/lighting.h"
#include "renderer/reference/path_tracer.h"

namespace greatx::render {

struct ReferenceOptions {
  uint32_t samples = 64;  ///< paths a pixel
  PathOptions paths;
  uint64_t seed = 0;     ///< of the paths' random numbers
  uint32_t threads = 0;  ///< 0: all cores; their number changes no byte
};

/// All arrays are in C order, row 0 on top.
struct ReferencePicture {
  uint32_t width = 0, height = 0;
  std::vector<float> radiance;   ///< [height, width, 3] cd/m^2, the mean over the pixel's area
  std::vector<float> variance;   ///< [height, width] of that mean's luminance, estimated; (cd/m^2)^2
  std::vector<float> key_share;  ///< [height, width] of the luminance that is direct light of the key light
  std::vector<float> roughness;  ///< [height, width] mean over the pixel's area; 1 where it shows the sky
  std::vector<float> coverage;   ///< [height, width] share of the pixel that shows the scene
};

/// Traces a camera's picture at one instant. Paths begin evenly over each pixel's area and go through the
/// camera's lens. The bytes depend on the arguments alone. It may take long and reports to the watch
/// (core/watch.h).
ReferencePicture trace_reference(const scene::Scene& scene, std::span<const Pose> body_poses,
                                 const Lighting& lighting, const CameraEffects& effects,
                                 const CameraDesc& desc, const Pose& local_from_sensor,
                                 const ReferenceOptions& options);

/// Returns the picture [height, width, 3] in sRGB that a camera without noise and vignetting develops from
/// radiance (cd/m^2) at the luminance that saturates it.
std::vector<uint8_t> develop_radiance(std::span<const float> radiance, double saturation_cd_m2);

/// How far a picture's luminance lies from the reference's over some pixels, relative to the reference's mean
/// there. Luminance is cut at the one that saturates the sensor, in both.
struct ReferenceError {
  size_t pixels = 0;
  double rmse = 0.0;   ///< less the reference's own variance
  double bias = 0.0;   ///< mean difference
  double noise = 0.0;  ///< rms of the reference's own error
};
/// Compares radiance [height, width, 3] over the pixels for which counted[i] is not 0.
ReferenceError compare_with(const ReferencePicture& reference, std::span<const float> radiance,
                            std::span<const uint8_t> counted, double saturation_cd_m2);

}  // namespace greatx::render
