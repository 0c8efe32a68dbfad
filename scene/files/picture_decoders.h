// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Declares the two decoders behind decode_picture(). Both libraries leave a failed call by longjmp. Functions
// that call setjmp therefore own nothing that needs a destructor; such objects are members of the class.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace greatx::scene {

class PictureDecoder {
 public:
  virtual ~PictureDecoder() = default;
  /// Reads the header. Returns false if it is invalid; error() then gives the reason.
  virtual bool read_header() = 0;
  uint32_t width() const { return width_; }
  uint32_t height() const { return height_; }
  /// Returns the memory that the library itself holds while it decodes, beyond a few rows.
  virtual uint64_t own_bytes() const { return 0; }
  /// Writes 4 width() height() bytes. Returns false if the file is invalid; error() then gives the reason.
  virtual bool read_rgba(uint8_t* rgba) = 0;
  const char* error() const { return message_; }

 protected:
  uint32_t width_ = 0, height_ = 0;
  char message_[256] = "no memory";
};

/// The bytes of the file must outlive the decoder.
std::unique_ptr<PictureDecoder> png_decoder(std::span<const unsigned char> file);
std::unique_ptr<PictureDecoder> jpeg_decoder(std::span<const unsigned char> file);

}  // namespace greatx::scene
