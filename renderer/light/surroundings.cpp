// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/light/surroundings.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include <glm/gtc/packing.hpp>

#include "core/parallel.h"
#include "core/srgb.h"
#include "core/units.h"
#include "renderer/light/sky.h"
#include "shaders/shared/surroundings.h"

namespace greatx::render {

namespace {

/// A surface whose normal's z is below this is a wall.
constexpr double wall_slope = 0.3;
/// What stands lower than this over the ground is part of it.
constexpr float low_m = 1.0f;
/// The share of the sky that a wall in a street sees beside its own half.
constexpr double wall_sky_share = 0.7;
/// The part of the sky's light that reaches the ground between houses.
constexpr double ground_sky_share = 0.8;

/// Returns the mean base colour of a material with its texture, from at most 32 x 32 texels.
dvec3 mean_color(const scene::Scene& scene, const scene::PbrMaterial& pbr) {
  const dvec3 factor(pbr.base_color);
  if (pbr.base_color_texture < 0) return factor;
  const scene::Texture& texture = scene.textures[static_cast<size_t>(pbr.base_color_texture)];
  constexpr uint32_t most = 32;
  const uint32_t across = std::min(texture.width, most), down = std::min(texture.height, most);
  dvec3 sum(0.0);
  for (uint32_t j = 0; j < down; ++j)
    for (uint32_t i = 0; i < across; ++i) {
      const size_t column = size_t{i} * texture.width / across, row = size_t{j} * texture.height / down;
      const uint8_t* bytes = &texture.rgba[4 * (row * texture.width + column)];
      for (int c = 0; c < 3; ++c)
        sum[c] += texture.srgb ? linear_from_srgb(bytes[c] / 255.0) : bytes[c] / 255.0;
    }
  return factor * sum / double(across * down);
}

/// Calls visit(cell, least height, greatest height) for what a triangle covers of the cells: a level one at
/// their centres, a steep one along its length.
class CellCover {
 public:
  explicit CellCover(const HeightField& field) : field_(field) {}

  template <typename Visit>
  void level(const std::array<dvec3, 3>& p, const Visit& visit) const {
    const dvec2 ab = dvec2(p[1] - p[0]), ac = dvec2(p[2] - p[0]);
    const double area = ab.x * ac.y - ab.y * ac.x;
    if (std::abs(area) < 1e-9) return;
    const dvec2 low = cells_of(glm::min(p[0], glm::min(p[1], p[2]))),
                high = cells_of(glm::max(p[0], glm::max(p[1], p[2])));
    const auto first = [](double x) { return static_cast<int64_t>(std::max(std::ceil(x - 0.5), 0.0)); };
    const auto last = [](double x, uint32_t count) {
      return std::min(static_cast<int64_t>(std::floor(x - 0.5)), int64_t{count} - 1);
    };
    for (int64_t j = first(low.y); j <= last(high.y, field_.height); ++j)
      for (int64_t i = first(low.x); i <= last(high.x, field_.width); ++i) {
        const dvec2 q = field_.corner + field_.cell_m * (dvec2(double(i), double(j)) + 0.5) - dvec2(p[0]);
        const double v = (q.x * ac.y - q.y * ac.x) / area, w = (ab.x * q.y - ab.y * q.x) / area;
        if (v < 0.0 || w < 0.0 || v + w > 1.0) continue;
        const auto height =
            static_cast<float>(p[0].z + v * (p[1].z - p[0].z) + w * (p[2].z - p[0].z) - field_.floor);
        visit(static_cast<size_t>(j * field_.width + i), height, height);
      }
  }

