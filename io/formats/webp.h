// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes pictures and animations as lossy WebP (RFC 9649) by libwebp. With the same version of libwebp, the
// same pictures always give the same bytes.
#pragma once

#include <cstdint>
#include <memory>

#include "core/record.h"
#include "io/files/file.h"

namespace greatx::io {

/// Longest side of a WebP picture, pixels (RFC 9649, section 2.5).
inline constexpr int webp_longest_side = 16383;

/// Encodes one picture, u8 [height, width, 3], whose sides are from 1 to webp_longest_side. `quality` is
/// libwebp's, from 0 to 100.
Bytes encode_webp(const Array& rgb, float quality);

/// Encodes frames, which are added in order, to a file. The animation repeats for ever.
class WebpAnimator {
 public:
  /// `width` and `height` are in pixels, from 1 to webp_longest_side.
  WebpAnimator(int width, int height);
  ~WebpAnimator();
  WebpAnimator(const WebpAnimator&) = delete;
  WebpAnimator& operator=(const WebpAnimator&) = delete;

  /// Adds a frame, u8 [height, width, 3], which is shown from `start_ms` until the start of the next frame.
  /// The first start must be 0, and starts must increase.
  void add(const Array& rgb, int start_ms);
  /// Returns the file. The last frame is shown until `end_ms`. Must be called once, after at least one frame.
  Bytes finish(int end_ms);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace greatx::io
