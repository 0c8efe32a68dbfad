// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/files/picture.h"

#include <algorithm>
#include <array>

#include "core/error.h"
#include "scene/files/picture_decoders.h"

namespace greatx::scene {
namespace {

std::unique_ptr<PictureDecoder> decoder_of(std::span<const unsigned char> file) {
  constexpr std::array<unsigned char, 8> png = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  constexpr std::array<unsigned char, 3> jpeg = {0xFF, 0xD8, 0xFF};
  const auto begins_with = [&](const auto& magic) {
    return file.size() >= magic.size() && std::equal(magic.begin(), magic.end(), file.begin());
  };
  if (begins_with(png)) return png_decoder(file);
  if (begins_with(jpeg)) return jpeg_decoder(file);
  return nullptr;
}

}  // namespace

DecodedPicture decode_picture(std::span<const unsigned char> file, const std::string& what,
                              Spending& memory) {
  const auto refuse = [&](const std::string& reason) {
    throw_user_error("{}: the image is no readable PNG or JPEG of {} pixels a side at most ({})", what,
                     most_picture_side, reason);
  };
  const std::unique_ptr<PictureDecoder> decoder = decoder_of(file);
  if (!decoder) refuse(fmt::format("its {} bytes begin like neither", file.size()));
  if (!decoder->read_header()) refuse(decoder->error());
  DecodedPicture picture{decoder->width(), decoder->height(), {}};
  if (picture.width == 0 || picture.height == 0 || picture.width > most_picture_side ||
      picture.height > most_picture_side)
    refuse(fmt::format("{} x {} pixels", picture.width, picture.height));
  const std::string where =
      fmt::format("{}: an image of {} x {} pixels", what, picture.width, picture.height);
  const uint64_t bytes = saturating_product({picture.width, picture.height, 4});
  require_within(where, saturating_sum(bytes, decoder->own_bytes()), budget::model_textures);
  memory.plan(where, bytes);
  picture.rgba.resize(bytes);
  if (!decoder->read_rgba(picture.rgba.data())) refuse(decoder->error());
  return picture;
}

}  // namespace greatx::scene
