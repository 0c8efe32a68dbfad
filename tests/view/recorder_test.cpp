// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Recordings: what is given is what is read back, a file is complete or not there, and nothing is lost in
// silence.
#include "view/record/recorder.h"

#include <algorithm>
#include <fstream>
#include <memory>
#include <set>
#include <sys/resource.h>
#include <webp/demux.h>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "io/files/file.h"
#include "io/formats/png.h"
#include "io/video/frame_file.h"
#include "tests/support/temporary_folder.h"

namespace greatx::view {
namespace {

using testing::HasSubstr;
using WhenFull = Recorder::WhenFull;

Array picture(int width, int height, int grey) {
  Array rgb(DType::u8, {height, width, 3});
  std::ranges::fill(rgb.bytes, static_cast<std::byte>(grey));
  return rgb;
}

std::set<std::string> names_in(const std::filesystem::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.insert(entry.path().filename().string());
  return names;
}

std::string fault_of(const std::filesystem::path& path) {
  try {
    Recorder recorder(path, WhenFull::wait);
    recorder.stop(0);
    recorder.wait();
    return recorder.status().error;
  } catch (const UserError& error) {
    return error.what();
  }
}

class Recording : public testing::Test {
 protected:
  std::filesystem::path folder() const { return temporary_.path(); }
  /// Records pictures of rising grey, 40 ms each, and returns what has become of it.
  static RecorderStatus record(const std::filesystem::path& path, int count, int width = 64,
                               int height = 48) {
    Recorder recorder(path, WhenFull::wait, 3 * 64 * 48 * 3);  // three pictures wait at most
    for (int i = 0; i < count; ++i) recorder.add(picture(width, height, 10 * i), 40 * i);
    recorder.stop(40 * count);
    recorder.wait();
    return recorder.status();
  }

