// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/light/surroundings_words.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include <glm/gtc/packing.hpp>

#include "core/units.h"
#include "renderer/light/bounced_places.h"
#include "shaders/shared/surroundings.h"

namespace greatx::render {

namespace {

/// A radiance as three bytes and a common exponent.
uint32_t stored_radiance(const dvec3& radiance) {
  const double most = std::max({radiance.x, radiance.y, radiance.z});
  if (!(most > 1e-30)) return 0;
  const int exponent = static_cast<int>(std::ceil(std::log2(most / 255.0)));
  uint32_t word = static_cast<uint32_t>(std::clamp(exponent + 136, 0, 255)) << 24;
  for (int c = 0; c < 3; ++c)
    word |= static_cast<uint32_t>(std::clamp(std::lround(radiance[c] * std::exp2(-exponent)), 0l, 255l))
            << 8 * c;
  return word;
}

/// An emitted radiance in 16 bits: three times four, and an exponent. Light above 2^15 cd/m^2 is no wall's.
uint32_t stored_glow(const dvec3& radiance) {
  const double most = std::max({radiance.x, radiance.y, radiance.z});
  if (!(most > 0.0)) return 0;
  const int exponent = std::clamp(static_cast<int>(std::ceil(std::log2(most))), 0, 15);
  uint32_t word = static_cast<uint32_t>(exponent) << 12;
  for (int c = 0; c < 3; ++c)
    word |= static_cast<uint32_t>(
                std::clamp(std::lround(15.0 * std::ldexp(std::max(radiance[c], 0.0), -exponent)), 0l, 15l))
            << 4 * c;
  return word;
}

/// The free cells of an octant in four bits, rounded down: half steps between powers of two.
uint32_t stored_leap(uint16_t cells) {
  if (cells < 2) return 0;
  const auto power = static_cast<uint32_t>(std::bit_width(cells) - 1);
  return std::min(15u, 2 * power + (cells >> (power - 1) & 1u));
}

}  // namespace

std::vector<uint32_t> surroundings_words(const Surroundings& surroundings, bool bounced_light) {
  const HeightField& field = surroundings.field();
  const std::vector<SurroundingCell>& all = surroundings.cells();
  const SurroundingLight& light = surroundings.light();
  const auto halves = [](double low, double high) {
    return glm::packHalf2x16(vec2(float(low), float(high)));
  };
  shared::SurroundingsHeader header{};
  header.corner = vec2(field.corner);
  header.cell_m = float(field.cell_m);
  header.inverse_cell = float(1.0 / field.cell_m);
  header.floor = float(field.floor);
  header.step_m = float(1.5 * field.cell_m);
  header.columns = field.width;
  header.rows = field.height;
  header.place_columns = std::max(2u, field.width / shared::surroundings_place_cells);
  header.place_rows = std::max(2u, field.height / shared::surroundings_place_cells);
  const auto cells = static_cast<uint32_t>(all.size());
  header.first_color = shared::surroundings_header_pairs + cells;
  header.first_place = header.first_color + shared::surroundings_color_pairs * cells;
  header.most_top = surroundings.most_top();
  header.key_direction = vec3(light.key_direction);
  header.key_over_pi = vec3(light.key_lux / pi);
  header.wall_sky = vec3(light.sky_lux * (0.5 * wall_sky_share / pi));
  header.beyond = vec3(light.beyond);
  std::vector<uint32_t> words(2 * shared::surroundings_header_pairs);
  std::memcpy(words.data(), &header, sizeof header);

  std::vector<uint32_t> leaps(all.size());
  for (uint32_t octant = 0; octant < 8; ++octant) {
    const std::vector<uint16_t> free = surroundings.free_cells(octant);
    for (size_t i = 0; i < all.size(); ++i) leaps[i] |= stored_leap(free[i]) << 4 * octant;
  }
  for (size_t i = 0; i < all.size(); ++i) {
    words.push_back(halves(all[i].top, all[i].bottom));
    words.push_back(leaps[i]);
  }
  for (size_t i = 0; i < all.size(); ++i) {
    const SurroundingCell& cell = all[i];
    words.push_back(stored_radiance(surroundings.top_radiance(i)));
    uint32_t wall = 0;
    for (int c = 0; c < 3; ++c)
      wall |= static_cast<uint32_t>(std::lround(255.0 * std::clamp(cell.wall_albedo[c], 0.0, 1.0))) << 8 * c;
    words.push_back(wall);
    const vec4 normal(0.0f, 0.0f, vec2(cell.wall_normal));
    words.push_back((glm::packHalf1x16(cell.shadow) & 0xffffu) | glm::packSnorm4x8(normal));
    words.push_back(stored_glow(cell.glow.low) | stored_glow(cell.glow.high) << 16);
  }
  if (bounced_light)
    put_bounced_light(words, surroundings, header.place_columns, header.place_rows);
  else
    words.resize(2 * (size_t{header.first_place} +
                      size_t{shared::surroundings_place_pairs} * header.place_columns * header.place_rows));
  return words;
}

}  // namespace greatx::render
