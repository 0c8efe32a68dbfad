// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/reference/ray_scene.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "renderer/surface/pane_color.h"
#include "renderer/surface/texel.h"
#include "scene/description/lamps.h"
#include "shaders/shared/camera.h"
#include "shaders/shared/pane.h"

namespace greatx::render {

namespace {

dvec4 texel_of(const scene::Texture& texture, int64_t column, int64_t row) {
  const auto place = [](int64_t i, int64_t count, bool repeats) {
    return repeats ? ((i % count) + count) % count : std::clamp<int64_t>(i, 0, count - 1);
  };
  const auto x = static_cast<size_t>(place(column, texture.width, texture.repeat_u));
  const auto y = static_cast<size_t>(place(row, texture.height, texture.repeat_v));
  return {linear_texel(texture, x, y), texture.rgba[4 * (y * texture.width + x) + 3] / 255.0};
}

/// Returns the texture at (u, v) with the weights of its four nearest texels, each in linear light.
dvec4 bilinear(const scene::Texture& texture, const dvec2& uv) {
  const double x = uv.x * texture.width - 0.5, y = uv.y * texture.height - 0.5;
  const double column = std::floor(x), row = std::floor(y), right = x - column, down = y - row;
  const auto i = static_cast<int64_t>(column), j = static_cast<int64_t>(row);
  return glm::mix(glm::mix(texel_of(texture, i, j), texel_of(texture, i + 1, j), right),
                  glm::mix(texel_of(texture, i, j + 1), texel_of(texture, i + 1, j + 1), right), down);
}

/// Returns whether a ray meets a box between two distances (the method of slabs).
bool ray_meets_box(const scene::TreeBox& box, const dvec3& origin, const dvec3& inverse, double least,
                   double most) {
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (double(box.min[axis]) - origin[axis]) * inverse[axis],
                 b = (double(box.max[axis]) - origin[axis]) * inverse[axis];
    // A ray within a face gives NaN, which leaves the interval as it is.
    const double enter = std::min(a, b), leave = std::max(a, b);
    if (enter > least) least = enter;
    if (leave < most) most = leave;
  }
  return least <= most * (1.0 + 1e-12);
}

std::vector<scene::TreeTriangle> placed_triangles(const scene::Scene& scene, const std::vector<Pose>& poses) {
  std::vector<scene::TreeTriangle> triangles;
  triangles.reserve(scene.triangle_count());
  for (uint32_t i = 0; i < scene.primitives.size(); ++i) {
    const scene::Primitive& primitive = scene.primitives[i];
    const uint32_t body = scene.instances[primitive.instance].body;
    for (uint32_t k = 0; k < primitive.index_count; k += 3) {
      scene::TreeTriangle triangle{{}, (primitive.first_index + k) / 3, i};
      for (uint32_t c = 0; c < 3; ++c) {
        const vec3 corner = scene.positions[scene.indices[primitive.first_index + k + c]];
        triangle.corners[c] = body == 0 ? corner : vec3(poses[body].apply(dvec3(corner)));
      }
      triangles.push_back(triangle);
    }
  }
  return triangles;
}

}  // namespace

RayScene::RayScene(const scene::Scene& scene, std::span<const Pose> body_poses, const CameraEffects& effects,
                   std::span<const float> lamp_factors)
    : scene_(&scene),
      poses_(body_poses.begin(), body_poses.end()),
      effects_(effects),
      factor_(scene.primitives.size(), 1.0f),
      glass_(scene) {
  GREATX_CHECK(poses_.size() == scene.bodies.size(), "{} poses for {} bodies", poses_.size(),
               scene.bodies.size());
  poses_[0] = Pose{};
  for (const scene::Material& material : scene.materials) {
    masked_.push_back(effects.alpha_mask && material.pbr.alpha_mode == scene::AlphaMode::mask);
    panes_.emplace_back();
    if (const auto color = effects.panes ? pane_color(material.pbr) : std::nullopt)
      panes_.back() = dvec3(*color);
    switched_.push_back(scene::lamp_role(material).has_value());
  }
  if (!lamp_factors.empty()) {
    const scene::SwitchedLamps lamps = scene::switched_lamps(scene);
    GREATX_CHECK(lamp_factors.size() == lamps.lamps.size(), "{} factors for {} switched lamps",
                 lamp_factors.size(), lamps.lamps.size());
    for (size_t i = 0; i < factor_.size(); ++i)
      if (lamps.of_primitive[i] != 0) factor_[i] = lamp_factors[lamps.of_primitive[i] - 1];
  }
  for (const scene::Primitive& primitive : scene.primitives)
    owner_.push_back(scene.owner_of(scene.instances[primitive.instance].body));
  tree_ = scene::make_sah_tree(placed_triangles(scene, poses_));
}

