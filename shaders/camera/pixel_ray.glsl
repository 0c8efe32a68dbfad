// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the rays of a pinhole camera. The including shader has a block `camera` with ray_0, ray_x and
// ray_y. Behind a lens that distorts, pass the place where a pinhole camera would show the same thing
// (TruthConstants::lens).
#ifndef GREATX_CAMERA_PIXEL_RAY_GLSL
#define GREATX_CAMERA_PIXEL_RAY_GLSL

/// Returns the ray of pixel coordinates (centres at + 0.5) in local axes, at planar depth 1 (dot(ray,
/// forward) = 1).
vec3 pixel_ray(vec2 pixel) { return camera.ray_0 + camera.ray_x * pixel.x + camera.ray_y * pixel.y; }
#endif