  template <typename Visit>
  void steep(const std::array<dvec3, 3>& p, const dvec3& normal, const Visit& visit) const {
    const dvec2 along = glm::normalize(dvec2(-normal.y, normal.x));
    std::array<double, 3> s;
    for (int k = 0; k < 3; ++k) s[k] = glm::dot(dvec2(p[k] - p[0]), along);
    const double begin = std::min({s[0], s[1], s[2]}), end = std::max({s[0], s[1], s[2]});
    const int steps = 1 + static_cast<int>((end - begin) / (0.5 * field_.cell_m));
    for (int step = 0; step <= steps; ++step) {
      const double at = begin + (end - begin) * (std::clamp(double(step) / steps, 1e-6, 1.0 - 1e-6));
      dvec3 low(1e300), high(-1e300);
      for (int k = 0; k < 3; ++k) {
        const int next = (k + 1) % 3;
        const double apart = s[next] - s[k];
        const double share = apart != 0.0 ? (at - s[k]) / apart : -1.0;
        if (share < 0.0 || share > 1.0) continue;
        const dvec3 point = glm::mix(p[k], p[next], share);
        if (point.z < low.z) low = point;
        if (point.z > high.z) high = point;
      }
      if (low.z > high.z) continue;
      const dvec2 cell = cells_of(low);
      if (cell.x < 0.0 || cell.y < 0.0 || cell.x >= field_.width || cell.y >= field_.height) continue;
      visit(static_cast<size_t>(cell.y) * field_.width + static_cast<size_t>(cell.x),
            static_cast<float>(low.z - field_.floor), static_cast<float>(high.z - field_.floor));
    }
  }

