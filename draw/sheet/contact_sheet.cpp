// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "draw/sheet/contact_sheet.h"

#include <algorithm>
#include <iterator>

#include "draw/sheet/sheet_tiles.h"
#include "io/dataset/summary.h"
#include "io/formats/png.h"

namespace greatx::io {

namespace {

using namespace sheet;

constexpr int header_height = 74;
constexpr size_t least_columns = 3;  ///< so that header and plots have room
constexpr int title_scale = 3;

/// Returns the panels of all sensors in one list.
Panels make_panels(const DatasetReader& reader, uint32_t sequence, const std::vector<size_t>& sensors,
                   const std::vector<SheetMoment>& moments, const PanelOptions& options) {
  Panels all;
  for (Panels& panels : panels_by_sensor(reader, sequence, sensors, moments, options)) {
    std::move(panels.frames.begin(), panels.frames.end(), std::back_inserter(all.frames));
    std::move(panels.series.begin(), panels.series.end(), std::back_inserter(all.series));
  }
  return all;
}

void draw_header(Canvas& canvas, const Rect& area, const DatasetReader& reader, uint32_t sequence) {
  const Summary summary = summarize(reader);
  canvas.text(area.x, area.y, fitted(summary.title, area.width, title_scale), title_scale,
              canvas.theme().text);
  std::string line = fmt::format("sequence {} of {}   {} ticks   {:.4g} s   {} sensors   {} records",
                                 sequence + 1, reader.info().sequences, reader.info().ticks_per_sequence,
                                 summary.duration_s, reader.sensors().size(), summary.records);
  if (!reader.finished()) line += "   UNFINISHED";
  canvas.text(area.x, area.y + 34, fitted(line, area.width, theme::text_scale), theme::text_scale,
              canvas.theme().dim);
}

/// Throws UserError if the sheet would be too large, because a data set may declare any number of sensors.
void check_size(const DatasetReader& reader, int64_t width, int64_t height, int64_t factor) {
  constexpr int64_t most_pixels = int64_t{1} << 28;
  if (width * height * factor * factor > most_pixels)
    throw_user_error("{}: expected a contact sheet of at most {} pixels, found {} x {}, of {} sensors",
                     reader.folder().string(), most_pixels, factor * width, factor * height,
                     reader.sensors().size());
}

void draw_times(Canvas& canvas, const SheetLayout& layout, const std::vector<SheetMoment>& moments) {
  for (const std::vector<Rect>& band : layout.times)
    for (size_t m = 0; m < moments.size(); ++m) {
      const Rect& at = band[m];
      const auto line = [&](int y, const std::string& text, Color color) {
        canvas.text(at.x, y, fitted(text, at.width, theme::text_scale), theme::text_scale, color);
      };
      line(at.y + 4, fmt::format("{:.3f} s", 1e-9 * static_cast<double>(moments[m].time_ns)),
           canvas.theme().text);
      line(at.y + 4 + theme::line_height, fmt::format("tick {}", moments[m].tick), canvas.theme().dim);
    }
}

/// Holds a column of a comparison: the panels of one data set at one moment.
struct Column {
  std::string title;
  Panels panels;
  std::vector<std::vector<KeyEntry>> keys;
};

}  // namespace

Array contact_sheet(const DatasetReader& reader, uint32_t sequence, const SheetOptions& options) {
  return drawn_contact_sheet(reader, sequence, options).image();
}

Canvas drawn_contact_sheet(const DatasetReader& reader, uint32_t sequence, const SheetOptions& options) {
  check_has_records(reader, sequence);
  const std::vector<size_t> sensors = shown_sensors(reader, options.sensors);
  size_t expected = 0;
  for (const size_t s : sensors) expected += count_frame_panels(reader.sensors()[s]);
  const std::vector<SheetMoment> moments = choose_moments(reader, sequence, sensors, moments_for(expected));
  if (moments.empty())
    throw_user_error("{}: the chosen sensors have no records in sequence {}", reader.folder().string(),
                     sequence);
  const Panels panels = make_panels(reader, sequence, sensors, moments, options.panels);

  LayoutWish wish;
  std::vector<std::vector<KeyEntry>> keys;
  for (const auto& panel : panels.frames) {
    keys.push_back(panel->key(*options.theme));
    wish.aspects.push_back(panel->aspect());
    wish.key_lines.push_back(keys.back().size());
  }
  wish.moments = moments.size();
  wish.plots = panels.series.size();
  wish.header = header_height;
  wish.least_columns = least_columns;
  const SheetLayout layout = sheet_layout(wish);
  check_size(reader, layout.width, layout.height, options.factor);
  Canvas canvas(layout.width, layout.height, *options.theme, options.factor);
  draw_header(canvas, layout.header, reader, sequence);
  draw_times(canvas, layout, moments);
  for (size_t i = 0; i < panels.frames.size(); ++i) {
    const SheetLayout::Tile& tile = layout.tiles[i];
    draw_title(canvas, tile.title, panels.frames[i]->title());
    for (size_t m = 0; m < moments.size(); ++m)
      draw_tile(canvas, *panels.frames[i], tile.pictures[m], tile.legends[m], m);
    draw_key(canvas, tile.key, keys[i]);
  }
  for (size_t i = 0; i < panels.series.size(); ++i) {
    draw_title(canvas, layout.plots[i].title, panels.series[i]->title());
    panels.series[i]->draw(canvas, layout.plots[i].area);
  }
  return canvas;
}

Array comparison_sheet(std::span<const DatasetReader> readers, uint32_t sequence,
                       const SheetOptions& options) {
  std::vector<Column> columns;
  size_t rows = 0;
  for (const DatasetReader& reader : readers) {
    check_has_records(reader, sequence);
    const std::vector<size_t> sensors = shown_sensors(reader, options.sensors);
    std::vector<SheetMoment> moments = choose_moments(reader, sequence, sensors, most_moments);
    if (!moments.empty()) moments = {moments[moments.size() / 2]};
    Column& column = columns.emplace_back(
        Column{summarize(reader).title, make_panels(reader, sequence, sensors, moments, options.panels), {}});
    for (const auto& panel : column.panels.frames) column.keys.push_back(panel->key(*options.theme));
    rows = std::max(rows, column.panels.frames.size());
  }
  if (rows == 0) throw_user_error("none of the data sets has a camera or a LiDAR to show");

  std::vector<int> tiles, keys;  // heights, by row
  int height = margin + header_height / 2 + margin;
  for (size_t row = 0; row < rows; ++row) {
    double aspect = 0.0;
    size_t lines = 0;
    for (const Column& column : columns)
      if (row < column.panels.frames.size()) {
        aspect = std::max(aspect, column.panels.frames[row]->aspect());
        lines = std::max(lines, column.keys[row].size());
      }
    tiles.push_back(tile_height(aspect));
    keys.push_back(static_cast<int>(lines) * theme::line_height);
    height += title_height + tiles.back() + legend_height + keys.back() + row_gap;
  }
  const int width = 2 * margin + static_cast<int>(columns.size()) * (tile_width + gap) - gap;
  check_size(readers[0], width, height, options.factor);
  Canvas canvas(width, height, *options.theme, options.factor);
  for (size_t c = 0; c < columns.size(); ++c) {
    const int x = margin + static_cast<int>(c) * (tile_width + gap);
    canvas.text(x, margin, fitted(columns[c].title, tile_width, title_scale), title_scale,
                canvas.theme().text);
    int y = margin + header_height / 2;
    for (size_t row = 0; row < rows; ++row) {
      if (row < columns[c].panels.frames.size()) {
        FramePanel& panel = *columns[c].panels.frames[row];
        const int top = y + title_height, below = top + tiles[row];
        draw_title(canvas, {x, y, tile_width, title_height}, panel.title());
        draw_tile(canvas, panel, {x, top, tile_width, tiles[row]},
                  {x, below + 2, tile_width, legend_height - 4}, 0);
        draw_key(canvas, {x, below + legend_height, tile_width, keys[row]}, columns[c].keys[row]);
      }
      y += title_height + tiles[row] + legend_height + keys[row] + row_gap;
    }
  }
  return canvas.image();
}

void write_contact_sheet(std::span<const DatasetReader> readers, const std::filesystem::path& file,
                         uint32_t sequence, const SheetOptions& options) {
  const Array sheet = readers.size() == 1 ? contact_sheet(readers[0], sequence, options)
                                          : comparison_sheet(readers, sequence, options);
  const Bytes png = encode_png(sheet);
  create_folder_of(file);
  write_file_atomically(file, png);
}

void write_contact_sheet(const DatasetReader& reader, const std::filesystem::path& file, uint32_t sequence,
                         const SheetOptions& options) {
  write_contact_sheet({&reader, 1}, file, sequence, options);
}

}  // namespace greatx::io
