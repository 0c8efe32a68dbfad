// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/light/surroundings.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/units.h"
#include "renderer/light/cell_cover.h"
#include "renderer/surface/pane_color.h"
#include "renderer/surface/texel.h"
#include "shaders/shared/surroundings.h"

namespace greatx::render {

namespace {

/// The part of the sky's light that reaches the ground between houses.
constexpr double ground_sky_share = 0.8;

/// Returns the mean base colour of a material with its texture, from at most 32 x 32 texels.
dvec3 mean_color(const scene::Scene& scene, const scene::PbrMaterial& pbr) {
  const dvec3 factor(solid_color(pbr));
  if (pbr.base_color_texture < 0) return factor;
  const scene::Texture& texture = scene.textures[static_cast<size_t>(pbr.base_color_texture)];
  constexpr uint32_t most = 32;
  const uint32_t across = std::min(texture.width, most), down = std::min(texture.height, most);
  dvec3 sum(0.0);
  for (uint32_t j = 0; j < down; ++j)
    for (uint32_t i = 0; i < across; ++i)
      sum += linear_texel(texture, size_t{i} * texture.width / across, size_t{j} * texture.height / down);
  return factor * sum / double(across * down);
}

/// A lamp's illuminance on level ground, without shadows (KHR_lights_punctual).
double lamp_lux(const scene::PunctualLight& lamp, const dvec3& apart) {
  const double distance2 = glm::dot(apart, apart), distance = std::sqrt(distance2);
  if (apart.z <= 0.0 || (lamp.range_m > 0.0f && distance > lamp.range_m)) return 0.0;
  double cone = 1.0;
  if (lamp.type == scene::PunctualLight::Type::spot) {
    const double outer = std::cos(double(lamp.outer_cone)), inner = std::cos(double(lamp.inner_cone));
    cone = std::clamp(
        (glm::dot(-apart / distance, glm::normalize(lamp.direction)) - outer) / std::max(inner - outer, 1e-3),
        0.0, 1.0);
  }
  const double window = lamp.range_m > 0.0f ? 1.0 - std::pow(distance / lamp.range_m, 4.0) : 1.0;
  return lamp.intensity * cone * cone * window * apart.z / (distance2 * distance);
}

}  // namespace

Surroundings::Surroundings(const scene::Scene& scene, const HeightField& field, const SurroundingLight& light,
                           const SurroundingSources& sources)
    : field_(&field), light_(light), cells_(field.heights.size()) {
  paint(scene);
  for (const SurroundingCell& cell : cells_) most_top_ = std::max(most_top_, cell.top);
  cast_shadows();
  if (sources.glow) emit(scene);
  for (int round = 0; round < 4; ++round) thicken_walls();
  if (sources.glow) average_glow();
  shine(sources.lamps);
}

void Surroundings::paint(const scene::Scene& scene) {
  const CellCover cover(*field_);
  std::vector<dvec3> colors;
  for (const scene::Material& material : scene.materials) colors.push_back(mean_color(scene, material.pbr));
  for (size_t i = 0; i < cells_.size(); ++i) {
    cells_[i].top = cells_[i].ground = field_->heights[i];
    cells_[i].bottom = 1e30f;
  }
  // The ground of a cell is its lowest level surface that looks up. A house without a floor stands on the
  // face that looks down far below its roof; the underside of a plate of soil is too near to what looks up.
  std::vector<float> highest(cells_.size(), -1e30f);
  std::vector<bool> grounded(cells_.size(), false);
  for (const bool up : {true, false})
    over_static(scene, [&](const std::array<dvec3, 3>& p, const dvec3& normal, uint32_t material, uint32_t) {
      if ((up ? normal.z : -normal.z) < wall_slope) return;
      cover.level(p, [&](size_t i, float height) {
        SurroundingCell& cell = cells_[i];
        const bool lower = up || !grounded[i] ? height <= cell.ground : height < cell.ground - standing_m;
        if (lower) {
          cell.ground = height;
          cell.ground_albedo = colors[material];
          if (up) grounded[i] = true;
        }
        if (height >= highest[i]) {
          highest[i] = height;
          cell.top_albedo = colors[material];
        }
      });
    });
  std::vector<dvec3> walls(cells_.size(), dvec3(0.0));
  std::vector<double> areas(cells_.size(), 0.0);
  // What stands in a cell begins at its lowest wall or its lowest face that looks down. Without
  // either, it is a house without a floor.
  const auto stand = [&](size_t i, float low, float high) {
    SurroundingCell& cell = cells_[i];
    if (high > cell.ground + low_thing_m) cell.bottom = std::min(cell.bottom, std::max(low, cell.ground));
  };
  over_static(scene, [&](const std::array<dvec3, 3>& p, const dvec3& normal, uint32_t material, uint32_t) {
    if (normal.z >= wall_slope) return;
    if (normal.z <= -wall_slope)
      return cover.level(p, [&](size_t i, float height) { stand(i, height, height); });
    cover.steep(p, normal, [&](size_t i, const SteepStrip& strip) {
      const auto low = static_cast<float>(strip.low), high = static_cast<float>(strip.high);
      stand(i, low, high);
      walls[i] += colors[material] * double(high - low);
      areas[i] += high - low;
      cells_[i].wall_normal += dvec2(normal) * double(high - low);
    });
  });
  for (size_t i = 0; i < cells_.size(); ++i) {
    SurroundingCell& cell = cells_[i];
    if (cell.bottom < cell.ground + low_thing_m || cell.bottom >= cell.top) cell.bottom = cell.ground;
    cell.wall_albedo = areas[i] > 0.0 ? walls[i] / areas[i] : cell.top_albedo;
    const double length = glm::length(cell.wall_normal);
    cell.wall_normal = length > 1e-9 ? cell.wall_normal / length : dvec2(0.0);
  }
}

void Surroundings::emit(const scene::Scene& scene) {
  WallGlows glows(scene, cells_.size(), field_->cell_m);
  if (!glows.any()) return;
  const CellCover cover(*field_);
  over_static(scene,
              [&](const std::array<dvec3, 3>& p, const dvec3& normal, uint32_t material, uint32_t first) {
                if (std::abs(normal.z) >= wall_slope || !glows.glows(p, material)) return;
                cover.steep(p, normal, [&](size_t i, const SteepStrip& strip) {
                  glows.add(i, cells_[i].bottom, strip, dvec2(normal), first, material);
                });
              });
  for (size_t i = 0; i < cells_.size(); ++i) cells_[i].glow = glows.of(i, cells_[i].bottom, cells_[i].top);
}

/// Gives what stands behind a wall the wall's colour, foot, normal, shadow and glow: a ray may step over a
/// thin one.
void Surroundings::thicken_walls() {
  const std::vector<SurroundingCell> before = cells_;
  const auto width = static_cast<int64_t>(field_->width), height = static_cast<int64_t>(field_->height);
  for (int64_t row = 0; row < height; ++row)
    for (int64_t column = 0; column < width; ++column) {
      SurroundingCell& cell = cells_[static_cast<size_t>(row * width + column)];
      if (!cell.stands() || cell.wall_normal != dvec2(0.0)) continue;
      for (const auto& [dx, dy] : {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)}) {
        const int64_t x = column + dx, y = row + dy;
        if (x < 0 || y < 0 || x >= width || y >= height) continue;
        const SurroundingCell& other = before[static_cast<size_t>(y * width + x)];
        // The wall looks away from what stands behind it.
        if (glm::dot(other.wall_normal, dvec2(dx, dy)) < 0.5) continue;
        cell.wall_normal = other.wall_normal;
        cell.wall_albedo = other.wall_albedo;
        cell.shadow = other.shadow;
        cell.glow = other.glow;
        cell.bottom = std::min(cell.bottom, other.bottom);
      }
    }
}

