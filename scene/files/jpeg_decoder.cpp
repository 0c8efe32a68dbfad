// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <csetjmp>
#include <cstddef>  // jpeglib.h needs size_t and FILE
#include <cstdio>
#include <jerror.h>
#include <jpeglib.h>

#include "scene/files/picture_decoders.h"

#ifndef JCS_ALPHA_EXTENSIONS
#error "expected the headers of libjpeg-turbo (libjpeg-dev), found those of another libjpeg"
#endif

namespace greatx::scene {
namespace {

/// A progressive file may repeat its scans almost without bytes, and each scan processes the whole picture.
constexpr int most_scans = 500;

/// Returns a b / 255, rounded.
uint8_t scaled(unsigned a, unsigned b) {
  const unsigned t = a * b + 128;
  return static_cast<uint8_t>((t + (t >> 8)) >> 8);
}

class JpegDecoder : public PictureDecoder {
 public:
  explicit JpegDecoder(std::span<const unsigned char> file) : file_(file) {}
  ~JpegDecoder() override { jpeg_destroy_decompress(&jpeg_); }
  JpegDecoder(const JpegDecoder&) = delete;
  JpegDecoder& operator=(const JpegDecoder&) = delete;

  bool read_header() override {
    jpeg_.err = jpeg_std_error(&errors_);
    errors_.error_exit = on_error;
    errors_.emit_message = on_message;
    jpeg_.client_data = this;
    if (setjmp(jump_) != 0) return false;
    jpeg_create_decompress(&jpeg_);
    jpeg_.client_data = this;  // set again, since jpeg_create_decompress() keeps it but does not promise to
    jpeg_mem_src(&jpeg_, file_.data(), file_.size());
    jpeg_read_header(&jpeg_, TRUE);
    width_ = jpeg_.image_width;
    height_ = jpeg_.image_height;
    return true;
  }

  uint64_t own_bytes() const override {
    // libjpeg holds all coefficients, of 16 bits, until the last scan has arrived.
    return jpeg_.progressive_mode || jpeg_.comps_in_scan < jpeg_.num_components
               ? uint64_t{width_} * height_ * 2 * static_cast<uint64_t>(jpeg_.num_components)
               : 0;
  }

  bool read_rgba(uint8_t* rgba) override {
    if (setjmp(jump_) != 0) return false;
    const bool cmyk = jpeg_.num_components == 4;
    if (cmyk && !jpeg_.saw_Adobe_marker)
      return refuse("four colours without Adobe's marker, which would say what they are");
    jpeg_.out_color_space = cmyk ? JCS_CMYK : JCS_EXT_RGBA;
    jpeg_.dct_method = JDCT_ISLOW;
    progress_.progress_monitor = on_progress;
    jpeg_.progress = &progress_;
    jpeg_start_decompress(&jpeg_);
    while (jpeg_.output_scanline < jpeg_.output_height) {
      JSAMPROW row = rgba + size_t{jpeg_.output_scanline} * width_ * 4;
      jpeg_read_scanlines(&jpeg_, &row, 1);
      if (cmyk) rgba_from_cmyk(row);
    }
    jpeg_finish_decompress(&jpeg_);
    return true;
  }

 private:
  bool refuse(const char* reason) {
    std::snprintf(message_, sizeof(message_), "%s", reason);
    return false;
  }

  /// Adobe stores 255 minus the ink.
  void rgba_from_cmyk(uint8_t* row) const {
    for (size_t x = 0; x < width_; ++x) {
      uint8_t* pixel = row + 4 * x;
      for (int c = 0; c < 3; ++c) pixel[c] = scaled(pixel[c], pixel[3]);
      pixel[3] = 255;
    }
  }

  static JpegDecoder& of(j_common_ptr jpeg) { return *static_cast<JpegDecoder*>(jpeg->client_data); }
  [[noreturn]] static void on_error(j_common_ptr jpeg) {
    char text[JMSG_LENGTH_MAX];
    jpeg->err->format_message(jpeg, text);
    JpegDecoder& decoder = of(jpeg);
    std::snprintf(decoder.message_, sizeof(message_), "%s", text);
    longjmp(decoder.jump_, 1);
  }
  /// Rejects a picture for which libjpeg replaces damaged or missing data by grey and warns. Extra bytes
  /// between markers are harmless, and cameras write them.
  static void on_message(j_common_ptr jpeg, int level) {
    if (level < 0 && jpeg->err->msg_code != JWRN_EXTRANEOUS_DATA && jpeg->err->msg_code != JWRN_JFIF_MAJOR)
      on_error(jpeg);
  }
  static void on_progress(j_common_ptr jpeg) {
    JpegDecoder& decoder = of(jpeg);
    if (jpeg->is_decompressor == FALSE || decoder.jpeg_.input_scan_number <= most_scans) return;
    decoder.refuse("more than 500 scans");
    longjmp(decoder.jump_, 1);
  }

  std::span<const unsigned char> file_;
  jpeg_decompress_struct jpeg_{};
  jpeg_error_mgr errors_{};
  jpeg_progress_mgr progress_{};
  std::jmp_buf jump_;
};

}  // namespace

std::unique_ptr<PictureDecoder> jpeg_decoder(std::span<const unsigned char> file) {
  return std::make_unique<JpegDecoder>(file);
}

}  // namespace greatx::scene
