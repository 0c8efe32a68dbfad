// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/formats/png.h"

#include <algorithm>
#include <array>
#include <bit>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <memory>
#include <png.h>
#include <utility>

#include <libdeflate.h>

#include "io/formats/deflate.h"
#include "io/formats/picture_shape.h"
#include "io/formats/png_filter.h"
#include "io/formats/run_deflate.h"

namespace greatx::io {

namespace {

/// Level of libdeflate for depth in 24 bits, whose lines repeat at many distances: runs alone would make
/// files 44 % larger.
constexpr int depth_level = 1;
constexpr int matched_level = 6;
constexpr double depth24_per_m = depth24_full_scale / depth24_range_m;
constexpr uint32_t largest_side = (1 << 24) - 1;

struct Layout {
  uint32_t width = 0, height = 0;
  int bit_depth = 8, color_type = PNG_COLOR_TYPE_GRAY;
  size_t row_bytes() const {
    return size_t{width} * (color_type == PNG_COLOR_TYPE_RGB ? 3 : 1) * static_cast<size_t>(bit_depth / 8);
  }
};

/// Holds the state that libpng's callbacks share. libpng leaves a failed call by longjmp, so the functions
/// below that call setjmp must not own objects with destructors. Such objects lie here or in their callers.
struct ReadSession {
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::span<const std::byte> in;    ///< rest of the file
  char message[128] = "no memory";  ///< message of the error

