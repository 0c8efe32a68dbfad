// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/exr.h"

#include <Imath/ImathBox.h>
#include <cstring>
#include <utility>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfThreading.h>

namespace greatx::io {

namespace {

/// Workers call this from many threads at once, so OpenEXR's own pool stays empty: each picture is done where it is
/// asked for.
int no_threads() {
  [[maybe_unused]] static const bool once = (Imf::setGlobalThreadCount(0), true);
  return 0;
}

constexpr int compression_level = 1;  // of zlib; the library's default, 4, takes 12 % longer for 1 % less

/// Bytes in memory for Imf::OutputFile, which comes back once to fill in the table of its blocks.
class MemoryStream : public Imf::OStream {
 public:
  MemoryStream() : OStream("memory") {}
  void write(const char data[], int count) override {
    const auto size = static_cast<size_t>(count);
    if (at_ + size > bytes_.size()) bytes_.resize(at_ + size);
    std::memcpy(bytes_.data() + at_, data, size);
    at_ += size;
  }
  uint64_t tellp() override { return at_; }
  void seekp(uint64_t position) override { at_ = position; }
  void reserve(size_t size) { bytes_.reserve(size); }
  Bytes take() { return std::move(bytes_); }

 private:
  Bytes bytes_;
  uint64_t at_ = 0;
};

std::vector<const char*> channel_names(bool rgb) {
  return rgb ? std::vector<const char*>{"R", "G", "B"} : std::vector<const char*>{"Z"};
}

/// The interleaved floats at `values` as a frame buffer of channels `names`.
Imf::FrameBuffer frame_buffer(const std::vector<const char*>& names, char* values,
                              const Imath::Box2i& window) {
  const size_t step = names.size() * sizeof(float);
  const size_t row = step * static_cast<size_t>(int64_t{window.max.x} - window.min.x + 1);
  Imf::FrameBuffer buffer;
  for (const char* name : names) {
    buffer.insert(name, Imf::Slice::Make(Imf::FLOAT, values, window, step, row));
    values += sizeof(float);
  }
  return buffer;
}

}  // namespace

Bytes encode_exr(const Array& image) {
  const bool rgb = image.shape.size() == 3;
  GREATX_CHECK(image.dtype == DType::f32 && (rgb || image.shape.size() == 2) && image.shape[0] > 0 &&
                   image.shape[1] > 0 && image.shape[0] < (1 << 24) && image.shape[1] < (1 << 24) &&
                   (!rgb || image.shape[2] == 3),
               "{} of {} axes", numpy_name(image.dtype), image.shape.size());
  // The header has the attributes that the format requires and none of time or owner: same pixels, same bytes.
  Imf::Header header(static_cast<int>(image.shape[1]), static_cast<int>(image.shape[0]));
  header.compression() = Imf::ZIP_COMPRESSION;
  header.zipCompressionLevel() = compression_level;
  const std::vector<const char*> names = channel_names(rgb);
  for (const char* name : names) header.channels().insert(name, Imf::Channel(Imf::FLOAT));
  // The library takes a pointer to mutable pixels for reading and writing alike; here it only reads.
  char* const values = reinterpret_cast<char*>(const_cast<std::byte*>(image.bytes.data()));

  MemoryStream stream;
  stream.reserve(image.bytes.size());
  {
    Imf::OutputFile file(stream, header, no_threads());
    file.setFrameBuffer(frame_buffer(names, values, header.dataWindow()));
    file.writePixels(static_cast<int>(image.shape[0]));
  }  // writes the table of blocks
  return stream.take();
}

Array read_exr(const std::filesystem::path& path) try {
  Imf::InputFile file(path.c_str(), no_threads());
  const Imath::Box2i window = file.header().dataWindow();
  const int64_t width = int64_t{window.max.x} - window.min.x + 1,
                height = int64_t{window.max.y} - window.min.y + 1;
  const Imf::ChannelList& list = file.header().channels();
  const bool depth = list.findChannel("Z") != nullptr;
  const std::vector<const char*> names = channel_names(!depth);
  for (const char* name : names) {
    if (list.findChannel(name) == nullptr)
      throw_user_error("{}: expected a channel Z, or R, G and B; {} is missing", path.string(), name);
  }
  Array image(DType::f32,
              depth ? std::vector<int64_t>{height, width} : std::vector<int64_t>{height, width, 3});
  file.setFrameBuffer(frame_buffer(names, reinterpret_cast<char*>(image.bytes.data()), window));
  file.readPixels(window.min.y, window.max.y);
  return image;
} catch (const UserError&) {
  throw;
} catch (const std::exception& error) {
  throw_user_error("{}: cannot be read as OpenEXR: {}", path.string(), error.what());
}

}  // namespace greatx::io
