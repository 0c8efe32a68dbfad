// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Compares pictures of every kind with an independent decoder (stb_image, which is safe on files that this
// test has made), and checks that damaged pictures are handled.
#include "scene/files/picture.h"

#include <cmath>
#include <csetjmp>
#include <cstdio>
#include <jpeglib.h>
#include <png.h>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#include <stb/stb_image.h>

namespace greatx::scene {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using Bytes = std::vector<unsigned char>;

constexpr uint32_t width = 37, height = 23;

DecodedPicture decode(const Bytes& file, const Budget& budget = budget::model_textures) {
  Spending memory(budget);
  return decode_picture(file, "x.glb: material 'm'", memory);
}

std::string message_of(const Bytes& file, const Budget& budget = budget::model_textures) {
  try {
    decode(file, budget);
  } catch (const UserError& error) {
    return error.what();
  }
  return "accepted";
}

std::vector<uint8_t> by_stb(const Bytes& file) {
  int w = 0, h = 0, channels = 0;
  stbi_uc* pixels = stbi_load_from_memory(file.data(), static_cast<int>(file.size()), &w, &h, &channels, 4);
  if (pixels == nullptr) return {};
  std::vector<uint8_t> rgba(pixels, pixels + size_t{4} * static_cast<size_t>(w * h));
  stbi_image_free(pixels);
  return rgba;
}

struct PngKind {
  int color_type, bits;
  bool interlaced = false, transparent = false;
};

Bytes png_of(const PngKind& kind, uint32_t w = width, uint32_t h = height) {
  Bytes out;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(
      png, &out,
      [](png_structp p, png_bytep data, size_t size) {
        auto& bytes = *static_cast<Bytes*>(png_get_io_ptr(p));
        bytes.insert(bytes.end(), data, data + size);
      },
      nullptr);
  png_set_IHDR(png, info, w, h, kind.bits, kind.color_type,
               kind.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_BASE,
               PNG_FILTER_TYPE_BASE);
  std::vector<png_color> palette;
  for (int i = 0; i < 1 << std::min(kind.bits, 8); ++i)
    palette.push_back(
        {static_cast<png_byte>(7 * i), static_cast<png_byte>(255 - i), static_cast<png_byte>(i)});
  if (kind.color_type == PNG_COLOR_TYPE_PALETTE)
    png_set_PLTE(png, info, palette.data(), static_cast<int>(palette.size()));
  const png_byte alphas[] = {0, 128};
  png_color_16 clear{};
  clear.gray = clear.red = clear.green = clear.blue = 1;
  if (kind.transparent && kind.color_type == PNG_COLOR_TYPE_PALETTE)
    png_set_tRNS(png, info, alphas, 2, nullptr);
  if (kind.transparent && kind.color_type != PNG_COLOR_TYPE_PALETTE)
    png_set_tRNS(png, info, nullptr, 1, &clear);
  png_set_gAMA(png, info, 0.7);  // stored in the file, but not applied
  png_write_info(png, info);
  std::mt19937 random(5);
  const size_t row_bytes = png_get_rowbytes(png, info);
  std::vector<Bytes> rows(h, Bytes(row_bytes));
  for (Bytes& row : rows)
    for (unsigned char& byte : row)
      byte = static_cast<unsigned char>(random() % (kind.transparent ? 2 : 256));
  std::vector<png_bytep> pointers;
  for (Bytes& row : rows) pointers.push_back(row.data());
  png_write_image(png, pointers.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return out;
}

struct JpegKind {
  int components = 3;
  bool progressive = false;
  int sampling = 2;
  J_COLOR_SPACE stored = JCS_UNKNOWN;  ///< JCS_UNKNOWN: the library chooses
  bool adobe = true;
};

/// Returns a smooth picture, so that decoders that interpolate colour differently give similar results.
Bytes jpeg_of(const JpegKind& kind, uint32_t w = width, uint32_t h = height) {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* data = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &data, &size);
  jpeg.image_width = w;
  jpeg.image_height = h;
  jpeg.input_components = kind.components;
  jpeg.in_color_space = kind.components == 1 ? JCS_GRAYSCALE : kind.components == 4 ? JCS_CMYK : JCS_RGB;
  jpeg_set_defaults(&jpeg);
  if (kind.stored != JCS_UNKNOWN) jpeg_set_colorspace(&jpeg, kind.stored);
  jpeg_set_quality(&jpeg, 95, TRUE);
  jpeg.comp_info[0].h_samp_factor = jpeg.comp_info[0].v_samp_factor =
      kind.components == 3 ? kind.sampling : 1;
  if (kind.progressive) jpeg_simple_progression(&jpeg);
  if (!kind.adobe) jpeg.write_Adobe_marker = FALSE;
  jpeg_start_compress(&jpeg, TRUE);
  Bytes row(size_t{w} * static_cast<size_t>(kind.components));
  for (uint32_t y = 0; y < h; ++y) {
    for (uint32_t x = 0; x < w; ++x)
      for (int c = 0; c < kind.components; ++c)
        row[x * static_cast<size_t>(kind.components) + static_cast<size_t>(c)] = static_cast<unsigned char>(
            128.0 + 90.0 * std::sin(0.1 * x + 0.7 * c) * std::cos(0.12 * y - 0.4 * c));
    JSAMPROW pointer = row.data();
    jpeg_write_scanlines(&jpeg, &pointer, 1);
  }
  jpeg_finish_compress(&jpeg);
  jpeg_destroy_compress(&jpeg);
  Bytes out(data, data + size);
  std::free(data);
  return out;
}

TEST(Picture, EveryPngIsTheSameToTheBit) {
  for (const bool interlaced : {false, true})
    for (const PngKind& kind : std::initializer_list<PngKind>{{PNG_COLOR_TYPE_GRAY, 1},
                                                              {PNG_COLOR_TYPE_GRAY, 2},
                                                              {PNG_COLOR_TYPE_GRAY, 4},
                                                              {PNG_COLOR_TYPE_GRAY, 8},
                                                              {PNG_COLOR_TYPE_GRAY, 16},
                                                              {PNG_COLOR_TYPE_GRAY_ALPHA, 8},
                                                              {PNG_COLOR_TYPE_GRAY_ALPHA, 16},
                                                              {PNG_COLOR_TYPE_RGB, 8},
                                                              {PNG_COLOR_TYPE_RGB, 16},
                                                              {PNG_COLOR_TYPE_RGB_ALPHA, 8},
                                                              {PNG_COLOR_TYPE_RGB_ALPHA, 16},
                                                              {PNG_COLOR_TYPE_PALETTE, 1},
                                                              {PNG_COLOR_TYPE_PALETTE, 4},
                                                              {PNG_COLOR_TYPE_PALETTE, 8},
                                                              {PNG_COLOR_TYPE_PALETTE, 8, false, true},
                                                              {PNG_COLOR_TYPE_GRAY, 8, false, true},
                                                              {PNG_COLOR_TYPE_RGB, 8, false, true}}) {
      PngKind file = kind;
      file.interlaced = interlaced;
      const Bytes png = png_of(file);
      const std::vector<uint8_t> expected = by_stb(png);
      ASSERT_EQ(expected.size(), size_t{4} * width * height);
      const DecodedPicture picture = decode(png);
      EXPECT_EQ(picture.width, width);
      EXPECT_EQ(picture.height, height);
      EXPECT_EQ(picture.rgba, expected)
          << "colour type " << kind.color_type << ", " << kind.bits << " bits"
          << (interlaced ? ", interlaced" : "") << (kind.transparent ? ", transparent" : "");
    }
}

/// Decoders may round and interpolate colour differently.
TEST(Picture, EveryJpegIsTheSameWithinRounding) {
  for (const JpegKind& kind : std::initializer_list<JpegKind>{{1, false},
                                                              {1, true},
                                                              {3, false, 1},
                                                              {3, false, 2},
                                                              {3, true, 2},
                                                              {3, false, 1, JCS_RGB},
                                                              {4, false, 1, JCS_CMYK},
                                                              {4, false, 1, JCS_YCCK},
                                                              {4, true, 1, JCS_YCCK}}) {
    const Bytes jpeg = jpeg_of(kind);
    const std::vector<uint8_t> expected = by_stb(jpeg);
    const DecodedPicture picture = decode(jpeg);
    ASSERT_EQ(picture.rgba.size(), expected.size());
    int largest = 0;
    for (size_t i = 0; i < expected.size(); ++i)
      largest =
          std::max(largest, std::abs(static_cast<int>(picture.rgba[i]) - static_cast<int>(expected[i])));
    EXPECT_LE(largest, 3) << kind.components << " components, progressive " << kind.progressive
                          << ", sampling " << kind.sampling << ", stored as " << kind.stored;
  }
}

TEST(Picture, FourColoursThatNobodyExplainsAreRefused) {
  EXPECT_THAT(message_of(jpeg_of({4, false, 1, JCS_CMYK, false})), HasSubstr("Adobe"));
}

TEST(Picture, ASideMayHave16384Pixels) {
  EXPECT_EQ(decode(png_of({PNG_COLOR_TYPE_GRAY, 8}, 16384, 1)).width, 16384u);
  EXPECT_THAT(message_of(png_of({PNG_COLOR_TYPE_GRAY, 8}, 16385, 1)), HasSubstr("16385 x 1"));
  EXPECT_THAT(message_of(jpeg_of({1}, 1, 16385)), HasSubstr("1 x 16385"));
}

TEST(Picture, TheBudgetIsAskedBeforePixelsAreMade) {
  const Budget small{"the textures", 1000};
  for (const Bytes& file : {png_of({PNG_COLOR_TYPE_RGB, 8}), jpeg_of({3})})
    EXPECT_THAT(message_of(file, small), AllOf(HasSubstr("x.glb: material 'm'"), HasSubstr("37 x 23 pixels"),
                                               HasSubstr("found 3404")));
}

TEST(Picture, TwoPicturesShareABudget) {
  const Bytes png = png_of({PNG_COLOR_TYPE_RGB, 8});
  Spending memory({"the textures", 5000});
  decode_picture(png, "first", memory);
  try {
    decode_picture(png, "second", memory);
    FAIL() << "no error";
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(),
                AllOf(HasSubstr("second: an image of 37 x 23 pixels"), HasSubstr("found 6808")));
  }
}

