// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/campaign/stats.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "apps/campaign/sqlite.h"
#include "draw/canvas/plot.h"

namespace greatx::apps {
namespace {

/// A quantity as a query of two columns: the split, and the value.
struct Asked {
  const char *name, *label, *sql;
};
constexpr Asked asked[] = {
    {"path_gain_db", "gain of a link, dB",
     "SELECT r.split, l.path_gain_db FROM links l JOIN records r USING (record) WHERE l.path_gain_db IS NOT "
     "NULL"},
    {"delay_spread_ns", "delay spread of a link, ns",
     "SELECT r.split, 1e9 * l.delay_spread_s FROM links l JOIN records r USING (record) WHERE "
     "l.delay_spread_s "
     "IS NOT NULL"},
    {"path_count", "paths of a link",
     "SELECT r.split, l.path_count FROM links l JOIN records r USING (record)"},
    {"height_m", "height of a sensor's node, m", "SELECT split, z FROM records WHERE z IS NOT NULL"},
    {"speed_mps", "speed of a sensor's node, m/s",
     "SELECT split, speed FROM (SELECT split, 1e9 * sqrt((x - lag(x) OVER s) * (x - lag(x) OVER s) + (y - "
     "lag(y) "
     "OVER s) * (y - lag(y) OVER s) + (z - lag(z) OVER s) * (z - lag(z) OVER s)) / (time_ns - lag(time_ns) "
     "OVER "
     "s) AS speed FROM records WHERE z IS NOT NULL WINDOW s AS (PARTITION BY cell, sequence, sensor ORDER BY "
     "tick)) WHERE speed IS NOT NULL"}};

size_t split_named(const std::string& name) {
  for (size_t s = 0; s < split_count; ++s)
    if (name == sim::split_names[s]) return s;
  throw_user_error("index.sqlite: expected a split train, validation or test, found '{}'", name);
}

double percentile(const std::vector<double>& ascending, double share) {
  const double place = share * static_cast<double>(ascending.size() - 1);
  const auto below = static_cast<size_t>(place);
  const size_t above = std::min(below + 1, ascending.size() - 1);
  return std::lerp(ascending[below], ascending[above], place - static_cast<double>(below));
}

}  // namespace

nlohmann::json figures_of(const std::vector<double>& ascending) {
  double sum = 0.0;
  for (const double value : ascending) sum += value;
  return {{"count", ascending.size()},
          {"mean", sum / static_cast<double>(ascending.size())},
          {"least", ascending.front()},
          {"p5", percentile(ascending, 0.05)},
          {"median", percentile(ascending, 0.5)},
          {"p95", percentile(ascending, 0.95)},
          {"most", ascending.back()}};
}

namespace {

void add_quantity(SqliteFile& index, const Asked& what, CampaignStats& stats) {
  Quantity quantity{what.name, what.label, std::vector<std::vector<double>>(split_count)};
  index.each(what.sql, [&](const SqliteRow& row) {
    quantity.values[split_named(row.text(0))].push_back(row.number(1));
  });
  bool any = false;
  for (size_t s = 0; s < split_count; ++s) {
    std::ranges::sort(quantity.values[s]);
    if (quantity.values[s].empty()) continue;
    stats.json["quantities"][what.name][sim::split_names[s]] = figures_of(quantity.values[s]);
    any = true;
  }
  if (any) stats.quantities.push_back(std::move(quantity));
}

void add_counts(SqliteFile& index, nlohmann::json& json) {
  index.each("SELECT split, kind, COUNT(*) FROM records GROUP BY split, kind ORDER BY split, kind",
             [&](const SqliteRow& row) { json["records"][row.text(0)][row.text(1)] = row.number(2); });
  index.each("SELECT split, COUNT(DISTINCT cell || '/' || sequence) FROM records GROUP BY split",
             [&](const SqliteRow& row) { json["sequences"][row.text(0)] = row.number(1); });
  index.each(
      "SELECT r.split, AVG(l.line_of_sight), AVG(l.path_count = 0) FROM links l JOIN records r USING "
      "(record) GROUP "
      "BY r.split",
      [&](const SqliteRow& row) {
        json["line_of_sight_share"][row.text(0)] = row.number(1);
        json["links_without_path_share"][row.text(0)] = row.number(2);
      });
  // The same node at the same place in two splits, to a micrometre: nodes at rest, or trajectories that leak.
  index.each(
      "SELECT COUNT(*) FROM (SELECT 1 FROM records WHERE z IS NOT NULL GROUP BY sensor, ROUND(x, 6), "
      "ROUND(y, 6), "
      "ROUND(z, 6), ROUND(qw, 6), ROUND(qx, 6), ROUND(qy, 6) HAVING COUNT(DISTINCT split) > 1)",
      [&](const SqliteRow& row) { json["poses_in_two_splits"] = row.number(0); });
}

/// Draws the shares of a quantity's values in 40 bins between its 1st and 99th percentile over all splits.
void draw_histogram(io::Canvas& canvas, const io::Rect& plot, const Quantity& quantity) {
  constexpr int bins = 40;
  std::vector<double> all;
  for (const auto& values : quantity.values) all.insert(all.end(), values.begin(), values.end());
  std::ranges::sort(all);
  const io::Scale x = io::scale_for(percentile(all, 0.01), percentile(all, 0.99));
  std::vector<std::vector<double>> shares(split_count, std::vector<double>(bins));
  double most = 0.0;
  for (size_t s = 0; s < split_count; ++s)
    for (const double value : quantity.values[s]) {
      const auto bin = static_cast<size_t>(std::clamp(x.at(value) * bins, 0.0, bins - 1.0));
      shares[s][bin] += 1.0 / static_cast<double>(quantity.values[s].size());
      most = std::max(most, shares[s][bin]);
    }
  const io::Scale y = io::scale_for(0.0, 1.1 * most);
  canvas.fill(plot, io::theme::panel);
  io::draw_x_axis(canvas, plot, x, quantity.label);
  io::draw_y_axis(canvas, plot, y, "share");
  for (size_t s = 0; s < split_count; ++s) {
    if (quantity.values[s].empty()) continue;
    const auto at = [&](int bin) {
      return dvec2(plot.x + (bin + 0.5) * plot.width / bins,
                   plot.bottom() - y.at(shares[s][static_cast<size_t>(bin)]) * plot.height);
    };
    for (int bin = 1; bin < bins; ++bin)
      canvas.line(at(bin - 1).x, at(bin - 1).y, at(bin).x, at(bin).y, 2.0, io::color_of_series(s));
  }
}

/// Draws a row of bars for each class, one for each split.
void draw_balance(io::Canvas& canvas, const io::Rect& plot, const ClassBalance& balance) {
  constexpr size_t most_rows = 10;
  const size_t rows = std::min(most_rows, balance.classes.size());
  canvas.fill(plot, io::theme::panel);
  canvas.text(plot.x, plot.bottom() + 10,
              balance.kind == "camera" ? "share of pixels; mean of the splits"
                                       : "share of returns; mean of the splits",
              io::theme::text_scale, io::theme::text);
  const int height = plot.height / static_cast<int>(std::max<size_t>(1, rows)), names = 170, numbers = 90;
  const int bar = std::max(2, (height - 6) / static_cast<int>(split_count));
  double most = 0.0;
  for (const auto& shares : balance.shares)
    for (const double share : shares) most = std::max(most, share);
  for (size_t row = 0; row < rows; ++row) {
    const int y = plot.y + static_cast<int>(row) * height;
    canvas.text(plot.x + 6, y + height / 2 - 8, balance.classes[row], io::theme::text_scale, io::theme::text);
    double mean = 0.0, sum = 0.0;
    for (size_t s = 0; s < split_count; ++s) {
      if (balance.shares[s].empty()) continue;
      const double share = balance.shares[s][row];
      mean += share, sum += 1.0;
      const int width = static_cast<int>(share / most * (plot.width - names - numbers));
      canvas.fill({plot.x + names, y + 3 + static_cast<int>(s) * bar, std::max(1, width), bar - 1},
                  io::color_of_series(s));
    }
    canvas.text(plot.x + plot.width - numbers + 6, y + height / 2 - 8,
                fmt::format("{:.2g} %", 100.0 * mean / sum), io::theme::text_scale, io::theme::text);
  }
}

}  // namespace

CampaignStats campaign_stats(const OpenCampaign& open, uint64_t most_sampled, bool quiet) {
  const std::filesystem::path file = open.folder / "index.sqlite";
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored))
    throw_user_error("{}: expected the index of a campaign, found none; `greatx campaign merge` writes it",
                     file.string());
  SqliteFile index(file, SqliteFile::Mode::read);
  CampaignStats stats;
  stats.json = {{"campaign", open.campaign.name}, {"cells", open.cells.size()}};
  add_counts(index, stats.json);
  for (const Asked& what : asked) add_quantity(index, what, stats);
  add_samples(open, most_sampled, quiet, stats);
  return stats;
}

