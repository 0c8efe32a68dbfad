// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Gives the changes of a pixel's ray to the right and down, over which textures and stars are filtered.
#ifndef GREATX_CAMERA_FOOTPRINT_GLSL
#define GREATX_CAMERA_FOOTPRINT_GLSL
#include "camera/effects.glsl"
#include "camera/visibility_view.glsl"

/// With several views these are set from the rays of the picture's own pixels, so that no seam shows where
/// two views meet.
vec3 footprint_of_lens_x, footprint_of_lens_y;

vec3 footprint_x() { return faces_on ? footprint_of_lens_x : camera.ray_x; }
vec3 footprint_y() { return faces_on ? footprint_of_lens_y : camera.ray_y; }
#endif
