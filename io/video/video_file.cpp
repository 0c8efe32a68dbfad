// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Videos by libavformat and libavcodec, if the program was built with them.
#include "core/error.h"
#include "core/text.h"
#include "io/video/frame_file.h"

#ifdef GREATX_LIBAV

#include <fmt/format.h>

#include "io/files/file.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

namespace greatx::io {

namespace {

constexpr AVRational milliseconds{1, 1000};
/// Of x264: a picture of the interface with sharp text stays readable, and a minute takes some megabytes.
constexpr const char* constant_quality = "20";

template <typename T, void (*free)(T**)>
struct AvFree {
  void operator()(T* object) const { free(&object); }
};
using Packet = std::unique_ptr<AVPacket, AvFree<AVPacket, av_packet_free>>;
using Frame = std::unique_ptr<AVFrame, AvFree<AVFrame, av_frame_free>>;
using Codec = std::unique_ptr<AVCodecContext, AvFree<AVCodecContext, avcodec_free_context>>;
struct SwsFree {
  void operator()(SwsContext* context) const { sws_freeContext(context); }
};
/// The muxer and its open file.
struct MuxerFree {
  void operator()(AVFormatContext* muxer) const {
    avio_closep(&muxer->pb);
    avformat_free_context(muxer);
  }
};

class VideoFile final : public FrameFile {
 public:
  VideoFile(std::filesystem::path path, int width, int height) : path_(std::move(path)) {
    av_log_set_level(AV_LOG_ERROR);
    AVFormatContext* muxer = nullptr;
    expect(avformat_alloc_output_context2(&muxer, nullptr, nullptr, path_.c_str()));
    muxer_.reset(muxer);
    open_encoder(width, height);
    stream_ = avformat_new_stream(muxer, nullptr);
    GREATX_CHECK(stream_ != nullptr, "libavformat: no memory for a stream");
    expect(avcodec_parameters_from_context(stream_->codecpar, encoder_.get()));
    stream_->time_base = milliseconds;
    File::open_for_writing(part()).close();  // it says what is wrong in the words of the system
    expect(avio_open(&muxer->pb, part().c_str(), AVIO_FLAG_WRITE));
    expect(avformat_write_header(muxer, nullptr));
    frame_.reset(av_frame_alloc());
    packet_.reset(av_packet_alloc());
    GREATX_CHECK(frame_ && packet_, "libavutil: no memory for a frame");
    frame_->format = encoder_->pix_fmt;
    frame_->width = encoder_->width;
    frame_->height = encoder_->height;
    expect(av_frame_get_buffer(frame_.get(), 0));
    scaler_.reset(sws_getContext(encoder_->width, encoder_->height, AV_PIX_FMT_RGB24, encoder_->width,
                                 encoder_->height, encoder_->pix_fmt, SWS_BILINEAR, nullptr, nullptr,
                                 nullptr));
    GREATX_CHECK(scaler_ != nullptr, "libswscale cannot convert the pictures");
  }
  ~VideoFile() override {
    std::error_code error;
    if (!finished_) std::filesystem::remove(part(), error);
  }

  void add(const Array& rgb, int64_t start_ms) override {
    expect(av_frame_make_writable(frame_.get()));
    const uint8_t* const lines[] = {rgb.as<uint8_t>().data()};
    const int pitch[] = {static_cast<int>(3 * rgb.shape.at(1))};
    sws_scale(scaler_.get(), lines, pitch, 0, encoder_->height, frame_->data, frame_->linesize);
    frame_->pts = last_ms_ = start_ms;
    encode(frame_.get());
  }

  void finish(int64_t end_ms) override {
    // A video ends with its last picture, so that one comes once more.
    if (end_ms > last_ms_ + 1) {
      expect(av_frame_make_writable(frame_.get()));
      frame_->pts = end_ms - 1;
      encode(frame_.get());
    }
    encode(nullptr);
    expect(av_write_trailer(muxer_.get()));
    bytes_ = static_cast<uint64_t>(std::max<int64_t>(0, avio_tell(muxer_->pb)));
    expect(avio_closep(&muxer_->pb));
    rename_file(part(), path_);
    finished_ = true;
  }
  uint64_t bytes() const override {
    return muxer_->pb == nullptr ? bytes_
                                 : static_cast<uint64_t>(std::max<int64_t>(0, avio_tell(muxer_->pb)));
  }

