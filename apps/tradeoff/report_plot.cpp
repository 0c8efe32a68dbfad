// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Plots as SVG. Colours are CSS variables with defaults, so that a plot follows the page that it stands in
// and can be looked at alone.
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <fmt/format.h>

#include "apps/tradeoff/report_parts.h"
#include "draw/canvas/plot.h"
#include "io/formats/html_text.h"

namespace greatx::apps {

namespace {

constexpr double width = 640.0, height = 374.0;
constexpr double left = 70.0, right = 24.0, top = 34.0, bottom = 78.0;
constexpr double exact_room = 26.0;  ///< below the axis: settings without error

/// A place in a plot.
struct Mark {
  double x = 0.0, x_low = 0.0, x_high = 0.0;
  std::optional<double> y;  ///< none: exact
  std::string label;
  bool standard = false, reference = false, hollow = false;
};

struct Axis {
  io::Scale scale;
  std::string label;
};

io::Scale scale_around(double low, double high, bool logarithmic) {
  if (logarithmic) return {low / 1.4, high * 1.4, true};
  const double room = std::max(0.08 * (high - low), 1e-3 * std::max(1.0, std::abs(high)));
  return {low - room, high + room, false};
}

/// Draws marks with their labels; labels move up where another one stands.
class Plot {
 public:
  Plot(std::vector<Mark> marks, const std::string& title, const std::string& x_label,
       const std::string& y_label, bool y_logarithmic)
      : marks_(std::move(marks)) {
    double low = std::numeric_limits<double>::infinity(), high = 0.0;
    double y_low = std::numeric_limits<double>::infinity(), y_high = -y_low;
    for (const Mark& mark : marks_) {
      low = std::min(low, mark.x_low);
      high = std::max(high, mark.x_high);
      if (!mark.y) continue;
      y_low = std::min(y_low, *mark.y);
      y_high = std::max(y_high, *mark.y);
    }
    if (!(y_low <= y_high)) y_low = y_logarithmic ? 0.1 : -1.0, y_high = 1.0;
    x_ = {scale_around(std::max(low, 1e-6), std::max(high, 2e-6), true), x_label};
    y_ = {scale_around(y_low, y_high, y_logarithmic), y_label};
    svg_ = fmt::format(
        R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {0} {1}" width="{0}" height="{1}" )"
        R"(role="img" font-family="system-ui, sans-serif" font-size="13"><title>{2}</title>)"
        R"(<rect width="{0}" height="{1}" fill='var(--panel, #ffffff)'/>)",
        width, height, escaped(title));
    text(left, 20, title, "var(--ink, #1c2430)", "start", 15);
    axes();
    for (const Mark& mark : marks_) draw(mark);
  }
  void note(const std::string& upper, const std::string& lower) {
    text(left, height - 21, upper, "var(--dim, #667085)", "start", 11);
    text(left, height - 7, lower, "var(--dim, #667085)", "start", 11);
  }
  std::string take() { return svg_ + "</svg>\n"; }

