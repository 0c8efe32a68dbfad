// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/surface/texel.h"

#include <array>

#include "core/srgb.h"

namespace greatx::render {

dvec3 linear_texel(const scene::Texture& texture, size_t column, size_t row) {
  static const std::array<double, 256> linear = [] {
    std::array<double, 256> values{};
    for (size_t byte = 0; byte < values.size(); ++byte) values[byte] = linear_from_srgb(double(byte) / 255.0);
    return values;
  }();
  const uint8_t* bytes = &texture.rgba[4 * (row * texture.width + column)];
  dvec3 color;
  for (int c = 0; c < 3; ++c) color[c] = texture.srgb ? linear[bytes[c]] : bytes[c] / 255.0;
  return color;
}

}  // namespace greatx::render
