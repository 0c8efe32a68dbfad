// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/surface/mark_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "renderer/surface/material_color.h"
#include "shaders/shared/camera.h"

namespace greatx::render {

namespace {

constexpr double least_texel_m = 0.06;
constexpr uint32_t block_side = MarkShares::side;
constexpr double flat = 0.7;  ///< least cosine of a marking's slope

using Polygon = std::vector<dvec2>;

/// Cuts off the part of a convex polygon beyond `limit` along an axis (`side` -1: below it).
void cut(Polygon& polygon, int axis, double limit, double side) {
  Polygon kept;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const dvec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    const double at_a = side * (a[axis] - limit), at_b = side * (b[axis] - limit);
    if (at_a <= 0.0) kept.push_back(a);
    if ((at_a < 0.0 && at_b > 0.0) || (at_a > 0.0 && at_b < 0.0))
      kept.push_back(a + (b - a) * (at_a / (at_a - at_b)));
  }
  polygon = std::move(kept);
}

double area_of(const Polygon& polygon) {
  double twice = 0.0;
  for (size_t i = 1; i + 1 < polygon.size(); ++i) {
    const dvec2 a = polygon[i] - polygon[0], b = polygon[i + 1] - polygon[0];
    twice += a.x * b.y - a.y * b.x;
  }
  return 0.5 * std::abs(twice);
}

/// Calls visit(primitive, corners) for every static triangle of roads and markings.
template <typename F>
void over_roads(const scene::Scene& scene, F&& visit) {
  const scene::Body& world = scene.bodies[0];
  for (uint32_t i = world.first_primitive; i < world.first_primitive + world.primitive_count; ++i) {
    const scene::Primitive& primitive = scene.primitives[i];
    const uint32_t kind = marks_of(scene, primitive);
    if (kind == 0) continue;
    for (uint32_t k = 0; k < primitive.index_count; k += 3) {
      std::array<dvec3, 3> corners;
      for (uint32_t c = 0; c < 3; ++c)
        corners[c] = dvec3(scene.positions[scene.indices[primitive.first_index + k + c]]);
      visit(kind, primitive, corners);
    }
  }
}

float& texel_at(MarkShares& map, uint32_t column, uint32_t row) {
  uint32_t& place = map.places[size_t{row / block_side} * map.columns + column / block_side];
  if (place == 0) {
    map.shares.resize(map.shares.size() + size_t{block_side} * block_side, 0.0f);
    place = static_cast<uint32_t>(map.shares.size() / (size_t{block_side} * block_side));
  }
  return map.shares[(size_t{place - 1} * block_side + row % block_side) * block_side + column % block_side];
}

void add_triangle(MarkShares& map, const std::array<dvec3, 3>& corners) {
  Polygon triangle;
  for (const dvec3& corner : corners) triangle.push_back((dvec2(corner) - map.corner) / map.texel_m);
  dvec2 low(triangle[0]), high(triangle[0]);
  for (const dvec2& p : triangle) low = glm::min(low, p), high = glm::max(high, p);
  const auto last_row = std::min<int64_t>(int64_t(std::floor(high.y)), int64_t(map.rows) * block_side - 1);
  for (int64_t row = std::max<int64_t>(int64_t(std::floor(low.y)), 0); row <= last_row; ++row) {
    // Cuts a row out of the triangle, and then the row into texels.
    Polygon strip = triangle;
    cut(strip, 1, double(row), -1.0);
    cut(strip, 1, double(row + 1), 1.0);
    if (strip.size() < 3) continue;
    double left = strip[0].x, right = strip[0].x;
    for (const dvec2& p : strip) left = std::min(left, p.x), right = std::max(right, p.x);
    const auto last = std::min<int64_t>(int64_t(std::floor(right)), int64_t(map.columns) * block_side - 1);
    for (int64_t column = std::max<int64_t>(int64_t(std::floor(left)), 0); column <= last; ++column) {
      Polygon texel = strip;
      cut(texel, 0, double(column), -1.0);
      cut(texel, 0, double(column + 1), 1.0);
      texel_at(map, uint32_t(column), uint32_t(row)) += float(area_of(texel));
    }
  }
}

/// Returns the levels of half the size each as bytes. A block ends as one texel of the last level, so every
/// level covers the same ground exactly. Sums are kept in floats, so that a thin line keeps its share down to
/// the step of a byte.
std::vector<std::vector<std::byte>> levels_of(const MarkShares& map) {
  std::vector<std::vector<std::byte>> all(shared::marks_levels + 1);
  for (uint32_t level = 0; level < all.size(); ++level)
    all[level].resize(size_t{map.rows} * map.columns * (block_side >> level) * (block_side >> level));
  std::vector<float> block;
  for (uint32_t place = 0; place < map.places.size(); ++place) {
    if (map.places[place] == 0) continue;
    const auto from =
        map.shares.begin() + std::ptrdiff_t(size_t{map.places[place] - 1} * block_side * block_side);
    block.assign(from, from + block_side * block_side);
    for (uint32_t level = 0, edge = block_side; level < all.size(); ++level, edge /= 2) {
      const size_t width = size_t{map.columns} * edge;
      const size_t first = place / map.columns * edge * width + place % map.columns * edge;
      for (uint32_t row = 0; row < edge; ++row)
        for (uint32_t column = 0; column < edge; ++column)
          all[level][first + row * width + column] =
              std::byte(uint8_t(std::lround(255.0f * block[size_t{row} * edge + column])));
      for (uint32_t row = 0; row < edge / 2; ++row)
        for (uint32_t column = 0; column < edge / 2; ++column) {
          const float* at = &block[size_t{2} * row * edge + 2 * column];
          // The sum goes to a place whose own value has already been added up.
          block[size_t{row} * (edge / 2) + column] = 0.25f * (at[0] + at[1] + at[edge] + at[edge + 1]);
        }
    }
  }
  return all;
}

/// Sums up colours by area.
struct MeanColor {
  dvec3 sum{0.0};
  double rough = 0.0, area = 0.0;
  void add(const dvec3& color, double roughness, double by) {
    sum += by * color;
    rough += by * roughness;
    area += by;
  }
  vec3 color() const { return area > 0.0 ? vec3(sum / area) : vec3(0.0f); }
  float roughness() const { return area > 0.0 ? float(rough / area) : 1.0f; }
};

shared::GpuMarks describe(const scene::GpuScene& gpu_scene, const MarkShares& map) {
  const scene::Scene& scene = gpu_scene.scene();
  MeanColor mark, road;
  std::vector<std::optional<dvec3>> colors(scene.materials.size());
  over_roads(scene, [&](uint32_t kind, const scene::Primitive& primitive, const std::array<dvec3, 3>& p) {
    const double area = glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
    std::optional<dvec3>& color = colors[primitive.material];
    if (!color) color = mean_color(scene, primitive.material);
    (kind == shared::triangle_of_mark ? mark : road)
        .add(*color, double(scene.materials[primitive.material].pbr.roughness), area);
  });
  shared::GpuMarks marks{};
  const dvec2 size = map.texel_m * double(block_side) * dvec2(map.columns, map.rows);
  marks.scale = vec2(1.0 / size);
  marks.offset = vec2(-map.corner / size);
  marks.mark = mark.color();
  marks.road = road.color();
  marks.mark_rough = mark.roughness();
  marks.road_rough = road.roughness();
  marks.texel_m = float(map.texel_m);
  return marks;
}

}  // namespace

