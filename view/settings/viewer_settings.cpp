// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/settings/viewer_settings.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "io/files/file.h"
#include "io/files/untrusted_json.h"

namespace greatx::view {

namespace {

constexpr uint64_t most_bytes = 1 << 20;
constexpr int version = 1;
constexpr int least_window = 64, most_window = 16384;
constexpr double fastest = 1000.0;

/// Takes the members that are there. What is missing keeps its value.
class Reader {
 public:
  explicit Reader(io::JsonValue json) : json_(json) {}
  void read(const char* key, bool& value) const {
    if (json_.has(key)) value = json_.at(key).boolean();
  }
  void read(const char* key, int& value, int least, int most) const {
    if (json_.has(key)) value = static_cast<int>(json_.at(key).integer(least, most));
  }
  void read(const char* key, double& value, double least, double most) const {
    if (json_.has(key)) value = json_.at(key).number(least, most);
  }

 private:
  io::JsonValue json_;
};

std::vector<OpenPanels> panels_in(const io::JsonValue& json) {
  std::vector<OpenPanels> all;
  for (const io::JsonValue& entry : json.list(ViewerSettings::most_scenarios)) {
    OpenPanels open{entry.at("title").text(), {}};
    for (const io::JsonValue& panel : entry.at("open").list(ViewerSettings::most_panels))
      open.panels.push_back(panel.text());
    all.push_back(std::move(open));
  }
  return all;
}

}  // namespace

std::optional<std::vector<std::string>> ViewerSettings::panels_of(const std::string& title) const {
  const auto found = std::ranges::find(panels, title, &OpenPanels::title);
  if (found == panels.end()) return {};
  return found->panels;
}

void ViewerSettings::set_panels(const std::string& title, std::vector<std::string> open) {
  std::erase_if(panels, [&](const OpenPanels& entry) { return entry.title == title; });
  if (open.size() > most_panels) open.resize(most_panels);
  panels.push_back({title, std::move(open)});
  if (panels.size() > most_scenarios) panels.erase(panels.begin());
}

std::string text_of(const ViewerSettings& settings) {
  nlohmann::ordered_json json;
  json["version"] = version;
  if (settings.width >= least_window && settings.height >= least_window) {
    json["width"] = settings.width;
    json["height"] = settings.height;
  }
  json["side_open"] = settings.side_open;
  json["side_share"] = settings.side_share;
  json["legend"] = settings.legend;
  json["speed"] = settings.speed;
  json["paths_by_kind"] = settings.paths_by_kind;
  json["shows"] = settings.shows;
  json["panels"] = nlohmann::ordered_json::array();
  for (const OpenPanels& open : settings.panels)
    json["panels"].push_back({{"title", open.title}, {"open", open.panels}});
  // A title may hold any bytes, because it is the name of a file.
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

ViewerSettings parse_settings(const std::string& text, const std::string& file) {
  const io::JsonDocument document(text, {file, 1}, {most_bytes, 1 << 16, 8});
  const io::JsonValue root = document.root();
  ViewerSettings settings;
  root.at("version").integer(version, version);
  const Reader reader(root);
  reader.read("width", settings.width, least_window, most_window);
  reader.read("height", settings.height, least_window, most_window);
  reader.read("side_open", settings.side_open);
  reader.read("side_share", settings.side_share, ViewerSettings::least_side_share,
              ViewerSettings::most_side_share);
  reader.read("legend", settings.legend);
  reader.read("speed", settings.speed, 0.0, fastest);
  reader.read("paths_by_kind", settings.paths_by_kind);
  if (root.has("shows")) {
    const io::JsonValue shows = root.at("shows");
    for (const auto& [name, value] : shows.json().items()) settings.shows[name] = shows.at(name).boolean();
  }
  if (root.has("panels")) settings.panels = panels_in(root.at("panels"));
  return settings;
}

ViewerSettings load_settings(const std::filesystem::path& file, std::string& message) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return {};
  try {
    return parse_settings(io::read_text_file(file, most_bytes), file.string());
  } catch (const UserError& failure) {
    message = fmt::format("the viewer's settings are ignored: {}", failure.what());
  }
  return {};
}

void save_settings(const std::filesystem::path& file, const ViewerSettings& settings) {
  io::write_file_atomically(file, text_of(settings));
}

}  // namespace greatx::view
