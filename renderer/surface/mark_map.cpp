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
/// Both sides of the map are multiples of 2^levels, so that every level covers the same ground exactly.
constexpr uint32_t levels = shared::marks_levels;
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

void add_triangle(MarkShares& map, const std::array<dvec3, 3>& corners) {
  Polygon triangle;
  for (const dvec3& corner : corners) triangle.push_back((dvec2(corner) - map.corner) / map.texel_m);
  dvec2 low(triangle[0]), high(triangle[0]);
  for (const dvec2& p : triangle) low = glm::min(low, p), high = glm::max(high, p);
  const auto last_row = std::min<int64_t>(int64_t(std::floor(high.y)), int64_t(map.height) - 1);
  for (int64_t row = std::max<int64_t>(int64_t(std::floor(low.y)), 0); row <= last_row; ++row) {
    // Cuts a row out of the triangle, and then the row into texels.
    Polygon strip = triangle;
    cut(strip, 1, double(row), -1.0);
    cut(strip, 1, double(row + 1), 1.0);
    if (strip.size() < 3) continue;
    double left = strip[0].x, right = strip[0].x;
    for (const dvec2& p : strip) left = std::min(left, p.x), right = std::max(right, p.x);
    const auto last = std::min<int64_t>(int64_t(std::floor(right)), int64_t(map.width) - 1);
    for (int64_t column = std::max<int64_t>(int64_t(std::floor(left)), 0); column <= last; ++column) {
      Polygon texel = strip;
      cut(texel, 0, double(column), -1.0);
      cut(texel, 0, double(column + 1), 1.0);
      map.shares[size_t(row) * map.width + size_t(column)] += float(area_of(texel));
    }
  }
}

/// Returns the levels of half the size each as bytes. Sums are kept in floats, so that a thin line keeps its
/// share down to the step of a byte.
std::vector<std::vector<std::byte>> levels_of(const MarkShares& map) {
  std::vector<std::vector<std::byte>> all;
  std::vector<float> shares = map.shares;
  for (uint32_t width = map.width, height = map.height;;) {
    std::vector<std::byte>& bytes = all.emplace_back();
    bytes.reserve(shares.size());
    for (const float share : shares) bytes.push_back(std::byte(uint8_t(std::lround(255.0f * share))));
    if (all.size() > levels || width % 2 != 0 || height % 2 != 0) return all;
    std::vector<float> half(shares.size() / 4);
    for (uint32_t row = 0; row < height / 2; ++row)
      for (uint32_t column = 0; column < width / 2; ++column) {
        const float* at = &shares[size_t{2} * row * width + 2 * column];
        half[size_t{row} * (width / 2) + column] = 0.25f * (at[0] + at[1] + at[width] + at[width + 1]);
      }
    shares.swap(half);
    width /= 2;
    height /= 2;
  }
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
  const dvec2 size = map.texel_m * dvec2(map.width, map.height);
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
  if (bounds.empty()) {
    map.shares = {0.0f};
    return map;
  }
  const dvec2 size(bounds.size());
  // An empty texel of the last level surrounds the map, so that places beyond it have no markings.
  constexpr uint32_t rim = 1u << levels;
  map.texel_m = std::max(least_texel_m, std::max(size.x, size.y) / (most - 3.0 * rim));
  map.corner = dvec2(bounds.min) - double(rim) * map.texel_m;
  const auto texels = [&](double length) {
    return (static_cast<uint32_t>(std::ceil(length / map.texel_m)) / rim + 3) * rim;
  };
  map.width = texels(size.x);
  map.height = texels(size.y);
  map.shares.assign(size_t{map.width} * map.height, 0.0f);
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
  shares.shares = {0.0f};
  if (wanted) shares = mark_shares(scene.scene());
  any_ = shares.shares.size() > 1;
  const std::vector<std::vector<std::byte>> bytes = levels_of(shares);
  map_ = gpu::Image(device,
                    {.format = VK_FORMAT_R8_UNORM,
                     .width = shares.width,
                     .height = shares.height,
                     .mip_levels = static_cast<uint32_t>(bytes.size()),
                     .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT},
                    "map of markings");
  std::vector<std::span<const std::byte>> mips(bytes.begin(), bytes.end());
  gpu::upload_image(device, map_, mips);
  sampler_ = gpu::Sampler(device, {.linear = true, .repeat_u = false, .repeat_v = false, .mipmaps = true},
                          "map of markings");
  const shared::GpuMarks marks = describe(scene, shares);
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