 private:
  greatx::test::TemporaryFolder temporary_;
};

TEST_F(Recording, PngFilesHoldEveryPicture) {
  const RecorderStatus status = record(folder() / "frames", 20);
  EXPECT_EQ(status.error, "");
  EXPECT_EQ(status.taken, 20);
  EXPECT_EQ(status.written, 20);
  EXPECT_EQ(names_in(folder() / "frames").size(), 20u);
  uint64_t bytes = 0;
  for (const int i : {0, 7, 19}) {
    const auto file = folder() / "frames" / fmt::format("{:06}.png", i);
    const Array read = io::decode_png(io::read_file(file), "frame");
    EXPECT_TRUE(read.bytes == picture(64, 48, 10 * i).bytes) << i;
    bytes += std::filesystem::file_size(file);
  }
  EXPECT_GT(status.bytes, bytes);
}

TEST_F(Recording, WebpHasTheFramesAndTimes) {
  EXPECT_EQ(record(folder() / "a.webp", 12).error, "");
  EXPECT_THAT(names_in(folder()), testing::ElementsAre("a.webp"));
  const io::Bytes file = io::read_file(folder() / "a.webp");
  const WebPData data{reinterpret_cast<const uint8_t*>(file.data()), file.size()};
  const std::unique_ptr<WebPAnimDecoder, void (*)(WebPAnimDecoder*)> decoder(
      WebPAnimDecoderNew(&data, nullptr), WebPAnimDecoderDelete);
  ASSERT_NE(decoder, nullptr);
  uint8_t* rgba = nullptr;
  int end_ms = 0, frames = 0;
  for (; WebPAnimDecoderGetNext(decoder.get(), &rgba, &end_ms) != 0; ++frames) {
    EXPECT_EQ(end_ms, 40 * (frames + 1));
    EXPECT_NEAR(rgba[4 * (24 * 64 + 32)], 10 * frames, 3);
  }
  EXPECT_EQ(frames, 12);
}

TEST_F(Recording, AnotherSizeEndsAFileAndNotAFolder) {
  for (const char* const name : {"sizes.webp", "sizes"}) {
    Recorder recorder(folder() / name, WhenFull::wait);
    recorder.add(picture(64, 48, 1), 0);
    recorder.add(picture(64, 48, 2), 40);
    recorder.add(picture(32, 48, 3), 80);
    recorder.stop(120);
    recorder.wait();
    EXPECT_EQ(recorder.status().error, "");
    const bool ends = std::string_view(name) == "sizes.webp";
    EXPECT_EQ(recorder.status().written, ends ? 2 : 3);
    EXPECT_EQ(recorder.status().note.empty(), !ends);
  }
  EXPECT_TRUE(std::filesystem::exists(folder() / "sizes.webp"));
}

TEST_F(Recording, PicturesThatAreLeftOutAreCounted) {
  Recorder recorder(folder() / "slow.webp", WhenFull::leave_out, 1);
  for (int i = 0; i < 50; ++i) recorder.add(picture(640, 480, i), 40 * i);
  recorder.stop(2000);
  recorder.wait();
  const RecorderStatus status = recorder.status();
  EXPECT_EQ(status.taken + status.left_out, 50);
  EXPECT_GE(status.taken, 1);
  EXPECT_EQ(status.written, status.taken);
}

TEST_F(Recording, AtTheEndOfTheProgramAFileIsComplete) {
  { Recorder(folder() / "end", WhenFull::wait).add(picture(64, 48, 5), 0); }
  EXPECT_THAT(names_in(folder() / "end"), testing::ElementsAre("000000.png"));
}

TEST_F(Recording, FaultsNameTheFile) {
  EXPECT_THAT(fault_of(folder() / "a.gif"), HasSubstr("a.gif: expected a name that ends in .webp"));
  std::ofstream(folder() / "taken").put('x');
  EXPECT_THAT(fault_of(folder() / "taken"), HasSubstr("expected an empty folder or nothing"));
  std::filesystem::create_directory(folder() / "full");
  std::ofstream(folder() / "full" / "file").put('x');
  EXPECT_THAT(fault_of(folder() / "full"), HasSubstr("expected an empty folder or nothing"));
  std::filesystem::create_directory(folder() / "b.webp");
  EXPECT_THAT(fault_of(folder() / "b.webp"), HasSubstr("expected a file or nothing"));
  EXPECT_THAT(
      fault_of(folder() / "a.mp4"),
      HasSubstr(io::writes_video() ? "nothing was recorded" : "this greatx was built without libavformat"));
}

TEST_F(Recording, WhatCannotBeWrittenIsAnErrorAndLeavesNothing) {
  EXPECT_THAT(record(folder() / "none" / "a.webp", 2).error, HasSubstr("none/a.webp.part"));
  std::ofstream(folder() / "plain").put('x');
  EXPECT_THAT(record(folder() / "plain" / "frames", 2).error, HasSubstr("plain"));
  const RecorderStatus empty = record(folder() / "empty.webp", 0);
  EXPECT_THAT(empty.error, HasSubstr("nothing was recorded"));
  EXPECT_THAT(names_in(folder()), testing::ElementsAre("plain"));
}

TEST_F(Recording, AFileThatMayNotGrowIsAnErrorAndLeavesNothing) {
  io::ignore_file_size_signal();
  rlimit limit{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &limit), 0);
  rlimit small = limit;
  small.rlim_cur = 60;  // as on a full disk
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const RecorderStatus webp = record(folder() / "a.webp", 3), png = record(folder() / "frames", 3);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
  EXPECT_THAT(webp.error, HasSubstr("a.webp"));
  EXPECT_THAT(png.error, HasSubstr("000000.png"));
  EXPECT_THAT(names_in(folder()), testing::ElementsAre("frames"));
  EXPECT_THAT(names_in(folder() / "frames"), testing::IsEmpty());
}

TEST_F(Recording, VideosAreComplete) {
  if (!io::writes_video()) GTEST_SKIP() << "built without libavformat";
  for (const char* const name : {"v.mp4", "v.mkv", "v.mov", "v.webm"}) {
    const RecorderStatus status = record(folder() / name, 20, 65, 49);
    EXPECT_EQ(status.error, "") << name;
    EXPECT_EQ(status.written, 20) << name;
    EXPECT_EQ(std::filesystem::file_size(folder() / name), status.bytes) << name;
    EXPECT_GT(status.bytes, 500u) << name;
  }
  EXPECT_THAT(names_in(folder()), testing::ElementsAre("v.mkv", "v.mov", "v.mp4", "v.webm"));
}

}  // namespace
}  // namespace greatx::view
