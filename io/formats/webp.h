// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Animated pictures as WebP (RFC 9649), lossy, written by libwebp: the same frames always give the same bytes
// (of one libwebp).
#pragma once

#include <cstdint>
#include <memory>

#include "core/record.h"
#include "io/files/file.h"

namespace greatx::io {

/// Longest side of a WebP picture, pixels (RFC 9649, section 2.5).
inline constexpr int webp_longest_side = 16383;

/// Takes frames in order, gives the file. Without end it starts again after the last frame.
class WebpAnimator {
 public:
  /// Width and height in pixels, 1 to webp_longest_side.
  WebpAnimator(int width, int height);
  ~WebpAnimator();
  WebpAnimator(const WebpAnimator&) = delete;
  WebpAnimator& operator=(const WebpAnimator&) = delete;

  /// u8 [height, width, 3], shown from `start_ms` until the next one's start; starts rise, the first is 0.
  void add(const Array& rgb, int start_ms);
  /// The file; the last frame is shown until `end_ms`. Once, after at least one frame.
  Bytes finish(int end_ms);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace greatx::io
