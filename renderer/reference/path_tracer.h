// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Path tracing as a reference for the camera's approximations: the same scene, materials, lights and haze,
// without an approximation of the transport of light (J. Kajiya, "The Rendering Equation", SIGGRAPH 1986). At
// each point of a path, light is sampled towards the key light's disc, the sky and one lamp, and by the
// direction in which the path goes on; the balance heuristic joins them (E. Veach and L. Guibas, "Optimally
// Combining Sampling Techniques for Monte Carlo Rendering", SIGGRAPH 1995). The estimate is unbiased.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/vec.h"
#include "renderer/light/lighting.h"
#include "renderer/reference/outside_light.h"
#include "renderer/reference/path_draws.h"
#include "renderer/reference/ray_scene.h"
#include "scene/description/scene.h"

namespace greatx::render {

struct PathOptions {
  /// The reflections after the first one that a path may have. With 0, surfaces show the light of key light,
  /// sky, lamps and glowing surfaces that reaches them directly.
  uint32_t bounces = 16;
  /// Surfaces are at least this rough (perceptual roughness) to a path that was reflected before. 0 is
  /// unbiased. A larger value spreads the sharp spots of light that smooth surfaces throw on others, which
  /// need many paths, and keeps their energy (A. Kaplanyan and C. Dachsbacher, "Path Space Regularization for
  /// Holistic and Robust Light Transport", Computer Graphics Forum 32(2), 2013). Mirror images that the eye
  /// sees stay sharp.
  double later_roughness = 0.0;
  /// The factors of the switched lamps' emission (scene/description/lamps.h), in their order; empty: all
  /// shine in full.
  std::vector<float> lamp_factors;
};

/// The light of one path.
struct PathLight {
  dvec3 radiance{0.0};     ///< cd/m^2 towards the eye
  dvec3 key{0.0};          ///< the part that came from the key light's disc over the first surface alone
  double roughness = 1.0;  ///< of the first surface; 1 where there is none
  bool scene = false;      ///< whether the ray meets the scene
};

class PathTracer {
 public:
  /// `scene` outlives this. Stars and the moon's phase are left out: the sky is that of Sky.
  PathTracer(const scene::Scene& scene, std::span<const Pose> body_poses, const Lighting& lighting,
             const CameraEffects& effects, const PathOptions& options);

  /// Returns the light of one path along a camera's ray. What is nearer than `near_m`, and bodies of the
  /// owner `excluded`, are passed through by the first ray.
  PathLight trace(const Ray& ray, double near_m, PathDraws& draws,
                  std::optional<uint32_t> excluded = {}) const;

 private:
  class Path;
  dvec3 background(const dvec3& direction) const;
  dvec3 airlight(const dvec3& direction) const;

  CameraEffects effects_;
  PathOptions options_;
  Sky sky_;
  RayScene rays_;
  SkyLight sky_light_;
  DiscLight disc_;
  LampLight lamps_;
  bool shows_disc_ = false;
  dvec3 key_direction_;
  double haze_extinction_ = 0.0;
};

}  // namespace greatx::render