 private:
  double at_x(double value) const { return left + x_.scale.at(value) * (width - left - right); }
  double at_y(const std::optional<double>& value) const {
    const double floor = height - bottom - exact_room;
    return value ? floor - y_.scale.at(*value) * (floor - top) : height - bottom - 8.0;
  }
  void line(double x0, double y0, double x1, double y1, const char* color, double thickness = 1.0) {
    svg_ += fmt::format(
        R"(<line x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}" stroke="{}" stroke-width="{}"/>)", x0, y0,
        x1, y1, color, thickness);
  }
  void text(double x, double y, const std::string& words, const char* color, const char* anchor,
            int size = 12) {
    svg_ += fmt::format(R"(<text x="{:.1f}" y="{:.1f}" fill="{}" text-anchor="{}" font-size="{}">{}</text>)",
                        x, y, color, anchor, size, escaped(words));
  }
  void axes() {
    const char *const grid = "var(--grid, #e4e7ec)", *const dim = "var(--dim, #667085)";
    const double floor = height - bottom - exact_room;
    double taken = 0.0;
    for (const double value : x_.scale.ticks(6)) {
      line(at_x(value), top, at_x(value), height - bottom, grid);
      if (at_x(value) < taken) continue;
      text(at_x(value), height - bottom + 16, short_number(value), dim, "middle");
      taken = at_x(value) + 40.0;
    }
    for (const double value : y_.scale.ticks(6)) {
      line(left, at_y(value), width - right, at_y(value), grid);
      text(left - 6, at_y(value) + 4, short_number(value), dim, "end");
    }
    line(left, floor, width - right, floor, dim);
    text(left - 6, height - bottom - 4, "exact", dim, "end");
    text(0.5 * (left + width - right), height - bottom + 34, x_.label, "var(--ink, #1c2430)", "middle");
    svg_ += fmt::format(
        R"(<text x="16" y="{0:.1f}" fill='var(--ink, #1c2430)' text-anchor="middle" font-size="12" )"
        R"(transform='rotate(-90 16 {0:.1f})'>{1}</text>)",
        0.5 * (top + floor), escaped(y_.label));
  }
  void draw(const Mark& mark) {
    const double x = at_x(mark.x), y = at_y(mark.y);
    const char* const color = mark.standard    ? "var(--own, #d92d20)"
                              : mark.reference ? "var(--finest, #067647)"
                                               : "var(--mark, #175cd3)";
    line(at_x(mark.x_low), y, at_x(mark.x_high), y, color, 1.5);
    svg_ +=
        fmt::format(R"(<circle cx="{:.1f}" cy="{:.1f}" r="4.5" fill="{}" stroke="{}" stroke-width="1.5"/>)",
                    x, y, mark.hollow ? "var(--panel, #ffffff)" : color, color);
    if (mark.label.empty()) return;
    const double room = 7.0 * static_cast<double>(mark.label.size());
    double place = y - 8.0;
    const auto overlaps = [&](double at) {
      return std::ranges::any_of(labels_, [&](const Box& box) {
        return std::abs(box.y - at) < 13.0 && x - 0.5 * room < box.right && x + 0.5 * room > box.left;
      });
    };
    for (int tries = 0; tries < 6 && overlaps(place); ++tries) place -= 13.0;
    const double middle = std::clamp(x, left + 0.5 * room, width - right - 0.5 * room);
    labels_.push_back({middle - 0.5 * room, middle + 0.5 * room, place});
    text(middle, place, mark.label, color, "middle");
  }

  struct Box {
    double left, right, y;
  };
  std::vector<Mark> marks_;
  Axis x_, y_;
  std::vector<Box> labels_;
  std::string svg_;
};

std::string with_unit(const std::string& name, const std::string& unit) {
  return unit == "1" || unit.empty() ? name : name + ", " + unit;
}

}  // namespace

std::string escaped(const std::string& text) { return io::html_escaped(text); }

std::string device_line(const nlohmann::json& report) {
  return fmt::format("{}, {} cores", report["device"].get<std::string>(), report["cores"].get<uint32_t>());
}

std::string plot_of_knob(const nlohmann::json& knob, const std::string& device) {
  std::vector<Mark> marks;
  std::string figure, unit;
  for (const Point& point : points_of(knob)) {
    if (figure.empty()) figure = point.figure, unit = point.unit;
    Mark mark{point.ms, point.low_ms, point.high_ms, {}, point.label, point.standard, point.reference, false};
    // A logarithmic axis has no place for 0: such a setting differs, but not in this figure.
    if (!point.exact && point.error && (point.unit == "dB" || *point.error > 0.0)) mark.y = *point.error;
    marks.push_back(std::move(mark));
  }
  Plot plot(std::move(marks),
            fmt::format("{}: {}", knob["modality"].get<std::string>(), knob["name"].get<std::string>()),
            fmt::format("time of a {}, ms", timed_of(knob)), with_unit(figure, unit), unit != "dB");
  plot.note(device, fmt::format("median and quartiles; red: default, green: reference {}",
                                knob["reference"].get<std::string>()));
  return plot.take();
}

