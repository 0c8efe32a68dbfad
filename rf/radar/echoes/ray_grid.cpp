// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/echoes/ray_grid.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/units.h"

namespace greatx::rf {
namespace {

constexpr double widest_cell = 0.5;
constexpr uint32_t most_subdivisions = 64;

dvec3 direction_of(double azimuth, double elevation) {
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

/// Describes the directions in which a target may be seen, and its smallest distance.
struct Footprint {
  double azimuth = 0.0, half_azimuth = 0.0;  ///< rad
  double elevation_min = 0.0, elevation_max = 0.0;
  double distance_m = 0.0;
};

Footprint whole_sphere(double distance_m) { return {0.0, pi, -0.5 * pi, 0.5 * pi, distance_m}; }

/// `seen_at` returns where a point of the target (local coordinates) appears to be.
template <typename SeenAt>
Footprint footprint_of(const TargetBox& target, const Pose& radar_from_local, const SeenAt& seen_at) {
  const dvec3 half = 0.5 * target.bounds.size();
  const auto in_radar = [&](const dvec3& p) { return radar_from_local.apply(seen_at(target.pose.apply(p))); };
  const dvec3 center = in_radar(target.bounds.center());
  const double distance = glm::length(center), radius = glm::length(half);
  if (distance < 1.5 * radius) return whole_sphere(std::max(0.25 * radius, distance - radius));
  Footprint print{std::atan2(center.y, center.x), 0.0, 0.5 * pi, -0.5 * pi, distance - radius};
  for (int corner = 0; corner < 8; ++corner) {
    const dvec3 sign(corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0, corner & 4 ? 1.0 : -1.0);
    const dvec3 p = in_radar(target.bounds.center() + sign * half);
    const double elevation = std::atan2(p.z, std::hypot(p.x, p.y));
    print.elevation_min = std::min(print.elevation_min, elevation);
    print.elevation_max = std::max(print.elevation_max, elevation);
    const double azimuth = std::remainder(std::atan2(p.y, p.x) - print.azimuth, 2.0 * pi);
    print.half_azimuth = std::max(print.half_azimuth, std::abs(azimuth));
  }
  // Near a pole the azimuth carries no information. The edges of a box bulge beyond its corners by less than
  // the sagitta of their span.
  const double highest = std::max(std::abs(print.elevation_min), std::abs(print.elevation_max));
  const double span = std::max(print.elevation_max - print.elevation_min, 2.0 * print.half_azimuth);
  const double bulge = 0.125 * span * span * std::tan(std::min(highest, 1.4));
  print.elevation_min -= bulge, print.elevation_max += bulge;
  if (highest + bulge > 1.3) print.half_azimuth = pi;
  return print;
}

}  // namespace

void RayGrid::choose_cells(const EchoOptions& options) {
  const double azimuths = view_.azimuth_max - view_.azimuth_min;
  const double elevations = view_.elevation_max - view_.elevation_min;
  constexpr double room = 1e-9;
  if (!(azimuths > 0.0 && azimuths <= 2.0 * pi + room))
    throw_user_error(
        "radar field of view: expected azimuths of more than 0 and at most 360 degrees, found {} to {} rad",
        view_.azimuth_min, view_.azimuth_max);
  if (!(elevations > 0.0 && view_.elevation_min >= -0.5 * pi - room &&
        view_.elevation_max <= 0.5 * pi + room))
    throw_user_error(
        "radar field of view: expected elevations that rise from -90 to 90 degrees, found {} to {} rad",
        view_.elevation_min, view_.elevation_max);
  const double solid_angle = azimuths * (std::sin(view_.elevation_max) - std::sin(view_.elevation_min));
  const double side = std::sqrt(solid_angle / std::max(1u, options.tubes));
  const double middle = solid_angle / (azimuths * elevations);  // mean cosine of the elevation
  columns_ = std::max(1u, static_cast<uint32_t>(std::lround(azimuths * middle / side)));
  rows_ = std::max(1u, static_cast<uint32_t>(std::lround(elevations / side)));
  if (azimuths / columns_ > widest_cell || elevations / rows_ > widest_cell)
    throw_user_error(
        "radar tubes: expected cells of at most {} rad, found {} tubes, which makes cells of {} x {} rad",
        widest_cell, options.tubes, azimuths / columns_, elevations / rows_);
  wraps_ = azimuths >= 2.0 * pi - room;
}

RayGrid::RayGrid(const EchoOptions& options, const Pose& local_from_radar, std::span<const TargetBox> targets,
                 std::span<const TargetImage> images)
    : view_(options.field_of_view), local_from_radar_(glm::mat3_cast(local_from_radar.orientation)) {
  choose_cells(options);
  set_vertices();
  subdivide(options, local_from_radar, targets, images);
  first_.resize(count_.size());
  for (uint32_t cell = 0; cell < count_.size(); ++cell) {
    first_[cell] = size();
    for (uint16_t y = 0; y < count_[cell]; ++y)
      for (uint16_t x = 0; x < count_[cell]; ++x) tubes_.push_back({cell, x, y});
    if (count_[cell] > 1) target_tubes_ += uint32_t{count_[cell]} * count_[cell];
  }
  axes_.reserve(tubes_.size());
  for (const Tube& t : tubes_) {
    const double n = count_[t.cell];
    axes_.push_back(at(t.cell, (t.x + 0.5) / n, (t.y + 0.5) / n));
  }
}

bool RayGrid::shows(const TargetImage& image, uint32_t cell) const {
  if (image.shows(at(cell, 0.5, 0.5))) return true;
  for (const double x : {0.0, 1.0})
    for (const double y : {0.0, 1.0})
      if (image.shows(at(cell, x, y))) return true;
  return false;
}

void RayGrid::subdivide(const EchoOptions& options, const Pose& local_from_radar,
                        std::span<const TargetBox> targets, std::span<const TargetImage> images) {
  const double step_azimuth = (view_.azimuth_max - view_.azimuth_min) / columns_;
  const double step_elevation = (view_.elevation_max - view_.elevation_min) / rows_;
  const double cell_rad = std::max(step_azimuth, step_elevation);
  const size_t cells = size_t{columns_} * rows_;
  const Pose radar_from_local = local_from_radar.inverse();
  std::vector<double> nearest(cells, 1e300);  // [cells] distance of the nearest target
  const auto mark = [&](const Footprint& print, const auto& counts) {
    for (uint32_t row = 0; row < rows_; ++row) {
      const double low = view_.elevation_min + row * step_elevation;
      if (low - step_elevation > print.elevation_max || low + 2.0 * step_elevation < print.elevation_min)
        continue;
      for (uint32_t column = 0; column < columns_; ++column) {
        const double middle = view_.azimuth_min + (column + 0.5) * step_azimuth;
        const double off = std::abs(std::remainder(middle - print.azimuth, 2.0 * pi));
        if (off > print.half_azimuth + 1.5 * step_azimuth) continue;
        const uint32_t cell = row * columns_ + column;
        if (print.distance_m < nearest[cell] && counts(cell)) nearest[cell] = print.distance_m;
      }
    }
  };
  count_.assign(cells, 1);
  target_tube_m_ = mirror_tube_m_ = options.target_tube_m;
  for (const TargetBox& target : targets)
    if (!target.bounds.empty())
      mark(footprint_of(target, radar_from_local, [](const dvec3& p) { return p; }),
           [](uint32_t) { return true; });
  divide_cells(nearest, cell_rad, options.target_budget, target_tube_m_);
  if (images.empty()) return;
  nearest.assign(cells, 1e300);
  for (const TargetImage& image : images)
    mark(footprint_of(image.target, radar_from_local,
                      [&](const dvec3& p) {
                        return p - 2.0 * (glm::dot(image.normal, p) - image.offset) * image.normal;
                      }),
         [&](uint32_t cell) { return shows(image, cell); });
  mirror_tubes_ =
      static_cast<uint32_t>(divide_cells(nearest, cell_rad, options.mirror_budget, mirror_tube_m_));
}

uint64_t RayGrid::divide_cells(std::span<const double> nearest, double cell_rad, uint32_t budget,
                               double& tube_m) {
  while (true) {
    std::vector<uint16_t> count = count_;
    uint64_t added = 0;
    for (size_t cell = 0; cell < count.size(); ++cell) {
      if (nearest[cell] >= 1e300) continue;
      const double n =
          std::clamp(std::ceil(cell_rad * nearest[cell] / tube_m), 1.0, double{most_subdivisions});
      if (n <= count[cell]) continue;
      added += static_cast<uint64_t>(n * n) - uint64_t{count[cell]} * count[cell];
      count[cell] = static_cast<uint16_t>(n);
    }
    if (added <= budget) {
      count_.swap(count);
      return added;
    }
    tube_m *= std::max(1.02, std::sqrt(double(added) / std::max(1u, budget)));
  }
}

void RayGrid::set_vertices() {
  for (uint32_t row = 0; row <= rows_; ++row)
    for (uint32_t column = 0; column <= columns_; ++column) {
      const double azimuth = view_.azimuth_min + (view_.azimuth_max - view_.azimuth_min) *
                                                     (wraps_ ? column % columns_ : column) / columns_;
      const double elevation =
          view_.elevation_min + (view_.elevation_max - view_.elevation_min) * row / rows_;
      vertices_.push_back(local_from_radar_ * direction_of(azimuth, elevation));
      units_.push_back(glm::normalize(vertices_.back()));
    }
}

dvec3 RayGrid::at(uint32_t cell, double x, double y) const {
  const uint32_t column = cell % columns_, row = cell / columns_;
  const dvec3 low = (1.0 - x) * vertex(column, row) + x * vertex(column + 1, row);
  const dvec3 high = (1.0 - x) * vertex(column, row + 1) + x * vertex(column + 1, row + 1);
  return glm::normalize((1.0 - y) * low + y * high);
}

std::array<dvec3, 4> RayGrid::corners(uint32_t tube) const {
  const Tube& t = tubes_[tube];
  if (count_[t.cell] == 1) {
    const size_t first = size_t{t.cell / columns_} * (columns_ + 1) + t.cell % columns_;
    return {units_[first], units_[first + 1], units_[first + columns_ + 2], units_[first + columns_ + 1]};
  }
  const double n = count_[t.cell], x0 = t.x / n, x1 = (t.x + 1) / n, y0 = t.y / n, y1 = (t.y + 1) / n;
  return {at(t.cell, x0, y0), at(t.cell, x1, y0), at(t.cell, x1, y1), at(t.cell, x0, y1)};
}

uint32_t RayGrid::tube_at(const dvec3& direction) const {
  // Multiplication by the transpose turns the direction into the radar's frame.
  const dvec3 d = direction * local_from_radar_;
  const double turn = 2.0 * pi, azimuths = view_.azimuth_max - view_.azimuth_min;
  double azimuth = std::fmod(std::atan2(d.y, d.x) - view_.azimuth_min, turn);
  if (azimuth < 0.0) azimuth += turn;
  const double x = azimuth / azimuths * columns_;
  const double y = (std::atan2(d.z, std::hypot(d.x, d.y)) - view_.elevation_min) /
                   (view_.elevation_max - view_.elevation_min) * rows_;
  if (!(x >= 0.0 && x < columns_ && y >= 0.0 && y < rows_)) return outside;
  const uint32_t cell = static_cast<uint32_t>(y) * columns_ + static_cast<uint32_t>(x);
  const uint32_t n = count_[cell];
  const auto within = [&](double value) {
    return std::min(n - 1, static_cast<uint32_t>((value - std::floor(value)) * n));
  };
  return first_[cell] + within(y) * n + within(x);
}

std::array<uint32_t, 8> RayGrid::neighbours(uint32_t tube) const {
  static constexpr int steps[8][2] = {{0, -1}, {1, 0}, {0, 1}, {-1, 0}, {-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  const Tube& t = tubes_[tube];
  const int n = count_[t.cell];
  std::array<uint32_t, 8> found;
  if (t.x > 0 && t.y > 0 && t.x + 1 < n && t.y + 1 < n) {  // all of them are in the same cell
    const uint32_t row = static_cast<uint32_t>(n);
    return {tube - row,     tube + 1,       tube + row,     tube - 1,
            tube - row - 1, tube - row + 1, tube + row + 1, tube + row - 1};
  }
  const uint32_t own_column = t.cell % columns_, own_row = t.cell / columns_;
  if (n == 1 && own_column > 0 && own_row > 0 && own_column + 1 < columns_ && own_row + 1 < rows_) {
    bool undivided = true;
    for (int i = 0; i < 8; ++i) {
      const int off = steps[i][1] * static_cast<int>(columns_) + steps[i][0];
      const uint32_t cell = t.cell + static_cast<uint32_t>(off);
      undivided = undivided && count_[cell] == 1;
      found[i] = first_[cell];
    }
    if (undivided) return found;
  }
  for (int i = 0; i < 8; ++i) {
    found[i] = outside;
    const int x = t.x + steps[i][0], y = t.y + steps[i][1];
    const int over_x = x < 0 ? -1 : x >= n ? 1 : 0, over_y = y < 0 ? -1 : y >= n ? 1 : 0;
    int column = static_cast<int>(own_column) + over_x;
    const int row = static_cast<int>(own_row) + over_y;
    if (wraps_) column = (column + static_cast<int>(columns_)) % static_cast<int>(columns_);
    if (column < 0 || row < 0 || column >= static_cast<int>(columns_) || row >= static_cast<int>(rows_))
      continue;
    const uint32_t cell = static_cast<uint32_t>(row) * columns_ + static_cast<uint32_t>(column);
    if (count_[cell] == n) {
      found[i] = first_[cell] + static_cast<uint32_t>((y - over_y * n) * n + (x - over_x * n));
      continue;
    }
    const double m = count_[cell];
    const auto inside = [&](int k, int over) {  // subdivision of the other cell at the same place
      return std::min(m - 1.0, std::floor((k - over * n + 0.5) / n * m));
    };
    found[i] = first_[cell] + static_cast<uint32_t>(inside(y, over_y) * m + inside(x, over_x));
  }
  return found;
}

}  // namespace greatx::rf