 private:
  dvec2 cells_of(const dvec3& p) const { return (dvec2(p) - field_.corner) / field_.cell_m; }
  const HeightField& field_;
};

/// Calls visit(corners, normal, material) for the static triangles.
template <typename Visit>
void over_static(const scene::Scene& scene, const Visit& visit) {
  const scene::Body& world = scene.bodies[0];
  for (uint32_t i = world.first_primitive; i < world.first_primitive + world.primitive_count; ++i) {
    const scene::Primitive& primitive = scene.primitives[i];
    for (uint32_t k = 0; k < primitive.index_count; k += 3) {
      const uint32_t* corner = &scene.indices[primitive.first_index + k];
      const std::array<dvec3, 3> p{dvec3(scene.positions[corner[0]]), dvec3(scene.positions[corner[1]]),
                                   dvec3(scene.positions[corner[2]])};
      const dvec3 normal = glm::cross(p[1] - p[0], p[2] - p[0]);
      const double length = glm::length(normal);
      if (length > 1e-9) visit(p, normal / length, primitive.material);
    }
  }
}

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

/// The free cells of an octant in four bits, rounded down: half steps between powers of two.
uint32_t stored_leap(uint16_t cells) {
  if (cells < 2) return 0;
  const auto power = static_cast<uint32_t>(std::bit_width(cells) - 1);
  return std::min(15u, 2 * power + (cells >> (power - 1) & 1u));
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

/// Returns what a band's radiance counts in the sum: Y00^2 = 1 / 4 pi, Y1m^2 = 3 / 4 pi; the cosine lobe's
/// factors over pi are 1 and 2/3.
dvec3 weighted(const dvec3& radiance) {
  return radiance * (4.0 * pi / (gather_azimuths * gather_bands)) / (4.0 * pi);
}

/// Light from the bands of one azimuth, weighted. What comes first along the azimuth hides what comes later.
class Bands {
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

/// The places at which a gathering looks, from the place's own, in cells. They are the same for all places of
/// a field.
struct GatherLooks {
  explicit GatherLooks(double cell_m) {
    for (double distance = 0.6 * cell_m; distance < 150.0; distance = distance * 1.2 + 0.1)
      distances.push_back(distance);
    for (int k = 0; k < gather_azimuths; ++k) {
      const double azimuth = (k + 0.5) * 2.0 * pi / gather_azimuths;
      along[k] = {std::cos(azimuth), std::sin(azimuth)};
      for (const double distance : distances) steps[k].push_back(along[k] * (distance / cell_m));
    }
  }
  std::vector<double> distances;
  std::array<dvec2, gather_azimuths> along;
  std::array<std::vector<dvec2>, gather_azimuths> steps;
};

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

Surroundings::Surroundings(const scene::Scene& scene, const HeightField& field, const SurroundingLight& light,
                           std::span<const scene::PunctualLight> lamps)
    : field_(&field), light_(light), cells_(field.heights.size()) {
  paint(scene);
  for (const SurroundingCell& cell : cells_) {
    columns_.push_back({cell.top, cell.bottom, cell.ground});
    most_top_ = std::max(most_top_, cell.top);
  }
  cast_shadows();
  for (int round = 0; round < 4; ++round) thicken_walls();
  shine(lamps);
}

void Surroundings::paint(const scene::Scene& scene) {
  const CellCover cover(*field_);
  std::vector<dvec3> colors;
  for (const scene::Material& material : scene.materials) colors.push_back(mean_color(scene, material.pbr));
  for (size_t i = 0; i < cells_.size(); ++i) {
    cells_[i].top = cells_[i].ground = field_->heights[i];
    cells_[i].bottom = 1e30f;
  }
  // The ground of a cell is its lowest level surface.
  std::vector<float> highest(cells_.size(), -1e30f);
  over_static(scene, [&](const std::array<dvec3, 3>& p, const dvec3& normal, uint32_t material) {
    if (std::abs(normal.z) < wall_slope) return;
    cover.level(p, [&](size_t i, float height, float) {
      if (height <= cells_[i].ground) {
        cells_[i].ground = height;
        cells_[i].ground_albedo = colors[material];
      }
      if (height >= highest[i]) {
        highest[i] = height;
        cells_[i].top_albedo = colors[material];
      }
    });
  });
  std::vector<dvec3> walls(cells_.size(), dvec3(0.0));
  std::vector<double> areas(cells_.size(), 0.0);
  // What stands in a cell begins at its lowest wall or its lowest face that looks down. Without
  // either, it is a house without a floor.
  const auto stand = [&](size_t i, float low, float high) {
    SurroundingCell& cell = cells_[i];
    if (high > cell.ground + low_m) cell.bottom = std::min(cell.bottom, std::max(low, cell.ground));
  };
  over_static(scene, [&](const std::array<dvec3, 3>& p, const dvec3& normal, uint32_t material) {
    if (normal.z >= wall_slope) return;
    if (normal.z <= -wall_slope) return cover.level(p, stand);
    cover.steep(p, normal, [&](size_t i, float low, float high) {
      stand(i, low, high);
      walls[i] += colors[material] * double(high - low);
      areas[i] += high - low;
      cells_[i].wall_normal += dvec2(normal) * double(high - low);
    });
  });
  for (size_t i = 0; i < cells_.size(); ++i) {
    SurroundingCell& cell = cells_[i];
    if (cell.bottom < cell.ground + low_m || cell.bottom >= cell.top) cell.bottom = cell.ground;
    cell.wall_albedo = areas[i] > 0.0 ? walls[i] / areas[i] : cell.top_albedo;
    const double length = glm::length(cell.wall_normal);
    cell.wall_normal = length > 1e-9 ? cell.wall_normal / length : dvec2(0.0);
  }
}

/// Gives what stands behind a wall the wall's colour, normal and shadow: a ray may step over a thin one.
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
      }
    }
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

/// Fills the bands of one azimuth with what a point sees.
template <typename Bands, typename Looks>
void Surroundings::look_along(const dvec2& middle, double height, const Looks& looks, int azimuth,
                              Bands& bands) const {
  const dvec2& along = looks.along[azimuth];
  double nearer = 1e-3;  // m
  for (size_t step = 0; step < looks.distances.size(); ++step) {
    const double distance = looks.distances[step];
    const dvec2 at = middle + looks.steps[azimuth][step];
    if (at.x < 0.0 || at.y < 0.0 || at.x >= field_->width || at.y >= field_->height) break;
    const size_t i = static_cast<size_t>(at.y) * field_->width + static_cast<size_t>(at.x);
    const CellColumn& column = columns_[i];
    // From above, the ground fills the slopes between its nearer and its farther rim.
    const double ground = column.ground - height;
    if (ground < 0.0) bands.fill(ground / nearer, ground / distance, [&] { return ground_radiance_[i]; });
    if (column.top > column.ground + low_m) {
      const double middle_height = 0.5 * (std::max<double>(column.bottom, column.ground) + column.top);
      const double low = (column.bottom - height) / distance, high = (column.top - height) / distance;
      const SurroundingCell& cell = cells_[i];
      // The lower and the upper half of a wall may lie in shadow and in light.
      const auto half = [&](double at_height) {
        const bool faces = glm::dot(cell.wall_normal, along) < 0.0 || cell.wall_normal == dvec2(0.0);
        return faces ? wall_radiance(cell, at_height) : dvec3(0.0);
      };
      bands.fill(low, (middle_height - height) / distance,
                 [&] { return half(0.5 * (cell.bottom + middle_height)); });
      bands.fill((middle_height - height) / distance, high,
                 [&] { return half(0.5 * (middle_height + cell.top)); });
      if (high < 0.0)
        bands.fill(high, (cell.top - height) / (distance * 1.2 + 0.1), [&] { return top_radiance_[i]; });
    }
    // What comes farther on is below the horizon, or below the slope of the highest top at this distance.
    if (bands.full_below(std::max(most_top_ - height, 0.0) / distance)) break;
    nearer = distance;
  }
}

BouncedLight Surroundings::gather(const dvec2& place, double height) const {
  return gather_with(GatherLooks(field_->cell_m), place, height);
}

template <typename Looks>
BouncedLight Surroundings::gather_with(const Looks& looks, const dvec2& place, double height) const {
  static const BandDirections directions;
  const dvec3 beyond = weighted(light_.beyond);
  BouncedLight result;
  const dvec2 middle = (place - field_->corner) / field_->cell_m;
  for (int k = 0; k < gather_azimuths; ++k) {
    Bands bands;
    look_along(middle, height, looks, k, bands);
    for (int i = 0; i < gather_bands; ++i) {
      if (!bands.filled(i) && directions.sine[i] > 0.0) continue;
      const dvec3& light = bands.filled(i) ? bands.light(i) : beyond;
      const dvec3 direction(looks.along[k] * directions.level[i], directions.sine[i]);
      result.constant += light;
      for (int axis = 0; axis < 3; ++axis) result.along[axis] += light * (2.0 * direction[axis]);
    }
  }
  return result;
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

std::vector<uint32_t> Surroundings::words() const {
  const auto halves = [](double low, double high) {
    return glm::packHalf2x16(vec2(float(low), float(high)));
  };
  shared::SurroundingsHeader header{};
  header.corner = vec2(field_->corner);
  header.cell_m = float(field_->cell_m);
  header.inverse_cell = float(1.0 / field_->cell_m);
  header.floor = float(field_->floor);
  header.step_m = float(1.5 * field_->cell_m);
  header.columns = field_->width;
  header.rows = field_->height;
  header.place_columns = std::max(2u, field_->width / shared::surroundings_place_cells);
  header.place_rows = std::max(2u, field_->height / shared::surroundings_place_cells);
  const auto cells = static_cast<uint32_t>(cells_.size());
  header.first_color = shared::surroundings_header_pairs + cells;
  header.first_place = header.first_color + shared::surroundings_color_pairs * cells;
  header.most_top = most_top_;
  header.key_direction = vec3(light_.key_direction);
  header.key_over_pi = vec3(light_.key_lux / pi);
  header.wall_sky = vec3(light_.sky_lux * (0.5 * wall_sky_share / pi));
  header.beyond = vec3(light_.beyond);
  std::vector<uint32_t> words(2 * shared::surroundings_header_pairs);
  std::memcpy(words.data(), &header, sizeof header);

  std::vector<uint32_t> leaps(cells_.size());
  for (uint32_t octant = 0; octant < 8; ++octant) {
    const std::vector<uint16_t> free = free_cells(octant);
    for (size_t i = 0; i < cells_.size(); ++i) leaps[i] |= stored_leap(free[i]) << 4 * octant;
  }
  for (size_t i = 0; i < cells_.size(); ++i) {
    words.push_back(halves(cells_[i].top, cells_[i].bottom));
    words.push_back(leaps[i]);
  }
  for (size_t i = 0; i < cells_.size(); ++i) {
    const SurroundingCell& cell = cells_[i];
    words.push_back(stored_radiance(top_radiance_[i]));
    uint32_t wall = 0;
    for (int c = 0; c < 3; ++c)
      wall |= static_cast<uint32_t>(std::lround(255.0 * std::clamp(cell.wall_albedo[c], 0.0, 1.0))) << 8 * c;
    words.push_back(wall);
    const vec4 normal(0.0f, 0.0f, vec2(cell.wall_normal));
    words.push_back((glm::packHalf1x16(cell.shadow) & 0xffffu) | glm::packSnorm4x8(normal));
    words.push_back(0);
  }
  put_places(words, header.place_columns, header.place_rows);
  return words;
}

namespace {

/// Bounced light at the two heights over a place.
struct BouncedPlace {
  BouncedLight low, high;
  float ground = 0.0f;
  bool free = true;  ///< not within a house
};

void add_scaled(BouncedLight& sum, const BouncedLight& light, double factor) {
  sum.constant += light.constant * factor;
  for (int axis = 0; axis < 3; ++axis) sum.along[axis] += light.along[axis] * factor;
}

/// Gives the places within houses that touch others the mean of their neighbours' light.
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
      BouncedPlace mean;
      for (const BouncedPlace* other : near) {
        add_scaled(mean.low, other->low, 1.0 / double(near.size()));
        add_scaled(mean.high, other->high, 1.0 / double(near.size()));
        mean.ground += other->ground / float(near.size());
      }
      places[size_t{row} * columns + column] = mean;
    }
}

/// The three signed bytes of a luminance's vector.
uint32_t stored_vector(const BouncedLight& light) {
  const double c = std::max(luminance(light.constant), 1e-30);
  vec4 part(0.0f);
  for (int axis = 0; axis < 3; ++axis)
    part[axis] = float(luminance(light.along[axis]) / (double(shared::surroundings_vector_scale) * c));
  return glm::packSnorm4x8(part);  // clamps
}

void put_place(std::vector<uint32_t>& words, const BouncedPlace& place) {
  const dvec3 sum = place.low.constant + place.high.constant;
  const double y = luminance(sum);
  const double red = y > 0.0 ? sum.r / y : 1.0, blue = y > 0.0 ? sum.b / y : 1.0;
  const dvec2 root =
      glm::sqrt(glm::max(dvec2(red, blue), dvec2(0.0))) / double(shared::surroundings_color_scale);
  const uint32_t color = glm::packUnorm4x8(vec4(0.0f, 0.0f, vec2(root)));  // clamps
  words.push_back((glm::packHalf1x16(float(luminance(place.low.constant))) & 0xffffu) | color);
  words.push_back(stored_vector(place.low));
  words.push_back(glm::packHalf2x16(vec2(float(luminance(place.high.constant)), place.ground)));
  words.push_back(stored_vector(place.high));
}

}  // namespace

void Surroundings::put_places(std::vector<uint32_t>& words, uint32_t columns, uint32_t rows) const {
  std::vector<BouncedPlace> places(size_t{columns} * rows);
  const GatherLooks looks(field_->cell_m);
  parallel_for(rows, 0, [&](size_t row) {
    for (uint32_t column = 0; column < columns; ++column) {
      const dvec2 at = (dvec2(column, double(row)) + 0.5) * double(shared::surroundings_place_cells);
      const size_t i = std::min(static_cast<uint32_t>(at.y), field_->height - 1) * size_t{field_->width} +
                       std::min(static_cast<uint32_t>(at.x), field_->width - 1);
      BouncedPlace& place = places[row * columns + column];
      place.ground = cells_[i].ground;
      place.free = !cells_[i].stands() || cells_[i].bottom > cells_[i].ground;
      if (!place.free) continue;
      const dvec2 middle = field_->corner + at * field_->cell_m;
      place.low = gather_with(looks, middle, place.ground + double(shared::surroundings_low));
      place.high = gather_with(looks, middle, place.ground + double(shared::surroundings_high));
    }
  });
  // Surfaces at the rim of a house look up places behind it, too.
  for (int round = 0; round < 3; ++round) fill_from_neighbours(places, columns, rows);
  for (const BouncedPlace& place : places) put_place(words, place);
}

}  // namespace greatx::render
