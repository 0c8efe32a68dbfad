// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/suite_scene.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <fmt/format.h>

#include "core/error.h"
#include "core/random.h"
#include "core/units.h"

namespace greatx::apps {

namespace {

constexpr uint64_t suite_seed = 20;
constexpr uint64_t box_triangles = 12;
/// Base of the estimate: the program, the driver, and the buffers that do not grow with the scene.
constexpr uint64_t base_bytes = uint64_t{400} << 20;

/// Appends faces to a scene, one facet each.
class SuiteBuilder {
 public:
  explicit SuiteBuilder(uint64_t triangles) {
    const size_t corners = triangles + triangles / 2 * 3;
    scene_.positions.reserve(corners);
    scene_.normals.reserve(corners);
    scene_.tangents.reserve(corners);
    scene_.uvs.reserve(corners);
    scene_.indices.reserve(3 * triangles);
    scene_.facets.reserve(triangles / 2 + 1);
    scene_.facet_triangles.reserve(triangles);
    scene_.facet_of_triangle.reserve(triangles);
    for (const auto& [name, medium, color] : {std::tuple{"ground", "concrete", vec3(0.30f, 0.32f, 0.28f)},
                                              {"wall", "concrete", vec3(0.62f, 0.55f, 0.48f)},
                                              {"paint", "metal", vec3(0.20f, 0.35f, 0.65f)}}) {
      scene::Material material;
      material.name = name;
      material.pbr.base_color = vec4(color, 1.0f);
      material.radio.emplace().layers.push_back({*scene::itu_medium(medium), 0.0});
      scene_.materials.push_back(material);
    }
  }

  void begin_body(std::string name) {
    scene::Body body;
    body.name = std::move(name);
    body.first_primitive = static_cast<uint32_t>(scene_.primitives.size());
    scene_.bodies.push_back(body);
  }
  void begin_object(std::string name, scene::SemanticClass semantic_class, uint32_t material) {
    scene::Instance instance;
    instance.name = std::move(name);
    instance.semantic_class = semantic_class;
    instance.body = static_cast<uint32_t>(scene_.bodies.size() - 1);
    scene_.primitives.push_back({static_cast<uint32_t>(scene_.indices.size()), 0, material,
                                 static_cast<uint32_t>(scene_.instances.size())});
    scene_.instances.push_back(instance);
    ++scene_.bodies.back().primitive_count;
  }
  /// Adds a convex polygon of three or four corners, counter-clockwise as seen from its front.
  void face(std::initializer_list<dvec3> corners) {
    const dvec3* const c = corners.begin();
    scene::Primitive& primitive = scene_.primitives.back();
    scene::Facet facet;
    facet.normal = glm::normalize(glm::cross(c[1] - c[0], c[2] - c[0]));
    facet.offset = glm::dot(facet.normal, c[0]);
    facet.body = scene_.instances.back().body;
    facet.material = primitive.material;
    facet.instance = primitive.instance;
    facet.first_triangle = static_cast<uint32_t>(scene_.facet_triangles.size());
    facet.triangle_count = static_cast<uint32_t>(corners.size() - 2);
    const auto first = static_cast<uint32_t>(scene_.positions.size());
    const vec2 uvs[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (size_t i = 0; i < corners.size(); ++i) {
      scene_.positions.push_back(vec3(c[i]));
      scene_.normals.push_back(vec3(facet.normal));
      scene_.tangents.push_back(vec4(0.0f));
      scene_.uvs.push_back(uvs[i]);
      scene_.instances.back().bounds.add(c[i]);
      scene_.bodies.back().bounds.add(c[i]);
    }
    for (uint32_t t = 0; t < facet.triangle_count; ++t) {
      for (const uint32_t corner : {0u, t + 1, t + 2}) scene_.indices.push_back(first + corner);
      scene_.facet_triangles.push_back({{c[0], c[t + 1], c[t + 2]}});
      scene_.facet_of_triangle.push_back(static_cast<uint32_t>(scene_.facets.size()));
      primitive.index_count += 3;
    }
    scene_.facets.push_back(facet);
  }
  void box(const dvec3& low, const dvec3& high) {
    const auto p = [&](bool x, bool y, bool z) {
      return dvec3(x ? high.x : low.x, y ? high.y : low.y, z ? high.z : low.z);
    };
    face({p(0, 0, 0), p(0, 1, 0), p(1, 1, 0), p(1, 0, 0)});
    face({p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1)});
    face({p(0, 0, 0), p(1, 0, 0), p(1, 0, 1), p(0, 0, 1)});
    face({p(0, 1, 0), p(0, 1, 1), p(1, 1, 1), p(1, 1, 0)});
    face({p(0, 0, 0), p(0, 0, 1), p(0, 1, 1), p(0, 1, 0)});
    face({p(1, 0, 0), p(1, 1, 0), p(1, 1, 1), p(1, 0, 1)});
  }
  void lamp(const scene::PunctualLight& light) { scene_.lights.push_back(light); }

  scene::Scene take(uint64_t boxes) {
    scene_.name = fmt::format("suite of {} boxes", boxes);
    scene_.hash = std::string(64, '0');  // nothing of the suite is cached by the scene's hash
    scene_.bounds = scene_.bodies[0].bounds;
    return std::move(scene_);
  }

