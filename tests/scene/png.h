// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace greatx::scene::test {

/// Returns RGBA8 pixels as a PNG file.
std::vector<unsigned char> encode_png(int width, int height, const std::vector<uint8_t>& rgba);
std::string base64(const std::vector<unsigned char>& bytes);

}  // namespace greatx::scene::test
