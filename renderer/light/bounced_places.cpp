// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/light/bounced_places.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/packing.hpp>

#include "core/parallel.h"
#include "renderer/light/light_gathering.h"
#include "renderer/light/sky.h"
#include "shaders/shared/surroundings.h"

namespace greatx::render {

namespace {

/// The height over a roof from which it is looked around: above its parapet, m.
constexpr double roof_clearance_m = 1.0;

/// Bounced light at the two heights over a place.
struct BouncedPlace {
  BouncedLight low, high;
  float ground = 0.0f;
  bool free = true;   ///< not within a house
  double roof = 0.0;  ///< height of the roof of a house
};

/// Shaders weaken the light at the high place by the height over it. Returns the inverse for a roof.
double strength_on_roof(const BouncedPlace& place) {
  return std::max((place.roof - place.ground) / double(shared::surroundings_high), 1.0);
}

void add_scaled(BouncedLight& sum, const BouncedLight& light, double factor) {
  for (size_t i = 0; i < sum.facing.size(); ++i) sum.facing[i] += light.facing[i] * factor;
}

/// Gives the places within houses that touch others the mean of their neighbours' light. Roofs keep theirs.
void fill_from_neighbours(std::vector<BouncedPlace>& places, uint32_t columns, uint32_t rows) {
  const std::vector<BouncedPlace> before = places;
  for (uint32_t row = 0; row < rows; ++row)
    for (uint32_t column = 0; column < columns; ++column) {
      if (before[size_t{row} * columns + column].free) continue;
      std::vector<const BouncedPlace*> near;
      for (const auto& [dx, dy] : {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)}) {
        const int64_t x = int64_t{column} + dx, y = int64_t{row} + dy;
        if (x < 0 || y < 0 || x >= columns || y >= rows) continue;
        const BouncedPlace& other = before[static_cast<size_t>(y) * columns + static_cast<size_t>(x)];
        if (other.free) near.push_back(&other);
      }
      if (near.empty()) continue;
      BouncedPlace& place = places[size_t{row} * columns + column];
      const dvec3 on_roof = place.high.facing[4];
      BouncedPlace mean;
      for (const BouncedPlace* other : near) {
        add_scaled(mean.low, other->low, 1.0 / double(near.size()));
        add_scaled(mean.high, other->high, 1.0 / double(near.size()));
        mean.ground += other->ground / float(near.size());
      }
      mean.roof = place.roof;
      mean.high.facing[4] = on_roof * strength_on_roof(mean) / strength_on_roof(place);
      place = mean;
    }
}

/// Gives each value of a place outdoors the median of its own and its neighbours', by luminance. Few looks,
/// and columns that a pole fills, make single places too dark or too bright; slopes and edges of light stay.
void take_medians(std::vector<BouncedPlace>& places, uint32_t columns, uint32_t rows) {
  const std::vector<BouncedPlace> before = places;
  parallel_for(rows, 0, [&](size_t row) {
    for (size_t column = 0; column < columns; ++column) {
      BouncedPlace& place = places[row * columns + column];
      if (!place.free) continue;
      std::array<const BouncedPlace*, 9> near;
      size_t count = 0;
      for (size_t y = row - std::min<size_t>(row, 1); y <= std::min<size_t>(row + 1, rows - 1); ++y)
        for (size_t x = column - std::min<size_t>(column, 1); x <= std::min<size_t>(column + 1, columns - 1);
             ++x)
          if (before[y * columns + x].free) near[count++] = &before[y * columns + x];
      for (BouncedLight BouncedPlace::*light : {&BouncedPlace::low, &BouncedPlace::high})
        for (size_t k = 0; k < place.low.facing.size(); ++k) {
          std::array<std::pair<double, const BouncedPlace*>, 9> values;
          for (size_t i = 0; i < count; ++i) values[i] = {luminance((near[i]->*light).facing[k]), near[i]};
          const auto middle = values.begin() + static_cast<ptrdiff_t>(count / 2);
          std::nth_element(values.begin(), middle, values.begin() + static_cast<ptrdiff_t>(count));
          (place.*light).facing[k] = (middle->second->*light).facing[k];
        }
    }
  });
}

/// The three signed bytes of a luminance's vector, and the byte of the root of what a surface that faces up
/// gets: far from what shines, that is far less than what walls get.
uint32_t stored_shape(const BouncedLight& light) {
  const double c = std::max(luminance(light.constant()), 1e-30);
  vec4 part(0.0f);
  for (int axis = 0; axis < 3; ++axis)
    part[axis] = float(luminance(light.along(axis)) / (double(shared::surroundings_vector_scale) * c));
  const double up = luminance(light.facing[4]) / (double(shared::surroundings_up_scale) * c);
  // Both clamp what little a wall gets beside a glowing roof or floor.
  return (glm::packSnorm4x8(part) & 0xffffffu) |
         static_cast<uint32_t>(std::lround(255.0 * std::sqrt(std::clamp(up, 0.0, 1.0)))) << 24;
}

void put_place(std::vector<uint32_t>& words, const BouncedPlace& place) {
  const dvec3 sum = place.low.constant() + place.high.constant();
  const double y = luminance(sum);
  const double red = y > 0.0 ? sum.r / y : 1.0, blue = y > 0.0 ? sum.b / y : 1.0;
  const dvec2 root =
      glm::sqrt(glm::max(dvec2(red, blue), dvec2(0.0))) / double(shared::surroundings_color_scale);
  const uint32_t color = glm::packUnorm4x8(vec4(0.0f, 0.0f, vec2(root)));  // clamps
  words.push_back((glm::packHalf1x16(float(luminance(place.low.constant()))) & 0xffffu) | color);
  words.push_back(stored_shape(place.low));
  words.push_back(glm::packHalf2x16(vec2(float(luminance(place.high.constant())), place.ground)));
  words.push_back(stored_shape(place.high));
}

}  // namespace

void put_bounced_light(std::vector<uint32_t>& words, const Surroundings& surroundings, uint32_t columns,
                       uint32_t rows) {
  const HeightField& field = surroundings.field();
  std::vector<BouncedPlace> places(size_t{columns} * rows);
  const LightGathering gathering(surroundings);
  parallel_for(rows, 0, [&](size_t row) {
    for (uint32_t column = 0; column < columns; ++column) {
      const dvec2 at = (dvec2(column, double(row)) + 0.5) * double(shared::surroundings_place_cells);
      const size_t i = std::min(static_cast<uint32_t>(at.y), field.height - 1) * size_t{field.width} +
                       std::min(static_cast<uint32_t>(at.x), field.width - 1);
      BouncedPlace& place = places[row * columns + column];
      const SurroundingCell& cell = surroundings.cells()[i];
      place.ground = cell.ground;
      place.free = !cell.stands() || cell.bottom > cell.ground;
      const dvec2 middle = field.corner + at * field.cell_m;
      if (!place.free) {
        place.roof = cell.top;
        place.high.facing.fill(gathering.on_ground(middle, cell.top + roof_clearance_m) *
                               strength_on_roof(place));
        continue;
      }
      place.low = gathering.at(middle, place.ground + double(shared::surroundings_low));
      place.low.facing[4] = gathering.on_ground(middle, place.ground);
      place.high = gathering.at(middle, place.ground + double(shared::surroundings_high));
    }
  });

  take_medians(places, columns, rows);
  // Surfaces at the rim of a house look up places behind it, too.
  for (int round = 0; round < 3; ++round) fill_from_neighbours(places, columns, rows);
  for (const BouncedPlace& place : places) put_place(words, place);
}

}  // namespace greatx::render
