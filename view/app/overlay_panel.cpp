// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/app/overlay_panel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <imgui.h>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"
#include "core/units.h"

namespace greatx::view {

namespace {

/// A number of things as an integer slider.
bool count_slider(const char* label, size_t& value, int least, int most) {
  int number = static_cast<int>(std::min<size_t>(value, static_cast<size_t>(most)));
  if (!ImGui::SliderInt(label, &number, least, most, "%d", ImGuiSliderFlags_Logarithmic)) return false;
  value = static_cast<size_t>(std::clamp(number, least, most));
  return true;
}

bool number_slider(const char* label, double& value, double least, double most, const char* format) {
  auto number = static_cast<float>(value);
  if (!ImGui::SliderFloat(label, &number, static_cast<float>(least), static_cast<float>(most), format))
    return false;
  value = static_cast<double>(number);
  return true;
}

template <typename Enum, size_t n>
bool choice(const char* label, Enum& value, const std::array<const char*, n>& names) {
  int number = static_cast<int>(value);
  if (!ImGui::Combo(label, &number, names.data(), static_cast<int>(n))) return false;
  value = static_cast<Enum>(number);
  return true;
}

bool section(const char* name) { return ImGui::CollapsingHeader(name, ImGuiTreeNodeFlags_DefaultOpen); }

void draw_record_settings(Overlays& overlays) {
  OverlaySettings& s = overlays.settings();
  bool changed = false;
  if (section("LiDAR points")) {
    changed |= ImGui::Checkbox("show##lidar", &s.lidar);
    changed |= choice("colours##lidar", s.cloud.colors,
                      std::array{"height", "intensity", "ring (beam)", "instance"});
    changed |= count_slider("points at most##lidar", s.cloud.most, 1'000, 1'000'000);
    changed |= ImGui::SliderFloat("size, pixels##lidar", &s.cloud.size_px, 1.0f, 6.0f, "%.1f");
  }
  if (section("Radar detections")) {
    changed |= ImGui::Checkbox("show##radar", &s.radar);
    ImGui::SameLine();
    changed |= ImGui::Checkbox("resolution cells", &s.detections.cells);
    ImGui::SameLine();
    changed |= ImGui::Checkbox("field of view", &s.detections.fan);
    changed |= number_slider("arrows, s of motion", s.detections.arrow_s, 0.1, 10.0, "%.1f");
  }
  if (section("Boxes")) {
    changed |= ImGui::Checkbox("show##boxes", &s.boxes);
    ImGui::SameLine();
    changed |= ImGui::Checkbox("names##boxes", &s.box.labels);
    changed |= choice("2-D boxes hold", s.rectangle, std::array{"the visible pixels", "the whole object"});
    ImGui::TextDisabled("2-D boxes show through a camera that records boxes.");
  }
  if (section("Events")) {
    changed |= ImGui::Checkbox("show##events", &s.events);
    changed |= number_slider("the last ms; 0: since the record before", s.event.window_s, 0.0, 0.1, "%.3f s");
    ImGui::TextDisabled("Events show through an event camera.");
  }
  if (section("Trajectories")) {
    changed |= ImGui::Checkbox("recorded##trajectories", &s.trajectories);
    changed |= number_slider("past, s", s.trajectory.past_s, 0.0, 60.0, "%.1f");
    changed |= number_slider("future, s", s.trajectory.future_s, 0.0, 60.0, "%.1f");
  }
  if (section("Sensors and antennas")) {
    changed |= ImGui::Checkbox("show##sensors", &s.sensors);
    ImGui::SameLine();
    changed |= ImGui::Checkbox("cameras", &s.sensor.cameras);
    ImGui::SameLine();
    changed |= ImGui::Checkbox("patterns", &s.sensor.patterns);
    ImGui::SameLine();
    changed |= ImGui::Checkbox("names##sensors", &s.sensor.names);
    changed |= number_slider("frusta, m", s.sensor.frustum_m, 0.5, 50.0, "%.1f");
    changed |= number_slider("patterns, m", s.sensor.pattern_m, 0.2, 30.0, "%.1f");
  }
  if (changed) ++s.version;
}

void draw_radio_settings(WorldSettings& s) {
  if (!section("Facets and wedges")) return;
  bool changed = ImGui::Checkbox("facets", &s.facets);
  ImGui::SameLine();
  changed |= ImGui::Checkbox("wedges", &s.wedges);
  changed |= choice("colours##facets", s.radio.colors, std::array{"kind", "material"});
  changed |= count_slider("facets at most", s.radio.most_facets, 10, 20'000);
  changed |= count_slider("wedges at most", s.radio.most_wedges, 10, 20'000);
  changed |= number_slider("within, m", s.radio.within_m, 10.0, 1e6, "%.0f");
  if (changed) ++s.version;
}

/// Where the cells of the next map lie.
void draw_map_request(sim::MapRequest& request) {
  double cell = request.cell_m.value_or(0.0);
  if (ImGui::InputDouble("cell, m (0: by the scene)", &cell, 0.0, 0.0, "%.3g"))
    request.cell_m = cell > 0.0 ? std::optional(cell) : std::nullopt;
  int where = request.height.plane_z_m ? 2 : request.height.over == sim::MapOver::roofs ? 1 : 0;
  if (ImGui::Combo("height over", &where, "ground\0ground and roofs\0one plane of the world\0")) {
    request.height.plane_z_m = where == 2 ? std::optional(request.height.above_m) : std::nullopt;
    request.height.over = where == 1 ? sim::MapOver::roofs : sim::MapOver::ground;
  }
  double height = request.height.plane_z_m.value_or(request.height.above_m);
  if (!ImGui::InputDouble("height, m", &height, 0.0, 0.0, "%.3g") || !std::isfinite(height)) return;
  if (request.height.plane_z_m)
    request.height.plane_z_m = height;
  else
    request.height.above_m = std::max(0.0, height);
}

bool draw_map_colors(MapColors& colors, const WorldOverlays& world, const MapLayerPaint* paint) {
  bool changed = false;
  if (ImGui::BeginCombo("quantity", colors.quantity.c_str())) {
    for (const sim::MapQuantity* of_map : sim::map_quantities_of(sim::MapPrecoding::mean)) {
      const sim::MapQuantity& quantity = *of_map;
      if (ImGui::Selectable(quantity.name.c_str(), quantity.name == colors.quantity)) {
        colors.quantity = quantity.name;
        colors.low.reset();
        colors.high.reset();
        changed = true;
      }
      if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", quantity.description.c_str());
    }
    ImGui::EndCombo();
  }
  const std::shared_ptr<const ShownMap> map = world.job() != nullptr ? world.job()->map() : nullptr;
  const auto name = [&](std::optional<uint32_t> number) {
    return number && map != nullptr && *number < map->transmitters.size()
               ? printable(map->transmitters[*number].name)
               : std::string("the best server of each cell");
  };
  if (map != nullptr && ImGui::BeginCombo("transmitter", name(colors.transmitter).c_str())) {
    for (int64_t t = -1; t < static_cast<int64_t>(map->transmitters.size()); ++t) {
      const auto number = t < 0 ? std::nullopt : std::optional(static_cast<uint32_t>(t));
      ImGui::PushID(static_cast<int>(t));
      if (ImGui::Selectable(name(number).c_str(), number == colors.transmitter)) {
        colors.transmitter = number;
        changed = true;
      }
      ImGui::PopID();
    }
    ImGui::EndCombo();
  }
  changed |= number_slider("opacity", colors.opacity, 0.0, 1.0, "%.2f");
  if (paint == nullptr || !paint->layer().classes.empty()) return changed;
  float range[] = {static_cast<float>(paint->scale().scale.low),
                   static_cast<float>(paint->scale().scale.high)};
  if (ImGui::DragFloat2(fmt::format("colours, {}", paint->layer().unit).c_str(), range, 0.5f)) {
    colors.low = static_cast<double>(range[0]);
    colors.high = static_cast<double>(range[1]);
    changed = true;
  }
  if ((colors.low || colors.high) && ImGui::SmallButton("colours of the whole map")) {
    colors.low.reset();
    colors.high.reset();
    changed = true;
  }
  return changed;
}

void draw_map_settings(WorldOverlays& world, const ShownTick* tick, size_t channel) {
  if (!section("Radio map")) return;
  WorldSettings& s = world.settings();
  ImGui::Checkbox("show##map", &s.map);
  draw_map_request(s.map_request);
  const MapJob* const job = world.job();
  const bool working = job != nullptr && !job->finished();
  if (working) {
    if (ImGui::Button("Cancel")) world.cancel_map();
    ImGui::SameLine();
    const double share = job->progress();
    ImGui::ProgressBar(static_cast<float>(std::max(0.0, share)), {-1.0f, 0.0f},
                       share < 0.0 ? "searching paths" : nullptr);
  } else if (tick != nullptr && ImGui::Button("Compute map")) {
    world.compute_map(*tick, channel);
  }
  const std::shared_ptr<const MapLayerPaint> paint = world.paint();
  if (job != nullptr && paint != nullptr) {
    const ShownMap& map = paint->map();
    ImGui::TextWrapped("Tick %lld, %u x %u cells of %g m: %zu of %zu done in %.1f s%s. %s",
                       static_cast<long long>(map.wish.tick), map.cells.grid.columns, map.cells.grid.rows,
                       map.cells.grid.cell_m, map.done, map.cells.grid.cells(), job->seconds(),
                       job->cancelled() ? " (cancelled)" : "", map.cells.height_rule.c_str());
    if (tick != nullptr && tick->packet.tick != map.wish.tick)
      ImGui::TextDisabled("The tick shown is another one; compute again to follow it.");
  }
  if (draw_map_colors(s.map_colors, world, paint.get())) ++s.version;
}

}  // namespace

void draw_overlay_settings(Overlays* overlays, WorldOverlays& world, const ShownTick* tick) {
  ImGui::PushItemWidth(0.45f * ImGui::GetContentRegionAvail().x);
  draw_map_settings(world, tick, overlays != nullptr ? overlays->settings().channel : 0);
  draw_radio_settings(world.settings());
  WorldSettings& s = world.settings();
  if (section("Ways and tubes")) {
    bool changed = ImGui::Checkbox("whole ways of the nodes", &s.courses);
    changed |= ImGui::Checkbox("Fresnel zone of the pinned path", &s.tubes);
    if (changed) ++s.version;
  }
  if (overlays != nullptr) draw_record_settings(*overlays);
  ImGui::PopItemWidth();
}

void draw_story(const PathStory& story) {
  constexpr int columns = 7;
  const float height = (static_cast<float>(story.stops.size()) + 3.0f) * ImGui::GetFrameHeightWithSpacing();
  if (ImGui::BeginTable("story", columns,
                        ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_ScrollX |
                            ImGuiTableFlags_BordersInnerV,
                        {0.0f, height})) {
    for (const char* const name : {"leg, m", "what", "object", "angle, deg", "loss, dB", "material", "at, m"})
      ImGui::TableSetupColumn(name);
    ImGui::TableHeadersRow();
    const auto row = [](const std::array<std::string, columns>& cells) {
      ImGui::TableNextRow();
      for (const std::string& cell : cells) {
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(cell.c_str());
      }
    };
    const auto point = [](const dvec3& p) { return fmt::format("{:.1f} {:.1f} {:.1f}", p.x, p.y, p.z); };
    row({"", "leaves", story.from, "", "", "", point(story.start)});
    for (const PathStop& stop : story.stops)
      row({fmt::format("{:.2f}", stop.leg_m), apps::kind_name(stop.type), stop.object,
           stop.angle ? fmt::format("{:.1f}", degrees(*stop.angle)) : "",
           stop.loss_db ? fmt::format("{:.1f}", *stop.loss_db) : "", stop.material, point(stop.at)});
    row({fmt::format("{:.2f}", story.last_leg_m), "reaches", story.to, "", "", "", point(story.end)});
    ImGui::EndTable();
  }
  for (const std::string& line : words_of(story)) ImGui::TextWrapped("%s", line.c_str());
}

void draw_map_legend(ImDrawList& list, const MapLayerPaint& paint, const ImVec2& corner) {
  constexpr float width = 220.0f, height = 14.0f, room = 10.0f;
  const float line = ImGui::GetTextLineHeightWithSpacing();
  const apps::MapLayer& layer = paint.layer();
  const auto packed = [](io::Color c) { return IM_COL32(c.r, c.g, c.b, 255); };
  const ImU32 text_color = IM_COL32(235, 235, 235, 255);
  const std::string title = fmt::format(
      "{}{}{}{}", printable(layer.title), layer.unit.empty() || !layer.classes.empty() ? "" : ", ",
      layer.classes.empty() ? layer.unit : "", paint.map().complete() ? "" : " (not complete)");
  const float rows = (layer.classes.empty() ? 2.0f : static_cast<float>(layer.classes.size()) + 1.0f) + 1.0f;
  const float full = std::max(width, ImGui::CalcTextSize(title.c_str()).x);
  const ImVec2 at(corner.x - full - 2.0f * room, corner.y - line * rows - height - 2.0f * room);
  list.AddRectFilled(at, corner, IM_COL32(16, 18, 24, 215), 4.0f);
  const float x = at.x + room;
  float y = at.y + room;
  list.AddText({x, y}, text_color, title.c_str());
  y += line;
  const auto swatch = [&](float top, io::Color color, const std::string& text) {
    list.AddRectFilled({x, top}, {x + height, top + height}, packed(color));
    list.AddText({x + line, top}, text_color, text.c_str());
  };
  swatch(corner.y - room - height, paint.color_at(NAN), layer.nothing);
  if (!layer.classes.empty()) {
    for (size_t i = 0; i < layer.classes.size(); ++i, y += line) {
      swatch(y, paint.color_at(static_cast<double>(i)), printable(layer.classes[i]));
    }
    return;
  }
  constexpr int steps = 55;
  const io::Scale& scale = paint.scale().scale;
  for (int i = 0; i < steps; ++i) {
    const float left = x + width * static_cast<float>(i) / steps;
    list.AddRectFilled({left, y}, {left + width / steps + 1.0f, y + height},
                       packed(io::viridis((i + 0.5) / steps)));
  }
  for (const double tick : scale.ticks(4)) {
    const float left = x + width * static_cast<float>(scale.at(tick));
    list.AddLine({left, y + height - 4.0f}, {left, y + height + 3.0f}, text_color);
    const std::string text = io::tick_text(tick);
    list.AddText({left - 0.5f * ImGui::CalcTextSize(text.c_str()).x, y + height + 2.0f}, text_color,
                 text.c_str());
  }
}

}  // namespace greatx::view
