// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A data set as a short animated picture: moment by moment what all its sensors saw, in tiles like the
// contact sheet's.
#pragma once

#include <filesystem>
#include <vector>

#include "draw/sheet/sheet_tiles.h"
#include "io/dataset/dataset_reader.h"

namespace greatx::io {

/// When the frames are shown. At the data set's own speed if that makes 7 to 40 of them a second, otherwise
/// 10 a second.
struct Playback {
  std::vector<int> start_ms;  ///< of each frame; the first is 0
  int end_ms = 0;             ///< of the last
  double speed = 1.0;         ///< of the data set's time: 1 is its own, 2 twice as fast
};
/// One moment or more, in order.
Playback playback_of(const std::vector<SheetMoment>& moments);

/// Three tiles a row, four panels as two by two; the tiles that stay free in the last row show plots of the
/// whole sequence, one a sensor.
class Animation {
 public:
  /// At most `frames` moments, evenly from the first to the last (choose_moments). Throws UserError if
  /// `frames` is 0, the sequence has no records, or none of the sensors is drawn moment by moment.
  Animation(const DatasetReader& reader, size_t frames, uint32_t sequence = 0);

  size_t frames() const { return moments_.size(); }
  const Playback& playback() const { return playback_; }
  int width() const { return background_.width(); }
  int height() const { return background_.height(); }
  /// u8 [height, width, 3].
  Array frame(size_t i) const;

 private:
  void choose_panels(const DatasetReader& reader, uint32_t sequence);
  Rect tile(const Band& band, size_t column) const;
  void draw_background(const std::string& title);

  std::vector<SheetMoment> moments_;
  Playback playback_;
  Panels panels_;  ///< frames, and the series that find a free tile
  std::vector<Band> bands_;
  std::vector<int> tops_;                 ///< of bands
  Canvas background_{1, 1, theme::page};  ///< what all frames share
};

/// What became of it.
struct AnimationFile {
  size_t frames = 0;
  int width = 0, height = 0, duration_ms = 0;
  uint64_t bytes = 0;
};
/// As an animated WebP that starts again at its end. Throws UserError like Animation, and if the file's name
/// does not end in .webp or the picture is too tall for WebP.
AnimationFile write_animation(const DatasetReader& reader, const std::filesystem::path& file, size_t frames,
                              uint32_t sequence = 0);

}  // namespace greatx::io
