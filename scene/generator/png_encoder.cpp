// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/png_encoder.h"

#include <array>
#include <cstring>
#include <string_view>

#include <libdeflate.h>

#include "core/error.h"

namespace greatx::scene::generator {

namespace {

void put_u32(std::vector<uint8_t>& out, uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<uint8_t>(value >> shift));
}

void put_chunk(std::vector<uint8_t>& out, std::string_view type, std::span<const uint8_t> data) {
  put_u32(out, static_cast<uint32_t>(data.size()));
  const size_t start = out.size();
  out.insert(out.end(), type.begin(), type.end());
  out.insert(out.end(), data.begin(), data.end());
  put_u32(out, libdeflate_crc32(0, out.data() + start, out.size() - start));
}

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

std::vector<uint8_t> compress(std::span<const uint8_t> pixels, uint32_t row_bytes, uint32_t height) {
  std::vector<uint8_t> filtered;
  filtered.reserve(pixels.size() + height);
  for (uint32_t y = 0; y < height; ++y) {
    filtered.push_back(0);  // filter type: none
    const auto row = pixels.subspan(static_cast<size_t>(y) * row_bytes, row_bytes);
    filtered.insert(filtered.end(), row.begin(), row.end());
  }
  libdeflate_compressor* const compressor = libdeflate_alloc_compressor(6);
  GREATX_CHECK(compressor != nullptr, "libdeflate has no memory for a compressor");
  std::vector<uint8_t> out(libdeflate_zlib_compress_bound(compressor, filtered.size()));
  out.resize(libdeflate_zlib_compress(compressor, filtered.data(), filtered.size(), out.data(), out.size()));
  libdeflate_free_compressor(compressor);
  GREATX_CHECK(!out.empty(), "libdeflate could not compress {} bytes", filtered.size());
  return out;
}

}  // namespace

std::vector<std::byte> encode_png(uint32_t width, uint32_t height, std::span<const uint8_t> rgb) {
  GREATX_CHECK(rgb.size() == 3ull * width * height, "{} bytes for {} x {} RGB pixels", rgb.size(), width,
               height);
  Palette palette;
  bool indexed = false;
  for (int bits = 0; bits <= 3 && !indexed; ++bits) indexed = quantise(rgb, bits, palette);

  std::vector<uint8_t> out{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  std::vector<uint8_t> header;
  put_u32(header, width);
  put_u32(header, height);
  // Bit depth 8, colour type 3 (palette) or 2 (RGB), deflate, adaptive filtering, no interlace.
  header.insert(header.end(), {8, static_cast<uint8_t>(indexed ? 3 : 2), 0, 0, 0});
  put_chunk(out, "IHDR", header);
  if (indexed) put_chunk(out, "PLTE", palette.colors);
  const std::span<const uint8_t> pixels = indexed ? std::span<const uint8_t>(palette.indices) : rgb;
  put_chunk(out, "IDAT", compress(pixels, indexed ? width : 3 * width, height));
  put_chunk(out, "IEND", {});
  std::vector<std::byte> bytes(out.size());
  std::memcpy(bytes.data(), out.data(), out.size());
  return bytes;
}

}  // namespace greatx::scene::generator
