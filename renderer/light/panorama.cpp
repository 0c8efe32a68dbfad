// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/light/panorama.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/packing.hpp>

#include "core/parallel.h"
#include "renderer/light/clouds.h"

namespace greatx::render {

namespace {

constexpr uint32_t coarse_size = 128;  ///< of the sky without clouds, which is smooth
constexpr float largest_half = 65504.0f;

/// Returns a number in [0, 1) for each texel that differs from its neighbours'.
float shift_of(uint32_t column, uint32_t row) {
  // Interleaved gradient noise (J. Jimenez, "Next Generation Post Processing in Call of Duty", 2014).
  const double x = 0.06711056 * column + 0.00583715 * row;
  const double y = 52.9829189 * (x - std::floor(x));
  return float(0.2 + 0.6 * (y - std::floor(y)));
}

/// Blurs rows and columns by [1 2 1] / 4, which hides the shifts of the samples.
void blur(std::vector<vec4>& texels, uint32_t size) {
  const auto mean = [](const vec4& before, const vec4& at, const vec4& after) {
    return 0.25f * before + 0.5f * at + 0.25f * after;
  };
  parallel_for(size, 0, [&](size_t row) {
    vec4* const line = &texels[row * size];
    vec4 before = line[0];
    for (uint32_t i = 0; i < size; ++i) {
      const vec4 at = line[i];
      line[i] = mean(before, at, line[std::min(i + 1, size - 1)]);
      before = at;
    }
  });
  // Columns go side by side, since a column alone would read a line of the cache for each texel.
  std::vector<vec4> above(texels.begin(), texels.begin() + size);
  for (uint32_t row = 0; row < size; ++row) {
    vec4* const line = &texels[size_t{row} * size];
    const vec4* const below = &texels[size_t{std::min(row + 1, size - 1)} * size];
    for (uint32_t i = 0; i < size; ++i) {
      const vec4 at = line[i];
      line[i] = mean(above[i], at, below[i]);
      above[i] = at;
    }
  }
}

}  // namespace

dvec3 panorama_direction(double u, double v) {
  const double a = 2.0 * u - 1.0, b = 2.0 * v - 1.0;
  const dvec2 p(0.5 * (a + b), 0.5 * (a - b));
  return glm::normalize(dvec3(p, std::max(1.0 - std::abs(p.x) - std::abs(p.y), 0.0)));
}

dvec2 panorama_uv(const dvec3& direction) {
  const dvec2 p = dvec2(direction) / (std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z));
  return dvec2(p.x + p.y, p.x - p.y) * 0.5 + 0.5;
}

std::vector<uint16_t> bake_panorama(const Sky& sky, uint32_t size, double scale) {
  // Texels of the coarse map lie on the square's border too, so that the horizon is one of its lines.
  constexpr uint32_t last = coarse_size - 1;
  std::vector<vec3> coarse(size_t{coarse_size} * coarse_size);
  parallel_for(coarse_size, 0, [&](size_t row) {
    for (uint32_t column = 0; column < coarse_size; ++column)
      coarse[row * coarse_size + column] =
          vec3(sky.cloudless(panorama_direction(double(column) / last, double(row) / last)));
  });
  const auto cloudless = [&](double u, double v) {
    const float x = float(u * last), y = float(v * last);
    const auto i = std::min(static_cast<uint32_t>(x), last - 1),
               j = std::min(static_cast<uint32_t>(y), last - 1);
    const vec3* at = &coarse[j * coarse_size + i];
    return glm::mix(glm::mix(at[0], at[1], x - float(i)),
                    glm::mix(at[coarse_size], at[coarse_size + 1], x - float(i)), y - float(j));
  };
  std::vector<vec4> texels(size_t{size} * size);
  parallel_for(size, 0, [&](size_t index) {
    const auto row = static_cast<uint32_t>(index);
    for (uint32_t column = 0; column < size; ++column) {
      const double u = (column + 0.5) / size, v = (row + 0.5) / size;
      const dvec3 direction = panorama_direction(u, v);
      const CloudView view = sky.clouds(direction, shift_of(column, row));
      const dvec3 seen = sky.over_clouds(direction, dvec3(cloudless(u, v)), view);
      texels[index * size + column] = vec4(vec3(seen / scale), view.passed);
    }
  });
  blur(texels, size);
  std::vector<uint16_t> halves(4 * texels.size());
  for (size_t i = 0; i < texels.size(); ++i)
    for (int c = 0; c < 4; ++c)
      halves[4 * i + size_t(c)] = glm::packHalf1x16(std::min(texels[i][c], largest_half));
  return halves;
}

}  // namespace greatx::render