Array draw_stats(const OpenCampaign& open, const CampaignStats& stats) {
  constexpr int width = 640, height = 360, left = 90, top = 60, right = 20, bottom = 70;
  const int columns = 2, panels = static_cast<int>(stats.quantities.size() + stats.balances.size()),
            rows = std::max(1, (panels + 1) / 2);
  io::Canvas canvas(columns * width, rows * height + top, io::theme::page);
  canvas.text(left, 20, open.campaign.name, io::theme::text_scale, io::theme::text);
  for (size_t s = 0; s < split_count; ++s)
    canvas.text(left + 500 + 180 * static_cast<int>(s), 20, sim::split_names[s], io::theme::text_scale,
                io::color_of_series(s));
  const auto panel = [&](size_t i) {
    const int x = static_cast<int>(i % 2) * width + left, y = static_cast<int>(i / 2) * height + top;
    return io::Rect{x, y, width - left - right, height - bottom};
  };
  for (size_t q = 0; q < stats.quantities.size(); ++q) draw_histogram(canvas, panel(q), stats.quantities[q]);
  for (size_t b = 0; b < stats.balances.size(); ++b)
    draw_balance(canvas, panel(stats.quantities.size() + b), stats.balances[b]);
  return canvas.image();
}

}  // namespace greatx::apps