double RayScene::clearance(const dvec3& position) const {
  const dvec3 size = glm::abs(position);
  return 1e-5 + 4e-7 * std::max({size.x, size.y, size.z});
}

template <typename Visit>
void RayScene::walk(const Ray& ray, double least, double most, const Visit& visit) const {
  if (tree_.nodes.empty()) return;
  const dvec3 inverse = 1.0 / ray.direction;
  std::array<uint32_t, 128> stack;
  uint32_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const scene::SahTree::Node& node = tree_.nodes[stack[--size]];
    if (!ray_meets_box(node.box, ray.origin, inverse, least, most)) continue;
    if (node.count == 0) {
      // The child whose centre comes first along the ray is visited first.
      const vec3 apart = tree_.nodes[node.right].box.center() - tree_.nodes[node.left].box.center();
      const bool left_first = glm::dot(dvec3(apart), ray.direction) >= 0.0;
      stack[size++] = left_first ? node.right : node.left;
      stack[size++] = left_first ? node.left : node.right;
      continue;
    }
    for (uint32_t i = node.first; i < node.first + node.count; ++i) {
      const scene::TreeTriangle& triangle = tree_.triangles[i];
      // T. Moeller and B. Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection" (1997).
      const dvec3 a(triangle.corners[0]), e1 = dvec3(triangle.corners[1]) - a,
                                          e2 = dvec3(triangle.corners[2]) - a,
                                          p = glm::cross(ray.direction, e2);
      const double determinant = glm::dot(e1, p);
      if (determinant == 0.0) continue;
      const dvec3 s = ray.origin - a, q = glm::cross(s, e1);
      const double u = glm::dot(s, p) / determinant, v = glm::dot(ray.direction, q) / determinant,
                   distance = glm::dot(e2, q) / determinant;
      if (!(u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > least && distance < most)) continue;
      if (visit(RayHit{distance, u, v, triangle.triangle, triangle.primitive}, most)) return;
    }
  }
}

RayHit RayScene::nearest(const Ray& ray, double least, std::optional<uint32_t> excluded) const {
  RayHit found;
  walk(ray, least, found.distance, [&](const RayHit& hit, double& most) {
    if (excluded && owner_[hit.primitive] == *excluded) return false;
    if (has_hole(hit.triangle, hit.primitive, hit.u, hit.v)) return false;
    found = hit;
    most = hit.distance;
    return false;
  });
  return found;
}

dvec3 RayScene::passed(const Ray& ray, double least, double most) const {
  dvec3 share(1.0);
  walk(ray, least, most, [&](const RayHit& hit, double&) {
    if (has_hole(hit.triangle, hit.primitive, hit.u, hit.v)) return false;
    share *= pane_passes(ray, hit);
    return share == dvec3(0.0);
  });
  return share;
}

dvec3 RayScene::geometric_normal(const RayHit& hit) const {
  const scene::Primitive& primitive = scene_->primitives[hit.primitive];
  const uint32_t* corner = &scene_->indices[size_t{3} * hit.triangle];
  const dvec3 a(scene_->positions[corner[0]]);
  return poses_[scene_->instances[primitive.instance].body].rotate(glm::normalize(
      glm::cross(dvec3(scene_->positions[corner[1]]) - a, dvec3(scene_->positions[corner[2]]) - a)));
}

/// Returns what a pane lets through; 0 if the hit is no pane.
dvec3 RayScene::pane_passes(const Ray& ray, const RayHit& hit) const {
  const std::optional<dvec3>& color = panes_[scene_->primitives[hit.primitive].material];
  if (!color) return dvec3(0.0);
  const double cosine = std::min(std::abs(glm::dot(geometric_normal(hit), ray.direction)), 1.0);
  return *color * (1.0 - double(shared::pane_reflectance(float(cosine), shared::pane_index, 1.0f)));
}

