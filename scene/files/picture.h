// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Decodes pictures from untrusted files with libpng and libjpeg-turbo. It does not use stb_image, which
// overruns an array on a damaged JPEG (Debian's 2.27).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/budget.h"

namespace greatx::scene {

inline constexpr uint32_t most_picture_side = 16384;

/// An RGBA8 image, top row first.
struct DecodedPicture {
  uint32_t width = 0, height = 0;
  std::vector<uint8_t> rgba;
};

/// Decodes a picture. PNG: every colour type and depth, interlaced or not; of 16 bits the upper 8 are kept;
/// gamma and profiles are not applied. JPEG: baseline and progressive, grey, YCbCr, RGB, and CMYK as Adobe
/// writes it. The size is read from the header and planned in `memory` before pixels are allocated. Throws
/// UserError, which starts with `what`, if the file is neither PNG nor JPEG, damaged, truncated, larger than
/// 16384 pixels on a side, or beyond the budget.
DecodedPicture decode_picture(std::span<const unsigned char> file, const std::string& what, Spending& memory);

}  // namespace greatx::scene
