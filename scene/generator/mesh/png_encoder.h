// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace greatx::scene::generator {

/// A PNG (ISO/IEC 15948) of RGB8 rows, top first. The colours are quantised until 256 are enough for a palette, which
/// keeps noisy textures small; a picture that needs more even at 5 bits a channel stays RGB. `exact` quantises nothing:
/// of what glows, black has to stay black.
std::vector<std::byte> encode_png(uint32_t width, uint32_t height, std::span<const uint8_t> rgb,
                                  bool exact = false);

}  // namespace greatx::scene::generator
