// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The camera that the tests of boxes and of coverage look through.
#pragma once

#include "renderer/camera/camera.h"

namespace greatx::test {

/// Returns a pinhole camera of `width` x `height` pixels without pictures. Its focal lengths differ, and its
/// principal point lies between pixels, so that a swap of axes or a shift by half a pixel changes the
/// results.
inline render::CameraDesc box_camera(uint32_t width = 96, uint32_t height = 64) {
  render::CameraDesc desc;
  desc.width = width;
  desc.height = height;
  desc.fx = 0.55 * width;
  desc.fy = 0.6 * width;
  desc.cx = 0.5 * width + 2.125;
  desc.cy = 0.5 * height - 1.625;
  desc.msaa = 1;
  desc.outputs = {};
  desc.outputs.rgb = desc.outputs.semantic = desc.outputs.material = false;
  return desc;
}

}  // namespace greatx::test
