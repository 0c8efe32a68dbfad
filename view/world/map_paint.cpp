// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/world/map_paint.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"
#include "renderer/lens/lens.h"
#include "sim/channel/radio_map_values.h"

namespace greatx::view {

namespace {

constexpr float flat_slack_m = 0.3f;  ///< kerbs and the rounding of depth

/// The directions of a picture's pixels in the world, of planar depth 1.
class PixelRays {
 public:
  explicit PixelRays(const apps::PictureView& view) : view_(view) {
    if (view.distortion.any())
      lens_.emplace(render::LensGeometry{"view", view.width, view.height, view.fx, view.fy, view.cx, view.cy,
                                         view.distortion});
  }
  dvec3 at(int x, int y) const {
    const dvec2 pixel(x + 0.5, y + 0.5);
    const dvec2 straight = lens_ ? lens_->undistorted(pixel)
                                 : dvec2((pixel.x - view_.cx) / view_.fx, (pixel.y - view_.cy) / view_.fy);
    return view_.local_from_sensor.rotate(dvec3(1.0, -straight.x, -straight.y));
  }

 private:
  const apps::PictureView& view_;
  std::optional<render::Lens> lens_;
};

}  // namespace

MapLayerPaint::MapLayerPaint(std::shared_ptr<const ShownMap> map, const MapColors& colors,
                             const dvec3& origin)
    : map_(std::move(map)), opacity_(std::clamp(colors.opacity, 0.0, 1.0)), origin_(origin) {
  std::optional<size_t> transmitter;
  if (colors.transmitter) {
    if (*colors.transmitter >= map_->transmitters.size())
      throw_user_error("the map has {} transmitters, found number {}", map_->transmitters.size(),
                       *colors.transmitter);
    transmitter = *colors.transmitter;
  }
  layer_ = apps::map_layer(map_->map(), sim::map_quantity(colors.quantity), transmitter, map_->transmitters);
  scale_ = apps::map_scale(layer_.values);
  if (colors.low) scale_.scale.low = *colors.low;
  if (colors.high) scale_.scale.high = *colors.high;
  if (!(scale_.scale.high > scale_.scale.low)) scale_.scale.high = scale_.scale.low + 1.0;
  measure_ground();
}

/// The ground of a cell is as uneven as the steps to its neighbours say.
void MapLayerPaint::measure_ground() {
  const sim::MapGrid& grid = map_->cells.grid;
  const bool plane = map_->wish.request.height.plane_z_m.has_value();
  const double above = plane ? 0.0 : map_->wish.request.height.above_m;
  ground_m_.resize(grid.cells());
  for (size_t cell = 0; cell < grid.cells(); ++cell)
    ground_m_[cell] = static_cast<float>(map_->cells.z_m[cell] - above);
  slack_m_.assign(grid.cells(), flat_slack_m);
  const auto step = [&](size_t a, size_t b) {
    const float difference = std::abs(ground_m_[a] - ground_m_[b]);
    // A step as high as a cell is wide is a wall or an edge, and no slope.
    if (!(difference < static_cast<float>(grid.cell_m))) return;
    slack_m_[a] = std::max(slack_m_[a], flat_slack_m + difference);
    slack_m_[b] = std::max(slack_m_[b], flat_slack_m + difference);
  };
  for (size_t cell = 0; cell < grid.cells(); ++cell) {
    if (cell % grid.columns + 1 < grid.columns) step(cell, cell + 1);
    if (cell + grid.columns < grid.cells()) step(cell, cell + grid.columns);
  }
}

std::optional<size_t> MapLayerPaint::cell_of(const dvec3& world) const {
  const sim::MapGrid& grid = map_->cells.grid;
  const dvec2 at = (dvec2(world) - grid.min_m) / grid.cell_m;
  if (!(at.x >= 0.0 && at.y >= 0.0 && at.x < grid.columns && at.y < grid.rows)) return {};
  const size_t cell = static_cast<size_t>(at.y) * grid.columns + static_cast<size_t>(at.x);
  if (cell >= map_->done || !map_->cells.solved(cell)) return {};
  return cell;
}

bool MapLayerPaint::is_ground(size_t cell, double z_m) const {
  return std::abs(static_cast<float>(z_m) - ground_m_[cell]) <= slack_m_[cell];
}

std::optional<size_t> MapLayerPaint::cell_at(const ScenePicture& picture, int x, int y) const {
  const apps::PictureView& view = picture.request.view;
  if (x < 0 || y < 0 || x >= static_cast<int>(view.width) || y >= static_cast<int>(view.height)) return {};
  const dvec3 ray = PixelRays(view).at(x, y), eye = view.local_from_sensor.position + origin_;
  const double depth = picture.depth[static_cast<size_t>(y) * view.width + static_cast<size_t>(x)];
  if (const std::optional<double>& plane = map_->wish.request.height.plane_z_m) {
    const double along = (*plane - eye.z) / ray.z;
    return along > 0.0 && std::isfinite(along) && !apps::is_hidden(along, static_cast<float>(depth))
               ? cell_of(eye + along * ray)
               : std::nullopt;
  }
  if (!std::isfinite(depth)) return {};
  const dvec3 world = eye + depth * ray;
  const std::optional<size_t> cell = cell_of(world);
  return cell && is_ground(*cell, world.z) ? cell : std::nullopt;
}

std::vector<uint8_t> MapLayerPaint::painted(const ScenePicture& picture) const {
  const apps::PictureView& view = picture.request.view;
  std::vector<uint8_t> rgb = picture.rgb;
  std::vector<io::Color> colors(layer_.values.size());
  for (size_t cell = 0; cell < colors.size(); ++cell) colors[cell] = color_at(layer_.values[cell]);
  const PixelRays rays(view);
  const dvec3 eye = view.local_from_sensor.position + origin_;
  const std::optional<double>& plane = map_->wish.request.height.plane_z_m;
  const double keep = 1.0 - opacity_;
  for (uint32_t y = 0; y < view.height; ++y)
    for (uint32_t x = 0; x < view.width; ++x) {
      const size_t pixel = size_t{y} * view.width + x;
      const double depth = picture.depth[pixel];
      if (!plane && !std::isfinite(depth)) continue;
      const dvec3 ray = rays.at(static_cast<int>(x), static_cast<int>(y));
      double along = depth;
      if (plane) {
        along = (*plane - eye.z) / ray.z;
        if (!(along > 0.0) || !std::isfinite(along) || apps::is_hidden(along, static_cast<float>(depth)))
          continue;
      }
      const dvec3 world = eye + along * ray;
      const std::optional<size_t> cell = cell_of(world);
      if (!cell || (!plane && !is_ground(*cell, world.z))) continue;
      const io::Color color = colors[*cell];
      const uint8_t parts[] = {color.r, color.g, color.b};
      for (size_t c = 0; c < 3; ++c)
        rgb[3 * pixel + c] = static_cast<uint8_t>(keep * rgb[3 * pixel + c] + opacity_ * parts[c] + 0.5);
    }
  return rgb;
}

std::string MapLayerPaint::text_of(size_t cell) const {
  const double value = layer_.values.at(cell);
  const dvec3 at = map_->cells.point(cell);
  std::string text;
  if (!std::isfinite(value))
    text = layer_.nothing;
  else if (!layer_.classes.empty())
    text = printable(layer_.classes.at(static_cast<size_t>(value)));
  else
    text = fmt::format("{:.2f} {}", value, layer_.unit);
  return fmt::format("{}: {}\ncell at ({:.2f}, {:.2f}, {:.2f}) m, tick {}", printable(layer_.title), text,
                     at.x, at.y, at.z, map_->wish.tick);
}

}  // namespace greatx::view
