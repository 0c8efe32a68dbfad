// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "draw/sheet/polar_map.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "draw/sheet/panels.h"

namespace greatx::io {

PolarMap::Layout PolarMap::layout(const Rect& picture) const {
  return {picture.x + 0.5 * picture.width, picture.bottom() - 10.0,
          std::min(picture.height - 24.0, 0.5 * picture.width) / far_m_};
}

std::optional<PolarMap::Cell> PolarMap::cell_of(double ahead, double left) const {
  const double range = std::hypot(ahead, left);
  if (range > far_m_) return std::nullopt;
  const double azimuth = std::atan2(left, ahead);
  const auto bin = static_cast<int64_t>(range / axes_.range_bin_m + 0.5);
  const double share = (azimuth - axes_.azimuth_min) / (axes_.azimuth_max - axes_.azimuth_min);
  if (bin >= axes_.ranges || share < 0.0 || share > 1.0) return std::nullopt;
  return Cell{bin, static_cast<int64_t>(share * static_cast<double>(axes_.azimuths - 1) + 0.5)};
}

void PolarMap::draw_cells(Canvas& canvas, const Rect& picture,
                          const std::function<Color(int64_t range, int64_t azimuth)>& color) const {
  const auto [foot_x, foot_y, pixels] = layout(picture);
  canvas.fill(picture, canvas.theme().panel);
  canvas.paint(picture, [&, x0 = foot_x, y0 = foot_y, scale = pixels](double x, double y, Color& pixel) {
    const std::optional<Cell> cell = cell_of((y0 - y) / scale, (x0 - x) / scale);
    if (cell) pixel = color(cell->range, cell->azimuth);
    return cell.has_value();
  });
}

void PolarMap::draw_rings(Canvas& canvas, const Rect& picture) const {
  const auto [foot_x, foot_y, pixels] = layout(picture);
  const double ring = round_down(far_m_ / 1.9);
  for (int i = 1; i * ring <= far_m_; ++i)
    canvas.circle(foot_x, foot_y, i * ring * pixels, 1.0, canvas.theme().false_alarm);
}

void PolarMap::draw_ring_ranges(Canvas& canvas, const Rect& picture) const {
  const auto [foot_x, foot_y, pixels] = layout(picture);
  const double ring = round_down(far_m_ / 1.9);
  for (int i = 1; i * ring <= far_m_; ++i)
    canvas.rimmed_text(static_cast<int>(foot_x) + 4, static_cast<int>(foot_y - i * ring * pixels) + 3,
                       tick_text(i * ring) + " m", theme::text_scale, canvas.theme().over,
                       canvas.theme().halo);
}

dvec2 PolarMap::pixel_of(const Rect& picture, double ahead, double left) const {
  const auto [foot_x, foot_y, pixels] = layout(picture);
  return {foot_x - left * pixels, foot_y - ahead * pixels};
}

dvec2 PolarMap::place(const Rect& picture, double range_m, double azimuth) const {
  const auto [foot_x, foot_y, pixels] = layout(picture);
  const double range = range_m * pixels;
  return {foot_x - range * std::sin(azimuth), foot_y - range * std::cos(azimuth)};
}

std::string PolarMap::text_at(const Rect& picture, int x, int y,
                              const std::function<double(int64_t range, int64_t azimuth)>& level) const {
  if (!cell_at(picture, 1, 1, x, y)) return {};
  const auto [foot_x, foot_y, pixels] = layout(picture);
  const double ahead = (foot_y - y) / pixels, left = (foot_x - x) / pixels;
  const std::string text =
      fmt::format("{:.2f} m, {:.1f} deg", std::hypot(ahead, left), degrees(std::atan2(left, ahead)));
  const std::optional<Cell> cell = cell_of(ahead, left);
  return text +
         (cell ? fmt::format(": {:.1f} dBm", level(cell->range, cell->azimuth)) : ": outside of the map");
}

}  // namespace greatx::io
