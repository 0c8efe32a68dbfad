// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/plan/indoors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/srgb.h"
#include "core/units.h"
#include "renderer/light/lamp_shadow.h"
#include "renderer/light/sky.h"
#include "sim/plan/trajectory_bounds.h"

namespace greatx::sim {

namespace {

constexpr int directions = 512;

using Corners = std::array<dvec3, 3>;

std::vector<Corners> static_triangles(const scene::Scene& scene) {
  std::vector<Corners> triangles;
  const scene::Body& world = scene.bodies[0];
  for (uint32_t i = world.first_primitive; i < world.first_primitive + world.primitive_count; ++i) {
    const scene::Primitive& primitive = scene.primitives[i];
    const uint32_t* index = &scene.indices[primitive.first_index];
    for (uint32_t k = 0; k < primitive.index_count; k += 3)
      triangles.push_back({dvec3(scene.positions[index[k]]), dvec3(scene.positions[index[k + 1]]),
                           dvec3(scene.positions[index[k + 2]])});
  }
  return triangles;
}

/// Returns whether a ray meets a triangle (Moeller and Trumbore, 1997). Rays through an edge meet both sides.
bool meets(const dvec3& from, const dvec3& along, const Corners& corners) {
  const dvec3 a = corners[1] - corners[0], b = corners[2] - corners[0], p = glm::cross(along, b);
  const double det = glm::dot(a, p);
  if (std::abs(det) < 1e-15) return false;
  const dvec3 t = from - corners[0], q = glm::cross(t, a);
  const double u = glm::dot(t, p) / det, v = glm::dot(along, q) / det;
  constexpr double rim = 1e-9;
  return u >= -rim && v >= -rim && u + v <= 1.0 + rim && glm::dot(b, q) / det > 0.0;
}

bool is_closed(const dvec3& from, const std::vector<Corners>& triangles) {
  for (int i = 0; i < directions; ++i) {
    // A spiral over the sphere from straight up, since most places that are open are open above.
    const double z = 1.0 - (2.0 * i + 1.0) / directions, r = std::sqrt(1.0 - z * z), turn = 2.39996323 * i;
    const dvec3 along(r * std::cos(turn), r * std::sin(turn), z);
    bool met = false;
    for (size_t k = 0; k < triangles.size() && !met; ++k) met = meets(from, along, triangles[k]);
    if (!met) return false;
  }
  return true;
}

/// Returns about where a node's sensor stands, in local coordinates: the middle of the node's way, and the
/// sensor's height over it.
dvec3 place_of(const Scenario& scenario, const scene::Scene& scene, const NodeConfig& node,
               const SensorConfig& sensor) {
  scene::Bounds way;
  add_trajectory(scenario, node.trajectory, way);
  return way.center() + dvec3(0.0, 0.0, sensor.mount.position_m.z) - scene.origin;
}

/// Returns the mean luminance of a texture of colours, from every 13th texel.
double mean_of(const scene::Texture& texture) {
  double sum = 0.0;
  size_t count = 0;
  for (size_t i = 0; i + 3 < texture.rgba.size(); i += size_t{4} * 13, ++count) {
    dvec3 color;
    for (int c = 0; c < 3; ++c) color[c] = linear_from_srgb(texture.rgba[i + size_t(c)] / 255.0);
    sum += render::luminance(color);
  }
  return count > 0 ? sum / double(count) : 1.0;
}

}  // namespace

std::optional<Indoors> indoors_of(const Scenario& scenario, const scene::Scene& scene) {
  if (scene.bodies.empty() || scene.bodies[0].primitive_count == 0) return {};
  std::vector<Corners> triangles;
  size_t cameras = 0;
  for (const NodeConfig& node : scenario.nodes)
    for (const SensorConfig& sensor : node.sensors) {
      if (!std::holds_alternative<CameraConfig>(sensor.config) &&
          !std::holds_alternative<EventCameraConfig>(sensor.config))
        continue;
      if (triangles.empty()) triangles = static_triangles(scene);
      if (!is_closed(place_of(scenario, scene, node, sensor), triangles)) return {};
      ++cameras;
    }
  if (cameras == 0) return {};
  Indoors indoors;
  const scene::Body& world = scene.bodies[0];
  double reflected = 0.0;
  size_t triangle = 0;
  for (uint32_t i = world.first_primitive; i < world.first_primitive + world.primitive_count; ++i) {
    const scene::PbrMaterial& pbr = scene.materials[scene.primitives[i].material].pbr;
    const double texture = pbr.base_color_texture >= 0
                               ? mean_of(scene.textures[static_cast<size_t>(pbr.base_color_texture)])
                               : 1.0;
    const double albedo = std::min(render::luminance(dvec3(pbr.base_color)) * texture, 0.95);
    for (uint32_t k = 0; k < scene.primitives[i].index_count; k += 3, ++triangle) {
      const Corners& c = triangles[triangle];
      const double area = 0.5 * glm::length(glm::cross(c[1] - c[0], c[2] - c[0]));
      indoors.area_m2 += area;
      reflected += area * albedo;
    }
  }
  for (const scene::PunctualLight& light : scene.lights)
    indoors.lamps_lm += render::luminance(render::lamp_flux(light));
  if (indoors.area_m2 > 0.0) indoors.albedo = reflected / indoors.area_m2;
  indoors.indirect_lux =
      indoors.lamps_lm / std::max(indoors.area_m2, 1e-9) * indoors.albedo / (1.0 - indoors.albedo);
  return indoors;
}

}  // namespace greatx::sim
