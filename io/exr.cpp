// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/exr.h"

#include <Imath/ImathBox.h>
#include <cstring>
#include <memory>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <libdeflate.h>

namespace greatx::io {

namespace {

constexpr int compression_level = 1;    // of libdeflate
constexpr size_t lines_per_block = 16;  // of ZIP

template <typename T>
void append_value(Bytes& out, const T& value) {
  append(out, std::as_bytes(std::span(&value, 1)));
}
void append_string(Bytes& out, std::string_view text) {
  append(out, bytes_of(text));
  out.push_back(std::byte{0});
}
void append_attribute(Bytes& out, std::string_view name, std::string_view type, const Bytes& value) {
  append_string(out, name);
  append_string(out, type);
  append_value(out, static_cast<int32_t>(value.size()));
  append(out, value);
}
template <typename... Values>
Bytes packed(const Values&... values) {
  Bytes bytes;
  (append_value(bytes, values), ...);
  return bytes;
}

/// Magic, version 2, and the attributes that the format requires.
Bytes header(int32_t width, int32_t height, std::string_view channels) {
  constexpr int32_t pixel_float = 2;
  constexpr uint8_t compression_zip = 3, increasing_y = 0;
  Bytes list;
  for (const char& channel : channels) {
    append_string(list, std::string_view(&channel, 1));
    append_value(list, pixel_float);
    append_value(list, uint32_t{0});  // perceptually linear: no; reserved
    append_value(list, int32_t{1});   // x sampling
    append_value(list, int32_t{1});   // y sampling
  }
  list.push_back(std::byte{0});
  const Bytes window = packed(int32_t{0}, int32_t{0}, width - 1, height - 1);
  Bytes out = packed(uint32_t{20000630}, uint32_t{2});
  append_attribute(out, "channels", "chlist", list);
  append_attribute(out, "compression", "compression", packed(compression_zip));
  append_attribute(out, "dataWindow", "box2i", window);
  append_attribute(out, "displayWindow", "box2i", window);
  append_attribute(out, "lineOrder", "lineOrder", packed(increasing_y));
  append_attribute(out, "pixelAspectRatio", "float", packed(1.0f));
  append_attribute(out, "screenWindowCenter", "v2f", packed(0.0f, 0.0f));
  append_attribute(out, "screenWindowWidth", "float", packed(1.0f));
  out.push_back(std::byte{0});
  return out;
}

struct FreeCompressor {
  void operator()(libdeflate_compressor* c) const { libdeflate_free_compressor(c); }
};

/// What ZIP does before deflate: even bytes first, odd bytes behind, then differences offset by 128.
void rearrange(std::span<const uint8_t> raw, std::vector<uint8_t>& halves, std::vector<uint8_t>& out) {
  const size_t half = (raw.size() + 1) / 2;
  for (size_t i = 0; i < raw.size() / 2; ++i) {
    halves[i] = raw[2 * i];
    halves[half + i] = raw[2 * i + 1];
  }
  out[0] = halves[0];
  for (size_t i = 1; i < raw.size(); ++i) out[i] = static_cast<uint8_t>(halves[i] - halves[i - 1] + 128);
}

}  // namespace

Bytes encode_exr(const Array& image) {
  const bool rgb = image.shape.size() == 3;
  GREATX_CHECK(image.dtype == DType::f32 && (rgb || image.shape.size() == 2) && image.shape[0] > 0 &&
                   image.shape[1] > 0 && image.shape[0] < (1 << 24) && image.shape[1] < (1 << 24) &&
                   (!rgb || image.shape[2] == 3),
               "{} of {} axes", numpy_name(image.dtype), image.shape.size());
  const auto height = static_cast<size_t>(image.shape[0]), width = static_cast<size_t>(image.shape[1]);
  const size_t channels = rgb ? 3 : 1, row_bytes = width * channels * sizeof(float);
  thread_local const std::unique_ptr<libdeflate_compressor, FreeCompressor> compressor(
      libdeflate_alloc_compressor(compression_level));
  GREATX_CHECK(compressor, "no memory for a compressor");

  // Channels lie in the file in the order of their names: B, G, R; each line's planes one after the other.
  std::vector<float> planes(rgb ? height * width * 3 : 0);
  const std::span<const float> values = image.as<float>();
  for (size_t y = 0; rgb && y < height; ++y)
    for (size_t x = 0; x < width; ++x)
      for (size_t c = 0; c < 3; ++c) planes[(3 * y + 2 - c) * width + x] = values[3 * (y * width + x) + c];
  const auto* const lines = reinterpret_cast<const uint8_t*>(rgb ? planes.data() : values.data());

  Bytes out = header(static_cast<int32_t>(width), static_cast<int32_t>(height), rgb ? "BGR" : "Z");
  const size_t blocks = (height + lines_per_block - 1) / lines_per_block, table = out.size();
  out.reserve(table + blocks * 16 + height * row_bytes);
  out.resize(table + blocks * sizeof(uint64_t));
  const size_t block_bytes = std::min(lines_per_block, height) * row_bytes;
  std::vector<uint8_t> halves(block_bytes), shuffled(block_bytes), deflated(block_bytes);
  for (size_t block = 0; block < blocks; ++block) {
    const size_t y = block * lines_per_block;
    const std::span<const uint8_t> raw(lines + y * row_bytes,
                                       std::min(lines_per_block, height - y) * row_bytes);
    rearrange(raw, halves, shuffled);
    // Into one byte less than the raw block: one that does not get smaller is stored as it is.
    const size_t size = libdeflate_zlib_compress(compressor.get(), shuffled.data(), raw.size(),
                                                 deflated.data(), raw.size() - 1);
    const std::span<const uint8_t> data = size > 0 ? std::span<const uint8_t>(deflated).first(size) : raw;
    const uint64_t offset = out.size();
    std::memcpy(out.data() + table + block * sizeof(uint64_t), &offset, sizeof(uint64_t));
    append_value(out, static_cast<int32_t>(y));
    append_value(out, static_cast<int32_t>(data.size()));
    append(out, std::as_bytes(data));
  }
  return out;
}

Array read_exr(const std::filesystem::path& path) try {
  Imf::InputFile file(path.c_str(), 0);  // 0: in this thread, not in OpenEXR's pool
  const Imath::Box2i window = file.header().dataWindow();
  const int64_t width = int64_t{window.max.x} - window.min.x + 1,
                height = int64_t{window.max.y} - window.min.y + 1;
  const Imf::ChannelList& list = file.header().channels();
  const bool depth = list.findChannel("Z") != nullptr;
  const std::vector<const char*> names =
      depth ? std::vector<const char*>{"Z"} : std::vector<const char*>{"R", "G", "B"};
  for (const char* name : names) {
    if (list.findChannel(name) == nullptr)
      throw_user_error("{}: expected a channel Z, or R, G and B; {} is missing", path.string(), name);
  }
  Array image(DType::f32,
              depth ? std::vector<int64_t>{height, width} : std::vector<int64_t>{height, width, 3});
  const size_t step = names.size() * sizeof(float), row = step * static_cast<size_t>(width);
  char* base = reinterpret_cast<char*>(image.bytes.data());
  Imf::FrameBuffer buffer;
  for (const char* name : names) {
    buffer.insert(name, Imf::Slice::Make(Imf::FLOAT, base, window, step, row));
    base += sizeof(float);
  }
  file.setFrameBuffer(buffer);
  file.readPixels(window.min.y, window.max.y);
  return image;
} catch (const UserError&) {
  throw;
} catch (const std::exception& error) {
  throw_user_error("{}: cannot be read as OpenEXR: {}", path.string(), error.what());
}

}  // namespace greatx::io
