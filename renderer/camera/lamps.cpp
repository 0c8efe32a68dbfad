// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/camera/lamps.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "shaders/shared/camera.h"

namespace greatx::render {

namespace {

/// Holds the place and the reach of a lamp in the view: right, down, forward from the eye.
struct Ball {
  dvec3 center{0.0};
  double radius = 0.0;
};

struct Grid {
  uint32_t columns = 0, rows = 0;
  double across = 0.0, down = 0.0;  ///< tiles over the picture, fractions included
  uint32_t index(uint32_t column, uint32_t row, uint32_t slice) const {
    return (slice * rows + row) * columns + column;
  }
  size_t size() const { return size_t{columns} * rows * shared::lamp_slices; }
};

/// The planar depths between which a slice lies. The first begins at the eye, and the last has no end.
double slice_begin(uint32_t slice) {
  if (slice == 0) return 0.0;
  return std::exp2((slice - double(shared::lamp_slice_of_1m)) / double(shared::lamp_slices_per_octave));
}
double slice_end(uint32_t slice) {
  return slice + 1 == shared::lamp_slices ? std::numeric_limits<double>::infinity() : slice_begin(slice + 1);
}

/// Returns the smallest ball around the part that a lamp lights: around the cone if it is narrow, else around
/// its cap.
Ball ball_of(const scene::PunctualLight& light, const dvec3& position, const dvec3& direction) {
  const double reach = lamp_reach(light), half = light.outer_cone;
  if (light.type != scene::PunctualLight::Type::spot || half >= 0.5 * 3.14159265358979323846)
    return {position, reach};
  const double cosine = std::cos(half);
  if (half < 0.25 * 3.14159265358979323846)
    return {position + direction * (0.5 * reach / cosine), 0.5 * reach / cosine};
  return {position + direction * (reach * cosine), reach * std::sin(half)};
}

/// Holds the first and last tile along one axis of the points within `reach` of `offset` between two depths.
/// It is empty if last < first.
struct Span {
  int64_t first = 0, last = -1;
};
Span tiles_of(double offset, double reach, double near, double far, double scale, double shift, double tiles,
              uint32_t count) {
  // (offset / depth) scale + shift is the place over the picture's width. The extremes are at the ends of the
  // slice.
  const auto place = [&](double side, double depth) {
    const double quotient = depth > 0.0 ? side / depth : side * std::numeric_limits<double>::infinity();
    return std::isnan(quotient) ? 0.0 : quotient;
  };
  const double low = std::min(place(offset - reach, near), place(offset - reach, far));
  const double high = std::max(place(offset + reach, near), place(offset + reach, far));
  const double first = std::floor((low * scale + shift) * tiles),
               last = std::floor((high * scale + shift) * tiles);
  if (last < 0.0 || first >= count) return {};
  return {static_cast<int64_t>(std::max(first, 0.0)), static_cast<int64_t>(std::min(last, count - 1.0))};
}

class Clusters {
 public:
  explicit Clusters(const CameraView& view) : view_(view) {
    grid_.across = double(view.pinhole.width) / shared::lamp_tile_pixels;
    grid_.down = double(view.pinhole.height) / shared::lamp_tile_pixels;
    grid_.columns = static_cast<uint32_t>(std::ceil(grid_.across));
    grid_.rows = static_cast<uint32_t>(std::ceil(grid_.down));
    lists_.resize(grid_.size());
  }
  const Grid& grid() const { return grid_; }
  const std::vector<std::vector<uint32_t>>& lists() const { return lists_; }

