// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <png.h>

#include "scene/files/picture.h"
#include "scene/files/picture_decoders.h"

namespace greatx::scene {
namespace {

class PngDecoder : public PictureDecoder {
 public:
  explicit PngDecoder(std::span<const unsigned char> file) : left_(file) {}
  ~PngDecoder() override { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngDecoder(const PngDecoder&) = delete;
  PngDecoder& operator=(const PngDecoder&) = delete;

  bool read_header() override {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning);
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
    if (info_ == nullptr || setjmp(png_jmpbuf(png_)) != 0) return false;
    png_set_read_fn(png_, this, on_read);
    // Profiles and texts are not needed, and decompression may enlarge them a thousandfold. They are skipped
    // unread.
    png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, ignored_chunks, ignored_count);
    png_read_info(png_, info_);
    width_ = png_get_image_width(png_, info_);
    height_ = png_get_image_height(png_, info_);
    return true;
  }

  bool read_rgba(uint8_t* rgba) override {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_set_expand(png_);  // palettes, fewer bits than 8, transparent colours
    png_set_strip_16(png_);
    png_set_gray_to_rgb(png_);
    png_set_add_alpha(png_, 0xFF, PNG_FILLER_AFTER);
    const int passes = png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    if (png_get_rowbytes(png_, info_) != size_t{width_} * 4) png_error(png_, "rows are not RGBA");
    for (int pass = 0; pass < passes; ++pass)
      for (uint32_t y = 0; y < height_; ++y) png_read_row(png_, rgba + size_t{y} * width_ * 4, nullptr);
    png_read_end(png_, nullptr);
    return true;
  }

 private:
  static PngDecoder& of(png_structp png) { return *static_cast<PngDecoder*>(png_get_error_ptr(png)); }
  [[noreturn]] static void on_error(png_structp png, png_const_charp message) {
    std::snprintf(of(png).message_, sizeof(message_), "%s", message);
    png_longjmp(png, 1);
  }
  static void on_warning(png_structp, png_const_charp) {}
  static void on_read(png_structp png, png_bytep data, size_t size) {
    std::span<const unsigned char>& left = of(png).left_;
    if (size > left.size()) png_error(png, "the file is cut off");
    std::memcpy(data, left.data(), size);
    left = left.subspan(size);
  }

  static constexpr int ignored_count = 7;
  static constexpr png_byte ignored_chunks[] = "iCCP\0zTXt\0iTXt\0tEXt\0sPLT\0hIST\0eXIf";
  std::span<const unsigned char> left_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

}  // namespace

std::unique_ptr<PictureDecoder> png_decoder(std::span<const unsigned char> file) {
  return std::make_unique<PngDecoder>(file);
}

}  // namespace greatx::scene
