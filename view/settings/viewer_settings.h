// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What the viewer remembers from one start to the next, beside the places of ImGui's own windows.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace greatx::view {

/// Which panels were open with a scenario or a data set.
struct OpenPanels {
  std::string title;  ///< of the scenario or data set, as ViewerOptions::title
  std::vector<std::string> panels;
};

struct ViewerSettings {
  static constexpr size_t most_scenarios = 40, most_panels = 200;
  static constexpr double least_side_share = 0.15, most_side_share = 0.8;

  int width = 0, height = 0;  ///< of the window, in screen coordinates; 0: unknown
  bool side_open = true, legend = true;
  double side_share = 0.42;           ///< of the window's width
  double speed = 1.0;                 ///< wanted; 0: as fast as it can
  std::map<std::string, bool> shows;  ///< overlays by name; what is missing is as at first
  bool paths_by_kind = false;
  std::vector<OpenPanels> panels;  ///< the title used last is last

  /// Returns the panels of a title; nothing if it is unknown.
  std::optional<std::vector<std::string>> panels_of(const std::string& title) const;
  /// Remembers the panels of a title and forgets the titles used longest ago.
  void set_panels(const std::string& title, std::vector<std::string> open);
};

std::string text_of(const ViewerSettings& settings);
/// Throws UserError, which names file, line and member, for a text that is damaged. `file` is for messages.
ViewerSettings parse_settings(const std::string& text, const std::string& file);

/// Reads the file. Without one the settings are those of the first start. A damaged file gives those, too,
/// and a message.
ViewerSettings load_settings(const std::filesystem::path& file, std::string& message);
/// Replaces the file as a whole. Throws WriteError.
void save_settings(const std::filesystem::path& file, const ViewerSettings& settings);

}  // namespace greatx::view
