// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tells how much light a pane of glass reflects and lets through. Cameras, the path-traced reference and
// LiDARs read the same functions.
#ifndef GREATX_SHADERS_SHARED_PANE_H
#define GREATX_SHADERS_SHARED_PANE_H
#include "glsl.h"

#ifdef __cplusplus
namespace greatx::shared {
using glm::clamp;
using glm::dot;
using std::sqrt;
}  // namespace greatx::shared
#endif

GREATX_SHARED_BEGIN

/// The refractive index of panes before cameras (that of KHR_materials_ior where a file states none).
const float pane_index = 1.5f;
/// Cameras see through panes that are no rougher than this; rougher glass is frosted and stays solid.
const float pane_most_roughness = 0.35f;
/// Cameras see through panes up to the distance at which a pixel spans pane_dark_pixel m; from
/// pane_clear_pixel on, the light behind fades.
const float pane_clear_pixel = 0.055f;
const float pane_dark_pixel = 0.083f;

/// Returns the reflectance of unpolarized light on `sheets` parallel plates of refractive index `n` in air,
/// under an angle of incidence with the given cosine. Every reflection between their 2 m faces is added up
/// without interference or absorption: 2 m r / (1 + (2 m - 1) r) for each polarization (G. G. Stokes, "On the
/// intensity of the light reflected from or transmitted through a pile of plates", Proc. R. Soc. 11 (1862),
/// pp. 545-556), with r by Fresnel. For one plate this is 2 r / (1 + r), and (1 - r) / (1 + r) passes.
GREATX_FUNCTION float pane_reflectance(float cosine, float n, float sheets) {
  float inner = sqrt(n * n - 1.0f + cosine * cosine);  // n times the cosine inside
  float s = (cosine - inner) / (cosine + inner);
  float p = (n * n * cosine - inner) / (n * n * cosine + inner);
  float faces = 2.0f * sheets;
  float r_s = s * s;
  float r_p = p * p;
  return 0.5f * faces * (r_s / (1.0f + (faces - 1.0f) * r_s) + r_p / (1.0f + (faces - 1.0f) * r_p));
}

/// Returns the share of the light behind a pane that a camera shows, where a pixel spans `pixel_m`.
GREATX_FUNCTION float pane_shows(float pixel_m) {
  return clamp((pane_dark_pixel - pixel_m) / (pane_dark_pixel - pane_clear_pixel), 0.0f, 1.0f);
}

/// Returns how many quarters of a beam's luminance a pane of the given colour holds off in maps of shadows;
/// the beam meets it under an angle of the given cosine. The rest differs from what passes the pane by an
/// eighth at most.
GREATX_FUNCTION uint pane_filled_quarters(vec3 color, float cosine) {
  float passes =
      dot(color, vec3(0.2126f, 0.7152f, 0.0722f)) * (1.0f - pane_reflectance(cosine, pane_index, 1.0f));
  return uint(4.0f * (1.0f - clamp(passes, 0.0f, 1.0f)) + 0.5f);
}

GREATX_SHARED_END
#endif
