// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads OpenEXR files as other programs do. They ask the OpenEXR library for channels by name. Where a file
// lacks a channel, the library silently fills in the slice's fill value. The rules are those of
//   OpenCV 4     modules/imgcodecs/src/grfmt_exr.cpp: R, G, B if the file has one of them, else Y as grey;
//   FreeImage 3  Source/FreeImage/PluginEXR.cpp (imageio's reader): R, G, B if all are there, else Y.
// Both programs were tried on files that greatx wrote (OpenCV 4.10, imageio 2.38 with FreeImage 3.18), as
// were ffmpeg (gray32 from Y alone) and OpenImageIO (every channel).
#include <Imath/ImathBox.h>
#include <limits>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/random.h"
#include "io/formats/exr.h"
#include "tests/support/temporary_folder.h"

namespace greatx::io {
namespace {

/// Returns the interleaved pixels of these channels, with zeros for channels that the file lacks.
std::vector<float> read_channels(const std::filesystem::path& path, const std::vector<const char*>& names) {
  Imf::InputFile file(path.c_str());
  const Imath::Box2i window = file.header().dataWindow();
  const size_t width = size_t(window.max.x - window.min.x + 1),
               height = size_t(window.max.y - window.min.y + 1);
  std::vector<float> pixels(width * height * names.size(), -1.0f);
  const size_t step = names.size() * sizeof(float);
  Imf::FrameBuffer buffer;
  for (size_t i = 0; i < names.size(); ++i)
    buffer.insert(names[i], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(pixels.data() + i), step,
                                       step * width, 1, 1, 0.0));
  file.setFrameBuffer(buffer);
  file.readPixels(window.min.y, window.max.y);
  return pixels;
}

bool has(const std::filesystem::path& path, const char* name) {
  return Imf::InputFile(path.c_str()).header().channels().findChannel(name) != nullptr;
}

std::vector<float> as_opencv_reads(const std::filesystem::path& path) {
  if (has(path, "R") || has(path, "G") || has(path, "B")) return read_channels(path, {"R", "G", "B"});
  return read_channels(path, {"Y"});
}
std::vector<float> as_freeimage_reads(const std::filesystem::path& path) {
  if (has(path, "R") && has(path, "G") && has(path, "B")) return read_channels(path, {"R", "G", "B"});
  return read_channels(path, {"Y"});
}

class ExrReaders : public testing::Test {
 protected:
  Array written(std::vector<int64_t> shape) {
    Array image(DType::f32, std::move(shape));
    RandomStream random(3, 0);
    for (float& value : image.as<float>()) value = static_cast<float>(random.uniform(0.1, 5000.0));
    image.as<float>()[7] = std::numeric_limits<float>::infinity();
    write_file_atomically(file_, encode_exr(image));
    return image;
  }
  void expect_same(const Array& image) {
    const std::vector<float> expected(image.as<float>().begin(), image.as<float>().end());
    EXPECT_EQ(as_opencv_reads(file_), expected);
    EXPECT_EQ(as_freeimage_reads(file_), expected);
    EXPECT_EQ(read_exr(file_).bytes, image.bytes);
  }
  const test::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_.path() / "frame.exr";
};

TEST_F(ExrReaders, OfPicturesFindDepth) {
  expect_same(written({31, 45}));
  int channels = 0;
  Imf::InputFile file(file_.c_str());
  for (auto at = file.header().channels().begin(); at != file.header().channels().end(); ++at) ++channels;
  EXPECT_EQ(channels, 1);  // ffmpeg takes Y as grey only if Y is alone
}

TEST_F(ExrReaders, OfPicturesFindColours) { expect_same(written({16, 9, 3})); }

/// Old data sets name the channel of a plane Z. The bytes of such a file differ from others in this letter
/// alone.
TEST_F(ExrReaders, OfGreatxReadOldDataSets) {
  const Array image = written({31, 45});
  Bytes file = encode_exr(image);
  const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  const size_t at = text.find(std::string_view("chlist\0\x13\0\0\0Y\0", 13));
  ASSERT_NE(at, text.npos);
  file[at + 11] = std::byte{'Z'};
  write_file_atomically(file_, file);
  EXPECT_TRUE(has(file_, "Z"));
  const Array back = read_exr(file_);
  EXPECT_EQ(back.shape, image.shape);
  EXPECT_EQ(back.bytes, image.bytes);
  EXPECT_THAT(as_opencv_reads(file_),
              testing::Each(0.0f));  // other programs do not find Z, so greatx writes Y
}

}  // namespace
}  // namespace greatx::io
