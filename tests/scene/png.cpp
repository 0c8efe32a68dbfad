// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/scene/png.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb/stb_image_write.h>

namespace greatx::scene::test {

std::vector<unsigned char> encode_png(int width, int height, const std::vector<uint8_t>& rgba) {
  std::vector<unsigned char> png;
  const auto append = [](void* context, void* data, int size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    auto& out = *static_cast<std::vector<unsigned char>*>(context);
    out.insert(out.end(), bytes, bytes + size);
  };
  stbi_write_png_to_func(append, &png, width, height, 4, rgba.data(), width * 4);
  return png;
}

std::string base64(const std::vector<unsigned char>& bytes) {
  static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t index = 0; index < bytes.size(); index += 3) {
    uint32_t word = static_cast<uint32_t>(bytes[index]) << 16;
    if (index + 1 < bytes.size()) word |= static_cast<uint32_t>(bytes[index + 1]) << 8;
    if (index + 2 < bytes.size()) word |= bytes[index + 2];
    text += digits[word >> 18];
    text += digits[(word >> 12) & 63];
    text += index + 1 < bytes.size() ? digits[(word >> 6) & 63] : '=';
    text += index + 2 < bytes.size() ? digits[word & 63] : '=';
  }
  return text;
}

}  // namespace greatx::scene::test
