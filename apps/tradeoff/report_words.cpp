// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/tradeoff/report_parts.h"

namespace greatx::apps {

std::string short_number(double value) {
  if (std::abs(value) < 1e-12) return "0";
  return std::abs(value) >= 999.5 && std::abs(value) < 1e9 ? fmt::format("{:.0f}", value)
                                                           : fmt::format("{:.3g}", value);
}

std::string timed_of(const nlohmann::json& knob) { return knob.value("timed", "tick"); }

Point::Point(const nlohmann::json& setting)
    : label(setting["label"]),
      ms(setting["tick_ms"]["median"]),
      low_ms(setting["tick_ms"]["low"]),
      high_ms(setting["tick_ms"]["high"]),
      start_ms(setting["start_ms"]),
      exact(setting["exact"]) {
  if (setting["errors"].empty()) return;
  const nlohmann::json& first = setting["errors"].front();
  figure = first["name"];
  unit = first["unit"];
  meaning = first["meaning"];
  if (!first["value"].is_null()) error = first["value"].get<double>();
}

std::vector<Point> points_of(const nlohmann::json& knob) {
  std::vector<Point> points;
  for (const nlohmann::json& setting : knob["settings"]) {
    points.emplace_back(setting);
    points.back().standard = setting["label"] == knob["default"];
    points.back().reference = setting["label"] == knob["reference"];
  }
  return points;
}

std::string error_text(const Point& point) {
  if (point.exact) return "exact";
  if (point.figure.empty()) return "not compared";
  if (!point.error) return "no error of that figure";
  return fmt::format("{}{}{}", short_number(*point.error), point.unit == "1" ? "" : " ",
                     point.unit == "1" ? "" : point.unit);
}

namespace {

/// Whether the times of two settings differ by more than their spreads.
bool apart(const Point& a, const Point& b) { return a.high_ms < b.low_ms || b.high_ms < a.low_ms; }

/// Smaller is better, also for dB; exact is best.
double badness(const Point& point) {
  if (point.exact || !point.error) return -1e300;
  return *point.error;
}

std::string versus(const Point& point, const Point& own) {
  const std::string factor = fmt::format("{:.2g}", point.ms / own.ms);
  const std::string long_as = factor == "1"       ? "about as long"
                              : point.ms < own.ms ? factor + " of the time"
                                                  : factor + " times as long";
  return fmt::format(
      "{} takes {} ({} ms), {}", point.label, long_as, short_number(point.ms),
      point.exact ? "with the same records as the reference" : "and its error is " + error_text(point));
}

}  // namespace

std::string words_of_knob(const nlohmann::json& knob) {
  const std::string skipped = knob["skipped"];
  if (!skipped.empty()) return "It was not measured: " + skipped + ".";
  const std::vector<Point> points = points_of(knob);
  std::vector<std::string> said;
  if (std::ranges::all_of(points, &Point::exact))
    said.push_back("It changes nothing here: all settings give the same records.");
  const auto own = std::ranges::find(points, true, &Point::standard);
  const auto reference = std::ranges::find(points, true, &Point::reference);
  const bool still = std::ranges::none_of(points, [&](const Point& p) { return apart(p, *reference); });
  if (still)
    said.push_back(fmt::format("The time of a {} does not change by more than its spread.", timed_of(knob)));
  if (own == points.end()) {
    if (!still)
      said.push_back(
          fmt::format("The scenario's own value is none of these settings. {}, the reference, takes {} ms.",
                      reference->label, short_number(reference->ms)));
    for (const Point& point : points)
      if (!point.reference && !still && apart(point, *reference))
        said.push_back(versus(point, *reference) + ".");
    return fmt::format("{}", fmt::join(said, " "));
  }
  if (!own->reference)
    said.push_back(fmt::format("Against {}, the default {} has {} {}.", reference->label, own->label,
                               own->exact ? "no" : "an",
                               own->exact ? "error" : "error of " + error_text(*own)));
  for (const Point& point : points) {
    if (&point == &*own || !apart(point, *own)) continue;
    if (point.ms < own->ms && badness(point) <= badness(*own))
      said.push_back(fmt::format("The default could be {}: it takes {:.2g} of the time and is not worse.",
                                 point.label, point.ms / own->ms));
    else
      said.push_back(versus(point, *own) + ".");
  }
  // Where to stop: the cheapest setting whose error is not visibly above that of the finest one.
  const Point* stop = nullptr;
  for (const Point& point : points)
    if (point.exact && (stop == nullptr || point.ms < stop->ms)) stop = &point;
  if (stop != nullptr && !stop->reference && apart(*stop, *reference))
    said.push_back(fmt::format("Beyond {} nothing changes: stop there.", stop->label));
  return fmt::format("{}", fmt::join(said, " "));
}

}  // namespace greatx::apps