dvec2 RayScene::texture_place(uint32_t triangle, double u, double v) const {
  const uint32_t* corner = &scene_->indices[size_t{3} * triangle];
  const dvec2 a(scene_->uvs[corner[0]]);
  return a + u * (dvec2(scene_->uvs[corner[1]]) - a) + v * (dvec2(scene_->uvs[corner[2]]) - a);
}

bool RayScene::is_lamp_glass(const RayHit& hit) const {
  const uint32_t* corner = &scene_->indices[size_t{3} * hit.triangle];
  const auto place = [&](int k) { return dvec3(scene_->positions[corner[k]]); };
  return glass_.is_glass(scene_->instances[scene_->primitives[hit.primitive].instance].body,
                         {place(0), place(1), place(2)});
}

bool RayScene::has_hole(uint32_t triangle, uint32_t primitive, double u, double v) const {
  const uint32_t material = scene_->primitives[primitive].material;
  if (!masked_[material]) return false;
  const scene::PbrMaterial& pbr = scene_->materials[material].pbr;
  double alpha = pbr.base_color.a;
  if (pbr.base_color_texture >= 0)
    alpha *=
        bilinear(scene_->textures[static_cast<size_t>(pbr.base_color_texture)], texture_place(triangle, u, v))
            .a;
  return alpha < pbr.alpha_cutoff;
}

RaySurface RayScene::surface(const Ray& ray, const RayHit& hit) const {
  const scene::Primitive& primitive = scene_->primitives[hit.primitive];
  const scene::PbrMaterial& pbr = scene_->materials[primitive.material].pbr;
  const Pose& pose = poses_[scene_->instances[primitive.instance].body];
  const uint32_t* corner = &scene_->indices[size_t{3} * hit.triangle];
  const std::array<double, 3> weights{1.0 - hit.u - hit.v, hit.u, hit.v};
  RaySurface s;
  s.position = ray.along(hit.distance);
  s.geometric = geometric_normal(hit);
  if (glm::dot(s.geometric, ray.direction) > 0.0) s.geometric = -s.geometric;

  s.base_color = dvec3(solid_color(pbr));
  if (panes_[primitive.material]) s.passes = pane_passes(ray, hit);
  s.metallic = pbr.metallic;
  s.roughness = pbr.roughness;
  const bool lamp = switched_[primitive.material];
  const scene::Material& material = scene_->materials[primitive.material];
  const bool seen_through = panes_[primitive.material] && is_lit_pane(material);
  const bool glows = lamp ? effects_.switched_lamps : effects_.emissive && !seen_through;
  if (glows) s.glow = dvec3(pbr.emissive) * double(shared::emissive_nits) * double(factor_[hit.primitive]);
  const dvec2 uv = texture_place(hit.triangle, hit.u, hit.v);
  const auto texture = [&](int32_t index) {
    return bilinear(scene_->textures[static_cast<size_t>(index)], uv);
  };
  if (effects_.textures) {
    if (pbr.base_color_texture >= 0) s.base_color *= dvec3(texture(pbr.base_color_texture));
    if (pbr.metallic_roughness_texture >= 0) {
      const dvec4 both = texture(pbr.metallic_roughness_texture);
      s.roughness *= both.g;
      s.metallic *= both.b;
    }
    if (glows && !lamp && pbr.emissive_texture >= 0) s.glow *= dvec3(texture(pbr.emissive_texture));
  }
  dvec3 normal(0.0), tangent(0.0);
  for (int i = 0; i < 3; ++i) {
    normal += weights[i] * dvec3(scene_->normals[corner[i]]);
    tangent += weights[i] * dvec3(scene_->tangents[corner[i]]);
  }
  normal = glm::dot(normal, normal) > 0.0 ? glm::normalize(pose.rotate(normal)) : s.geometric;
  if (effects_.normal_maps && pbr.normal_texture >= 0) {
    tangent = pose.rotate(tangent);
    dvec3 in_map = 2.0 * dvec3(texture(pbr.normal_texture)) - 1.0;
    in_map.x *= pbr.normal_scale;
    in_map.y *= pbr.normal_scale;
    if (scene_->tangents[corner[0]].w < 0.0f) in_map.y = -in_map.y;
    normal = glm::normalize(tangent * in_map.x + glm::cross(normal, tangent) * in_map.y + normal * in_map.z);
  }
  s.normal = glm::dot(normal, s.geometric) < 0.0 ? -normal : normal;
  return s;
}

}  // namespace greatx::render