  ReadSession() = default;
  ReadSession(const ReadSession&) = delete;
  ReadSession& operator=(const ReadSession&) = delete;
  ~ReadSession() { png_destroy_read_struct(&png, &info, nullptr); }
  static ReadSession& of(png_structp png) { return *static_cast<ReadSession*>(png_get_error_ptr(png)); }
};

[[noreturn]] void on_error(png_structp png, png_const_charp message) {
  ReadSession& session = ReadSession::of(png);
  std::snprintf(session.message, sizeof(session.message), "%s", message);
  png_longjmp(png, 1);
}

void on_read(png_structp png, png_bytep data, size_t size) {
  std::span<const std::byte>& in = ReadSession::of(png).in;
  if (size > in.size()) png_error(png, "the file is cut off");
  std::memcpy(data, in.data(), size);
  in = in.subspan(size);
}

/// Makes libpng return 16-bit values in the machine's byte order; PNG stores them in big-endian order.
void match_byte_order(png_structp png, const Layout& layout) {
  if (layout.bit_depth == 16 && std::endian::native == std::endian::little) png_set_swap(png);
}

/// Reads the file up to the pixels. Returns false on an error or a warning, because a file of a data set must
/// not cause warnings.
bool read_header(ReadSession& session, Layout& layout, bool& interlaced) {
  session.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &session, on_error, on_error);
  if (session.png != nullptr) session.info = png_create_info_struct(session.png);
  if (session.info == nullptr || setjmp(png_jmpbuf(session.png)) != 0) return false;
  png_set_read_fn(session.png, nullptr, on_read);
  png_set_user_limits(session.png, largest_side, largest_side);
  png_read_info(session.png, session.info);
  layout = {png_get_image_width(session.png, session.info), png_get_image_height(session.png, session.info),
            png_get_bit_depth(session.png, session.info), png_get_color_type(session.png, session.info)};
  interlaced = png_get_interlace_type(session.png, session.info) != PNG_INTERLACE_NONE;
  return true;
}

bool read_pixels(ReadSession& session, const Layout& layout, std::byte* pixels) {
  if (setjmp(png_jmpbuf(session.png)) != 0) return false;
  match_byte_order(session.png, layout);
  for (uint32_t y = 0; y < layout.height; ++y)
    png_read_row(session.png, reinterpret_cast<png_bytep>(pixels + y * layout.row_bytes()), nullptr);
  png_read_end(session.png, nullptr);
  return true;
}

void append_word(Bytes& out, uint32_t word) {
  for (const int shift : {24, 16, 8, 0}) out.push_back(static_cast<std::byte>(word >> shift));
}

/// Appends a chunk: length, type, data, checksum of type and data (section 5.3 of the standard). `fill`
/// appends the data.
template <typename Fill>
void append_chunk(Bytes& out, const char (&type)[5], Fill&& fill) {
  const size_t length_at = out.size();
  append_word(out, 0);
  append(out, std::as_bytes(std::span(type, 4)));
  fill();
  const auto length = static_cast<uint32_t>(out.size() - length_at - 8);
  for (int i = 0; i < 4; ++i) out[length_at + size_t(i)] = static_cast<std::byte>(length >> (24 - 8 * i));
  append_word(out, libdeflate_crc32(0, out.data() + length_at + 4, length + 4));
}

/// Encodes a PNG file. `pixels` holds the lines in order, 16-bit values in the machine's byte order. The
/// filtered lines are packed by libdeflate at `level`, or by runs (io/formats/run_deflate.h) if it is 0.
Bytes encode(const Layout& layout, PngFilters filters, int level, std::span<const std::byte> pixels) {
  GREATX_CHECK(pixels.size() == layout.height * layout.row_bytes(), "{} bytes for {}x{} pixels",
               pixels.size(), layout.width, layout.height);
  const size_t pixel_bytes = layout.row_bytes() / layout.width;
  thread_local Bytes lines;  // kept from picture to picture
  filter_lines({pixels.data(), layout.row_bytes(), layout.height, pixel_bytes,
                layout.bit_depth == 16 && std::endian::native == std::endian::little},
               filters, lines);

  constexpr uint8_t signature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  Bytes out;
  append(out, std::as_bytes(std::span(signature)));
  append_chunk(out, "IHDR", [&] {
    append_word(out, layout.width);
    append_word(out, layout.height);
    for (const int byte : {layout.bit_depth, layout.color_type, PNG_COMPRESSION_TYPE_BASE,
                           PNG_FILTER_TYPE_BASE, PNG_INTERLACE_NONE})
      out.push_back(static_cast<std::byte>(byte));
  });
  append_chunk(out, "IDAT", [&] {
    if (level > 0)
      append_deflated(lines, level, out);
    else
      append_run_deflated(lines, pixel_bytes, out);
    GREATX_CHECK(out.size() < (1u << 31), "{} bytes of {}", out.size(), lines.size());
  });
  append_chunk(out, "IEND", [] {});
  return out;
}

/// Encodes a picture of any kind but depth. A choice of filters makes files of colours 4 % smaller than Up
/// alone; those of ids are smaller with Up.
Bytes encode(const Layout& layout, int level, std::span<const std::byte> pixels) {
  const bool color = layout.color_type == PNG_COLOR_TYPE_RGB;
  return encode(layout, color ? PngFilters::sub_or_up : PngFilters::up, level, pixels);
}

Layout layout_of(const Array& image, int bit_depth, int color_type) {
  const bool rgb = image.shape.size() == 3;
  GREATX_CHECK(image.shape.size() >= 2 && image.shape.size() <= 3 && (!rgb || image.shape[2] == 3) &&
                   image.shape[0] > 0 && image.shape[1] > 0 && image.shape[0] <= largest_side &&
                   image.shape[1] <= largest_side,
               "image of {} axes", image.shape.size());
  return {static_cast<uint32_t>(image.shape[1]), static_cast<uint32_t>(image.shape[0]), bit_depth,
          color_type};
}

Array narrowed(const Array& image) {
  Array narrow(DType::u16, image.shape);
  const std::span<const uint32_t> from = image.as<uint32_t>();
  const std::span<uint16_t> to = narrow.as<uint16_t>();
  for (size_t i = 0; i < from.size(); ++i) {
    if (from[i] > 65535u)
      throw_user_error("pixel {} has the value {}, but a 16-bit PNG holds at most 65535", i, from[i]);
    to[i] = static_cast<uint16_t>(from[i]);
  }
  return narrow;
}

struct Palette {
  std::vector<uint8_t> colors;   ///< RGB triples in order of first use
  std::vector<uint8_t> indices;  ///< [width * height]
};

/// Computes the palette of the picture with `bits` low bits dropped from each channel. Returns false if more
/// than 256 colours remain.
bool quantise(std::span<const uint8_t> rgb, int bits, Palette& palette) {
  palette = {};
  const int half = bits == 0 ? 0 : 1 << (bits - 1);
  constexpr uint32_t slots = 1024;  // hash table with open addressing, at most a quarter full
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

/// Encodes RGB by libpng's simplified interface, with a palette if 256 colours suffice after dropping at most
/// `most_dropped_bits` bits per channel. `flags` are those of png_image.
Bytes encode_small(const Layout& layout, std::span<const uint8_t> rgb, int most_dropped_bits,
                   uint32_t flags) {
  Palette palette;
  bool indexed = false;
  for (int bits = 0; bits <= most_dropped_bits && !indexed; ++bits) indexed = quantise(rgb, bits, palette);

  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = layout.width;
  image.height = layout.height;
  image.format = indexed ? PNG_FORMAT_RGB_COLORMAP : PNG_FORMAT_RGB;
  image.flags = flags;
  image.colormap_entries = static_cast<uint32_t>(palette.colors.size() / 3);
  const uint8_t* const pixels = indexed ? palette.indices.data() : rgb.data();
  const auto row_stride = static_cast<png_int_32>(indexed ? layout.width : 3 * layout.width);
  Bytes out(PNG_IMAGE_PNG_SIZE_MAX(image));
  size_t size = out.size();
  const int written =
      png_image_write_to_memory(&image, out.data(), &size, 0, pixels, row_stride, palette.colors.data());
  GREATX_CHECK(written != 0, "libpng: {}", image.message);
  out.resize(size);
  return out;
}

/// Encodes RGB with alpha by libpng's simplified interface, after dropping so many bits of red, green and
/// blue.
Bytes encode_small_alpha(const Array& image, int dropped_bits, uint32_t flags) {
  GREATX_CHECK(image.shape[0] > 0 && image.shape[1] > 0 && image.shape[0] <= largest_side &&
                   image.shape[1] <= largest_side,
               "image of {} x {} pixels", image.shape[1], image.shape[0]);
  const std::span<const uint8_t> given = image.as<uint8_t>();
  std::vector<uint8_t> pixels(given.begin(), given.end());
  const int half = dropped_bits == 0 ? 0 : 1 << (dropped_bits - 1);
  for (size_t i = 0; i < pixels.size(); ++i)
    if (i % 4 != 3) pixels[i] = static_cast<uint8_t>((pixels[i] >> dropped_bits << dropped_bits) + half);
  png_image out_image{};
  out_image.version = PNG_IMAGE_VERSION;
  out_image.width = static_cast<uint32_t>(image.shape[1]);
  out_image.height = static_cast<uint32_t>(image.shape[0]);
  out_image.format = PNG_FORMAT_RGBA;
  out_image.flags = flags;
  Bytes out(PNG_IMAGE_PNG_SIZE_MAX(out_image));
  size_t size = out.size();
  const int written = png_image_write_to_memory(&out_image, out.data(), &size, 0, pixels.data(), 0, nullptr);
  GREATX_CHECK(written != 0, "libpng: {}", out_image.message);
  out.resize(size);
  return out;
}

/// Writes depth24_code() of `count` depths.
void depth24_codes(const float* metres, size_t count, uint32_t* codes) {
  constexpr auto range_m = static_cast<float>(depth24_range_m);
  bool good = true;
  for (size_t i = 0; i < count; ++i) good &= metres[i] >= 0.0f;
  for (size_t i = 0; i < count; ++i) {
    // As depth24_code(). A signed conversion has a vector instruction, and codes have 24 bits.
    const float depth_m = metres[i] < range_m ? metres[i] : range_m;
    const auto code = static_cast<int32_t>(static_cast<double>(depth_m) * depth24_per_m + 0.5);
    codes[i] = metres[i] < range_m ? static_cast<uint32_t>(code) : depth24_full_scale;
  }
  for (size_t i = 0; !good && i < count; ++i) depth24_code(metres[i]);  // fails at the one that is bad
}

}  // namespace

Bytes encode_png(const Array& image, PngCoding coding) {
  const bool rgb = image.shape.size() == 3;
  const bool quick = coding == PngCoding::quick || coding == PngCoding::quick_inexact;
  const bool inexact = coding == PngCoding::small_inexact || coding == PngCoding::quick_inexact;
  if (quick || inexact || coding == PngCoding::small) {
    GREATX_CHECK(rgb && image.dtype == DType::u8, "{} of {} axes", numpy_name(image.dtype),
                 image.shape.size());
    const int most_dropped_bits = inexact ? 3 : 0;
    const uint32_t flags = quick ? PNG_IMAGE_FLAG_FAST : 0;
    if (image.shape[2] == 4) return encode_small_alpha(image, most_dropped_bits, flags);
    return encode_small(layout_of(image, 8, PNG_COLOR_TYPE_RGB), image.as<uint8_t>(), most_dropped_bits,
                        flags);
  }
  const int level = coding == PngCoding::matched ? matched_level : 0;
  switch (image.dtype) {
    case DType::u8:
      return encode(layout_of(image, 8, rgb ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_GRAY), level, image.bytes);
    case DType::u16:
      GREATX_CHECK(!rgb, "image of {} axes", image.shape.size());
      return encode(layout_of(image, 16, PNG_COLOR_TYPE_GRAY), level, image.bytes);
    case DType::u32:
      return encode_png(narrowed(image), coding);
    default:
      GREATX_CHECK(false, "no PNG holds {}", numpy_name(image.dtype));
  }
  return {};
}

Array decode_png(std::span<const std::byte> file, const std::string& name,
                 const std::vector<int64_t>& expected_shape) {
  ReadSession session;
  session.in = file;
  Layout layout;
  bool interlaced = false;
  if (!read_header(session, layout, interlaced))
    throw_user_error("{}: cannot be read as PNG: {}", name, session.message);
  const bool rgb = layout.color_type == PNG_COLOR_TYPE_RGB;
  const bool known = (layout.bit_depth == 8 && (rgb || layout.color_type == PNG_COLOR_TYPE_GRAY)) ||
                     (layout.bit_depth == 16 && layout.color_type == PNG_COLOR_TYPE_GRAY);
  if (!known || interlaced) {
    throw_user_error(
        "{}: expected 8-bit RGB, 8-bit or 16-bit grey, not interlaced, found depth {}, colour type {}{}",
        name, layout.bit_depth, layout.color_type, interlaced ? ", interlaced" : "");
  }
  const int64_t height = layout.height, width = layout.width;
  const DType dtype = layout.bit_depth == 16 ? DType::u16 : DType::u8;
  const std::vector<int64_t> shape =
      rgb ? std::vector<int64_t>{height, width, 3} : std::vector<int64_t>{height, width};
  check_picture_shape(name, dtype, shape, expected_shape);
  Array image(dtype, shape);
  if (!read_pixels(session, layout, image.bytes.data()))
    throw_user_error("{}: cannot be read as PNG: {}", name, session.message);
  return image;
}

uint32_t depth24_code(float depth_m) {
  GREATX_CHECK(depth_m >= 0.0f, "depth of {} m", depth_m);
  if (depth_m >= static_cast<float>(depth24_range_m)) return depth24_full_scale;
  // fp64 is exact enough for 24 bits of depth times 24 bits of scale. Adding one half rounds to the nearest
  // code.
  return static_cast<uint32_t>(static_cast<double>(depth_m) * depth24_per_m + 0.5);
}

Bytes encode_png_depth24(const Array& depth) {
  GREATX_CHECK(depth.dtype == DType::f32 && depth.shape.size() == 2, "{} of {} axes", numpy_name(depth.dtype),
               depth.shape.size());
  const std::span<const float> metres = depth.as<float>();
  thread_local Bytes pixels;
  pixels.resize(metres.size() * 3);
  // Pieces whose codes stay in the nearest cache; plain loops over them become vector code.
  constexpr size_t piece = 1024;
  std::array<uint32_t, piece> codes;
  for (size_t first = 0; first < metres.size(); first += piece) {
    const size_t count = std::min(piece, metres.size() - first);
    depth24_codes(metres.data() + first, count, codes.data());
    auto* to = reinterpret_cast<uint8_t*>(pixels.data()) + 3 * first;
    for (size_t i = 0; i < count; ++i, to += 3) {
      to[0] = static_cast<uint8_t>(codes[i]);
      to[1] = static_cast<uint8_t>(codes[i] >> 8);
      to[2] = static_cast<uint8_t>(codes[i] >> 16);
    }
  }
  return encode(layout_of(depth, 8, PNG_COLOR_TYPE_RGB), PngFilters::up, depth_level, pixels);
}

Array decode_png_depth24(std::span<const std::byte> file, const std::string& name,
                         const std::vector<int64_t>& expected_shape) {
  std::vector<int64_t> colors = expected_shape;
  if (!colors.empty()) colors.push_back(3);
  const Array image = decode_png(file, name, colors);
  if (image.shape.size() != 3) throw_user_error("{}: expected an 8-bit RGB PNG", name);
  const std::span<const uint8_t> pixels = image.as<uint8_t>();
  Array depth(DType::f32, {image.shape[0], image.shape[1]});
  const std::span<float> metres = depth.as<float>();
  for (size_t i = 0; i < metres.size(); ++i) {
    const uint32_t code = pixels[3 * i] | static_cast<uint32_t>(pixels[3 * i + 1]) << 8 |
                          static_cast<uint32_t>(pixels[3 * i + 2]) << 16;
    metres[i] = static_cast<float>(code * (depth24_range_m / depth24_full_scale));
  }
  return depth;
}

}  // namespace greatx::io
