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

constexpr int gutter = 132, header_height = 74, plot_height = 400;
constexpr size_t most_columns = 4, rows_of_sheet = 4;

/// Returns the panels of all sensors in one list.
Panels make_panels(const DatasetReader& reader, uint32_t sequence, const std::vector<SheetMoment>& moments) {
  Panels all;
  for (Panels& panels : panels_by_sensor(reader, sequence, moments)) {
    std::move(panels.frames.begin(), panels.frames.end(), std::back_inserter(all.frames));
    std::move(panels.series.begin(), panels.series.end(), std::back_inserter(all.series));
  }
  return all;
}

int row_height(const Band& band) { return band.picture_height + legend_height + row_gap; }

void draw_header(Canvas& canvas, const DatasetReader& reader, uint32_t sequence) {
  const Summary summary = summarize(reader);
  canvas.text(margin, margin, summary.title, 3, theme::text);
  std::string line = fmt::format("sequence {} of {}   {} ticks   {:.4g} s   {} sensors   {} records",
                                 sequence + 1, reader.info().sequences, reader.info().ticks_per_sequence,
                                 summary.duration_s, reader.sensors().size(), summary.records);
  if (!reader.finished()) line += "   UNFINISHED";
  canvas.text(margin, margin + 34, line, theme::text_scale, theme::dim);
}

/// Draws a band of panels with a row for each moment. Returns the y below it.
int draw_band(Canvas& canvas, int y, const Band& band, const Panels& panels,
              const std::vector<SheetMoment>& moments) {
  const auto column_x = [](size_t column) {
    return margin + gutter + static_cast<int>(column) * (tile_width + gap);
  };
  for (size_t c = 0; c < band.count; ++c)
    draw_title(canvas, column_x(c), y, panels.frames[band.first + c]->title());
  y += title_height;
  for (size_t row = 0; row < moments.size(); ++row, y += row_height(band)) {
    canvas.text(margin, y + 4, fmt::format("{:.3f} s", 1e-9 * static_cast<double>(moments[row].time_ns)),
                theme::text_scale, theme::text);
    canvas.text(margin, y + 4 + theme::line_height, fmt::format("tick {}", moments[row].tick),
                theme::text_scale, theme::dim);
    for (size_t c = 0; c < band.count; ++c) {
      const Rect tile{column_x(c), y, tile_width, band.picture_height};
      draw_tile(canvas, *panels.frames[band.first + c], tile, row);
    }
  }
  return y;
}

/// Throws UserError if the sheet would be too large, because a data set may declare any number of sensors.
void check_size(const DatasetReader& reader, int64_t width, int64_t height) {
  constexpr int64_t most_pixels = int64_t{1} << 28;
  if (width * height > most_pixels)
    throw_user_error("{}: expected a contact sheet of at most {} pixels, found {} x {}, of {} sensors",
                     reader.folder().string(), most_pixels, width, height, reader.sensors().size());
}

/// Holds a column of a comparison: the panels of one data set at one moment.
struct Column {
  std::string title;
  Panels panels;
};

}  // namespace

Array contact_sheet(const DatasetReader& reader, uint32_t sequence) {
  check_has_records(reader, sequence);
  const std::vector<SheetMoment> moments = choose_moments(reader, sequence, rows_of_sheet);
  const Panels panels = make_panels(reader, sequence, moments);
  const size_t total = panels.frames.size();
  const std::vector<Band> bands =
      make_bands(panels.frames, total <= most_columns + 1 ? most_columns + 1 : most_columns);

  const size_t columns = bands.empty() ? 4 : std::max<size_t>(bands[0].count, 3);
  const int width = 2 * margin + gutter + static_cast<int>(columns) * (tile_width + gap) - gap;
  const int inner = width - 2 * margin;
  const auto plots_per_row = static_cast<int>(std::clamp<size_t>(panels.series.size(), 1, 3));
  const int plot_rows = (static_cast<int>(panels.series.size()) + plots_per_row - 1) / plots_per_row;
  int height = margin + header_height + plot_rows * (title_height + plot_height) + margin;
  for (const Band& band : bands)
    height += title_height + static_cast<int>(moments.size()) * row_height(band) + gap;

  check_size(reader, width, height);
  Canvas canvas(width, height, theme::page);
  draw_header(canvas, reader, sequence);
  int y = margin + header_height;
  for (const Band& band : bands) y = draw_band(canvas, y, band, panels, moments) + gap;
  const int plot_width = (inner - (plots_per_row - 1) * gap) / plots_per_row;
  for (int i = 0; i < static_cast<int>(panels.series.size()); ++i) {
    const int x = margin + i % plots_per_row * (plot_width + gap);
    const int top = y + i / plots_per_row * (title_height + plot_height);
    SeriesPanel& panel = *panels.series[static_cast<size_t>(i)];
    draw_title(canvas, x, top, panel.title());
    panel.draw(canvas, {x, top + title_height, plot_width, plot_height});
  }
  return canvas.image();
}

Array comparison_sheet(std::span<const DatasetReader> readers, uint32_t sequence) {
  std::vector<Column> columns;
  size_t rows = 0;
  for (const DatasetReader& reader : readers) {
    check_has_records(reader, sequence);
    std::vector<SheetMoment> moments = choose_moments(reader, sequence, rows_of_sheet);
    if (!moments.empty()) moments = {moments[moments.size() / 2]};
    columns.push_back({summarize(reader).title, make_panels(reader, sequence, moments)});
    rows = std::max(rows, columns.back().panels.frames.size());
  }
  if (rows == 0) throw_user_error("none of the data sets has a camera or a LiDAR to show");

  std::vector<int> heights;
  for (size_t row = 0; row < rows; ++row) {
    double aspect = 0.0;
    for (const Column& column : columns)
      if (row < column.panels.frames.size()) aspect = std::max(aspect, column.panels.frames[row]->aspect());
    heights.push_back(tile_height(aspect));
  }
  int height = margin + header_height / 2 + margin;
  for (const int tile : heights) height += title_height + tile + legend_height + row_gap;
  Canvas canvas(2 * margin + static_cast<int>(columns.size()) * (tile_width + gap) - gap, height,
                theme::page);
  for (size_t c = 0; c < columns.size(); ++c) {
    const int x = margin + static_cast<int>(c) * (tile_width + gap);
    canvas.text(x, margin, columns[c].title, 3, theme::text);
    int y = margin + header_height / 2;
    for (size_t row = 0; row < rows; ++row) {
      if (row < columns[c].panels.frames.size()) {
        FramePanel& panel = *columns[c].panels.frames[row];
        draw_title(canvas, x, y, panel.title());
        draw_tile(canvas, panel, {x, y + title_height, tile_width, heights[row]}, 0);
      }
      y += title_height + heights[row] + legend_height + row_gap;
    }
  }
  return canvas.image();
}

void write_contact_sheet(std::span<const DatasetReader> readers, const std::filesystem::path& file,
                         uint32_t sequence) {
  const Array sheet =
      readers.size() == 1 ? contact_sheet(readers[0], sequence) : comparison_sheet(readers, sequence);
  const Bytes png = encode_png(sheet);
  create_folder_of(file);
  write_file_atomically(file, png);
}

void write_contact_sheet(const DatasetReader& reader, const std::filesystem::path& file, uint32_t sequence) {
  write_contact_sheet({&reader, 1}, file, sequence);
}

}  // namespace greatx::io
