// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests every encoder against a decoder, which is an independent one where one exists (stb for PNG, NumPy in
// numpy_test.cpp).
#include <array>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <numeric>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/random.h"
#include "io/formats/exr.h"
#include "io/formats/npy.h"
#include "io/formats/pcd.h"
#include "io/formats/ply.h"
#include "io/formats/png.h"
#include "tests/support/temporary_folder.h"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wduplicated-branches"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

namespace greatx::io {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

/// Returns a picture with flat areas, gradients and noise.
template <typename T>
Array test_picture(std::vector<int64_t> shape) {
  Array image(DTypeOf<T>::value, std::move(shape));
  RandomStream random(7, 1);
  const auto width = static_cast<size_t>(image.shape[1] * (image.shape.size() == 3 ? 3 : 1));
  const std::span<T> values = image.as<T>();
  for (size_t i = 0; i < values.size(); ++i) {
    const size_t y = i / width, x = i % width;
    const size_t value = y % 16 < 4 ? 200 : y % 16 < 8 ? 3 * x : y % 16 < 12 ? 5 * y : random.below(65536);
    values[i] = static_cast<T>(value);
  }
  return image;
}

const stbi_uc* raw(const Bytes& bytes) { return reinterpret_cast<const stbi_uc*>(bytes.data()); }

TEST(Png, RgbIsReadBackByStb) {
  const Array image = test_picture<uint8_t>({37, 53, 3});
  const Bytes file = encode_png(image);
  int width = 0, height = 0, channels = 0;
  stbi_uc* pixels =
      stbi_load_from_memory(raw(file), static_cast<int>(file.size()), &width, &height, &channels, 0);
  ASSERT_NE(pixels, nullptr) << stbi_failure_reason();
  EXPECT_EQ(std::tie(width, height, channels), std::make_tuple(53, 37, 3));
  EXPECT_EQ(std::memcmp(pixels, image.bytes.data(), image.bytes.size()), 0);
  stbi_image_free(pixels);
}

TEST(Png, GreyIsReadBackByStb) {
  const Array image = test_picture<uint8_t>({20, 1});
  const Bytes file = encode_png(image);
  int width = 0, height = 0, channels = 0;
  stbi_uc* pixels =
      stbi_load_from_memory(raw(file), static_cast<int>(file.size()), &width, &height, &channels, 0);
  ASSERT_NE(pixels, nullptr) << stbi_failure_reason();
  EXPECT_EQ(std::tie(width, height, channels), std::make_tuple(1, 20, 1));
  EXPECT_EQ(std::memcmp(pixels, image.bytes.data(), image.bytes.size()), 0);
  stbi_image_free(pixels);
}

TEST(Png, SixteenBitGreyIsReadBackByStb) {
  const Array image = test_picture<uint16_t>({33, 21});
  const Bytes file = encode_png(image);
  int width = 0, height = 0, channels = 0;
  stbi_us* pixels =
      stbi_load_16_from_memory(raw(file), static_cast<int>(file.size()), &width, &height, &channels, 0);
  ASSERT_NE(pixels, nullptr) << stbi_failure_reason();
  EXPECT_EQ(std::tie(width, height, channels), std::make_tuple(21, 33, 1));
  EXPECT_EQ(std::memcmp(pixels, image.bytes.data(), image.bytes.size()), 0);
  stbi_image_free(pixels);
}

TEST(Png, OwnDecoderGivesTheInputBack) {
  for (const Array& image : {test_picture<uint8_t>({37, 53, 3}), test_picture<uint8_t>({16, 16}),
                             test_picture<uint16_t>({33, 21})}) {
    const Array back = decode_png(encode_png(image), "x.png");
    EXPECT_EQ(back.shape, image.shape);
    EXPECT_EQ(back.bytes, image.bytes);
  }
}

/// Returns a picture u8 [height, width, 3]. `color(i)` is the colour of pixel i, counted line by line.
template <typename ColorOf>
Array rgb_picture(int64_t height, int64_t width, ColorOf&& color) {
  Array image(DType::u8, {height, width, 3});
  const std::span<uint8_t> rgb = image.as<uint8_t>();
  for (size_t i = 0; i < rgb.size(); ++i)
    rgb[i] = static_cast<uint8_t>(color(static_cast<int>(i / 3))[i % 3]);
  return image;
}

constexpr size_t color_type_at = 25;  // offset of the colour type in IHDR
constexpr std::byte palette_type{3}, rgb_type{2};

/// Returns the pixels as stb reads them.
std::vector<uint8_t> pixels_by_stb(const Bytes& file) {
  int width = 0, height = 0, channels = 0;
  stbi_uc* pixels =
      stbi_load_from_memory(raw(file), static_cast<int>(file.size()), &width, &height, &channels, 3);
  if (pixels == nullptr) return {};
  const std::vector<uint8_t> rgb(pixels, pixels + 3 * width * height);
  stbi_image_free(pixels);
  return rgb;
}

TEST(Png, SmallIsAPaletteWhereItSuffices) {
  const Array few = rgb_picture(5, 6, [](int i) { return std::array{i % 7 == 0 ? 200 : 10, 20, 30}; });
  for (const PngCoding coding : {PngCoding::small, PngCoding::small_inexact}) {
    const Bytes file = encode_png(few, coding);
    EXPECT_EQ(file[color_type_at], palette_type);
    EXPECT_THAT(pixels_by_stb(file), testing::ElementsAreArray(few.as<uint8_t>()));
  }
  // A picture with more than 256 colours at any quantisation down to 5 bits stays RGB and exact.
  const Array many = rgb_picture(64, 64, [](int i) {
    return std::array{i % 32 * 8, i / 32 % 32 * 8, i / 1024 * 60};
  });
  const Bytes exact = encode_png(many, PngCoding::small_inexact);
  EXPECT_EQ(exact[color_type_at], rgb_type);
  EXPECT_EQ(decode_png(exact, "x.png").bytes, many.bytes);
}

TEST(Png, SmallInexactDropsAsFewBitsAsItTakes) {
  // 512 greys and near-greys are at most 256 colours without the lowest bit.
  const Array image = rgb_picture(16, 32, [](int i) {
    return std::array{i / 2, i / 2, (i / 2 & ~1) + i % 2};
  });
  const Bytes exact = encode_png(image, PngCoding::small),
              inexact = encode_png(image, PngCoding::small_inexact);
  EXPECT_EQ(exact[color_type_at], rgb_type);
  EXPECT_EQ(decode_png(exact, "x.png").bytes, image.bytes);
  ASSERT_EQ(inexact[color_type_at], palette_type);
  const std::vector<uint8_t> back = pixels_by_stb(inexact);
  const std::span<const uint8_t> rgb = image.as<uint8_t>();
  ASSERT_EQ(back.size(), rgb.size());
  for (size_t i = 0; i < rgb.size(); ++i) ASSERT_LE(std::abs(int{back[i]} - int{rgb[i]}), 1) << i;
  // In a hurry, the pixels are the same.
  EXPECT_EQ(pixels_by_stb(encode_png(image, PngCoding::quick)), pixels_by_stb(exact));
  EXPECT_EQ(pixels_by_stb(encode_png(image, PngCoding::quick_inexact)), back);
}

TEST(Png, SmallTakesRgbAlone) {
  for (const std::vector<int64_t>& shape : {std::vector<int64_t>{40, 30, 3}, {40, 30}}) {
    const Array picture = test_picture<uint8_t>(shape);
    EXPECT_EQ(decode_png(encode_png(picture, PngCoding::matched), "x.png").bytes, picture.bytes);
  }
  EXPECT_THROW(encode_png(test_picture<uint8_t>({4, 4}), PngCoding::small), ContractError);
  EXPECT_THROW(encode_png(test_picture<uint16_t>({4, 4}), PngCoding::small), ContractError);
}

TEST(Png, IdsThatDoNotFitAreRefused) {
  const std::vector<uint32_t> good{0, 65535}, bad{0, 65536};
  EXPECT_EQ(decode_png(encode_png(Array::of<uint32_t>({1, 2}, good)), "x").as<uint16_t>()[1], 65535);
  EXPECT_THROW(encode_png(Array::of<uint32_t>({1, 2}, bad)), UserError);
  EXPECT_THROW(encode_png(Array(DType::f32, {4, 4})), ContractError);
}

TEST(Png, DecoderRefusesBrokenFiles) {
  const Bytes good = encode_png(test_picture<uint8_t>({8, 8, 3}));
  for (size_t at = 0; at < good.size(); ++at) {
    Bytes bad = good;
    bad[at] ^= std::byte{0x10};
    EXPECT_THROW(decode_png(bad, "x.png"), UserError) << "byte " << at;
    EXPECT_THROW(decode_png(std::span(good).first(at), "x.png"), UserError) << "cut at " << at;
  }
}

TEST(Depth24, FollowsCarlasCoding) {
  EXPECT_EQ(depth24_code(0.0f), 0u);
  EXPECT_EQ(depth24_code(1000.0f), 16777215u);
  EXPECT_EQ(depth24_code(1500.0f), 16777215u);
  EXPECT_EQ(depth24_code(infinity), 16777215u);
  EXPECT_EQ(depth24_code(500.0f), 8388608u);  // 8388607.5 rounds up
  EXPECT_EQ(depth24_code(1.0f), 16777u);      // 16777.215
  EXPECT_EQ(depth24_code(0.0001f), 2u);       // 1.6777
  EXPECT_THROW(depth24_code(-1.0f), ContractError);
  EXPECT_THROW(depth24_code(std::numeric_limits<float>::quiet_NaN()), ContractError);
}

TEST(Depth24, RedIsTheLowestByte) {
  const std::vector<float> depth{1.0f, 999.0f};
  const Array image = decode_png(encode_png_depth24(Array::of<float>({1, 2}, depth)), "x.png");
  const std::span<const uint8_t> rgb = image.as<uint8_t>();
  for (size_t i = 0; i < 2; ++i) {
    const double metres =
        1000.0 * (rgb[3 * i] + 256.0 * rgb[3 * i + 1] + 65536.0 * rgb[3 * i + 2]) / 16777215.0;
    EXPECT_NEAR(metres, depth[i], 0.5 * 1000.0 / 16777215.0);
  }
}

TEST(Depth24, DecodesWithinHalfACode) {
  Array depth(DType::f32, {50, 40});
  RandomStream random(3, 0);
  for (float& value : depth.as<float>()) value = static_cast<float>(random.uniform(0.0, 1000.0));
  const Array back = decode_png_depth24(encode_png_depth24(depth), "x.png");
  for (size_t i = 0; i < 2000; ++i) EXPECT_NEAR(back.as<float>()[i], depth.as<float>()[i], 6.1e-5);
}

TEST(Exr, DepthIsExactWithInfinityAndNan) {
  const test::TemporaryFolder folder;
  Array depth(DType::f32, {31, 45});
  RandomStream random(3, 0);
  for (float& value : depth.as<float>()) value = static_cast<float>(random.uniform(0.1, 5000.0));
  for (size_t i = 0; i < 450; ++i) depth.as<float>()[i] = infinity;
  depth.as<float>()[500] = std::numeric_limits<float>::quiet_NaN();
  depth.as<float>()[501] = -0.0f;
  depth.as<float>()[502] = std::numeric_limits<float>::denorm_min();
  write_file_atomically(folder.path() / "z.exr", encode_exr(depth));
  const Array back = read_exr(folder.path() / "z.exr");
  EXPECT_EQ(back.shape, depth.shape);
  EXPECT_EQ(back.bytes, depth.bytes);
}

TEST(Exr, RgbIsExact) {
  const test::TemporaryFolder folder;
  for (const int64_t width : {1, 2, 640}) {
    Array image(DType::f32, {5, width, 3});
    RandomStream random(4, 0);
    for (float& value : image.as<float>()) value = static_cast<float>(random.below(4)) / 3.0f;
    write_file_atomically(folder.path() / "small.exr", encode_exr(image, 6));
    EXPECT_EQ(read_exr(folder.path() / "small.exr").bytes, image.bytes);
    write_file_atomically(folder.path() / "c.exr", encode_exr(image));
    const Array back = read_exr(folder.path() / "c.exr");
    EXPECT_EQ(back.shape, image.shape);
    EXPECT_EQ(back.bytes, image.bytes);
  }
}

TEST(Exr, WhatDoesNotShrinkIsStoredAsItIs) {
  const test::TemporaryFolder folder;
  Array noise(DType::f32, {33, 17, 3});
  RandomStream random(5, 0);
  for (std::byte& byte : noise.bytes) byte = static_cast<std::byte>(random.below(256));
  const Bytes file = encode_exr(noise);
  EXPECT_GE(file.size(), noise.bytes.size());
  write_file_atomically(folder.path() / "c.exr", file);
  EXPECT_EQ(read_exr(folder.path() / "c.exr").bytes, noise.bytes);
}

TEST(Exr, SamePixelsGiveTheSameBytesInEveryThread) {
  Array depth(DType::f32, {100, 60});
  RandomStream random(9, 1);
  for (float& value : depth.as<float>()) value = static_cast<float>(random.below(1000));
  const Bytes first = encode_exr(depth);
  std::vector<Bytes> others(4);
  std::vector<std::thread> threads;
  for (Bytes& other : others) threads.emplace_back([&] { other = encode_exr(depth); });
  for (std::thread& thread : threads) thread.join();
  for (const Bytes& other : others) EXPECT_EQ(other, first);
  const std::string_view text(reinterpret_cast<const char*>(first.data()), first.size());
  for (const char* attribute : {"capDate", "utcOffset", "owner"})
    EXPECT_EQ(text.find(attribute), text.npos) << attribute;
}

TEST(Exr, BrokenFileIsAUserError) {
  const test::TemporaryFolder folder;
  Bytes file = encode_exr(Array(DType::f32, {16, 16}));
  file.resize(file.size() / 2);
  write_file_atomically(folder.path() / "z.exr", file);
  EXPECT_THROW(read_exr(folder.path() / "z.exr"), UserError);
  EXPECT_THROW(read_exr(folder.path() / "missing.exr"), UserError);
}

TEST(Npy, HeaderIsAlignedAndFixed) {
  const Bytes header = npy_header(DType::complex64, {0, 1, 2, 3});
  EXPECT_EQ(header.size(), 256u);
  EXPECT_EQ(header.back(), std::byte{'\n'});
  EXPECT_EQ(npy_header(DType::complex64, {INT64_MAX, 1, 2, 3, 4, 5, 6}).size(), 256u);
}

TEST(Npy, RoundTripsEveryTypeAndAxisCount) {
  const test::TemporaryFolder folder;
  for (const DType dtype : {DType::u8, DType::u16, DType::u32, DType::i32, DType::i64, DType::u64, DType::f32,
                            DType::f64, DType::complex64}) {
    for (const std::vector<int64_t>& shape : {std::vector<int64_t>{}, std::vector<int64_t>{5},
                                              std::vector<int64_t>{0, 3}, std::vector<int64_t>{4, 3, 2}}) {
      Array array(dtype, shape);
      for (size_t i = 0; i < array.bytes.size(); ++i) array.bytes[i] = static_cast<std::byte>(i);
      write_file_atomically(folder.path() / "a.npy", encode_npy(array));
      const NpyFile file(folder.path() / "a.npy");
      EXPECT_EQ(file.shape(), shape);
      EXPECT_EQ(file.dtype(), dtype);
      EXPECT_EQ(file.read().bytes, array.bytes);
    }
  }
}

TEST(Npy, ReadsRows) {
  const test::TemporaryFolder folder;
  std::vector<int32_t> values(12);
  std::iota(values.begin(), values.end(), 0);
  write_file_atomically(folder.path() / "a.npy", encode_npy(Array::of<int32_t>({4, 3}, values)));
  const Array rows = NpyFile(folder.path() / "a.npy").read_rows(1, 3);
  EXPECT_EQ(rows.shape, (std::vector<int64_t>{2, 3}));
  EXPECT_EQ(rows.as<int32_t>()[0], 3);
  EXPECT_EQ(rows.as<int32_t>()[5], 8);
}

TEST(Npy, TruncatedOrForeignFileIsAUserError) {
  const test::TemporaryFolder folder;
  Bytes file = encode_npy(Array(DType::f64, {3}));
  file.pop_back();
  write_file_atomically(folder.path() / "a.npy", file);
  EXPECT_THROW(NpyFile(folder.path() / "a.npy"), UserError);
  write_file_atomically(folder.path() / "a.npy", std::string_view("hello"));
  EXPECT_THROW(NpyFile(folder.path() / "a.npy"), UserError);
}

TEST(Ply, RoundTrips) {
  const std::vector<float> points{1, 2, 3, 0.5f, 4, 5, 6, 0.25f};
  const std::vector<uint16_t> ring{7, 65535};
  const std::vector<uint32_t> instance{70000, 3};
  const Array a = Array::of<float>({2, 4}, points), b = Array::of<uint16_t>({2}, ring),
              c = Array::of<uint32_t>({2}, instance);
  const Bytes file = encode_ply({"points", "ring", "instance"}, {&a, &b, &c});
  const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  EXPECT_TRUE(
      text.starts_with("ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty float x\n"
                       "property float y\nproperty float z\nproperty float intensity\nproperty uint16 ring\n"
                       "property int instance\nend_header\n"));
  const std::map<std::string, Array> back = decode_ply(file, "x.ply");
  EXPECT_EQ(back.at("z").as<float>()[1], 6.0f);
  EXPECT_EQ(back.at("intensity").as<float>()[0], 0.5f);
  EXPECT_EQ(back.at("ring").as<uint16_t>()[1], 65535);
  EXPECT_EQ(back.at("instance").as<int32_t>()[0], 70000);
  EXPECT_THROW(decode_ply(std::span(file).first(file.size() - 1), "x.ply"), UserError);
}

TEST(Ply, ReadsTheTypeNamesOfOlderFiles) {
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty ushort ring\n"
      "property uint instance\nproperty uchar class\nend_header\n";
  Bytes file(header.size() + 7);
  std::memcpy(file.data(), header.data(), header.size());
  const unsigned char row[] = {0xff, 0xff, 0x04, 0x03, 0x02, 0xf1, 9};
  std::memcpy(file.data() + header.size(), row, sizeof row);
  const std::map<std::string, Array> back = decode_ply(file, "x.ply");
  EXPECT_EQ(back.at("ring").as<uint16_t>()[0], 65535);
  EXPECT_EQ(back.at("instance").as<uint32_t>()[0], 0xf1020304u);
  EXPECT_EQ(back.at("class").as<uint8_t>()[0], 9);
}

TEST(Ply, RefusesNumbersThatNoTypeHolds) {
  const std::vector<float> points{1, 2, 3, 0.5f};
  const std::vector<uint32_t> most{0x7fffffff}, beyond{0x80000000};
  const Array a = Array::of<float>({1, 4}, points), fits = Array::of<uint32_t>({1}, most),
              large = Array::of<uint32_t>({1}, beyond);
  EXPECT_EQ(decode_ply(encode_ply({"points", "id"}, {&a, &fits}), "x.ply").at("id").as<int32_t>()[0],
            0x7fffffff);
  EXPECT_THROW(encode_ply({"points", "id"}, {&a, &large}), UserError);
}

TEST(Ply, MayBeEmpty) {
  const Array none(DType::f32, {0, 4});
  EXPECT_EQ(decode_ply(encode_ply({"points"}, {&none}), "x.ply").at("x").element_count(), 0);
}

TEST(Pcd, FieldsOfEveryTypeComeBack) {
  const std::vector<float> points{1, 2, 3, 0.5f, -1, -2, -3, 0.25f};
  const std::vector<uint16_t> ring{7, 65535};
  const std::vector<uint32_t> instance{1, 4'000'000'000u};
  const std::vector<double> time{1e-9, 2.5};
  const Array a = Array::of<float>({2, 4}, points), b = Array::of<uint16_t>({2}, ring),
              c = Array::of<uint32_t>({2}, instance), d = Array::of<double>({2}, time);
  const Bytes file = encode_pcd({"points", "ring", "instance", "time"}, {&a, &b, &c, &d});
  const std::string text(reinterpret_cast<const char*>(file.data()), file.size());
  const std::string header =
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z intensity ring instance time\n"
      "SIZE 4 4 4 4 2 4 8\nTYPE F F F F U U F\nCOUNT 1 1 1 1 1 1 1\nWIDTH 2\nHEIGHT 1\n"
      "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA binary\n";
  ASSERT_TRUE(text.starts_with(header));
  EXPECT_EQ(file.size(), header.size() + 2 * 30);
  const std::map<std::string, Array> back = decode_pcd(file, "x.pcd");
  ASSERT_EQ(back.size(), 7u);
  EXPECT_EQ(back.at("z").as<float>()[1], -3.0f);
  EXPECT_EQ(back.at("intensity").as<float>()[0], 0.5f);
  EXPECT_EQ(back.at("ring").bytes, b.bytes);
  EXPECT_EQ(back.at("instance").bytes, c.bytes);
  EXPECT_EQ(back.at("time").bytes, d.bytes);
  const auto broken = [&](const std::string& what, const std::string& with) {
    std::string copy = text;
    copy.replace(copy.find(what), what.size(), with);
    return std::as_bytes(std::span(copy)).empty()
               ? Bytes()
               : Bytes(std::as_bytes(std::span(copy)).begin(), std::as_bytes(std::span(copy)).end());
  };
  for (const auto& [what, with] : {std::pair("POINTS 2", "POINTS 3"),
                                   {"SIZE 4 4", "SIZE 4 3"},
                                   {"COUNT 1", "COUNT 2"},
                                   {"DATA binary", "DATA ascii"},
                                   {"TYPE F", "TYPE F F"},
                                   {"FIELDS", "FILDS"}})
    EXPECT_THROW(decode_pcd(broken(what, with), "x.pcd"), UserError) << what;
  EXPECT_THROW(decode_pcd(std::span(file).first(file.size() - 1), "x.pcd"), UserError);
  EXPECT_THROW(decode_pcd({}, "x.pcd"), UserError);
  const Array none(DType::f32, {0, 4}), wide(DType::i64, {2});
  EXPECT_EQ(decode_pcd(encode_pcd({"points"}, {&none}), "x.pcd").at("x").element_count(), 0);
  EXPECT_THROW(encode_pcd({"points", "id"}, {&a, &wide}), ContractError);
}

TEST(Kitti, IsTheArrayItself) {
  const std::vector<float> points{1, 2, 3, 0.5f, -1, -2, -3, 0.25f};
  const Array a = Array::of<float>({2, 4}, points);
  const Bytes file = encode_kitti(a);
  EXPECT_EQ(file, Bytes(a.bytes.begin(), a.bytes.end()));
  EXPECT_EQ(decode_kitti(file, "x.bin").bytes, a.bytes);
  EXPECT_THROW(decode_kitti(std::span(file).first(20), "x.bin"), UserError);
}

TEST(File, ErrorsNameTheFileAndTheReason) {
  const test::TemporaryFolder folder;
  write_file_atomically(folder.path() / "file", std::string_view("x"));
  try {
    write_file_atomically(folder.path() / "file" / "below", std::string_view("x"));
    FAIL();
  } catch (const WriteError& error) {
    EXPECT_NE(std::string(error.what()).find("file/below"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("Not a directory"), std::string::npos) << error.what();
  }
  File full = File::open_for_writing("/dev/full");
  EXPECT_THROW(full.write_at(0, bytes_of("x")), WriteError);
}

}  // namespace
}  // namespace greatx::io
