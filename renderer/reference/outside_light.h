// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws directions to the light of a scene: the sky, the disc of the key light, and lamps.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/vec.h"
#include "renderer/light/lighting.h"
#include "renderer/light/sky.h"
#include "scene/description/scene.h"

namespace greatx::render {

/// Light from one direction.
struct LightSample {
  dvec3 to_light{0.0, 0.0, 1.0};  ///< unit
  dvec3 radiance{0.0};            ///< cd/m^2; of a lamp: its illuminance on a facing surface, lux
  double density = 0.0;           ///< 1/sr; of a lamp: the probability with which it was chosen
  double distance = 0.0;          ///< m, up to which nothing may block it; +inf for sky and key light
};

/// The sky without discs and stars. Directions are drawn in proportion to its luminance on cells of equal
/// solid angle; the radiance itself is that of Sky in fp64.
class SkyLight {
 public:
  explicit SkyLight(const Sky& sky);
  dvec3 radiance(const dvec3& direction) const { return sky_.radiance(direction); }
  LightSample draw(double choice, double u, double v) const;
  double density(const dvec3& direction) const;

 private:
  static constexpr uint32_t rings = 64, sectors = 128;
  Sky sky_;
  std::vector<double> cumulative_;  ///< [rings * sectors], ends at 1
};

/// The disc of the sun or the moon, with the same radiance all over.
class DiscLight {
 public:
  DiscLight(const Sky& sky, const KeyLight& key);
  bool shines() const { return radiance_ != dvec3(0.0); }
  bool holds(const dvec3& direction) const { return glm::dot(direction, direction_) > cos_radius_; }
  const dvec3& radiance() const { return radiance_; }
  double density() const { return density_; }
  LightSample draw(double u, double v) const;

 private:
  dvec3 direction_, x_, y_, radiance_{0.0};
  double cos_radius_ = 1.0, density_ = 0.0;
};

/// The punctual lamps, in local coordinates. Rays of shadow end `clearance_m` before a lamp, so that its
/// housing does not hide it.
class LampLight {
 public:
  static constexpr double clearance_m = 0.2;
  LampLight(std::span<const scene::PunctualLight> lights, std::span<const Pose> body_poses);
  /// Chooses a lamp by the illuminance that it would give a point with this normal without shadows; nothing
  /// if no lamp reaches the point.
  std::optional<LightSample> draw(const dvec3& position, const dvec3& normal, double choice) const;

 private:
  struct Lamp {
    scene::PunctualLight::Type type;
    dvec3 position, direction, color;  ///< the colour times candelas, or lux of a directional lamp
    double window = 0.0;               ///< 1 / reach^2
    double cone_scale = 0.0, cone_offset = 1.0;
    bool passing = false;  ///< a passing beam
    dvec3 right{0.0}, up{0.0};
  };
  static LightSample of(const Lamp& lamp, const dvec3& position);
  std::vector<Lamp> lamps_;
};

}  // namespace greatx::render
