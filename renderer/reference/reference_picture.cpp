// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/reference/reference_picture.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/parallel.h"
#include "renderer/lens/lens.h"
#include "renderer/reference/path_draws.h"
#include "shaders/shared/develop.h"

namespace greatx::render {

namespace {

/// The rays of a camera's pixels.
class PixelRays {
 public:
  PixelRays(const CameraDesc& desc, const Pose& local_from_sensor) : desc_(desc), pose_(local_from_sensor) {
    if (desc.distortion.any()) lens_.emplace(lens_geometry(desc));
  }
  /// Returns the ray through pixel coordinates; `near_m` becomes the distance of the near plane along it.
  Ray through(const dvec2& place, double& near_m) const {
    const dvec2 at = lens_ ? lens_->undistorted(place)
                           : dvec2((place.x - desc_.cx) / desc_.fx, (place.y - desc_.cy) / desc_.fy);
    const dvec3 ray(1.0, -at.x, -at.y);  // optical axes to x forward, y left, z up
    near_m = desc_.near_m * glm::length(ray);
    return {pose_.position, glm::normalize(pose_.rotate(ray))};
  }

 private:
  const CameraDesc& desc_;
  Pose pose_;
  std::optional<Lens> lens_;
};

double cut_luminance(std::span<const float> radiance, size_t pixel, double most) {
  return std::min(luminance(dvec3(radiance[3 * pixel], radiance[3 * pixel + 1], radiance[3 * pixel + 2])),
                  most);
}

}  // namespace

ReferencePicture trace_reference(const scene::Scene& scene, std::span<const Pose> body_poses,
                                 const Lighting& lighting, const CameraEffects& effects,
                                 const CameraDesc& desc, const Pose& local_from_sensor,
                                 const ReferenceOptions& options) {
  GREATX_CHECK(options.samples > 0, "{} paths a pixel", options.samples);
  const PathTracer tracer(scene, body_poses, lighting, effects, options.paths);
  const PixelRays rays(desc, local_from_sensor);
  ReferencePicture picture;
  picture.width = desc.width;
  picture.height = desc.height;
  const size_t pixels = size_t{desc.width} * desc.height;
  picture.radiance.resize(3 * pixels);
  for (std::vector<float>* each :
       {&picture.variance, &picture.key_share, &picture.roughness, &picture.coverage})
    each->resize(pixels);
  WorkStage stage("reference");
  stage.expect(desc.height);
  parallel_for(desc.height, options.threads, [&](size_t row) {
    for (uint32_t column = 0; column < desc.width; ++column) {
      const auto pixel = static_cast<uint32_t>(row * desc.width + column);
      dvec3 sum(0.0);
      double squares = 0.0, mean = 0.0, key = 0.0, roughness = 0.0, coverage = 0.0;
      for (uint32_t sample = 0; sample < options.samples; ++sample) {
        double near_m = 0.0;
        PathDraws draws(options.seed, pixel, sample);
        const double x = draws.next(), y = draws.next();
        const Ray ray = rays.through({column + x, double(row) + y}, near_m);
        const PathLight light = tracer.trace(ray, near_m, draws, desc.excluded_body);
        sum += light.radiance;
        // Welford's running sum of squares keeps its digits.
        const double value = luminance(light.radiance), away = value - mean;
        mean += away / (sample + 1.0);
        squares += away * (value - mean);
        key += luminance(light.key);
        roughness += light.roughness;
        coverage += light.scene ? 1.0 : 0.0;
      }
      const double n = options.samples;
      for (int c = 0; c < 3; ++c) picture.radiance[3 * size_t{pixel} + c] = float(sum[c] / n);
      picture.variance[pixel] = n > 1.0 ? float(squares / (n * (n - 1.0))) : 0.0f;
      picture.key_share[pixel] = mean > 0.0 ? float(key / n / mean) : 0.0f;
      picture.roughness[pixel] = float(roughness / n);
      picture.coverage[pixel] = float(coverage / n);
    }
    stage.add(1);
  });
  return picture;
}

std::vector<uint8_t> develop_radiance(std::span<const float> radiance, double saturation_cd_m2) {
  std::vector<uint8_t> rgb(radiance.size());
  for (size_t i = 0; i + 2 < radiance.size(); i += 3) {
    const vec3 mapped =
        shared::tone_map(vec3(radiance[i], radiance[i + 1], radiance[i + 2]) * float(1.0 / saturation_cd_m2));
    for (int c = 0; c < 3; ++c) rgb[i + c] = static_cast<uint8_t>(shared::srgb_byte(mapped[c]));
  }
  return rgb;
}

ReferenceError compare_with(const ReferencePicture& reference, std::span<const float> radiance,
                            std::span<const uint8_t> counted, double saturation_cd_m2) {
  GREATX_CHECK(radiance.size() == reference.radiance.size() && 3 * counted.size() == radiance.size(),
               "{} values for a reference of {}", radiance.size(), reference.radiance.size());
  ReferenceError error;
  double squares = 0.0, sum = 0.0, difference = 0.0, variance = 0.0;
  for (size_t i = 0; i < counted.size(); ++i) {
    if (counted[i] == 0) continue;
    const double expected = cut_luminance(reference.radiance, i, saturation_cd_m2);
    const double away = cut_luminance(radiance, i, saturation_cd_m2) - expected;
    squares += away * away;
    difference += away;
    sum += expected;
    // A mean that is cut has less variance than the paths that make it.
    variance += expected < saturation_cd_m2 ? double(reference.variance[i]) : 0.0;
    ++error.pixels;
  }
  if (error.pixels == 0 || !(sum > 0.0)) return error;
  const double n = double(error.pixels), mean = sum / n;
  error.noise = std::sqrt(variance / n) / mean;
  error.rmse = std::sqrt(std::max(squares - variance, 0.0) / n) / mean;
  error.bias = difference / n / mean;
  return error;
}

}  // namespace greatx::render