  /// Adds a lamp to the clusters that a ball around the eye's axes meets. Returns false if there is none.
  bool add(uint32_t lamp, const Ball& ball) {
    bool any = false;
    const PinholeView& pinhole = view_.pinhole;
    for (uint32_t slice = 0; slice < shared::lamp_slices; ++slice) {
      const double near = std::max(slice_begin(slice), ball.center.z - ball.radius);
      const double far = std::min(slice_end(slice), ball.center.z + ball.radius);
      if (near > far || far <= 0.0) continue;
      const double away = std::max({near - ball.center.z, ball.center.z - far, 0.0});
      // The reach is taken a little larger, for the rounding of the shader.
      const double reach = std::sqrt(std::max(ball.radius * ball.radius - away * away, 0.0)) + 1e-3;
      const Span columns =
          tiles_of(ball.center.x, reach, std::max(near, 0.0), far, pinhole.fx / pinhole.width,
                   pinhole.cx / pinhole.width, grid_.across, grid_.columns);
      const Span rows = tiles_of(ball.center.y, reach, std::max(near, 0.0), far, pinhole.fy / pinhole.height,
                                 pinhole.cy / pinhole.height, grid_.down, grid_.rows);
      for (int64_t row = rows.first; row <= rows.last; ++row)
        for (int64_t column = columns.first; column <= columns.last; ++column) {
          lists_[grid_.index(static_cast<uint32_t>(column), static_cast<uint32_t>(row), slice)].push_back(
              lamp);
          any = true;
        }
    }
    return any;
  }
  /// Returns the lamps of each column of clusters, the brightest first and most_halos at most. `brightness`
  /// is by lamp.
  std::vector<std::vector<uint32_t>> columns(std::span<const double> brightness) const {
    std::vector<std::vector<uint32_t>> result(size_t{grid_.columns} * grid_.rows);
    for (size_t i = 0; i < result.size(); ++i) {
      std::vector<uint32_t>& all = result[i];
      for (size_t at = i; at < lists_.size(); at += result.size())
        all.insert(all.end(), lists_[at].begin(), lists_[at].end());
      std::ranges::sort(all);
      all.erase(std::unique(all.begin(), all.end()), all.end());
      std::erase_if(all, [&](uint32_t lamp) { return brightness[lamp] <= 0.0; });
      std::ranges::stable_sort(all, [&](uint32_t a, uint32_t b) { return brightness[a] > brightness[b]; });
      all.resize(std::min<size_t>(all.size(), shared::most_halos));
      std::ranges::sort(all);  // a sum in one order, so that neighbours agree to the last bit
    }
    return result;
  }
  void add_everywhere(uint32_t lamp) {
    for (std::vector<uint32_t>& list : lists_) list.push_back(lamp);
  }

