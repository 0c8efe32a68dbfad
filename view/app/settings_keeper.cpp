// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/app/settings_keeper.h"

#include <algorithm>
#include <cmath>
#include <imgui.h>

namespace greatx::view {

namespace {

struct NamedSwitch {
  const char* name;
  bool OverlaySettings::*value;
};
constexpr NamedSwitch overlay_switches[] = {{"paths", &OverlaySettings::paths},
                                            {"lidar", &OverlaySettings::lidar},
                                            {"radar", &OverlaySettings::radar},
                                            {"boxes", &OverlaySettings::boxes},
                                            {"trajectories", &OverlaySettings::trajectories},
                                            {"sensors", &OverlaySettings::sensors}};

}  // namespace

SettingsKeeper::SettingsKeeper(std::filesystem::path file, std::string title, ViewerSettings settings)
    : file_(std::move(file)), title_(std::move(title)), settings_(std::move(settings)) {}

void SettingsKeeper::add_commands(Commands& commands) {
  commands.add({"settings.forget", "View", "Forget settings", "", [this](const std::string&) { forget(); },
                [this] { return forgotten_; }, [this] { return !file_.empty(); }});
}

void SettingsKeeper::apply(const SettledParts& parts) {
  if (file_.empty()) return;
  parts.side_open = settings_.side_open;
  parts.side_share = static_cast<float>(settings_.side_share);
  parts.main.show_legend() = settings_.legend;
  if (const auto panels = settings_.panels_of(title_)) parts.grid.open_at_first(*panels);
}

void SettingsKeeper::apply(ShownRun& run) {
  if (file_.empty()) return;
  if (settled_speeds_.insert(run.name()).second) run.run().set_speed(settings_.speed);
  Overlays* const overlays = run.overlays();
  if (overlays == nullptr || !settled_overlays_.insert(run.name()).second) return;
  OverlaySettings& shown = overlays->settings();
  for (const NamedSwitch& overlay : overlay_switches)
    if (const auto found = settings_.shows.find(overlay.name); found != settings_.shows.end())
      shown.*overlay.value = found->second;
  shown.path.colors = settings_.paths_by_kind ? PathColors::kind : PathColors::gain;
  ++shown.version;
}

void SettingsKeeper::save(const SettledParts& parts, ShownRun& run) {
  if (file_.empty() || forgotten_) return;
  const double scale = parts.window.pixel_scale();
  if (!parts.window.minimized()) {
    settings_.width = static_cast<int>(std::lround(parts.window.width() / scale));
    settings_.height = static_cast<int>(std::lround(parts.window.height() / scale));
  }
  settings_.side_open = parts.side_open;
  const double share = std::round(1e4 * static_cast<double>(parts.side_share)) / 1e4;
  settings_.side_share = std::clamp(share, ViewerSettings::least_side_share, ViewerSettings::most_side_share);
  settings_.legend = parts.main.show_legend();
  settings_.speed = run.run().status().speed;
  if (Overlays* const overlays = run.overlays()) {
    for (const NamedSwitch& overlay : overlay_switches)
      settings_.shows[overlay.name] = overlays->settings().*overlay.value;
    settings_.paths_by_kind = overlays->settings().path.colors == PathColors::kind;
    settings_.set_panels(title_, parts.grid.open());
  }
  save_settings(file_, settings_);
}

/// Removes what is remembered. The window stays as it is, and its end writes nothing.
void SettingsKeeper::forget() {
  forgotten_ = true;
  std::error_code error;
  std::filesystem::remove(file_, error);
  ImGuiIO& io = ImGui::GetIO();
  if (io.IniFilename != nullptr) std::filesystem::remove(io.IniFilename, error);
  io.IniFilename = nullptr;
}

}  // namespace greatx::view
