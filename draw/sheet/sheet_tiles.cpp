// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "draw/sheet/sheet_tiles.h"

#include <algorithm>
#include <cmath>
#include <set>

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

std::vector<SheetMoment> choose_moments(const DatasetReader& reader, uint32_t sequence, size_t count) {
  GREATX_CHECK(count > 0, "{} moments", count);
  const bool intervals = std::ranges::any_of(
      reader.sensors(), [](const SensorSpec& sensor) { return is_about_intervals(sensor.kind); });
  for (const bool frames_only : {true, false}) {
    for (size_t s = 0; s < reader.sensors().size(); ++s) {
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
                                     const std::vector<SheetMoment>& moments) {
  std::vector<Panels> panels(reader.sensors().size());
  std::set<std::string> drawn;
  for (size_t s = 0; s < reader.sensors().size(); ++s) {
    const SensorSpec& sensor = reader.sensors()[s];
    const std::vector<IndexRow> rows = reader.records_of(sequence, s);
    if (rows.empty() || (!has_frame_panels(sensor) && !drawn.insert(sensor.kind).second)) continue;
    add_panels({reader, sequence, s, nearest(rows, moments)}, panels[s]);
  }
  return panels;
}

void check_has_records(const DatasetReader& reader, uint32_t sequence) {
  if (sequence >= reader.sequences() || reader.records(sequence).empty())
    throw_user_error("{}: sequence {} has no records to show", reader.folder().string(), sequence);
}

std::vector<Band> make_bands(const std::vector<std::unique_ptr<FramePanel>>& panels, size_t per_band) {
  std::vector<Band> bands;
  for (size_t first = 0; first < panels.size(); first += per_band) {
    const size_t count = std::min(per_band, panels.size() - first);
    double aspect = 0.0;
    for (size_t i = first; i < first + count; ++i) aspect = std::max(aspect, panels[i]->aspect());
    bands.push_back({first, count, tile_height(aspect)});
  }
  return bands;
}

Rect fit(const Rect& tile, double aspect) {
  const int width = std::min(tile.width, static_cast<int>(std::lround(tile.height / aspect)));
  const int height = std::min(tile.height, static_cast<int>(std::lround(width * aspect)));
  return {tile.x + (tile.width - width) / 2, tile.y + (tile.height - height) / 2, width, height};
}

int tile_height(double tallest_aspect) {
  return static_cast<int>(std::lround(sheet::tile_width * std::clamp(tallest_aspect, 0.5, 1.0)));
}

void draw_tile(Canvas& canvas, FramePanel& panel, const Rect& tile, size_t row) {
  canvas.fill(tile, theme::panel);
  panel.draw(canvas, fit(tile, panel.aspect()),
             {tile.x, tile.bottom() + 2, tile.width, sheet::legend_height - 4}, row);
  canvas.frame(tile, theme::border);
}

void draw_title(Canvas& canvas, int x, int y, const std::string& title) {
  canvas.text(x, y + 6, title, theme::text_scale, theme::text);
}

}  // namespace greatx::io