 private:
  std::filesystem::path part() const { return part_name(path_); }

  void expect(int result) const {
    if (result >= 0) return;
    char text[AV_ERROR_MAX_STRING_SIZE] = "";
    av_strerror(result, text, sizeof text);
    throw_user_error("{}: the video cannot be written: {}", path_.string(), text);
  }

  void open_encoder(int width, int height) {
    const AVCodec* codec = nullptr;
    const bool webm = path_.extension() == ".webm";
    if (!webm) codec = avcodec_find_encoder_by_name("libx264");
    if (codec == nullptr) codec = avcodec_find_encoder(muxer_->oformat->video_codec);
    if (codec == nullptr)
      throw_user_error("{}: libavcodec has no encoder for this kind of file", path_.string());
    encoder_.reset(avcodec_alloc_context3(codec));
    GREATX_CHECK(encoder_ != nullptr, "libavcodec: no memory for an encoder");
    encoder_->width = width & ~1;  // colours have half the pixels
    encoder_->height = height & ~1;
    encoder_->pix_fmt = AV_PIX_FMT_YUV420P;
    encoder_->time_base = milliseconds;
    encoder_->bit_rate = int64_t{4} * width * height;  // for encoders without a constant quality
    encoder_->thread_count = 1;                        // the simulation needs the other cores
    if (std::string_view(codec->name) == "libx264") {
      encoder_->bit_rate = 0;
      av_opt_set(encoder_->priv_data, "preset", "veryfast", 0);
      av_opt_set(encoder_->priv_data, "crf", constant_quality, 0);
    } else if (webm) {
      av_opt_set(encoder_->priv_data, "deadline", "realtime", 0);
      av_opt_set_int(encoder_->priv_data, "cpu-used", 6, 0);
    }
    if ((muxer_->oformat->flags & AVFMT_GLOBALHEADER) != 0) encoder_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    expect(avcodec_open2(encoder_.get(), codec, nullptr));
  }

  /// Encodes a frame, or what is left if it is null, and writes what comes out.
  void encode(const AVFrame* frame) {
    expect(avcodec_send_frame(encoder_.get(), frame));
    for (;;) {
      const int result = avcodec_receive_packet(encoder_.get(), packet_.get());
      if (result == AVERROR(EAGAIN) || result == AVERROR_EOF) return;
      expect(result);
      av_packet_rescale_ts(packet_.get(), milliseconds, stream_->time_base);
      packet_->stream_index = stream_->index;
      // An MP4 ends at the end of its last frame. Without a duration, players would leave this frame out.
      if (packet_->duration <= 0) packet_->duration = av_rescale_q(1, milliseconds, stream_->time_base);
      expect(av_interleaved_write_frame(muxer_.get(), packet_.get()));
    }
  }

  std::filesystem::path path_;
  std::unique_ptr<AVFormatContext, MuxerFree> muxer_;
  Codec encoder_;
  AVStream* stream_ = nullptr;  ///< of the muxer
  Frame frame_;
  Packet packet_;
  std::unique_ptr<SwsContext, SwsFree> scaler_;
  int64_t last_ms_ = 0;
  uint64_t bytes_ = 0;
  bool finished_ = false;
};

}  // namespace

bool writes_video() { return true; }
std::unique_ptr<FrameFile> open_video(const std::filesystem::path& path, int width, int height) {
  return std::make_unique<VideoFile>(path, width, height);
}

}  // namespace greatx::io

#else

namespace greatx::io {

bool writes_video() { return false; }
std::unique_ptr<FrameFile> open_video(const std::filesystem::path& path, int /*width*/, int /*height*/) {
  throw_user_error("{}: this greatx was built without libavformat", printable(path.string()));
}

}  // namespace greatx::io

#endif
