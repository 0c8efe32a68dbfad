// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the base class of panels that show one array of a camera or an event camera as a picture for each
// moment.
#pragma once

#include <string>
#include <utility>

#include "draw/sheet/panels.h"

namespace greatx::io {

/// Loads the array and draws the caption for its derived classes.
class PicturePanel : public FramePanel {
 public:
  /// `array` has one of the types, and the shape [h, w] or, if `channels` is not 0, [h, w, channels]. It sets
  /// the aspect of the picture. `what` follows the sensor's name in the title.
  PicturePanel(const PanelSource& source, std::string array, const char* what,
               std::initializer_list<DType> types, int64_t channels = 0)
      : source_(source),
        array_(std::move(array)),
        title_(source.spec().name + " " + what),
        types_(types),
        channels_(channels) {
    for (const ArraySpec& spec : source.spec().arrays)
      if (spec.name == array_ && spec.shape.size() >= 2 && spec.shape[0] > 0 && spec.shape[1] > 0)
        aspect_ = static_cast<double>(spec.shape[0]) / static_cast<double>(spec.shape[1]);
  }
  std::string title() const override { return title_; }
  double aspect() const override { return aspect_; }

 protected:
  /// The picture of the row, kept until another row's is asked for.
  const Array& load(size_t row) {
    if (kept_row_ != row) {
      kept_row_.reset();
      kept_ =
          source_.load(source_.chosen[row], array_, types_,
                       channels_ > 0 ? std::vector<int64_t>{0, 0, channels_} : std::vector<int64_t>{0, 0});
      kept_row_ = row;
    }
    return kept_;
  }
  std::string value_at(const Rect& picture, size_t row, int x, int y, const SceneNames& names) override {
    const Array& array = load(row);
    const std::optional<RasterCell> cell = cell_at(picture, array.shape[1], array.shape[0], x, y);
    if (!cell) return {};
    const size_t i = static_cast<size_t>(cell->row) * static_cast<size_t>(array.shape[1]) +
                     static_cast<size_t>(cell->column);
    return fmt::format("({}, {})  {}", cell->column, cell->row, text_of(row, array, i, names));
  }
  /// The value of pixel `i` as text, with its unit.
  virtual std::string text_of(size_t row, const Array& array, size_t i, const SceneNames& names) = 0;
  static void caption(Canvas& canvas, const Rect& legend, std::string_view text) {
    canvas.text(legend.x, legend.y + 4, text, theme::text_scale, canvas.theme().dim);
  }

  PanelSource source_;
  std::string array_, title_;
  std::vector<DType> types_;
  int64_t channels_;
  double aspect_ = 0.75;

 private:
  std::optional<size_t> kept_row_;
  Array kept_;
};

}  // namespace greatx::io
