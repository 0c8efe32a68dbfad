// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/contact_sheet.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "io/panels.h"
#include "io/png.h"
#include "io/summary.h"

namespace greatx::io {

namespace {

constexpr int margin = 28, gap = 14, gutter = 132;
constexpr int tile_width = 400, legend_height = 24, title_height = 30, row_gap = 10;
constexpr int header_height = 74, plot_height = 400;
constexpr size_t most_columns = 4;

struct Moment {
  int64_t tick, time_ns;
};

/// First, one third, two thirds, last of the records of the sensor that the rows follow. With an event camera the second
/// stands for the first, at which there are no events yet.
std::vector<Moment> choose_moments(const DatasetReader& reader, uint32_t sequence) {
  const bool events = std::any_of(reader.sensors().begin(), reader.sensors().end(),
                                  [](const SensorSpec& sensor) { return sensor.kind == "event_camera"; });
  for (const bool frames_only : {true, false}) {
    for (size_t s = 0; s < reader.sensors().size(); ++s) {
      const std::vector<IndexRow> rows = reader.records_of(sequence, s);
      if (rows.empty() || (frames_only && !has_frame_panels(reader.sensors()[s].kind))) continue;
      std::vector<Moment> moments;
      std::set<size_t> taken;
      const size_t first = events && rows.size() > 1 ? 1 : 0;
      for (const size_t third : {0, 1, 2, 3}) {
        const size_t i = first + third * (rows.size() - 1 - first) / 3;
        if (taken.insert(i).second) moments.push_back({rows[i].tick, rows[i].time_ns});
      }
      return moments;
    }
  }
  return {};
}

std::vector<IndexRow> nearest(const std::vector<IndexRow>& rows, const std::vector<Moment>& moments) {
  std::vector<IndexRow> chosen;
  for (const Moment& moment : moments) {
    chosen.push_back(*std::min_element(rows.begin(), rows.end(), [&](const IndexRow& a, const IndexRow& b) {
      return std::abs(a.tick - moment.tick) < std::abs(b.tick - moment.tick);
    }));
  }
  return chosen;
}

/// All panels; of the kinds that are drawn over time only the first sensor gets some.
Panels make_panels(const DatasetReader& reader, uint32_t sequence, const std::vector<Moment>& moments) {
  Panels panels;
  std::set<std::string> drawn;
  for (size_t s = 0; s < reader.sensors().size(); ++s) {
    const SensorSpec& sensor = reader.sensors()[s];
    const std::vector<IndexRow> rows = reader.records_of(sequence, s);
    if (rows.empty() || (!has_frame_panels(sensor.kind) && !drawn.insert(sensor.kind).second)) continue;
    add_panels({reader, sequence, s, nearest(rows, moments)}, panels);
  }
  return panels;
}

/// Columns of a band of frame panels, and the height of their pictures: the tallest aspect, kept within reason.
struct Band {
  size_t first, count;
  int picture_height;
};

std::vector<Band> make_bands(const Panels& panels) {
  std::vector<Band> bands;
  const size_t total = panels.frames.size();
  const size_t per_band = total <= most_columns + 1 ? std::max<size_t>(total, 1) : most_columns;
  for (size_t first = 0; first < total; first += per_band) {
    const size_t count = std::min(per_band, total - first);
    double aspect = 0.5;
    for (size_t i = first; i < first + count; ++i) aspect = std::max(aspect, panels.frames[i]->aspect());
    bands.push_back({first, count, static_cast<int>(std::lround(tile_width * std::min(aspect, 1.0)))});
  }
  return bands;
}

int row_height(const Band& band) { return band.picture_height + legend_height + row_gap; }

/// The largest rectangle of the aspect in the middle of the tile.
Rect fit(const Rect& tile, double aspect) {
  const int width = std::min(tile.width, static_cast<int>(std::lround(tile.height / aspect)));
  const int height = std::min(tile.height, static_cast<int>(std::lround(width * aspect)));
  return {tile.x + (tile.width - width) / 2, tile.y + (tile.height - height) / 2, width, height};
}

void draw_header(Canvas& canvas, const DatasetReader& reader, uint32_t sequence) {
  const Summary summary = summarize(reader);
  canvas.text(margin, margin, summary.title, 3, theme::text);
  std::string line = fmt::format("sequence {} of {}   {} ticks   {:.4g} s   {} sensors   {} records",
                                 sequence + 1, reader.info().sequences, reader.info().ticks_per_sequence,
                                 summary.duration_s, reader.sensors().size(), summary.records);
  if (!reader.finished()) line += "   UNFINISHED";
  canvas.text(margin, margin + 34, line, theme::text_scale, theme::dim);
}

int draw_band(Canvas& canvas, int y, const Band& band, const Panels& panels,
              const std::vector<Moment>& moments) {
  const auto column_x = [](size_t column) {
    return margin + gutter + static_cast<int>(column) * (tile_width + gap);
  };
  for (size_t c = 0; c < band.count; ++c)
    canvas.text(column_x(c), y + 6, panels.frames[band.first + c]->title(), theme::text_scale, theme::text);
  y += title_height;
  for (size_t row = 0; row < moments.size(); ++row, y += row_height(band)) {
    canvas.text(margin, y + 4, fmt::format("{:.3f} s", 1e-9 * static_cast<double>(moments[row].time_ns)),
                theme::text_scale, theme::text);
    canvas.text(margin, y + 4 + theme::line_height, fmt::format("tick {}", moments[row].tick),
                theme::text_scale, theme::dim);
    for (size_t c = 0; c < band.count; ++c) {
      FramePanel& panel = *panels.frames[band.first + c];
      const Rect tile{column_x(c), y, tile_width, band.picture_height};
      canvas.fill(tile, theme::panel);
      panel.draw(canvas, fit(tile, panel.aspect()),
                 {tile.x, tile.bottom() + 2, tile_width, legend_height - 4}, row);
      canvas.frame(tile, theme::border);
    }
  }
  return y;
}

void check_has_records(const DatasetReader& reader, uint32_t sequence) {
  if (sequence >= reader.sequences() || reader.records(sequence).empty())
    throw_user_error("{}: sequence {} has no records to show", reader.folder().string(), sequence);
}

/// A column of a comparison: what one data set shows at one moment.
struct Column {
  std::string title;
  Panels panels;
};

}  // namespace

Array contact_sheet(const DatasetReader& reader, uint32_t sequence) {
  check_has_records(reader, sequence);
  const std::vector<Moment> moments = choose_moments(reader, sequence);
  const Panels panels = make_panels(reader, sequence, moments);
  const std::vector<Band> bands = make_bands(panels);

  const size_t columns = bands.empty() ? 4 : std::max<size_t>(bands[0].count, 3);
  const int width = 2 * margin + gutter + static_cast<int>(columns) * (tile_width + gap) - gap;
  const int inner = width - 2 * margin;
  const auto plots_per_row = static_cast<int>(std::clamp<size_t>(panels.series.size(), 1, 3));
  const int plot_rows = (static_cast<int>(panels.series.size()) + plots_per_row - 1) / plots_per_row;
  int height = margin + header_height + plot_rows * (title_height + plot_height) + margin;
  for (const Band& band : bands)
    height += title_height + static_cast<int>(moments.size()) * row_height(band) + gap;

  Canvas canvas(width, height, theme::page);
  draw_header(canvas, reader, sequence);
  int y = margin + header_height;
  for (const Band& band : bands) y = draw_band(canvas, y, band, panels, moments) + gap;
  const int plot_width = (inner - (plots_per_row - 1) * gap) / plots_per_row;
  for (int i = 0; i < static_cast<int>(panels.series.size()); ++i) {
    const int x = margin + i % plots_per_row * (plot_width + gap);
    const int top = y + i / plots_per_row * (title_height + plot_height);
    SeriesPanel& panel = *panels.series[static_cast<size_t>(i)];
    canvas.text(x, top + 6, panel.title(), theme::text_scale, theme::text);
    panel.draw(canvas, {x, top + title_height, plot_width, plot_height});
  }
  return canvas.image();
}

Array comparison_sheet(std::span<const DatasetReader> readers, uint32_t sequence) {
  std::vector<Column> columns;
  size_t rows = 0;
  for (const DatasetReader& reader : readers) {
    check_has_records(reader, sequence);
    std::vector<Moment> moments = choose_moments(reader, sequence);
    if (!moments.empty()) moments = {moments[moments.size() / 2]};
    columns.push_back({summarize(reader).title, make_panels(reader, sequence, moments)});
    rows = std::max(rows, columns.back().panels.frames.size());
  }
  if (rows == 0) throw_user_error("none of the data sets has a camera or a LiDAR to show");

  std::vector<int> heights;
  for (size_t row = 0; row < rows; ++row) {
    double aspect = 0.5;
    for (const Column& column : columns)
      if (row < column.panels.frames.size()) aspect = std::max(aspect, column.panels.frames[row]->aspect());
    heights.push_back(static_cast<int>(std::lround(tile_width * std::min(aspect, 1.0))));
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
        canvas.text(x, y + 6, panel.title(), theme::text_scale, theme::text);
        const Rect tile{x, y + title_height, tile_width, heights[row]};
        canvas.fill(tile, theme::panel);
        panel.draw(canvas, fit(tile, panel.aspect()), {x, tile.bottom() + 2, tile_width, legend_height - 4},
                   0);
        canvas.frame(tile, theme::border);
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
