// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/video/frame_file.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"
#include "io/files/file.h"
#include "io/formats/png.h"
#include "io/formats/webp.h"

namespace greatx::io {

namespace {

constexpr const char* video_endings[] = {".mp4", ".mkv", ".mov", ".webm"};

bool is_video(const std::filesystem::path& path) {
  return std::ranges::find(video_endings, path.extension()) != std::end(video_endings);
}

/// A folder of PNG files: 000000.png, 000001.png, …
class PngFolder final : public FrameFile {
 public:
  explicit PngFolder(std::filesystem::path folder) : folder_(std::move(folder)) { create_folders(folder_); }
  void add(const Array& rgb, int64_t /*start_ms*/) override {
    const Bytes file = encode_png(rgb);
    write_file_atomically(folder_ / fmt::format("{:06}.png", count_), file);
    ++count_;
    bytes_ += file.size();
  }
  void finish(int64_t /*end_ms*/) override {}
  uint64_t bytes() const override { return bytes_; }
  bool takes_any_size() const override { return true; }

 private:
  std::filesystem::path folder_;
  int64_t count_ = 0;
  uint64_t bytes_ = 0;
};

/// libwebp gives the whole file at the end. An empty file under the other name shows early that the folder
/// can be written.
class WebpFile final : public FrameFile {
 public:
  WebpFile(std::filesystem::path path, int width, int height)
      : path_(std::move(path)), animator_(width, height) {
    File::open_for_writing(part_name(path_)).close();
  }
  ~WebpFile() override {
    std::error_code error;
    if (!finished_) std::filesystem::remove(part_name(path_), error);
  }
  void add(const Array& rgb, int64_t start_ms) override { animator_.add(rgb, checked(start_ms)); }
  void finish(int64_t end_ms) override {
    const Bytes file = animator_.finish(checked(end_ms));
    bytes_ = file.size();
    write_file_atomically(path_, file);
    finished_ = true;
  }
  uint64_t bytes() const override { return bytes_; }

 private:
  static int checked(int64_t ms) {
    if (ms > std::numeric_limits<int>::max()) throw_user_error("an animated WebP is too long: {} ms", ms);
    return static_cast<int>(ms);
  }
  std::filesystem::path path_;
  WebpAnimator animator_;
  uint64_t bytes_ = 0;
  bool finished_ = false;
};

}  // namespace

std::string frame_file_endings() {
  std::string text = ".webp";
  if (writes_video())
    for (const char* const ending : video_endings) text += fmt::format(", {}", ending);
  return text;
}

void check_frame_file(const std::filesystem::path& path) {
  const std::filesystem::path name = path.filename(), ending = path.extension();
  const std::string shown = printable(path.string());
  if (is_video(path) && !writes_video())
    throw_user_error(
        "{}: this greatx was built without libavformat, so it writes no videos; it writes {} or a "
        "folder of PNG files (docs/pictures.md)",
        shown, frame_file_endings());
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::symlink_status(path, error);
  if (ending == ".webp" || is_video(path)) {
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
      throw_user_error("{}: expected a file or nothing, found something else", shown);
    return;
  }
  if (!ending.empty())
    throw_user_error("{}: expected a name that ends in {}, or a folder's, without an ending", shown,
                     frame_file_endings());
  if (name.empty() || name == "." || name == "..")
    throw_user_error("{}: expected the name of a folder", shown);
  if (!std::filesystem::exists(status)) return;
  if (!std::filesystem::is_directory(status) || !std::filesystem::is_empty(path, error) || error)
    throw_user_error("{}: expected an empty folder or nothing, found something else", shown);
}

std::unique_ptr<FrameFile> open_frame_file(const std::filesystem::path& path, int width, int height) {
  if (is_video(path)) return open_video(path, width, height);
  if (path.extension() != ".webp") return std::make_unique<PngFolder>(path);
  if (width > webp_longest_side || height > webp_longest_side)
    throw_user_error("{}: a WebP has at most {} pixels along a side, found {} x {}", printable(path.string()),
                     webp_longest_side, width, height);
  return std::make_unique<WebpFile>(path, width, height);
}

}  // namespace greatx::io
