// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "core/error.h"
#include "core/text.h"
#include "view/app/viewer_window.h"

namespace greatx::view {

void Viewer::add_overlay_commands() {
  struct Switch {
    const char *name, *label, *key;
    bool OverlaySettings::*value;
  };
  static constexpr Switch switches[] = {
      {"show.paths", "Radio paths", "1", &OverlaySettings::paths},
      {"show.lidar", "LiDAR points", "2", &OverlaySettings::lidar},
      {"show.radar", "Radar detections", "3", &OverlaySettings::radar},
      {"show.boxes", "Boxes of objects", "4", &OverlaySettings::boxes},
      {"show.trajectories", "Trajectories", "5", &OverlaySettings::trajectories},
      {"show.sensors", "Sensors and antennas", "6", &OverlaySettings::sensors},
      {"show.events", "Events of a camera", "7", &OverlaySettings::events}};
  for (const Switch& s : switches)
    commands_.add({s.name, "Show", s.label, s.key,
                   [this, s](const std::string& argument) { switch_overlay(s.name, s.value, argument); },
                   [this, s] { return shown().overlays() && shown().overlays()->settings().*s.value; },
                   [this] { return shown().overlays() != nullptr; }});
}

void Viewer::add_world_commands() {
  WorldSettings& s = world_.settings();
  const auto add = [&](const char* name, const char* label, const char* key, bool& value) {
    add_switch(commands_, name, "Show", label, key, value);
    count_changes(commands_, s.version);
  };
  add("show.ways", "Whole ways of the nodes", "8", s.courses);
  add("show.facets", "Facets of radio", "9", s.facets);
  add("show.wedges", "Wedges that diffract", "0", s.wedges);
  add("show.map", "Radio map", "", s.map);
  add("show.tubes", "Fresnel zone of the pinned path", "", s.tubes);
  add_choices();
  const auto is_there = [this] { return shown().experiment() != nullptr && shown().run().shown(); };
  commands_.add({"map",
                 "Run",
                 "Compute a radio map of this tick",
                 "",
                 [this](const std::string& argument) { compute_map(argument); },
                 {},
                 is_there});
  commands_.add({"pin",
                 "View",
                 "Pin the strongest path",
                 "",
                 [this](const std::string& rank) { pin_path(rank); },
                 {},
                 is_there});
}

void Viewer::add_choices() {
  commands_.add({"lidar.colors",
                 "Show",
                 "LiDAR points: other colours",
                 "",
                 [this](const std::string& name) {
                   if (shown().overlays() == nullptr) return;
                   OverlaySettings& s = shown().overlays()->settings();
                   choose("lidar.colors", name, {"height", "intensity", "ring", "instance"}, s.cloud.colors);
                   ++s.version;
                 },
                 {},
                 {}});
  commands_.add({"facets.colors",
                 "Show",
                 "Facets: other colours",
                 "",
                 [this](const std::string& name) {
                   WorldSettings& s = world_.settings();
                   choose("facets.colors", name, {"kind", "material"}, s.radio.colors);
                   ++s.version;
                 },
                 {},
                 {}});
  commands_.add({"show.cells",
                 "Show",
                 "Resolution cells of detections",
                 "",
                 [this](const std::string& argument) {
                   if (!argument.empty() && argument != "on" && argument != "off")
                     throw_user_error("show.cells: expected on or off, found '{}'", printable(argument));
                   if (shown().overlays() == nullptr) return;
                   OverlaySettings& s = shown().overlays()->settings();
                   s.detections.cells = argument.empty() ? !s.detections.cells : argument == "on";
                   ++s.version;
                 },
                 [this] { return shown().overlays() && shown().overlays()->settings().detections.cells; },
                 {}});
}

void Viewer::compute_map(const std::string& words) {
  parse_map_words(words, world_.settings());
  world_.compute_map(*shown().run().shown(), chosen_channel());
}

void Viewer::pin_path(const std::string& rank) {
  if (rank == "off") return main_.pin(0);
  const auto number = parse_number(rank.empty() ? "1" : rank);
  if (!number || *number < 1.0 || *number != std::floor(*number))
    throw_user_error("pin: expected 1 for the strongest path, 2 for the next, or off, found '{}'",
                     printable(rank));
  if (shown().overlays() == nullptr) return;
  main_.pin(shown().overlays()->path_of_rank(shown().run().shown(), static_cast<size_t>(*number)));
}

void Viewer::switch_overlay(const std::string& name, bool OverlaySettings::*value,
                            const std::string& argument) {
  if (!argument.empty() && argument != "on" && argument != "off")
    throw_user_error("{}: expected on or off, found '{}'", name, printable(argument));
  for (const std::unique_ptr<ShownRun>& run : runs_) {
    if (run->overlays() == nullptr) continue;
    OverlaySettings& settings = run->overlays()->settings();
    settings.*value = argument.empty() ? !(settings.*value) : argument == "on";
    ++settings.version;
  }
}

}  // namespace greatx::view