TEST(Picture, WhatIsCutOffOrForeignIsRefused) {
  EXPECT_THAT(message_of({}), HasSubstr("PNG or JPEG"));
  EXPECT_THAT(message_of({'G', 'I', 'F', '8', '9', 'a'}), HasSubstr("PNG or JPEG"));
  for (const Bytes& file : {png_of({PNG_COLOR_TYPE_RGB, 8}), jpeg_of({3}), jpeg_of({3, true})})
    for (size_t size = 0; size + 12 < file.size(); size += 1 + file.size() / 60)
      EXPECT_THAT(message_of(Bytes(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(size))),
                  HasSubstr("x.glb: material 'm'"))
          << size;
}

/// Debian's stb_image 2.27 overran an array in its Huffman tables on such files. The decoder either decodes
/// or refuses them and does nothing else (also under the sanitizers).
TEST(Picture, DamageIsSurvived) {
  std::mt19937 random(17);
  size_t refused = 0;
  for (const Bytes& file :
       {jpeg_of({3}), jpeg_of({3, true}), jpeg_of({4, false, 1, JCS_YCCK}),
        png_of({PNG_COLOR_TYPE_PALETTE, 8, true, true}), png_of({PNG_COLOR_TYPE_RGB, 16})})
    for (int round = 0; round < 400; ++round) {
      Bytes damaged = file;
      for (uint32_t i = 0; i <= random() % 4; ++i)
        damaged[2 + random() % (damaged.size() - 2)] = static_cast<unsigned char>(random());
      refused += message_of(damaged) != "accepted";
    }
  EXPECT_GT(refused, 300u);
}

/// Files whose Huffman tables give false numbers of codes, such as those that overran stb_image's tables.
TEST(Picture, HuffmanTablesThatLie) {
  const Bytes good = jpeg_of({3});
  size_t tables = 0;
  for (size_t i = 2; i + 20 < good.size() && good[i] == 0xFF;) {
    const size_t length = size_t{good[i + 2]} << 8 | good[i + 3];
    for (size_t at = i + 5; good[i + 1] == 0xC4 && at < i + 21; ++at) {
      Bytes bad = good;
      bad[at] = 255;
      EXPECT_NE(message_of(bad), "accepted");
      ++tables;
    }
    if (good[i + 1] == 0xDA) break;
    i += 2 + length;
  }
  EXPECT_GE(tables, 32u);
}

}  // namespace
}  // namespace greatx::scene
