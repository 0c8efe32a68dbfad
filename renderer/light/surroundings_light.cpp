// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/light/surroundings_light.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <glm/gtc/packing.hpp>

#include "core/parallel.h"
#include "core/units.h"
#include "renderer/light/sky.h"
#include "shaders/shared/surroundings.h"

namespace greatx::render {

namespace {

constexpr int gather_azimuths = 16, gather_bands = 24;
/// The height over a roof from which it is looked around: above its parapet, m.
constexpr double roof_clearance_m = 1.0;

/// Returns the sine of elevation at a place among the bands, which have equal steps of it.
double sine_of(double band) { return 2.0 * band / gather_bands - 1.0; }

/// Returns the band in which the tangent of an elevation lies.
int band_of(double slope) {
  const double sine = slope / std::sqrt(1.0 + slope * slope), place = 0.5 * (sine + 1.0) * gather_bands;
  // This is std::lround of a number that is not negative.
  const int whole = static_cast<int>(place);
  return whole + static_cast<int>(place - whole >= 0.5);
}

/// Returns a band's radiance times its solid angle over pi.
dvec3 weighted(const dvec3& radiance) { return radiance * (4.0 / (gather_azimuths * gather_bands)); }

/// The directions of the middles of bands.
struct BandDirections {
  BandDirections() {
    for (int i = 0; i < gather_bands; ++i) {
      sine[i] = sine_of(i + 0.5);
      level[i] = std::sqrt(1.0 - sine[i] * sine[i]);
    }
  }
  std::array<double, gather_bands> sine, level;
};

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

/// The four signed bytes of a luminance's vector and of what it has more along the vertical.
uint32_t stored_shape(const BouncedLight& light) {
  const double scale =
      double(shared::surroundings_vector_scale) * std::max(luminance(light.constant()), 1e-30);
  vec4 part(0.0f);
  for (int axis = 0; axis < 3; ++axis) part[axis] = float(luminance(light.along(axis)) / scale);
  part.w = float(luminance(light.upright()) / scale);
  return glm::packSnorm4x8(part);  // clamps what little a wall gets beside a glowing roof or floor
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

/// Light from the bands of one azimuth, weighted. What comes first along the azimuth hides what comes later.
class LightGathering::Bands {
 public:
  /// Fills the free bands between two slopes with the radiance that `radiance` returns. It is not called if
  /// no such band is free.
  template <typename Radiance>
  void fill(double low, double high, const Radiance& radiance) {
    const uint32_t below_low = below(low), below_high = below(high),
                   fresh = below_high & ~below_low & ~filled_;
    if (fresh == 0) return;
    filled_ |= fresh;
    const dvec3 light = weighted(radiance());
    for (uint32_t left = fresh; left != 0; left &= left - 1)
      light_[static_cast<size_t>(std::countr_zero(left))] = light;
  }
  /// Takes what is below the horizon for known.
  void leave_out_below_horizon() { filled_ |= (1u << gather_bands / 2) - 1u; }
  bool filled(int band) const { return (filled_ >> band & 1u) != 0; }
  const dvec3& light(int band) const { return light_[static_cast<size_t>(band)]; }
  /// Whether no band below a slope, which is not negative, is free.
  bool full_below(double slope) {
    constexpr uint32_t below_horizon = (1u << gather_bands / 2) - 1u;
    return (below_horizon & ~filled_) == 0 && (below(slope) & ~filled_) == 0;
  }

 private:
  /// Returns the bands below that of a slope, a bit each. The two slopes that were asked for last are known:
  /// level ground ends at the slope at which it goes on in the next cell, and the parts of a wall meet.
  uint32_t below(double slope) {
    for (const Known& known : known_)
      if (known.slope == slope) return known.below;
    Known& known = known_[next_ ^= 1u];
    known = {slope, (1u << band_of(slope)) - 1u};
    return known.below;
  }
  struct Known {
    double slope = 1e300;
    uint32_t below = (1u << gather_bands) - 1u;
  };
  std::array<Known, 2> known_;
  uint32_t next_ = 0, filled_ = 0;
  std::array<dvec3, gather_bands> light_;
};

LightGathering::LightGathering(const Surroundings& surroundings)
    : surroundings_(&surroundings),
      looks_(surroundings.field().cell_m, 0.6 * surroundings.field().cell_m, 150.0, 1.2) {
  for (const SurroundingCell& cell : surroundings.cells())
    columns_.push_back({cell.top, cell.bottom, cell.ground});
}

/// Fills the bands between two slopes with the wall of a column, seen from a height at a distance. Its lower
/// and its upper half may lie in shadow and in light, and its lowest metres and the rest may glow.
void LightGathering::fill_wall(size_t i, double low, double high, double height, double distance, int azimuth,
                               Bands& bands) const {
  const SurroundingCell& cell = surroundings_->cells()[i];
  const bool faces =
      glm::dot(cell.wall_normal, looks_.along[azimuth]) < 0.0 || cell.wall_normal == dvec2(0.0);
  const double middle = 0.5 * (std::max<double>(cell.bottom, cell.ground) + cell.top);
  const auto lower = [&] { return surroundings_->wall_radiance(cell, 0.5 * (cell.bottom + middle)); };
  const auto upper = [&] { return surroundings_->wall_radiance(cell, 0.5 * (middle + cell.top)); };
  const auto slope_of = [&](double at) { return (at - height) / distance; };
  if (!faces) return bands.fill(low, high, [] { return dvec3(0.0); });
  if (!cell.glow.any()) {
    bands.fill(low, slope_of(middle), lower);
    return bands.fill(slope_of(middle), high, upper);
  }
  const double split = std::min<double>(cell.bottom + shared::surroundings_glow_split, cell.top);
  bands.fill(low, slope_of(std::min(split, middle)), [&] { return lower() + cell.glow.low; });
  if (split < middle)
    bands.fill(slope_of(split), slope_of(middle), [&] { return lower() + cell.glow.high; });
  else
    bands.fill(slope_of(middle), slope_of(split), [&] { return upper() + cell.glow.low; });
  bands.fill(slope_of(std::max(split, middle)), high, [&] { return upper() + cell.glow.high; });
}

/// Fills the bands of one azimuth with what a point sees.
void LightGathering::look_along(const dvec2& place, double height, int azimuth, Bands& bands) const {
  const HeightField& field = surroundings_->field();
  const dvec2 middle = (place - field.corner) / field.cell_m;
  double nearer = 1e-3;  // m
  for (size_t step = 0; step < looks_.distances.size(); ++step) {
    const double distance = looks_.distances[step];
    const dvec2 at = middle + looks_.steps[azimuth][step];
    if (at.x < 0.0 || at.y < 0.0 || at.x >= field.width || at.y >= field.height) break;
    const size_t i = static_cast<size_t>(at.y) * field.width + static_cast<size_t>(at.x);
    const Column& column = columns_[i];
    // From above, the ground fills the slopes between its nearer and its farther rim.
    const double ground = column.ground - height;
    if (ground < 0.0)
      bands.fill(ground / nearer, ground / distance, [&] { return surroundings_->ground_radiance(i); });
    if (column.top > column.ground + low_thing_m) {
      const double low = (column.bottom - height) / distance, high = (column.top - height) / distance;
      fill_wall(i, low, high, height, distance, azimuth, bands);
      if (high < 0.0)
        bands.fill(high, (column.top - height) / looks_.after(distance),
                   [&] { return surroundings_->top_radiance(i); });
    }
    // What comes farther on is below the horizon, or below the slope of the highest top at this distance.
    if (bands.full_below(std::max(surroundings_->most_top() - height, 0.0) / distance)) break;
    nearer = distance;
  }
}

BouncedLight LightGathering::at(const dvec2& place, double height) const {
  static const BandDirections directions;
  const dvec3 beyond = weighted(surroundings_->light().beyond);
  BouncedLight result;
  for (int k = 0; k < gather_azimuths; ++k) {
    Bands bands;
    look_along(place, height, k, bands);
    for (int i = 0; i < gather_bands; ++i) {
      if (!bands.filled(i) && directions.sine[i] > 0.0) continue;
      const dvec3& light = bands.filled(i) ? bands.light(i) : beyond;
      const dvec3 direction(looks_.along[k] * directions.level[i], directions.sine[i]);
      for (int axis = 0; axis < 3; ++axis)
        result.facing[2 * axis + (direction[axis] < 0.0 ? 1 : 0)] += light * std::abs(direction[axis]);
    }
  }
  return result;
}

dvec3 LightGathering::on_ground(const dvec2& place, double height) const {
  static const BandDirections directions;
  dvec3 result(0.0);
  for (int k = 0; k < gather_azimuths; ++k) {
    Bands bands;
    bands.leave_out_below_horizon();
    look_along(place, height, k, bands);
    for (int i = gather_bands / 2; i < gather_bands; ++i)
      if (bands.filled(i)) result += bands.light(i) * directions.sine[i];
  }
  return result;
}

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

  // Surfaces at the rim of a house look up places behind it, too.
  for (int round = 0; round < 3; ++round) fill_from_neighbours(places, columns, rows);
  for (const BouncedPlace& place : places) put_place(words, place);
}

}  // namespace greatx::render
