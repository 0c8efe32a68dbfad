// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws a data set as a short animated picture. Each frame shows the records of all sensors at one moment, in
// tiles like those of the contact sheet.
#pragma once

#include <filesystem>
#include <vector>

#include "draw/sheet/sheet_tiles.h"
#include "io/dataset/dataset_reader.h"

namespace greatx::io {

/// Holds the times of the frames. The animation runs in real time if its frames are then 25 to 150 ms apart
/// on average. Otherwise the frames are 100 ms apart.
struct Playback {
  std::vector<int> start_ms;  ///< start of each frame; the first is 0
  int end_ms = 0;             ///< end of the last frame
  double speed = 1.0;         ///< simulated time divided by shown time; 1: real time, 2: twice as fast
};
/// Returns the times of the frames of one or more moments. Throws UserError unless the times of the moments
/// ascend.
Playback playback_of(const std::vector<SheetMoment>& moments);

/// Draws the frames of an animation. A row has at most three tiles; four panels are arranged two by two. Free
/// tiles in the last row show plots of the whole sequence, one for each sensor.
class Animation {
 public:
  /// Uses at most `frames` moments, equally spaced from the first to the last (choose_moments()). Throws
  /// UserError if `frames` is 0, the sequence has no records, its times do not ascend, or no sensor has a
  /// frame panel.
  Animation(const DatasetReader& reader, size_t frames, uint32_t sequence = 0);

  size_t frames() const { return moments_.size(); }
  const Playback& playback() const { return playback_; }
  int width() const { return background_.width(); }
  int height() const { return background_.height(); }
  /// Returns frame i, u8 [height, width, 3].
  Array frame(size_t i) const;

 private:
  void choose_panels(const DatasetReader& reader, uint32_t sequence);
  Rect tile(const Band& band, size_t column) const;
  void draw_background(const std::string& title);

  std::vector<SheetMoment> moments_;
  Playback playback_;
  Panels panels_;  ///< all frame panels, and the series panels for which there is a free tile
  std::vector<Band> bands_;
  std::vector<int> tops_;                 ///< top of the tiles of each band, pixels
  Canvas background_{1, 1, theme::page};  ///< the parts that are the same in all frames
};

/// Describes a written animation.
struct AnimationFile {
  size_t frames = 0;
  int width = 0, height = 0, duration_ms = 0;
  uint64_t bytes = 0;
};
/// Writes an animated WebP that repeats endlessly. Throws UserError like Animation, and if the name of the
/// file does not end in .webp or the picture is too high for WebP.
AnimationFile write_animation(const DatasetReader& reader, const std::filesystem::path& file, size_t frames,
                              uint32_t sequence = 0);

}  // namespace greatx::io
