// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/light/horizon.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/units.h"
#include "renderer/light/sky.h"
#include "renderer/light/sky_view.h"
#include "renderer/surface/material_color.h"

namespace greatx::render {

namespace {

constexpr double least_scene_m = 60.0;
/// The share of a scene under buildings that makes it a city.
constexpr double city_share = 1.0 / 12.0;
constexpr double aerosol_scale_m = 1200.0, air_scale_m = 8000.0;
constexpr double air_depth_550 = 0.098;  ///< vertical optical depth of air (Rayleigh) at 550 nm
/// Below this illuminance of the ground windows are lit and street lamps are on, lux.
constexpr double dusk_lux = 400.0;
/// The slope of the view in which the sky over the horizon is known.
constexpr double air_slope = 0.03;
constexpr double lit_window_cd_m2 = 20.0;

/// Calls visit(primitive, corners, twice the area times the unit normal) for every static triangle.
template <typename F>
void over_triangles(const scene::Scene& scene, F&& visit) {
  const scene::Body& world = scene.bodies[0];
  for (uint32_t i = world.first_primitive; i < world.first_primitive + world.primitive_count; ++i) {
    const scene::Primitive& primitive = scene.primitives[i];
    for (uint32_t k = 0; k < primitive.index_count; k += 3) {
      const uint32_t* corner = &scene.indices[primitive.first_index + k];
      const dvec3 a(scene.positions[corner[0]]), b(scene.positions[corner[1]]), c(scene.positions[corner[2]]);
      visit(primitive, (a + b + c) / 3.0, glm::cross(b - a, c - a));
    }
  }
}

}  // namespace

HorizonKind horizon_of(const scene::Scene& scene) {
  if (scene.bounds.empty()) return HorizonKind::none;
  const dvec3 size = scene.bounds.size();
  if (std::min(size.x, size.y) < least_scene_m) return HorizonKind::none;
  double roofs = 0.0;
  over_triangles(scene, [&](const scene::Primitive& primitive, const dvec3&, const dvec3& normal) {
    const auto kind = scene.instances[primitive.instance].semantic_class;
    if (kind == scene::SemanticClass::building || kind == scene::SemanticClass::roof)
      roofs += 0.5 * std::max(normal.z, 0.0);
  });
  if (roofs > city_share * size.x * size.y) return HorizonKind::city;
  // Green and brown things reflect less blue than green and red.
  const dvec3 color = ground_color(scene, land_height(scene) + 0.25 * size.z);
  return color.z < 0.75 * std::max(color.x, color.y) ? HorizonKind::country : HorizonKind::plain;
}

double land_height(const scene::Scene& scene) {
  const HeightField field = height_field(scene, 64);
  std::vector<float> border;
  for (uint32_t row = 0; row < field.height; ++row)
    for (uint32_t column = 0; column < field.width; ++column)
      if (row == 0 || column == 0 || row + 1 == field.height || column + 1 == field.width)
        border.push_back(field.heights[size_t{row} * field.width + column]);
  if (border.empty()) return 0.0;
  // Houses, trees and masts at the border do not count. Streets leave a tenth of it free at least. Land that
  // is higher than they are would stand across their ends as a wall.
  const auto tenth = border.begin() + std::ptrdiff_t(border.size() / 10);
  std::nth_element(border.begin(), tenth, border.end());
  return field.floor + double(*tenth);
}

dvec3 ground_color(const scene::Scene& scene, double height) {
  std::vector<double> areas(scene.materials.size(), 0.0);
  over_triangles(scene, [&](const scene::Primitive& primitive, const dvec3& center, const dvec3& normal) {
    if (normal.z > 0.7 * glm::length(normal) && center.z <= height) areas[primitive.material] += normal.z;
  });
  dvec3 sum(0.0);
  double area = 0.0;
  for (uint32_t i = 0; i < areas.size(); ++i)
    if (areas[i] > 0.0) sum += areas[i] * mean_color(scene, i), area += areas[i];
  return area > 0.0 ? sum / area : dvec3(Lighting{}.ground_albedo);
}

double clear_air_extinction(double turbidity) {
  return air_depth_550 / air_scale_m + (turbidity - 1.0) * air_depth_550 / aerosol_scale_m;
}

std::array<dvec3, shared::air_azimuths> air_light_of(const Sky& sky, bool clouds) {
  constexpr int azimuths = shared::air_azimuths, reach = azimuths / 12;
  std::array<dvec3, azimuths> seen, smooth{};
  for (int i = 0; i < azimuths; ++i) {
    const double azimuth = (i + 0.5) * 2.0 * pi / azimuths;
    seen[i] = sky.radiance(glm::normalize(dvec3(std::cos(azimuth), std::sin(azimuth), air_slope)));
  }
  if (!clouds) return seen;
  for (int i = 0; i < azimuths; ++i)
    for (int k = -reach; k <= reach; ++k) {
      const double weight = (1.0 + std::cos(pi * k / (reach + 1.0))) / (2.0 * (reach + 1.0));
      smooth[i] += weight * seen[(i + k + azimuths) % azimuths];
    }
  return smooth;
}

shared::GpuHorizon describe_horizon(const scene::Scene& scene, HorizonKind kind, const Lighting& lighting,
                                    const LandLight& light) {
  shared::GpuHorizon horizon{};
  const double floor = land_height(scene);
  const dvec3 level = light.key * std::max(light.key_height, 0.0) + light.sky;
  horizon.sunlit = vec3(level / pi);
  horizon.shaded = vec3(light.sky / pi);
  horizon.key = vec3(light.key / pi);
  horizon.floor = float(floor);
  horizon.air = float(clear_air_extinction(lighting.turbidity));
  if (!scene.bounds.empty()) {
    horizon.min = vec2(scene.bounds.min);
    horizon.max = vec2(scene.bounds.max);
  }
  horizon.albedo = vec3(ground_color(scene, floor + 0.25 * scene.bounds.size().z));
  horizon.seed = static_cast<uint32_t>(lighting.cloud_seed);
  for (size_t i = 0; i < light.air_light.size(); ++i)
    horizon.air_light[i] = vec4(vec3(light.air_light[i]), 0.0f);
  const double dark = std::clamp(1.0 - luminance(level) / dusk_lux, 0.0, 1.0);
  if (kind == HorizonKind::city) {
    // The land goes on as the scene ends: a town without lamps would else lie in a sea of light.
    horizon.lit = luminance(light.lamps) > 0.0 ? float(dark * lit_window_cd_m2) : 0.0f;
    horizon.lamps = vec3(light.lamps * (dark / pi));
  }
  return horizon;
}

}  // namespace greatx::render
