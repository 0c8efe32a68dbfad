// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "draw/sheet/map_marks.h"

#include <cmath>
#include <span>

#include "draw/canvas/labels.h"

namespace greatx::io {

namespace {

constexpr double ring_radius = 6.0, cross_inner = 4.0, cross_outer = 12.0;
constexpr int widest_name = 264;  ///< pixels

void draw_ring(Canvas& canvas, const dvec2& at, bool real) {
  canvas.circle(at.x, at.y, ring_radius, real ? 3.4 : 2.6, canvas.theme().halo);
  canvas.circle(at.x, at.y, ring_radius, real ? 1.8 : 1.2,
                real ? canvas.theme().detection : canvas.theme().false_alarm);
}

void draw_cross(Canvas& canvas, const dvec2& at, bool real) {
  for (const double thickness : {3.2, 1.6})
    for (const double side : {-1.0, 1.0}) {
      const Color color = thickness > 2.0 ? canvas.theme().halo
                          : real          ? canvas.theme().truth
                                          : canvas.theme().false_alarm;
      canvas.line(at.x + side * cross_inner, at.y, at.x + side * cross_outer, at.y, thickness, color);
      canvas.line(at.x, at.y + side * cross_inner, at.x, at.y + side * cross_outer, thickness, color);
    }
}

}  // namespace

void draw_map_marks(Canvas& canvas, const std::vector<MapMark>& marks) {
  for (const MapMark& mark : marks) switch (mark.kind) {
      case MapMark::Kind::detection:
        draw_ring(canvas, mark.at, mark.real);
        break;
      case MapMark::Kind::truth:
        draw_cross(canvas, mark.at, mark.real);
        break;
      case MapMark::Kind::sensor:
        canvas.disc(mark.at.x, mark.at.y, 5.5, canvas.theme().halo);
        canvas.disc(mark.at.x, mark.at.y, 4.0, canvas.theme().over);
        break;
    }
}

void label_map_marks(Canvas& canvas, const Rect& picture, const std::vector<MapMark>& marks) {
  Labels labels(canvas, picture);
  for (const MapMark& mark : marks) labels.keep_free(mark.at.x, mark.at.y, ring_radius + 1.0);
  for (const MapMark& mark : marks) {
    if (mark.label.empty()) continue;
    const bool truth = mark.kind == MapMark::Kind::truth;
    const double radius = truth ? 0.7 * cross_outer : ring_radius;
    const Color color = mark.real ? canvas.theme().over : canvas.theme().false_alarm;
    // Where all lines have no room, the name alone may have.
    if (!labels.write(mark.at.x, mark.at.y, radius, mark.label, color))
      labels.write(mark.at.x, mark.at.y, radius, std::span(mark.label).first(1), color);
  }
}

std::vector<std::string> mark_label(const std::string& name, double range_m, double velocity_m_s) {
  const std::string range = range_m < 100.0 ? fmt::format("{:.1f}", range_m) : fmt::format("{:.0f}", range_m);
  const double velocity = std::round(10.0 * velocity_m_s) / 10.0 + 0.0;  // no -0.0
  return {fitted(name, widest_name, theme::text_scale), fmt::format("{} m {:+.1f} m/s", range, velocity)};
}

}  // namespace greatx::io
