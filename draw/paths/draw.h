// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Paths over a rendered view of the scene.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/record.h"
#include "draw/paths/stroke.h"
#include "draw/paths/view.h"

namespace greatx::apps {

/// What lines are coloured by.
enum class PathColors { gain, kind };

/// Gains from the weakest to the strongest path, widened to whole tens of dB; at most 60 dB: what is weaker
/// is drawn in the weakest colour, and the legend says so.
struct GainScale {
  double low_db = -120.0, high_db = -60.0;
  bool weaker = false;  ///< there are paths below low_db
  /// 0 to 1.
  double at(double gain_db) const;
};
GainScale gain_scale(std::span<const PathLink> links, double carrier_hz);

io::Color color_of_gain(const GainScale& scale, double gain_db);
io::Color color_of_kind(rf::InteractionType kind);

/// What the picture's head says.
struct PictureText {
  std::string title;        ///< "etoile, csi"
  std::string moment;       ///< "tick 40, 4.000 s, 3.5 GHz"
  std::string transmitter;  ///< "bs/panel"
};

/// The picture of `view` with a head and a legend, u8 [height, width, 3]: the scene subdued, hidden stretches
/// thin and faint, stronger paths over weaker ones, a marker of its kind at each interaction. `rgb` [height,
/// width, 3] and `depth` [height, width] of the view.
Array draw_paths(const PictureView& view, std::span<const uint8_t> rgb, std::span<const float> depth,
                 std::span<const PathLink> links, const PathScene& scene, PathColors colors,
                 const PictureText& text);

/// Rows that head and legend take of the picture's height.
inline constexpr int picture_head = 58, picture_foot = 66;

}  // namespace greatx::apps