void Surroundings::average_glow() {
  std::vector<dvec2> normals;
  std::vector<WallGlow> glows;
  for (const SurroundingCell& cell : cells_) {
    normals.push_back(cell.wall_normal);
    glows.push_back(cell.glow);
  }
  glow_average_ = GlowAverage(field_->width, normals, glows);
}

void Surroundings::cast_shadows() {
  const dvec2 level(light_.key_direction);
  const double across = glm::length(level);
  const double rise = light_.key_direction.z / std::max(across, 1e-6);
  const dvec2 step = across > 1e-6 ? level / across : dvec2(1.0, 0.0);
  parallel_for(field_->height, 0, [&](size_t row) {
    for (uint32_t column = 0; column < field_->width; ++column) {
      SurroundingCell& cell = cells_[row * field_->width + column];
      cell.shadow = -1e4f;
      for (double away = 1.0; away * field_->cell_m * rise < most_top_; away += 1.0) {
        const dvec2 at = dvec2(column + 0.5, double(row) + 0.5) + step * away;
        if (at.x < 0.0 || at.y < 0.0 || at.x >= field_->width || at.y >= field_->height) break;
        const float top = cells_[static_cast<size_t>(at.y) * field_->width + static_cast<size_t>(at.x)].top;
        cell.shadow = std::max(cell.shadow, static_cast<float>(top - away * field_->cell_m * rise));
      }
    }
  });
}

