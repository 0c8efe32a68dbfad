// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the place of a pixel in a picture's buffers (renderer/camera/picture.h), and its colour there. A
// shader that uses the places has the block `camera` of CameraConstants.
#ifndef GREATX_CAMERA_PICTURE_GLSL
#define GREATX_CAMERA_PICTURE_GLSL
#include "camera/visibility_view.glsl"
#include "camera/stored_color.glsl"

ivec2 picture_size() { return ivec2(camera.size & 0xffffu, camera.size >> 16); }
bool outside_picture(ivec2 at) { return any(greaterThanEqual(at, picture_size())); }
uint picture_element(ivec2 at) { return uint(at.y) * (camera.size & 0xffffu) + uint(at.x); }
#endif
