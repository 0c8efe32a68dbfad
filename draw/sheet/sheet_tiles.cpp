// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "draw/sheet/sheet_tiles.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/ranges.h>

#include "core/text.h"
#include "draw/sheet/channel_links.h"

namespace greatx::io {

namespace {

/// Returns the record nearest to each moment.
std::vector<IndexRow> nearest(const std::vector<IndexRow>& rows, const std::vector<SheetMoment>& moments) {
  std::vector<IndexRow> chosen;
  for (const SheetMoment& moment : moments) {
    chosen.push_back(*std::min_element(rows.begin(), rows.end(), [&](const IndexRow& a, const IndexRow& b) {
      return std::abs(a.tick - moment.tick) < std::abs(b.tick - moment.tick);
    }));
  }
  return chosen;
}

}  // namespace

std::vector<size_t> shown_sensors(const DatasetReader& reader, const std::vector<std::string>& names) {
  const std::vector<SensorSpec>& sensors = reader.sensors();
  const auto fits = [](const SensorSpec& sensor, const std::string& name) {
    return sensor.name == name || node_of(sensor) == name;
  };
  std::vector<std::string> there;
  for (const SensorSpec& sensor : sensors) there.push_back(sensor.name);
  for (const std::string& name : names)
    if (std::ranges::none_of(sensors, [&](const SensorSpec& sensor) { return fits(sensor, name); }))
      throw_user_error(
          "{}: expected the name of a sensor, a channel or a node, found '{}'{}; the sensors are {}",
          reader.folder().string(), printable(name), suggestion(name, there),
          printable(fmt::format("{}", fmt::join(there, ", "))));
  std::vector<size_t> shown;
  for (size_t s = 0; s < sensors.size(); ++s)
    if (names.empty() ||
        std::ranges::any_of(names, [&](const std::string& name) { return fits(sensors[s], name); }))
      shown.push_back(s);
  return shown;
}

std::vector<SheetMoment> choose_moments(const DatasetReader& reader, uint32_t sequence,
                                        const std::vector<size_t>& sensors, size_t count) {
  GREATX_CHECK(count > 0, "{} moments", count);
  const bool intervals = std::ranges::any_of(
      sensors, [&](size_t sensor) { return is_about_intervals(reader.sensors()[sensor].kind); });
  for (const bool frames_only : {true, false}) {
    for (const size_t s : sensors) {
      const std::vector<IndexRow> rows = reader.records_of(sequence, s);
      if (rows.empty() || (frames_only && !has_frame_panels(reader.sensors()[s]))) continue;
      std::vector<SheetMoment> moments;
      const size_t first = intervals && rows.size() > 1 ? 1 : 0;
      const size_t most = std::min(count, rows.size() - first);
      for (size_t k = 0; k < most; ++k) {
        const size_t i = most == 1 ? first : first + k * (rows.size() - 1 - first) / (most - 1);
        moments.push_back({rows[i].tick, rows[i].time_ns});
      }
      return moments;
    }
  }
  return {};
}

std::vector<Panels> panels_by_sensor(const DatasetReader& reader, uint32_t sequence,
                                     const std::vector<size_t>& sensors,
                                     const std::vector<SheetMoment>& moments, const PanelOptions& options) {
  check_links(reader, options.links);
  const auto scene = std::make_shared<const SceneFacts>(scene_facts(reader));
  std::vector<Panels> panels(sensors.size());
  for (size_t i = 0; i < sensors.size(); ++i) {
    const std::vector<IndexRow> rows = reader.records_of(sequence, sensors[i]);
    if (!rows.empty())
      add_panels({reader, sequence, sensors[i], nearest(rows, moments), {}, scene}, panels[i], options);
  }
  return panels;
}

void check_has_records(const DatasetReader& reader, uint32_t sequence) {
  if (sequence >= reader.sequences() || reader.records(sequence).empty())
    throw_user_error("{}: sequence {} has no records to show", reader.folder().string(), sequence);
}

void draw_tile(Canvas& canvas, FramePanel& panel, const Rect& tile, const Rect& legend, size_t row) {
  canvas.fill(tile, canvas.theme().panel);
  panel.draw(canvas, fit(tile, panel.aspect()), legend, row);
  canvas.frame(tile, canvas.theme().border);
}

void draw_title(Canvas& canvas, const Rect& area, const std::string& title) {
  canvas.text(area.x, area.y + 6, fitted(title, area.width, theme::text_scale), theme::text_scale,
              canvas.theme().text);
}

}  // namespace greatx::io