void Surroundings::shine(std::span<const scene::PunctualLight> lamps) {
  const dvec3 key = light_.key_lux * std::max(light_.key_direction.z, 0.0);
  std::vector<dvec3> by_lamps(cells_.size(), dvec3(0.0));
  for (const scene::PunctualLight& lamp : lamps) {
    if (lamp.body != 0 || lamp.type == scene::PunctualLight::Type::directional) continue;
    const double reach = lamp.range_m > 0.0f ? double(lamp.range_m) : 50.0;
    const dvec2 middle = (dvec2(lamp.position) - field_->corner) / field_->cell_m;
    const double cells = reach / field_->cell_m;
    for (auto row = static_cast<int64_t>(std::max(middle.y - cells, 0.0));
         row < std::min<int64_t>(static_cast<int64_t>(middle.y + cells) + 1, field_->height); ++row)
      for (auto column = static_cast<int64_t>(std::max(middle.x - cells, 0.0));
           column < std::min<int64_t>(static_cast<int64_t>(middle.x + cells) + 1, field_->width); ++column) {
        const auto i = static_cast<size_t>(row * field_->width + column);
        const dvec2 place = field_->corner + field_->cell_m * (dvec2(double(column), double(row)) + 0.5);
        const dvec3 point(place, field_->floor + cells_[i].ground);
        by_lamps[i] += dvec3(lamp.color) * lamp_lux(lamp, lamp.position - point);
      }
  }
  for (size_t i = 0; i < cells_.size(); ++i) {
    const SurroundingCell& cell = cells_[i];
    const auto lit = [&](float height) { return std::clamp(double(height - cell.shadow) + 0.5, 0.0, 1.0); };
    const bool covered = cell.bottom > cell.ground;
    top_radiance_.push_back(cell.top_albedo / pi *
                            (key * lit(cell.top) + light_.sky_lux * (cell.stands() ? 1.0 : ground_sky_share) +
                             (cell.stands() ? dvec3(0.0) : by_lamps[i])));
    ground_radiance_.push_back(
        cell.ground_albedo / pi *
        (key * (covered ? 0.0 : lit(cell.ground)) + light_.sky_lux * ground_sky_share + by_lamps[i]));
  }
}

dvec3 Surroundings::wall_radiance(const SurroundingCell& cell, double height) const {
  const double facing = std::max(glm::dot(dvec3(cell.wall_normal, 0.0), light_.key_direction), 0.0),
               lit = std::clamp(height - cell.shadow + 0.5, 0.0, 1.0);
  return cell.wall_albedo / pi * (light_.key_lux * facing * lit + light_.sky_lux * (0.5 * wall_sky_share));
}

std::vector<uint16_t> Surroundings::free_cells(uint32_t octant) const {
  const auto width = static_cast<int64_t>(field_->width), height = static_cast<int64_t>(field_->height);
  const int64_t right = octant & shared::surroundings_negative_x ? -1 : 1,
                up = octant & shared::surroundings_negative_y ? -1 : 1;
  const bool along_y = (octant & shared::surroundings_along_y) != 0;
  constexpr uint16_t most = 1000;  // beyond the field nothing stands
  std::vector<uint16_t> cone(cells_.size());
  const auto of = [&](const std::vector<uint16_t>& values, int64_t column, int64_t row) {
    const bool inside = column >= 0 && row >= 0 && column < width && row < height;
    return inside ? values[static_cast<size_t>(row * width + column)] : most;
  };
  // From a cell, the cone covers the next cell along the axis, the one beside that, and their cones.
  for (int64_t j = 0; j < height; ++j)
    for (int64_t i = 0; i < width; ++i) {
      const int64_t column = right > 0 ? width - 1 - i : i, row = up > 0 ? height - 1 - j : j;
      const auto here = static_cast<size_t>(row * width + column);
      if (cells_[here].stands()) continue;
      const uint16_t straight = along_y ? of(cone, column, row + up) : of(cone, column + right, row);
      const uint16_t next = std::min(straight, of(cone, column + right, row + up));
      cone[here] = std::min<uint16_t>(most, static_cast<uint16_t>(next + 1));
    }
  // A ray may start anywhere in its cell, and so also pass through the cones of the cell beside it.
  std::vector<uint16_t> result(cells_.size());
  for (int64_t row = 0; row < height; ++row)
    for (int64_t column = 0; column < width; ++column)
      result[static_cast<size_t>(row * width + column)] = std::min(
          of(cone, column, row), along_y ? of(cone, column + right, row) : of(cone, column, row + up));
  return result;
}

}  // namespace greatx::render
