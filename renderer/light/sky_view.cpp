// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/light/sky_view.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/gtc/packing.hpp>

#include "core/parallel.h"
#include "core/units.h"
#include "renderer/light/azimuth_looks.h"

namespace greatx::render {

namespace {

constexpr int azimuths = 16;
constexpr double least_cell_m = 0.5;
constexpr double step_growth = 1.25;  ///< ratio of successive distances at which a horizon is sampled
constexpr double farthest_m = 200.0;

/// Raises the cells whose centres a triangle covers from above. It also raises those of the triangle's
/// corners and edges, so that walls (which cover no centre) count.
class Raiser {
 public:
  explicit Raiser(HeightField& field) : field_(field) {}

  void add(const dvec3& a, const dvec3& b, const dvec3& c) {
    edge(a, b);
    edge(b, c);
    edge(c, a);
    const dvec3 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
    const double area = cross(dvec2(b - a), dvec2(c - a));
    if (std::abs(area) < 1e-9) return;
    const auto column = [&](double x) { return (x - field_.corner.x) / field_.cell_m - 0.5; };
    const auto row = [&](double y) { return (y - field_.corner.y) / field_.cell_m - 0.5; };
    const int64_t last_row = last_below(row(high.y), field_.height);
    const int64_t last_column = last_below(column(high.x), field_.width);
    for (int64_t j = ceil_at_least_0(row(low.y)); j <= last_row; ++j)
      for (int64_t i = ceil_at_least_0(column(low.x)); i <= last_column; ++i) {
        const dvec2 p = field_.corner + field_.cell_m * (dvec2(double(i), double(j)) + 0.5);
        const double v = cross(p - dvec2(a), dvec2(c - a)) / area,
                     w = cross(dvec2(b - a), p - dvec2(a)) / area;
        if (v >= 0.0 && w >= 0.0 && v + w <= 1.0) raise(i, j, a.z + v * (b.z - a.z) + w * (c.z - a.z));
      }
  }

 private:
  static double cross(const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; }
  static int64_t ceil_at_least_0(double x) {
    return std::max<int64_t>(static_cast<int64_t>(std::ceil(x)), 0);
  }

  static int64_t last_below(double x, uint32_t count) {
    return std::min<int64_t>(static_cast<int64_t>(std::floor(x)), int64_t{count} - 1);
  }

  void edge(const dvec3& a, const dvec3& b) {
    const int steps = 1 + static_cast<int>(glm::length(dvec2(b - a)) / field_.cell_m);
    for (int k = 0; k <= steps; ++k) {
      const dvec3 p = a + (b - a) * (double(k) / steps);
      const dvec2 cell = (dvec2(p) - field_.corner) / field_.cell_m;
      const auto i = static_cast<int64_t>(std::floor(cell.x)), j = static_cast<int64_t>(std::floor(cell.y));
      if (i >= 0 && j >= 0 && i < field_.width && j < field_.height) raise(i, j, p.z);
    }
  }
  void raise(int64_t i, int64_t j, double z) {
    float& height = field_.heights[static_cast<size_t>(j) * field_.width + static_cast<size_t>(i)];
    height = std::max(height, static_cast<float>(z - field_.floor));
  }