std::string plot_of_front(const nlohmann::json& front, const std::string& device) {
  std::vector<Mark> marks;
  const bool db = front["unit"] == "dB";
  size_t number = 0;
  for (const nlohmann::json& point : front["points"]) {
    Mark mark;
    mark.x = point["tick_ms"]["median"];
    mark.x_low = point["tick_ms"]["low"];
    mark.x_high = point["tick_ms"]["high"];
    mark.standard = point["default"];
    mark.reference = point["reference"];
    mark.label = std::to_string(++number);
    if (!point["error"].is_null() && (db || point["error"].get<double>() > 0.0))
      mark.y = point["error"].get<double>();
    marks.push_back(mark);
    const double predicted = point["predicted_ms"];
    if (!(predicted > 0.0)) continue;
    Mark guess;
    guess.x = guess.x_low = guess.x_high = predicted;
    guess.hollow = true;
    if (!point["predicted_error"].is_null() && (db || point["predicted_error"].get<double>() > 0.0))
      guess.y = point["predicted_error"].get<double>();
    marks.push_back(guess);
  }
  Plot plot(std::move(marks), fmt::format("{}: joint settings", front["modality"].get<std::string>()),
            "time of a tick, ms", with_unit(front["figure"], front["unit"]), !db);
  plot.note(device,
            "filled: measured, hollow: predicted; red: default, green: all knobs at their references");
  return plot.take();
}

std::string overview_plot(const nlohmann::json& report) {
  // A row for each knob: the times of its settings over that of the default.
  struct Row {
    std::string name;
    std::vector<std::pair<double, const nlohmann::json*>> places;
  };
  std::vector<Row> rows;
  double low = 0.5, high = 2.0;
  for (const nlohmann::json& knob : report["knobs"]) {
    if (!knob["skipped"].get<std::string>().empty()) continue;
    double own = 0.0;
    for (const nlohmann::json& setting : knob["settings"])
      if (setting["label"] == knob["default"]) own = setting["tick_ms"]["median"];
    if (own <= 0.0) continue;
    Row row{fmt::format("{} {}", knob["modality"].get<std::string>(), knob["name"].get<std::string>()), {}};
    for (const nlohmann::json& setting : knob["settings"]) {
      const double factor = setting["tick_ms"]["median"].get<double>() / own;
      low = std::min(low, factor);
      high = std::max(high, factor);
      row.places.emplace_back(factor, &setting);
    }
    rows.push_back(std::move(row));
  }
  constexpr double name_room = 250.0, row_height = 22.0, span = 560.0;
  const io::Scale scale{low / 1.2, high * 1.2, true};
  const double total = 70.0 + row_height * static_cast<double>(rows.size());
  std::string svg = fmt::format(
      R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {0} {1}" width="{0}" height="{1}" role="img" )"
      R"(font-family="system-ui, sans-serif" font-size="12"><title>all knobs</title>)"
      R"(<rect width="{0}" height="{1}" fill='var(--panel, #ffffff)'/>)",
      name_room + span + 40.0, total);
  for (const double value : scale.ticks(6)) {
    const double x = name_room + scale.at(value) * span;
    svg +=
        fmt::format(R"(<line x1="{0:.1f}" x2="{0:.1f}" y1="34" y2="{1:.1f}" stroke='var(--grid, #e4e7ec)'/>)"
                    R"(<text x="{0:.1f}" y="28" text-anchor="middle" fill='var(--dim, #667085)'>{2}</text>)",
                    x, total - 24.0, short_number(value));
  }
  for (size_t r = 0; r < rows.size(); ++r) {
    const double y = 48.0 + row_height * static_cast<double>(r);
    svg +=
        fmt::format(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="end" fill='var(--ink, #1c2430)'>{}</text>)",
                    name_room - 10.0, y + 4.0, escaped(rows[r].name));
    for (const auto& [factor, setting] : rows[r].places)
      svg += fmt::format(R"(<circle cx="{:.1f}" cy="{:.1f}" r="5" fill="{}" stroke='var(--mark, #175cd3)'>)"
                         R"(<title>{}: {:.3g} of the time, {}</title></circle>)",
                         name_room + scale.at(factor) * span, y,
                         (*setting)["exact"].get<bool>() ? "var(--mark, #175cd3)" : "var(--panel, #ffffff)",
                         escaped((*setting)["label"].get<std::string>()), factor,
                         escaped(error_text(Point(*setting))));
  }
  svg += fmt::format(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="middle" fill='var(--dim, #667085)'>)"
                     "time over that of the default; filled: the reference's own records</text></svg>",
                     name_room + 0.5 * span, total - 8.0);
  return svg + "\n";
}

}  // namespace greatx::apps
