// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws a data set as an animated picture or a video. Each frame shows the records of all sensors at one
// moment, in tiles like those of the contact sheet, and marks this moment in the plots.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "draw/sheet/sheet_tiles.h"
#include "io/dataset/dataset_reader.h"

namespace greatx::io {

/// Holds the times of the frames. Without a rate the animation runs in real time if its frames are then 25 to
/// 150 ms apart on average. Otherwise the frames are 100 ms apart.
struct Playback {
  std::vector<int> start_ms;  ///< start of each frame; the first is 0
  int end_ms = 0;             ///< end of the last frame
  double speed = 1.0;         ///< simulated time divided by shown time; 1: real time, 2: twice as fast
};
/// Returns the times of the frames of one or more moments, `rate_hz` frames a second; 0: without a rate.
/// Throws UserError unless the times of the moments ascend.
Playback playback_of(const std::vector<SheetMoment>& moments, double rate_hz = 0.0);

struct AnimationOptions {
  size_t frames = 36;    ///< at most
  double rate_hz = 0.0;  ///< frames a second, at most 1000; 0: real time or ten (Playback)
  SheetOptions sheet{};
  /// Called behind each frame that was written, with the number of those done.
  std::function<void(size_t done, size_t all)> on_frame{};
};

/// Draws the frames of an animation. The first plot of each sensor has a tile of its own behind the pictures;
/// tiles that are still free show further plots.
class Animation {
 public:
  /// Uses at most options.frames moments, equally spaced from the first to the last (choose_moments()).
  /// Throws UserError if `frames` is 0, the sequence has no records, its times do not ascend, or no sensor
  /// has a frame panel.
  Animation(const DatasetReader& reader, const AnimationOptions& options, uint32_t sequence = 0);

  size_t frames() const { return moments_.size(); }
  const Playback& playback() const { return playback_; }
  int width() const { return background_.width() * background_.factor(); }
  int height() const { return background_.height() * background_.factor(); }
  /// Returns frame i, u8 [height, width, 3].
  Array frame(size_t i) const;

 private:
  void choose_panels(const DatasetReader& reader, uint32_t sequence, const std::vector<size_t>& sensors,
                     const SheetOptions& options);
  void draw_background(const std::string& title, const SheetOptions& options);

  std::vector<SheetMoment> moments_;
  Playback playback_;
  Panels panels_;  ///< all frame panels, and the series panels that have a tile
  SheetLayout layout_;
  Canvas background_{1, 1, dark_theme()};  ///< the parts that are the same in all frames
};

/// Describes a written animation.
struct AnimationFile {
  size_t frames = 0;
  int width = 0, height = 0, duration_ms = 0;
  uint64_t bytes = 0;
};
/// Writes an animated WebP that repeats endlessly, a video, or a folder of PNG files, as the file's name says
/// (open_frame_file() of io/video/frame_file.h). Throws UserError like Animation, and if such a file cannot
/// be written.
AnimationFile write_animation(const DatasetReader& reader, const std::filesystem::path& file,
                              const AnimationOptions& options, uint32_t sequence = 0);

}  // namespace greatx::io
