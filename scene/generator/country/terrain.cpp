// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/country/terrain.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "scene/generator/mesh/materials.h"

namespace greatx::scene::generator {

namespace {

double smooth(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

}  // namespace

Terrain::Terrain(double size_m, RandomStream& random) : half_(snap(0.5 * size_m)) {
  for (int i = 0; i < 5; ++i) {
    const double wavelength = random.uniform(120.0, 320.0), angle = random.uniform(0.0, 2.0 * pi);
    const double k = 2.0 * pi / wavelength;
    waves_.push_back({k * dvec2(std::cos(angle), std::sin(angle)),
                      0.0085 * wavelength * random.uniform(0.5, 1.0), random.uniform(0.0, 2.0 * pi)});
  }
  // The road of a small model has tighter bends.
  const double tightness = std::clamp(half_ / 150.0, 0.4, 1.0);
  for (const double wavelength :
       {tightness * random.uniform(240.0, 320.0), tightness * random.uniform(110.0, 150.0)})
    bends_.push_back({dvec2(2.0 * pi / wavelength, 0.0), 0.06 * wavelength, random.uniform(0.0, 2.0 * pi)});
  bends_[1].amplitude *= 0.5;
}

double Terrain::road_y(double x) const {
  double y = 0.0;
  for (const Wave& bend : bends_) y += bend.amplitude * std::sin(bend.k.x * x + bend.phase);
  return y;
}

dvec2 Terrain::road_direction(double x) const {
  double slope = 0.0;
  for (const Wave& bend : bends_) slope += bend.amplitude * bend.k.x * std::cos(bend.k.x * x + bend.phase);
  return glm::normalize(dvec2(1.0, slope));
}

double Terrain::hills(const dvec2& point) const {
  double z = 0.0;
  for (const Wave& wave : waves_) z += wave.amplitude * std::sin(glm::dot(wave.k, point) + wave.phase);
  return z;
}

double Terrain::height(const dvec2& point) const {
  // The road is level across, and the ground beside it follows. Sites are level inside.
  const double road = road_y(point.x);
  const double distance = std::abs(point.y - road) * road_direction(point.x).x;
  double z = glm::mix(hills({point.x, road}), hills(point),
                      smooth(road_half_width_m + verge_m, road_half_width_m + verge_m + 22.0, distance));
  for (const Site& site : sites_)
    z = glm::mix(site.level, z, smooth(site.inner_m, site.outer_m, glm::length(point - site.center)));
  return z;
}

void Terrain::build_grid() {
  const double cell = std::clamp(half_ / 17.0, 6.0, 14.0);
  rows_ = static_cast<int>(std::lround(2.0 * half_ / cell)) + 1;
  side_ = std::max(3, static_cast<int>(std::lround(half_ / cell)));
  columns_ = 2 * side_ + 4;
  grid_.clear();
  for (int row = 0; row < rows_; ++row) {
    const double x = -half_ + 2.0 * half_ * row / (rows_ - 1);
    const double middle = road_y(x), stretch = 1.0 / road_direction(x).x;
    const double edge = road_half_width_m * stretch, outside = (road_half_width_m + verge_m) * stretch;
    std::vector<double> ys;
    for (int i = 0; i <= side_; ++i)
      ys.push_back(glm::mix(-half_, middle - outside, static_cast<double>(i) / side_));
    ys.push_back(middle - edge);
    ys.push_back(middle + edge);
    for (int i = 0; i <= side_; ++i)
      ys.push_back(glm::mix(middle + outside, half_, static_cast<double>(i) / side_));
    for (const double y : ys) grid_.push_back(snap(dvec3(x, y, height({x, y}))));
  }
}

dvec3 Terrain::normal(int row, int column) const {
  const dvec3 along = vertex(std::min(row + 1, rows_ - 1), column) - vertex(std::max(row - 1, 0), column);
  const dvec3 across = vertex(row, std::min(column + 1, columns_ - 1)) - vertex(row, std::max(column - 1, 0));
  return glm::normalize(glm::cross(along, across));
}

double Terrain::road_length(double x) const {
  double length = 0.0;
  constexpr double step = 2.0;
  for (double at = -half_; at < x; at += step)
    length += std::min(step, x - at) / road_direction(at + 0.5 * std::min(step, x - at)).x;
  return length;
}

dvec2 Terrain::uv(const Cover& cover, int row, int column) const {
  const dvec3& p = vertex(row, column);
  if (cover.along_road) {
    const dvec2 tile = material_library()[static_cast<size_t>(cover.material)].tile_m;
    return {column == road_south() ? 0.0 : 1.0, road_length(p.x) / tile.y};
  }
  const double c = std::cos(cover.angle), s = std::sin(cover.angle);
  return planar_uv(cover.material, dvec3(c * p.x + s * p.y, c * p.y - s * p.x, p.z), dvec3(0, 0, 1)) +
         cover.offset;
}

void Terrain::add_surface(MeshBuilder& mesh,
                          const std::function<Cover(int row, int column)>& cover_of) const {
  for (int row = 0; row + 1 < rows_; ++row)
    for (int column = 0; column + 1 < columns_; ++column) {
      const Cover cover = cover_of(row, column);
      if (cover.material < 0) continue;
      const std::array<std::array<int, 2>, 4> corners{
          {{row, column}, {row + 1, column}, {row + 1, column + 1}, {row, column + 1}}};
      const auto face = [&](size_t a, size_t b, size_t c) {
        std::array<dvec3, 3> p, n;
        std::array<dvec2, 3> uvs;
        size_t k = 0;
        for (const size_t i : {a, b, c}) {
          p[k] = vertex(corners[i][0], corners[i][1]);
          n[k] = normal(corners[i][0], corners[i][1]);
          uvs[k] = uv(cover, corners[i][0], corners[i][1]);
          ++k;
        }
        mesh.triangle(cover.material, p, n, uvs);
      };
      // Diagonals alternate, which hides the grid.
      if ((row + column) % 2 == 0) {
        face(0, 1, 2);
        face(0, 2, 3);
      } else {
        face(0, 1, 3);
        face(1, 2, 3);
      }
    }
}

void Terrain::add_base(MeshBuilder& mesh) const {
  const int subsoil = material("subsoil");
  double lowest = grid_.front().z;
  for (const dvec3& p : grid_) lowest = std::min(lowest, p.z);
  const double bottom = snap(lowest - 3.0);
  std::vector<dvec3> border;  // counter-clockwise from above
  for (int row = 0; row + 1 < rows_; ++row) border.push_back(vertex(row, 0));
  for (int column = 0; column + 1 < columns_; ++column) border.push_back(vertex(rows_ - 1, column));
  for (int row = rows_ - 1; row > 0; --row) border.push_back(vertex(row, columns_ - 1));
  for (int column = columns_ - 1; column > 0; --column) border.push_back(vertex(0, column));
  const dvec3 middle(0.0, 0.0, bottom), down(0, 0, -1);
  for (size_t i = 0; i < border.size(); ++i) {
    const dvec3 a = border[i], b = border[(i + 1) % border.size()];
    const dvec3 c(dvec2(a), bottom), d(dvec2(b), bottom);
    mesh.quad(subsoil, c, d, b, a);
    mesh.triangle(
        subsoil, {middle, d, c},
        {planar_uv(subsoil, middle, down), planar_uv(subsoil, d, down), planar_uv(subsoil, c, down)});
  }
}

}  // namespace greatx::scene::generator
