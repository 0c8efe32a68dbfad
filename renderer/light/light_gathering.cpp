// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/light/light_gathering.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/units.h"
#include "shaders/shared/surroundings.h"

namespace greatx::render {

namespace {

constexpr int gather_azimuths = 16, gather_bands = 24;

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
  /// Whether a band between two slopes is free.
  bool any_free(double low, double high) { return (below(high) & ~below(low) & ~filled_) != 0; }
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

/// Returns what an azimuth sees of the wall of a column. Its lower and its upper half may lie in shadow and
/// in light, and its lowest metres and the rest may glow.
LightGathering::WallParts LightGathering::wall_seen(size_t i, double distance, int azimuth) const {
  // A look stands for the azimuths half-way to the next ones.
  static const double aside = std::tan(pi / gather_azimuths);
  const SurroundingCell& cell = surroundings_->cells()[i];
  const double bottom = cell.bottom, top = cell.top, middle = 0.5 * (bottom + top);
  WallParts parts;
  if (glm::dot(cell.wall_normal, looks_.along[azimuth]) >= 0.0 && cell.wall_normal != dvec2(0.0)) {
    parts.add(bottom, top, dvec3(0.0));
    return parts;
  }
  const WallGlow& glow = surroundings_->glow(i, aside * distance / surroundings_->field().cell_m);
  const dvec3 lower = surroundings_->wall_radiance(cell, 0.5 * (bottom + middle)),
              upper = surroundings_->wall_radiance(cell, 0.5 * (middle + top));
  const double split = glow.any() ? std::min(bottom + double(shared::surroundings_glow_split), top) : middle;
  parts.add(bottom, std::min(split, middle), lower + glow.low);
  parts.add(split, middle, lower + glow.high);
  parts.add(middle, split, upper + glow.low);
  parts.add(std::max(split, middle), top, upper + glow.high);
  return parts;
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
    if (stands(i)) {
      const double low = (column.bottom - height) / distance, high = (column.top - height) / distance;
      if (bands.any_free(low, high)) {
        const WallParts wall = wall_seen(i, distance, azimuth);
        for (size_t k = 0; k < wall.count; ++k)
          bands.fill((wall.part[k].bottom - height) / distance, (wall.part[k].top - height) / distance,
                     [&] { return wall.part[k].radiance; });
      }
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

/// Returns the column at a distance along an azimuth, if it is one of the field.
std::optional<size_t> LightGathering::column_at(const dvec2& place, int azimuth, double distance) const {
  const HeightField& field = surroundings_->field();
  const dvec2 at = (place + looks_.along[azimuth] * distance - field.corner) / field.cell_m;
  if (at.x < 0.0 || at.y < 0.0 || at.x >= field.width || at.y >= field.height) return {};
  return static_cast<size_t>(at.y) * field.width + static_cast<size_t>(at.x);
}

/// Returns the distance, within half a cell, at which what stands at `farther` begins.
double LightGathering::first_standing(const dvec2& place, int azimuth, double nearer, double farther) const {
  while (farther - nearer > 0.5 * surroundings_->field().cell_m) {
    const double middle = 0.5 * (nearer + farther);
    const auto i = column_at(place, azimuth, middle);
    (i && stands(*i) ? farther : nearer) = middle;
  }
  return 0.5 * (nearer + farther);
}

/// What hides the sky along one azimuth: all below one slope, and what hangs above it.
class LightGathering::Hidden {
 public:
  /// Calls see(slope, slope) for the free parts between two slopes, and then hides them.
  template <typename See>
  void hide(double low, double high, const See& see) {
    const double first = std::max(low, below_);
    if (high <= first) return;
    const double gap_end = hangs_ ? std::min(high, hang_low_) : high;
    if (gap_end > first) see(first, gap_end);
    if (hangs_ && high > std::max(first, hang_high_)) see(std::max(first, hang_high_), high);
    // A slit of a kerb's height does not let light through.
    if (low <= below_ + 0.03) {
      below_ = high;
      if (hangs_ && below_ >= hang_low_) {
        below_ = std::max(below_, hang_high_);
        hangs_ = false;
      }
      return;
    }
    // Of two things that hang, the gap between them counts as hidden.
    hang_low_ = hangs_ ? std::min(hang_low_, low) : low;
    hang_high_ = hangs_ ? std::max(hang_high_, high) : high;
    hangs_ = true;
  }
  double below() const { return below_; }

 private:
  double below_ = 0.0, hang_low_ = 0.0, hang_high_ = 0.0;
  bool hangs_ = false;
};

dvec3 LightGathering::on_ground(const dvec2& place, double height) const {
  // The integral of the sine of elevation over the solid angle up to a slope, over an azimuth's width.
  const auto up_to = [](double slope) { return 0.5 * slope * slope / (1.0 + slope * slope); };
  dvec3 result(0.0);
  for (int k = 0; k < gather_azimuths; ++k) {
    Hidden hidden;
    double nearer = 0.0;
    for (const double distance : looks_.distances) {
      const auto i = column_at(place, k, distance);
      // Nothing farther on rises above what hides it.
      if (!i || surroundings_->most_top() - height <= hidden.below() * distance) break;
      if (stands(*i) && columns_[*i].top - height > hidden.below() * distance) {
        const double wall = std::max(first_standing(place, k, nearer, distance), 1e-3);
        const WallParts parts = wall_seen(*i, wall, k);
        for (size_t p = 0; p < parts.count; ++p)
          hidden.hide((parts.part[p].bottom - height) / wall, (parts.part[p].top - height) / wall,
                      [&](double low, double high) {
                        result += parts.part[p].radiance * (up_to(high) - up_to(low));
                      });
      }
      nearer = distance;
    }
  }
  return result * (2.0 / gather_azimuths);
}

}  // namespace greatx::render
