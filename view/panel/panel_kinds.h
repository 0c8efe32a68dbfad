// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The panels beside those that the contact sheet has, and what they have in common. Inside of view/panel.
#pragma once

#include "view/panel/panel.h"

namespace greatx::view {

using Records = std::shared_ptr<const io::RecordSource>;

/// A panel that the viewer has and the sheet does not.
struct PanelKind {
  const char* sensor;               ///< SensorSpec::kind
  const char* name;                 ///< PanelChoice::kind
  std::vector<const char*> arrays;  ///< that the sensor must declare
  std::unique_ptr<Panel> (*make)(const PanelChoice& choice, Records records);
};
std::vector<PanelKind> time_surface_kinds();  ///< event cameras
std::vector<PanelKind> range_image_kinds();   ///< LiDAR
std::vector<PanelKind> channel_kinds();       ///< H over delay, frequency and time
std::vector<PanelKind> path_kinds();          ///< angles, delays and amplitudes of paths
std::vector<PanelKind> link_kinds();          ///< statistics of links
std::vector<PanelKind> motion_kinds();        ///< poses over time

template <typename Made>
std::unique_ptr<Panel> make_view_panel(const PanelChoice& choice, Records records) {
  return std::make_unique<Made>(choice, std::move(records));
}

/// Throws UserError if the sensor does not declare all of the arrays; the message names both.
void require_arrays(const SensorSpec& sensor, std::span<const char* const> arrays, const std::string& kind);

/// Where a plot lies in a canvas: room for its axes is left around it, unless the canvas is too small for
/// them.
struct PlotPlace {
  io::Rect plot;
  bool axes = true;
};
PlotPlace place_plot(const io::Canvas& canvas, bool color_scale);
/// The value of a linear scale at the middle of pixel i of `extent` pixels from `start`.
double value_at_pixel(const io::Scale& scale, int start, int extent, int i);
/// Text in the middle of the canvas, in as many lines as it needs.
void write_note(io::Canvas& canvas, const std::string& text, io::Color color);
/// A number with the prefix of its unit: "1.25 us", "-3.2 MHz"; "none" for NaN.
std::string with_prefix(double value, const char* unit);

/// The numbers of the ends and of the ports that arrays of a channel tell of.
struct LinkSizes {
  int64_t receivers = 1, receiver_ports = 1, transmitters = 1, transmitter_ports = 1;
};
LinkSizes link_sizes(const SensorSpec& sensor);

}  // namespace greatx::view
