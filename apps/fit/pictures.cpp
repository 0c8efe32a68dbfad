// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/fit/pictures.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "draw/canvas/canvas.h"
#include "draw/canvas/plot.h"

namespace greatx::apps {
namespace {

using io::Canvas;
using io::Color;
using io::Rect;

constexpr int margin = 24, left_axis = 100, below_axis = 72, title_height = 64, line = 22, text = 2;

Canvas page(int width, int height, const std::string& title, const std::string& below) {
  Canvas canvas(width, height, io::dark_theme());
  canvas.text(margin, 16, io::fitted(title, width - 2 * margin, text), text, canvas.theme().text);
  canvas.text(margin, 16 + line, io::fitted(below, width - 2 * margin, text), text, canvas.theme().dim);
  return canvas;
}

/// A distribution to draw: its name and its values.
struct Distribution {
  std::string name;
  std::vector<double> values;
};

void draw_panel(Canvas& canvas, const Rect& plot, std::vector<Distribution> all, const std::string& label) {
  double low = INFINITY, high = -INFINITY;
  for (Distribution& one : all) {
    std::erase_if(one.values, [](double value) { return !std::isfinite(value); });
    std::ranges::sort(one.values);
    if (one.values.empty()) continue;
    low = std::min(low, one.values.front());
    high = std::max(high, one.values.back());
  }
  if (!(low <= high)) low = 0.0, high = 1.0;
  const io::Scale across = io::scale_for(low, high), upward{0.0, 1.0, false};
  canvas.fill(plot, canvas.theme().panel);
  for (const double value : upward.ticks(5))
    canvas.fill({plot.x, plot.y + static_cast<int>((1.0 - value) * plot.height), plot.width, 1},
                canvas.theme().grid);
  canvas.frame(plot, canvas.theme().border);
  io::draw_x_axis(canvas, plot, across, label);
  io::draw_y_axis(canvas, plot, upward, "share of positions");
  canvas.clip(plot);
  for (size_t d = 0; d < all.size(); ++d) {
    const std::vector<double>& values = all[d].values;
    const double count = static_cast<double>(values.size());
    double x = plot.x, y = plot.bottom();
    for (size_t i = 0; i < values.size(); ++i) {
      const double to_x = plot.x + across.at(values[i]) * plot.width,
                   to_y = plot.bottom() - static_cast<double>(i + 1) / count * plot.height;
      canvas.line(x, y, to_x, y, 2.0, io::color_of_series(canvas.theme(), d));
      canvas.line(to_x, y, to_x, to_y, 2.0, io::color_of_series(canvas.theme(), d));
      x = to_x, y = to_y;
    }
    if (!values.empty()) canvas.line(x, y, plot.right(), y, 2.0, io::color_of_series(canvas.theme(), d));
  }
  canvas.unclip();
  for (size_t d = 0; d < all.size(); ++d) {
    const int y = plot.bottom() + below_axis + static_cast<int>(d) * line;
    canvas.fill({plot.x, y + 4, 24, 4}, io::color_of_series(canvas.theme(), d));
    canvas.text(plot.x + 34, y, fmt::format("{} ({})", all[d].name, all[d].values.size()), text,
                canvas.theme().text);
  }
}

/// Returns the values of a set's usable positions, of one part or of all.
template <typename Value>
std::vector<double> values_of(const FitResult& result, uint32_t set, std::optional<bool> held_out,
                              const Value& value) {
  std::vector<double> values;
  for (const FitPlace& place : result.places)
    if (place.set == set && place.usable && held_out.value_or(place.held_out) == place.held_out)
      values.push_back(value(place));
  return values;
}

}  // namespace

std::vector<PlanLine> plan_lines(const sim::FitModel& model, const dvec3& origin, double height_m) {
  std::vector<PlanLine> lines;
  if (model.links().empty()) return lines;
  const rf::FacetWorld& world = *model.links()[0].world;
  const double z = height_m - origin.z;
  for (uint32_t f = 0; f < world.facet_count(); ++f)
    for (uint32_t t = 0; t < world.facet(f).triangle_count; ++t) {
      const std::array<dvec3, 3> corners = world.corners(f, t);
      std::vector<dvec2> ends;
      for (size_t i = 0; i < 3; ++i) {
        const dvec3 &a = corners[i], &b = corners[(i + 1) % 3];
        if ((a.z < z) == (b.z < z)) continue;
        const double share = (z - a.z) / (b.z - a.z);
        ends.emplace_back(a.x + share * (b.x - a.x) + origin.x, a.y + share * (b.y - a.y) + origin.y);
      }
      if (ends.size() == 2) lines.push_back({ends[0], ends[1]});
    }
  return lines;
}

Array draw_error_map(const FitResult& result, uint32_t set, std::span<const PlanLine> plan,
                     const std::string& title) {
  const sim::FitSet& of = result.model->problem().sets[set];
  dvec2 low(INFINITY), high(-INFINITY);
  double most = 0.0;
  std::vector<double> magnitudes;
  for (const FitPlace& place : result.places) {
    if (place.set != set) continue;
    low = glm::min(low, dvec2(place.at)), high = glm::max(high, dvec2(place.at));
    if (place.usable) magnitudes.push_back(std::abs(place.error));
  }
  std::ranges::sort(magnitudes);
  if (!magnitudes.empty())  // the largest 2 % do not widen the scale
    most = magnitudes[static_cast<size_t>(0.98 * static_cast<double>(magnitudes.size() - 1))];
  most = std::max(most, 1e-6);
  const dvec2 border = dvec2(0.06 * std::max({high.x - low.x, high.y - low.y, 1.0}));
  low -= border, high += border;
  constexpr int longest = 900;
  const double per_m = longest / std::max(high.x - low.x, high.y - low.y);
  const int width = std::max(360, static_cast<int>((high.x - low.x) * per_m)),
            height = std::max(240, static_cast<int>((high.y - low.y) * per_m));
  Canvas canvas =
      page(left_axis + width + 150, title_height + height + below_axis + margin, title,
           fmt::format("{}: errors after the fit, {}; rings are held out", of.name, error_unit(of)));
  const Rect plot{left_axis, title_height + line, width, height};
  const io::Scale across{low.x, low.x + width / per_m, false}, upward{low.y, low.y + height / per_m, false};
  canvas.fill(plot, canvas.theme().panel);
  const auto at = [&](const dvec2& place) {
    return dvec2(plot.x + across.at(place.x) * plot.width, plot.bottom() - upward.at(place.y) * plot.height);
  };
  canvas.clip(plot);
  for (const PlanLine& wall : plan) {
    const dvec2 a = at(wall.from), b = at(wall.to);
    canvas.line(a.x, a.y, b.x, b.y, 1.5, canvas.theme().dim);
  }
  const bool signed_values =
      !of.complex_values && of.quantity != sim::FitQuantity::cir && of.quantity != sim::FitQuantity::cfr;
  const io::Scale scale{signed_values ? -most : 0.0, most, false};
  const io::ColorMap map = signed_values ? canvas.theme().velocities : canvas.theme().power;
  const double radius =
      std::clamp(0.25 * width / std::sqrt(1.0 + static_cast<double>(magnitudes.size())), 3.0, 9.0);
  for (const FitPlace& place : result.places) {
    if (place.set != set) continue;
    const dvec2 p = at(dvec2(place.at));
    if (!place.usable) {
      canvas.disc(p.x, p.y, 2.0, canvas.theme().dim);
      continue;
    }
    canvas.disc(p.x, p.y, radius, map(std::clamp(scale.at(place.error), 0.0, 1.0)));
    if (place.held_out) canvas.circle(p.x, p.y, radius + 1.5, 1.5, canvas.theme().over);
  }
  canvas.unclip();
  canvas.frame(plot, canvas.theme().border);
  io::draw_x_axis(canvas, plot, across, "x, m");
  io::draw_y_axis(canvas, plot, upward, "y, m");
  io::draw_color_scale(canvas, {plot.right() + 30, plot.y, 24, plot.height}, scale, map, error_unit(of));
  return canvas.image();
}

Array draw_distributions(const FitResult& result, uint32_t set, const std::string& title) {
  const sim::FitSet& of = result.model->problem().sets[set];
  const bool single =
      of.quantity == sim::FitQuantity::power_db || of.quantity == sim::FitQuantity::delay_spread_ns;
  constexpr int width = 520, height = 420, step = width + left_axis + margin;
  Canvas canvas =
      page(left_axis + (single ? 2 : 1) * step, title_height + line + height + below_axis + 5 * line, title,
           fmt::format("{}: distributions over the positions", of.name));
  Rect plot{left_axis, title_height + line, width, height};
  if (single) {
    draw_panel(
        canvas, plot,
        {{"measured", values_of(result, set, {}, [](const FitPlace& p) { return p.measured; })},
         {"modelled before", values_of(result, set, {}, [](const FitPlace& p) { return p.modelled_before; })},
         {"modelled after", values_of(result, set, {}, [](const FitPlace& p) { return p.modelled; })}},
        of.quantity == sim::FitQuantity::power_db ? "power, dB" : "delay spread, ns");
    plot.x += step;
  }
  const auto before = [](const FitPlace& p) { return std::abs(p.error_before); };
  const auto after = [](const FitPlace& p) { return std::abs(p.error); };
  draw_panel(canvas, plot,
             {{"before, fitted", values_of(result, set, false, before)},
              {"before, held out", values_of(result, set, true, before)},
              {"after, fitted", values_of(result, set, false, after)},
              {"after, held out", values_of(result, set, true, after)}},
             fmt::format("magnitude of the error, {}", error_unit(of)));
  return canvas.image();
}

Array draw_correlations(const FitResult& result, const std::string& title) {
  const std::vector<sim::FitVariable>& variables = result.model->variables();
  const int count = static_cast<int>(variables.size());
  const int cell = std::clamp(480 / std::max(1, count), 24, 72);
  size_t longest = 0;
  for (const sim::FitVariable& variable : variables) longest = std::max(longest, variable.name.size());
  const int names = std::min(620, static_cast<int>(longest + 5) * Canvas::glyph_width * text);
  Canvas canvas = page(margin + names + count * cell + 170,
                       title_height + 2 * line + std::max(count * cell, 200) + margin, title,
                       "correlations of the errors of the variables, by the measurements alone");
  const Rect plot{margin + names, title_height + 2 * line, count * cell, count * cell};
  const io::Scale scale{-1.0, 1.0, false};
  for (int a = 0; a < count; ++a) {
    canvas.text(
        plot.x - 10, plot.y + a * cell + cell / 2 - 7,
        io::fitted(fmt::format("{} {}", variables[static_cast<size_t>(a)].name, a + 1), names - 10, text),
        text, canvas.theme().text, io::Align::right);
    canvas.text(plot.x + a * cell + cell / 2, plot.y - line, fmt::format("{}", a + 1), text,
                canvas.theme().text, io::Align::center);
    for (int b = 0; b < count; ++b) {
      const double value = result.assessment.correlation(a, b);
      const Rect square{plot.x + b * cell, plot.y + a * cell, cell - 1, cell - 1};
      canvas.fill(square, canvas.theme().velocities(scale.at(value)));
      if (cell >= 60)
        canvas.rimmed_text(square.x + cell / 2, square.y + cell / 2 - 7, fmt::format("{:.2f}", value), text,
                           canvas.theme().over, canvas.theme().halo, io::Align::center);
    }
  }
  io::draw_color_scale(canvas, {plot.right() + 30, plot.y, 24, std::max(count * cell, 200)}, scale,
                       canvas.theme().velocities, "1");
  return canvas.image();
}

}  // namespace greatx::apps
