// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What the parts of the report share. Inside of apps/tradeoff.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/tradeoff/report.h"

namespace greatx::apps {

/// A setting of a knob, as words and plots need it.
struct Point {
  explicit Point(const nlohmann::json& setting);
  std::string label;
  double ms, low_ms, high_ms, start_ms;
  bool exact;
  std::string figure, unit, meaning;  ///< of the first figure; empty: there is none
  std::optional<double> error;        ///< none: minus infinity, or no figure
  bool standard = false, reference = false;
};
std::vector<Point> points_of(const nlohmann::json& knob);
/// "-23.1 dB", "0.012", "exact".
std::string error_text(const Point& point);

/// Three significant digits, and all digits before the point: "0.0637", "1033".
std::string short_number(double value);

/// What the times of a knob are of: "tick" or "map".
std::string timed_of(const nlohmann::json& knob);

/// Replaces what has a meaning in HTML and SVG.
std::string escaped(const std::string& text);
/// A plot of all knobs: how much faster each setting is than the default, over its error.
std::string overview_plot(const nlohmann::json& report);
/// A plot of the joint settings of a modality.
std::string plot_of_front(const nlohmann::json& front, const std::string& device);
/// The page.
std::string html_of(const nlohmann::json& report, const std::filesystem::path& folder);
/// "llvmpipe ..., 2 cores".
std::string device_line(const nlohmann::json& report);

}  // namespace greatx::apps
