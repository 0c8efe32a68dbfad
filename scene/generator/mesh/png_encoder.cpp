// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/mesh/png_encoder.h"

#include <array>
#include <png.h>

#include "core/error.h"

namespace greatx::scene::generator {

namespace {

struct Palette {
  std::vector<uint8_t> colors;   ///< RGB triples in order of first use
  std::vector<uint8_t> indices;  ///< [width * height]
};

/// The picture with `bits` bits dropped from each channel; false if more than 256 colours remain.
bool quantise(std::span<const uint8_t> rgb, int bits, Palette& palette) {
  palette = {};
  const int half = bits == 0 ? 0 : 1 << (bits - 1);
  constexpr uint32_t slots = 1024;  // open addressing, never more than a quarter full
  constexpr uint32_t empty = 0xffffffffu;
  std::array<uint32_t, slots> keys;
  std::array<uint8_t, slots> values;
  keys.fill(empty);
  for (size_t i = 0; i < rgb.size(); i += 3) {
    std::array<uint8_t, 3> color;
    for (size_t c = 0; c < 3; ++c) color[c] = static_cast<uint8_t>((rgb[i + c] >> bits << bits) + half);
    const uint32_t key = static_cast<uint32_t>(color[0] << 16 | color[1] << 8 | color[2]);
    uint32_t slot = (key * 0x9E3779B1u) >> 22;
    while (keys[slot] != key && keys[slot] != empty) slot = (slot + 1) % slots;
    if (keys[slot] == empty) {
      if (palette.colors.size() == 3 * 256) return false;
      keys[slot] = key;
      values[slot] = static_cast<uint8_t>(palette.colors.size() / 3);
      palette.colors.insert(palette.colors.end(), color.begin(), color.end());
    }
    palette.indices.push_back(values[slot]);
  }
  return true;
}

}  // namespace

std::vector<std::byte> encode_png(uint32_t width, uint32_t height, std::span<const uint8_t> rgb, bool exact) {
  GREATX_CHECK(rgb.size() == 3ull * width * height, "{} bytes for {} x {} RGB pixels", rgb.size(), width,
               height);
  Palette palette;
  bool indexed = false;
  for (int bits = 0; bits <= (exact ? 0 : 3) && !indexed; ++bits) indexed = quantise(rgb, bits, palette);

  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = width;
  image.height = height;
  image.format = indexed ? PNG_FORMAT_RGB_COLORMAP : PNG_FORMAT_RGB;
  image.colormap_entries = static_cast<uint32_t>(palette.colors.size() / 3);
  const uint8_t* pixels = indexed ? palette.indices.data() : rgb.data();
  const auto row_stride = static_cast<png_int_32>(indexed ? width : 3 * width);
  std::vector<std::byte> bytes(PNG_IMAGE_PNG_SIZE_MAX(image));
  size_t size = bytes.size();
  const int written =
      png_image_write_to_memory(&image, bytes.data(), &size, 0, pixels, row_stride, palette.colors.data());
  GREATX_CHECK(written != 0, "libpng: {}", image.message);
  bytes.resize(size);
  return bytes;
}

}  // namespace greatx::scene::generator
