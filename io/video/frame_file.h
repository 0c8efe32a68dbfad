// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Files that hold a series of pictures: a folder of PNG files, an animated WebP, or a video by libavformat.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "core/record.h"

namespace greatx::io {

/// A file is complete after finish(). Before that it has another name, or is not there. The destructor of an
/// unfinished one removes what it has written, except the pictures of a folder, which are complete one by
/// one. All functions throw UserError for what cannot be written.
class FrameFile {
 public:
  virtual ~FrameFile() = default;
  /// Adds a picture, u8 [height, width, 3], that is shown from `start_ms` on. The first start is 0, and
  /// starts increase.
  virtual void add(const Array& rgb, int64_t start_ms) = 0;
  /// Completes the file. The last picture is shown until `end_ms`.
  virtual void finish(int64_t end_ms) = 0;
  /// Bytes that are written so far.
  virtual uint64_t bytes() const = 0;
  /// Whether pictures may differ in size.
  virtual bool takes_any_size() const { return false; }
};

/// Throws UserError if `path` names no kind of file that can be written, or something is in the way there.
void check_frame_file(const std::filesystem::path& path);
/// Opens the file for pictures of a size, after check_frame_file(). Its name says the kind: .webp; .mp4,
/// .mkv, .mov or .webm; without an ending a folder, which is empty or is made.
std::unique_ptr<FrameFile> open_frame_file(const std::filesystem::path& path, int width, int height);

/// Says which endings can be written: ".webp, .mp4, ...".
std::string frame_file_endings();
/// Whether this program can write videos.
bool writes_video();
std::unique_ptr<FrameFile> open_video(const std::filesystem::path& path, int width, int height);

}  // namespace greatx::io
