// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws paths over a rendered view of the scene.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/record.h"
#include "draw/paths/stroke.h"
#include "draw/paths/view.h"

namespace greatx::apps {

/// Selects the meaning of the colours of lines.
enum class PathColors { gain, kind };

/// Describes the range of gains that colours show: from the weakest to the strongest path, widened to
/// multiples of 10 dB, 20 to 60 dB wide. Weaker paths have the colour of the low end, and the legend says so.
struct GainScale {
  double low_db = -120.0, high_db = -60.0;
  bool weaker = false;  ///< there are paths below low_db
  /// Returns the position of a gain in the range, clamped to 0..1.
  double at(double gain_db) const;
};
GainScale gain_scale(std::span<const PathLink> links, double carrier_hz);

io::Color color_of_gain(const GainScale& scale, double gain_db);
io::Color color_of_kind(rf::InteractionType kind);

/// Holds the texts in the head of the picture.
struct PictureText {
  std::string title;        ///< e.g. "etoile, csi"
  std::string moment;       ///< e.g. "tick 40, 4.000 s, 3.5 GHz"
  std::string transmitter;  ///< e.g. "bs/panel"
};

/// Returns the picture of `view` with a head and a legend, u8 [height, width, 3]. The scene is subdued.
/// Hidden parts of paths are thin and faint, and stronger paths are drawn over weaker ones. A marker at each
/// interaction shows its type. `rgb` [height, width, 3] and `depth` [height, width] are the rendered view.
Array draw_paths(const PictureView& view, std::span<const uint8_t> rgb, std::span<const float> depth,
                 std::span<const PathLink> links, const PathScene& scene, PathColors colors,
                 const PictureText& text);

/// Heights of the head and of the legend, pixels.
inline constexpr int picture_head = 58, picture_foot = 66;

}  // namespace greatx::apps
