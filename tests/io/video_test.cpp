// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Videos of data sets, decoded again by libavcodec.
#include <cmath>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "draw/sheet/animation.h"
#include "io/formats/png.h"
#include "io/video/frame_file.h"
#include "tests/io/sample_set.h"

#ifdef GREATX_LIBAV
extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libswscale/swscale.h>
}
#endif

namespace greatx::io {
namespace {

using testing::HasSubstr;

class VideoOfSample : public SampleSet {};

std::string fault_of_animation(const DatasetReader& reader, const std::filesystem::path& file) {
  try {
    write_animation(reader, file, {});
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

/// A folder holds each frame as it is, and is not overwritten.
TEST_F(VideoOfSample, AFolderHasTheFrames) {
  const DatasetReader reader(set_);
  const AnimationFile written = write_animation(reader, folder_.path() / "frames", {});
  ASSERT_EQ(written.frames, 3u);
  const Animation animation(reader, {});
  for (size_t i = 0; i < 3; ++i) {
    const Array read =
        decode_png(read_file(folder_.path() / "frames" / fmt::format("{:06}.png", i)), "frame");
    EXPECT_TRUE(read.bytes == animation.frame(i).bytes) << i;
  }
  EXPECT_THAT(fault_of_animation(reader, folder_.path() / "frames"), HasSubstr("expected an empty folder"));
}

TEST_F(VideoOfSample, WithoutLibavTheMessageSaysSo) {
  if (writes_video()) GTEST_SKIP() << "built with libavformat";
  EXPECT_THAT(fault_of_animation(DatasetReader(set_), folder_.path() / "a.mp4"),
              HasSubstr("built without libavformat, so it writes no videos; it writes .webp or a folder"));
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "a.mp4"));
}

#ifdef GREATX_LIBAV

struct Video {
  int width = 0, height = 0;
  std::vector<double> times_ms;
  std::vector<Array> rgb;
};

template <typename T, void (*release)(T**)>
struct AvRelease {
  void operator()(T* object) const { release(&object); }
};

/// Decodes a video by libavformat and libavcodec.
Video decode_video(const std::filesystem::path& file) {
  Video video;
  AVFormatContext* opened = nullptr;
  if (avformat_open_input(&opened, file.c_str(), nullptr, nullptr) < 0) return video;
  const std::unique_ptr<AVFormatContext, AvRelease<AVFormatContext, avformat_close_input>> demuxer(opened);
  if (avformat_find_stream_info(demuxer.get(), nullptr) < 0 || demuxer->nb_streams != 1) return video;
  const AVStream* const stream = demuxer->streams[0];
  const AVCodec* const codec = avcodec_find_decoder(stream->codecpar->codec_id);
  if (codec == nullptr) return video;
  const std::unique_ptr<AVCodecContext, AvRelease<AVCodecContext, avcodec_free_context>> decoder(
      avcodec_alloc_context3(codec));
  avcodec_parameters_to_context(decoder.get(), stream->codecpar);
  if (avcodec_open2(decoder.get(), codec, nullptr) < 0) return video;
  const std::unique_ptr<AVPacket, AvRelease<AVPacket, av_packet_free>> packet(av_packet_alloc());
  const std::unique_ptr<AVFrame, AvRelease<AVFrame, av_frame_free>> frame(av_frame_alloc());
  video.width = decoder->width, video.height = decoder->height;
  const auto take_frames = [&] {
    while (avcodec_receive_frame(decoder.get(), frame.get()) >= 0) {
      video.times_ms.push_back(1e3 * static_cast<double>(frame->pts) * av_q2d(stream->time_base));
      Array& rgb = video.rgb.emplace_back(DType::u8, std::vector<int64_t>{frame->height, frame->width, 3});
      SwsContext* const scaler =
          sws_getContext(frame->width, frame->height, static_cast<AVPixelFormat>(frame->format), frame->width,
                         frame->height, AV_PIX_FMT_RGB24, SWS_BILINEAR, nullptr, nullptr, nullptr);
      uint8_t* const lines[] = {rgb.as<uint8_t>().data()};
      const int pitch[] = {3 * frame->width};
      sws_scale(scaler, frame->data, frame->linesize, 0, frame->height, lines, pitch);
      sws_freeContext(scaler);
    }
  };
  while (av_read_frame(demuxer.get(), packet.get()) >= 0) {
    avcodec_send_packet(decoder.get(), packet.get());
    av_packet_unref(packet.get());
    take_frames();
  }
  avcodec_send_packet(decoder.get(), nullptr);
  take_frames();
  return video;
}

double mean_error(const Array& a, const Array& b) {
  if (a.shape != b.shape) return 255.0;
  double sum = 0.0;
  for (size_t i = 0; i < a.bytes.size(); ++i) sum += std::abs(a.as<uint8_t>()[i] - b.as<uint8_t>()[i]);
  return sum / static_cast<double>(a.bytes.size());
}

/// Every frame comes back at its time, in its size and with its picture. A video ends with its last frame, so
/// that one is there twice.
TEST_F(VideoOfSample, DecodesToTheFramesThatWereDrawn) {
  const DatasetReader reader(set_);
  AnimationOptions options;
  options.rate_hz = 8.0;
  options.sheet.theme = &light_theme();
  const Animation animation(reader, options);
  for (const char* const name : {"a.mp4", "a.mkv"}) {
    const AnimationFile written = write_animation(reader, folder_.path() / name, options);
    EXPECT_EQ(written.frames, 3u);
    EXPECT_EQ(written.duration_ms, 375);
    EXPECT_EQ(written.bytes, std::filesystem::file_size(folder_.path() / name));
    const Video video = decode_video(folder_.path() / name);
    EXPECT_EQ(video.width, animation.width()) << name;
    EXPECT_EQ(video.height, animation.height()) << name;
    ASSERT_EQ(video.rgb.size(), 4u) << name;
    const double times[] = {0.0, 125.0, 250.0, 374.0};
    for (size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(video.times_ms[i], times[i], 1.0) << name;
      EXPECT_LT(mean_error(video.rgb[i], animation.frame(std::min<size_t>(i, 2))), 4.0) << name << ' ' << i;
      EXPECT_GT(mean_error(video.rgb[i], animation.frame(i == 0 ? 1 : 0)), 4.0) << name << ' ' << i;
    }
  }
}

/// The same data set, library and options give the same bytes.
TEST_F(VideoOfSample, HasTheSameBytesAgain) {
  const DatasetReader reader(set_);
  for (const char* const name : {"a.mp4", "b.mp4"}) write_animation(reader, folder_.path() / name, {});
  EXPECT_EQ(read_file(folder_.path() / "a.mp4"), read_file(folder_.path() / "b.mp4"));
}

#endif

}  // namespace
}  // namespace greatx::io
