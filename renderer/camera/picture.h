// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines a picture between a camera's passes: storage buffers, row by row. On a CPU driver a load from a
// buffer or a store to it costs a third of one from or to an image.
#pragma once

#include "gpu/resources.h"

namespace greatx::render {

/// Holds the pixels [height * width], and zeros up to a whole number of DevelopPass's invocations. An output
/// that a camera does not deliver has no room.
struct PictureBuffers {
  gpu::Buffer color;  ///< uvec2: red, green, blue over stored_luminance(), share that shows the scene; halves
  gpu::Buffer luminance;  ///< float, cd/m^2
};

}  // namespace greatx::render