  HeightField& field_;
};

/// Holds the places where a horizon is looked up, from a cell's middle.
struct Looks : AzimuthLooks<azimuths> {
  explicit Looks(const HeightField& field)
      : AzimuthLooks(field.cell_m, field.cell_m, farthest_m, step_growth) {
    for (const float height : field.heights) highest = std::max(highest, height);
  }
  float highest = 0.0f;  ///< of the whole field
};

/// Returns the shares of the sky at several heights above a cell's floor: 1 - mean of sin^2 of the horizon.
template <size_t N>
std::array<double, N> shares(const HeightField& field, const Looks& looks, uint32_t column, uint32_t row,
                             const std::array<double, N>& above) {
  const double floor = field.heights[size_t{row} * field.width + column];
  const double most_rise = looks.highest - floor;
  std::array<double, N> hidden{};
  for (const std::vector<dvec2>& steps : looks.steps) {
    std::array<double, N> steepest{};  // tangent of the horizon
    for (size_t step = 0; step < steps.size(); ++step) {
      const double distance = looks.distances[step];
      // The highest cell that there is, here or farther off, would not raise any of the horizons.
      const auto raises = [&](size_t n) { return (most_rise - above[n]) / distance > steepest[n]; };
      bool any = false;
      for (size_t n = 0; n < N; ++n) any = any || raises(n);
      if (!any) break;
      const dvec2 cell = dvec2(column + 0.5, row + 0.5) + steps[step];
      if (cell.x < 0.0 || cell.y < 0.0 || cell.x >= field.width || cell.y >= field.height) break;
      const double rise =
          field.heights[static_cast<size_t>(cell.y) * field.width + static_cast<size_t>(cell.x)] - floor;
      for (size_t n = 0; n < N; ++n) steepest[n] = std::max(steepest[n], (rise - above[n]) / distance);
    }
    for (size_t n = 0; n < N; ++n) hidden[n] += steepest[n] * steepest[n] / (1.0 + steepest[n] * steepest[n]);
  }
  std::array<double, N> result;
  for (size_t n = 0; n < N; ++n) result[n] = 1.0 - hidden[n] / azimuths;
  return result;
}

}  // namespace

HeightField height_field(const scene::Scene& scene, uint32_t edge) {
  HeightField field;
  if (scene.bounds.empty()) {
    field.heights = {0.0f};
    return field;
  }
  const dvec3 size = scene.bounds.size();
  field.cell_m = std::max(least_cell_m, std::max(size.x, size.y) / edge);
  field.corner = dvec2(scene.bounds.min);
  field.floor = scene.bounds.min.z;
  field.width = std::max(1u, static_cast<uint32_t>(std::ceil(size.x / field.cell_m)));
  field.height = std::max(1u, static_cast<uint32_t>(std::ceil(size.y / field.cell_m)));
  field.heights.assign(size_t{field.width} * field.height, 0.0f);
  Raiser raiser(field);
  const scene::Body& world = scene.bodies[0];
  for (uint32_t i = world.first_primitive; i < world.first_primitive + world.primitive_count; ++i) {
    const scene::Primitive& primitive = scene.primitives[i];
    for (uint32_t k = 0; k < primitive.index_count; k += 3) {
      const uint32_t* corner = &scene.indices[primitive.first_index + k];
      raiser.add(dvec3(scene.positions[corner[0]]), dvec3(scene.positions[corner[1]]),
                 dvec3(scene.positions[corner[2]]));
    }
  }
  return field;
}

double sky_share(const HeightField& field, uint32_t column, uint32_t row, double above) {
  return shares<1>(field, Looks(field), column, row, {above})[0];
}

std::vector<uint16_t> sky_view_texels(const HeightField& field) {
  const Looks looks(field);
  std::vector<uint16_t> texels(4 * field.heights.size());
  parallel_for(field.height, 0, [&](size_t row) {
    for (uint32_t column = 0; column < field.width; ++column) {
      const auto at = shares<3>(field, looks, column, static_cast<uint32_t>(row),
                                {0.0, shared::sky_view_middle, shared::sky_view_top});
      const size_t place = row * field.width + column;
      texels[4 * place] = glm::packHalf1x16(field.heights[place]);
      for (size_t i = 0; i < at.size(); ++i) texels[4 * place + 1 + i] = glm::packHalf1x16(float(at[i]));
    }
  });
  return texels;
}

void describe_sky_view(const HeightField& field, shared::GpuLighting& block) {
  const dvec2 scale = 1.0 / (field.cell_m * dvec2(field.width, field.height));
  block.sky_view_uv = vec4(vec2(scale), vec2(-field.corner * scale));
  block.sky_view_floor = float(field.floor);
  // The step leads out of the wall's own cell.
  block.sky_view_step = float(1.5 * field.cell_m);
}

}  // namespace greatx::render