uint32_t marks_of(const scene::Scene& scene, const scene::Primitive& primitive) {
  const scene::Instance& instance = scene.instances[primitive.instance];
  if (instance.body != 0) return 0;
  if (instance.semantic_class == scene::SemanticClass::road) return shared::triangle_of_road;
  return instance.semantic_class == scene::SemanticClass::lane_marking ? shared::triangle_of_mark : 0;
}

MarkShares mark_shares(const scene::Scene& scene, uint32_t most) {
  scene::Bounds bounds;
  over_roads(scene, [&](uint32_t kind, const scene::Primitive&, const std::array<dvec3, 3>& corners) {
    if (kind != shared::triangle_of_mark) return;
    for (const dvec3& corner : corners) bounds.add(corner);
  });
  MarkShares map;
  if (bounds.empty()) return map;
  const dvec2 size(bounds.size());
  // A block without markings surrounds the map, so that places beyond it have none.
  map.texel_m = std::max(least_texel_m, std::max(size.x, size.y) / (most - 3.0 * block_side));
  map.corner = dvec2(bounds.min) - double(block_side) * map.texel_m;
  const auto blocks = [&](double length) {
    return static_cast<uint32_t>(std::ceil(length / map.texel_m)) / block_side + 3;
  };
  map.columns = blocks(size.x);
  map.rows = blocks(size.y);
  map.places.assign(size_t{map.columns} * map.rows, 0u);
  over_roads(scene, [&](uint32_t kind, const scene::Primitive&, const std::array<dvec3, 3>& p) {
    const dvec3 normal = glm::cross(p[1] - p[0], p[2] - p[0]);
    if (kind == shared::triangle_of_mark && std::abs(normal.z) > flat * glm::length(normal))
      add_triangle(map, p);
  });
  for (float& share : map.shares) share = std::min(share, 1.0f);
  return map;
}

MarkMap::MarkMap(const scene::GpuScene& scene, bool wanted) {
  gpu::Device& device = scene.device();
  MarkShares shares;
  if (wanted) shares = mark_shares(scene.scene());
  any_ = !shares.places.empty();
  std::vector<std::vector<std::byte>> bytes{{std::byte{0}}};
  if (any_) bytes = levels_of(shares);
  map_ = gpu::Image(device,
                    {.format = VK_FORMAT_R8_UNORM,
                     .width = any_ ? block_side * shares.columns : 1,
                     .height = any_ ? block_side * shares.rows : 1,
                     .mip_levels = static_cast<uint32_t>(bytes.size()),
                     .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT},
                    "map of markings");
  std::vector<std::span<const std::byte>> mips(bytes.begin(), bytes.end());
  gpu::upload_image(device, map_, mips);
  sampler_ = gpu::Sampler(device, {.linear = true, .repeat_u = false, .repeat_v = false, .mipmaps = true},
                          "map of markings");
  const shared::GpuMarks marks = any_ ? describe(scene, shares) : shared::GpuMarks{};
  block_ = gpu::upload_buffer(device, std::as_bytes(std::span(&marks, 1)), "markings",
                              VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
}

std::vector<gpu::Binding> MarkMap::bindings() {
  return {{shared::marks_binding, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
          {shared::mark_map_binding, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}};
}

std::vector<gpu::Descriptor> MarkMap::descriptors() const {
  gpu::Descriptor block = gpu::Descriptor::buffer(shared::marks_binding, block_);
  block.type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
  return {block, gpu::Descriptor::sampled(shared::mark_map_binding, map_, sampler_)};
}

}  // namespace greatx::render
