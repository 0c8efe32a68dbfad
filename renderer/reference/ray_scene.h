// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds what a ray meets in the scene at one instant, and the material there. It runs on the host in fp64 and
// needs no device. The interpretation of materials is that of shaders/camera/surface.glsl. Textures are read
// at full size with bilinear weights, since a reference has many rays a pixel.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/vec.h"
#include "renderer/light/lighting.h"
#include "renderer/surface/lamp_glass.h"
#include "scene/description/scene.h"
#include "scene/device/sah_tree.h"

namespace greatx::render {

/// A ray with a unit direction, in local coordinates.
struct Ray {
  dvec3 origin{0.0}, direction{0.0, 0.0, 1.0};
  dvec3 along(double distance) const { return origin + distance * direction; }
};

/// The nearest triangle on a ray.
struct RayHit {
  double distance = std::numeric_limits<double>::infinity();  ///< m; +inf: nothing
  double u = 0.0, v = 0.0;                                    ///< barycentrics of the second and third corner
  uint32_t triangle = 0, primitive = 0;                       ///< indices into the scene
  bool any() const { return distance < std::numeric_limits<double>::infinity(); }
};

/// The surface that a ray meets. Normals are unit and on the side from which the ray comes, because surfaces
/// are solid from both sides.
struct RaySurface {
  dvec3 position{0.0}, geometric{0.0, 0.0, 1.0};
  dvec3 normal{0.0, 0.0, 1.0};  ///< with smooth shading and the normal map
  dvec3 base_color{0.0};        ///< linear
  dvec3 glow{0.0};              ///< emitted radiance, cd/m^2
  double metallic = 0.0, roughness = 1.0;
  std::optional<dvec3> passes;  ///< a pane lets this share of the light through along the ray
};

class RayScene {
 public:
  /// `body_poses` has the pose of every body in local coordinates. `effects` says whether textures, normal
  /// maps, alpha masks, emission and panes count. `lamp_factors` are those of the switched lamps
  /// (scene/description/lamps.h); empty: all shine in full. `scene` outlives this.
  RayScene(const scene::Scene& scene, std::span<const Pose> body_poses, const CameraEffects& effects,
           std::span<const float> lamp_factors = {});

  /// Returns the nearest hit farther than `least` metres. A body whose owner is `excluded` is passed through.
  RayHit nearest(const Ray& ray, double least, std::optional<uint32_t> excluded = {}) const;
  /// Returns the share of the light that passes between `least` and `most` metres, through panes alone.
  dvec3 passed(const Ray& ray, double least, double most) const;
  bool is_pane(const RayHit& hit) const {
    return panes_[scene_->primitives[hit.primitive].material].has_value();
  }
  RaySurface surface(const Ray& ray, const RayHit& hit) const;
  /// Whether what glows there is the glass of a lamp, whose light comes from the lamp.
  bool is_lamp_glass(const RayHit& hit) const;

  /// The distance from a surface at which a ray may begin, so that it does not meet the surface itself:
  /// corners of bodies are rounded to fp32.
  double clearance(const dvec3& position) const;

 private:
  template <typename Visit>
  void walk(const Ray& ray, double least, double most, const Visit& visit) const;
  dvec3 pane_passes(const Ray& ray, const RayHit& hit) const;
  dvec3 geometric_normal(const RayHit& hit) const;
  bool has_hole(uint32_t triangle, uint32_t primitive, double u, double v) const;
  dvec2 texture_place(uint32_t triangle, double u, double v) const;

  const scene::Scene* scene_;
  std::vector<Pose> poses_;
  CameraEffects effects_;
  std::vector<bool> masked_;                 ///< by material: it has holes
  std::vector<bool> switched_;               ///< by material: of a lamp that switches
  std::vector<float> factor_;                ///< by primitive: of its emission
  std::vector<std::optional<dvec3>> panes_;  ///< by material: its pane_color, if panes count
  std::vector<uint32_t> owner_;              ///< by primitive: the owner of its body
  LampGlass glass_;
  scene::SahTree tree_;
};

}  // namespace greatx::render