 private:
  scene::Scene scene_;
};

/// Adds `triangles` triangles: rows of rectangles of level ground, and for an odd number a sign beside it.
void add_ground(SuiteBuilder& builder, uint64_t triangles, double side_m) {
  const uint64_t squares = triangles / 2;
  const auto columns = static_cast<uint64_t>(std::max(1.0, std::floor(std::sqrt(double(squares)))));
  const uint64_t rows = (squares + columns - 1) / columns;
  const double step_y = side_m / double(rows), low = -0.5 * side_m;
  builder.begin_object("ground", scene::SemanticClass::ground, 0);
  for (uint64_t row = 0; row < rows; ++row) {
    const uint64_t in_row = std::min(columns, squares - row * columns);
    const double step_x = side_m / double(in_row);
    const double y0 = low + step_y * double(row), y1 = y0 + step_y;
    for (uint64_t i = 0; i < in_row; ++i) {
      const double x0 = low + step_x * double(i), x1 = x0 + step_x;
      builder.face({{x0, y0, 0}, {x1, y0, 0}, {x1, y1, 0}, {x0, y1, 0}});
    }
  }
  if (triangles % 2 == 1) builder.face({{low, low, 0}, {low, low, 1}, {low - 1, low, 0}});
}

/// Adds boxes in the cells of a square grid, row by row; each fills a part of its cell.
void add_boxes(SuiteBuilder& builder, uint64_t boxes, double side_m, double cell_m) {
  const auto across = static_cast<uint64_t>(std::ceil(std::sqrt(double(boxes))));
  RandomStream random(suite_seed, 1);
  // One object holds a row, so that the number of primitives, of which a raster pass draws one after the
  // other, grows with the square root of the boxes.
  for (uint64_t i = 0; i < boxes; ++i) {
    if (i % across == 0)
      builder.begin_object(fmt::format("row_{}", i / across), scene::SemanticClass::building, 1);
    const double half_x = 0.5 * cell_m * random.uniform(0.3, 0.7),
                 half_y = 0.5 * cell_m * random.uniform(0.3, 0.7), height = cell_m * random.uniform(0.3, 1.2),
                 x = -0.5 * side_m + cell_m * (double(i % across) + 0.5),
                 y = -0.5 * side_m + cell_m * (double(i / across) + 0.5);
    builder.box({x - half_x, y - half_y, 0.0}, {x + half_x, y + half_y, height});
  }
}

}  // namespace

SuiteScene make_suite_scene(const SuiteSceneSize& size) {
  GREATX_CHECK(size.triangles >= 100, "a suite scene of {} triangles", size.triangles);
  const uint64_t boxes = size.triangles * 9 / 10 / box_triangles,
                 ground = size.triangles - boxes * box_triangles;
  SuiteScene result;
  result.side_m = 250.0 * std::pow(double(size.triangles) / 1000.0, 0.25);
  result.cell_m = result.side_m / std::ceil(std::sqrt(double(boxes)));
  result.mast = {0.13 * result.cell_m, 0.07 * result.cell_m, 1.5 * result.cell_m};
  SuiteBuilder builder(size.triangles + box_triangles * size.bodies);
  builder.begin_body("static");
  add_ground(builder, ground, result.side_m);
  add_boxes(builder, boxes, result.side_m, result.cell_m);
  for (uint32_t body = 0; body < size.bodies; ++body) {
    builder.begin_body(fmt::format("body_{}", body));
    builder.begin_object(fmt::format("body_{}", body), scene::SemanticClass::vehicle, 2);
    builder.box({-2.0, -0.9, 0.0}, {2.0, 0.9, 1.5});
  }
  RandomStream random(suite_seed, 2);
  for (uint32_t i = 0; i < size.lamps; ++i) {
    scene::PunctualLight lamp;
    lamp.name = fmt::format("lamp_{}", i);
    const double reach = std::min(0.5 * result.side_m, 150.0);
    lamp.position = {random.uniform(-reach, reach), random.uniform(-reach, reach), 1.3 * result.cell_m};
    lamp.intensity = 800.0f;
    lamp.range_m = 30.0f;
    builder.lamp(lamp);
  }
  result.scene = builder.take(boxes);
  return result;
}

std::vector<Pose> suite_poses(const SuiteScene& scene, uint32_t round) {
  std::vector<Pose> poses(scene.scene.bodies.size());
  RandomStream random(suite_seed, 3);
  const double reach = std::min(0.45 * scene.side_m, 80.0);
  for (size_t body = 1; body < poses.size(); ++body) {
    const dvec3 place{random.uniform(-reach, reach), random.uniform(-reach, reach),
                      random.uniform(0.1, 1.2) * scene.cell_m};
    const double angle = 2.0 * pi * random.uniform() + 0.1 * round;
    poses[body].position = place + dvec3(3.0 * std::cos(angle), 3.0 * std::sin(angle), 0.0);
    poses[body].orientation = glm::angleAxis(angle, dvec3(0.0, 0.0, 1.0));
  }
  return poses;
}

uint64_t suite_bytes(uint64_t triangles, size_t tracers) {
  return base_bytes + triangles * (650 + 350 * uint64_t{tracers});
}

uint64_t suite_tick_bytes(uint64_t triangles) { return base_bytes + triangles * 2'400; }

}  // namespace greatx::apps
