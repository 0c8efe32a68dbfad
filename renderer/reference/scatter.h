// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reflection at one point of a surface, and directions drawn by it. The values are those of
// shaders/shared/brdf.h; the narrow peak of the lobe is computed in fp64.
#pragma once

#include "core/vec.h"
#include "renderer/reference/ray_scene.h"
#include "shaders/shared/brdf.h"

namespace greatx::render {

class Scatter {
 public:
  /// `to_eye` is unit. Without `specular` the surface is Lambertian.
  Scatter(const RaySurface& surface, const dvec3& to_eye, bool specular);

  /// Returns the part of the light from a unit direction that goes to the eye, 1/sr, times the cosine of its
  /// angle with the normal. It is 0 from below the surface.
  dvec3 reflected(const dvec3& to_light) const;
  /// Draws a direction from three numbers in [0, 1): the cosine's law for the diffuse part, and half vectors
  /// by GGX for the lobe (Walter et al., EGSR 2007, eq. 35 and 36).
  dvec3 draw(double choice, double u, double v) const;
  /// Returns the density of draw(), 1/sr.
  double density(const dvec3& to_light) const;

 private:
  bool above(const dvec3& to_light) const;
  double lobe(double n_dot_h, const dvec3& half) const;

  dvec3 normal_, geometric_, to_eye_, x_, y_;
  shared::Reflectance reflectance_;
  double lobe_share_ = 0.0;  ///< part of the draws that goes to the lobe
};

/// Completes a unit vector to a right-handed frame (Duff et al., "Building an Orthonormal Basis, Revisited",
/// JCGT 6(1), 2017).
void complete_frame(const dvec3& z, dvec3& x, dvec3& y);

}  // namespace greatx::render