 private:
  const CameraView& view_;
  Grid grid_;
  std::vector<std::vector<uint32_t>> lists_;
};

void put_lamp(std::vector<uint32_t>& words, const scene::PunctualLight& light, const vec3& position,
              const vec3& direction, const Pose& body, const LampTile& tile, const BeamTile* beam) {
  const bool directional = light.type == scene::PunctualLight::Type::directional;
  float scale = 0.0f, offset = 1.0f;
  if (light.type == scene::PunctualLight::Type::spot) {
    // The angles are those of KHR_lights_punctual, "Inner and Outer Cone Angles".
    const double inner = std::cos(double(light.inner_cone)), outer = std::cos(double(light.outer_cone));
    scale = float(1.0 / std::max(0.001, inner - outer));
    offset = float(-outer) * scale;
  }
  // A lamp without a range gets the window of its reach, so that the light does not jump at the rim of its
  // clusters.
  const double reach = lamp_reach(light);
  const float window = directional ? -1.0f : float(1.0 / std::max(reach * reach, 1e-12));
  vec4 last(vec3(tile.across), std::bit_cast<float>(glm::packUnorm2x16(vec2(tile.center))));
  const bool passing = light.beam == scene::PunctualLight::Beam::passing;
  if (passing || beam != nullptr)
    last = vec4(vec3(beam_axes(light, body).up),
                std::bit_cast<float>(passing ? shared::lamp_of_beam : shared::lamp_of_cone));
  vec4 moving(0.0f);
  if (beam != nullptr)
    moving = vec4(std::bit_cast<float>(glm::packUnorm2x16(vec2(beam->center))), vec2(beam->scale),
                  float(beam->strength));
  for (const vec4& quad : {vec4(directional ? -direction : position, window), vec4(direction, scale),
                           vec4(light.color * light.intensity, offset), last, moving})
    for (int i = 0; i < 4; ++i) words.push_back(std::bit_cast<uint32_t>(quad[i]));
}

}  // namespace

std::vector<uint32_t> cluster_lamps(const CameraView& view, std::span<const scene::PunctualLight> lights,
                                    std::span<const Pose> body_poses, LampCounts& counts,
                                    std::span<const LampTile> tiles, bool halos,
                                    std::span<const BeamTile> beams) {
  Clusters clusters(view);
  std::vector<uint32_t> lamps;     // records of the seen lamps; clusters name them by number
  std::vector<double> brightness;  // of their halos, about
  counts = {};
  for (size_t i = 0; i < lights.size(); ++i) {
    const scene::PunctualLight& light = lights[i];
    const Pose& pose = body_poses[light.body];
    const dvec3 position = pose.apply(light.position) - view.eye;
    const dvec3 direction = glm::normalize(pose.rotate(light.direction));
    const uint32_t record = counts.seen;
    if (light.type == scene::PunctualLight::Type::directional) {
      clusters.add_everywhere(record);
    } else {
      Ball ball = ball_of(light, position, direction);
      if (view.outside(ball.center, ball.radius)) continue;
      ball.center = {glm::dot(view.right, ball.center), glm::dot(view.down, ball.center),
                     glm::dot(view.forward, ball.center)};
      if (!clusters.add(record, ball)) continue;
    }
    const auto beam = std::ranges::find(beams, i, &BeamTile::light);
    put_lamp(lamps, light, vec3(position), vec3(direction), pose, tiles.empty() ? LampTile{} : tiles[i],
             beam == beams.end() ? nullptr : &*beam);
    // Directional light scatters everywhere: it makes no halo.
    brightness.push_back(light.type == scene::PunctualLight::Type::directional
                             ? 0.0
                             : light.intensity / std::max(glm::length(position), 1.0));
    ++counts.seen;
  }
  const Grid& grid = clusters.grid();
  std::vector<uint32_t> words(shared::lamps_header_words + 2 * grid.size());
  words[shared::lamps_columns_word] = grid.columns;
  words[shared::lamps_rows_word] = grid.rows;
  words[shared::lamps_across_word] = std::bit_cast<uint32_t>(float(grid.across));
  words[shared::lamps_down_word] = std::bit_cast<uint32_t>(float(grid.down));
  words[shared::lamps_last_column_word] = std::bit_cast<uint32_t>(float(grid.columns - 1));
  words[shared::lamps_last_row_word] = std::bit_cast<uint32_t>(float(grid.rows - 1));
  const std::vector<std::vector<uint32_t>> columns =
      halos ? clusters.columns(brightness) : std::vector<std::vector<uint32_t>>{};
  size_t entries = 0, in_air = 2 * columns.size();
  for (const std::vector<uint32_t>& list : columns) in_air += list.size();
  for (const std::vector<uint32_t>& list : clusters.lists()) entries += list.size();
  counts.entries = static_cast<uint32_t>(entries);
  const size_t first_lamp = (words.size() + entries + in_air + 3) / 4;  // quadruples
  words.reserve(4 * first_lamp + lamps.size());
  for (size_t i = 0; i < grid.size(); ++i) {
    const std::vector<uint32_t>& list = clusters.lists()[i];
    words[shared::lamps_header_words + 2 * i] = static_cast<uint32_t>(words.size());
    words[shared::lamps_header_words + 2 * i + 1] = static_cast<uint32_t>(list.size());
    for (const uint32_t lamp : list)
      words.push_back(static_cast<uint32_t>(first_lamp + shared::lamp_record_quads * lamp));
  }
  const size_t first_column = words.size();
  words[shared::lamps_halos_word] = static_cast<uint32_t>(first_column);
  words.resize(first_column + 2 * columns.size());
  for (size_t i = 0; i < columns.size(); ++i) {
    words[first_column + 2 * i] = static_cast<uint32_t>(words.size());
    words[first_column + 2 * i + 1] = static_cast<uint32_t>(columns[i].size());
    for (const uint32_t lamp : columns[i])
      words.push_back(static_cast<uint32_t>(first_lamp + shared::lamp_record_quads * lamp));
  }
  words.resize(4 * first_lamp);
  words.insert(words.end(), lamps.begin(), lamps.end());
  return words;
}

}  // namespace greatx::render
