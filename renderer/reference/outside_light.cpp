// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/reference/outside_light.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/units.h"
#include "renderer/camera/lamps.h"
#include "renderer/reference/scatter.h"
#include "shaders/shared/beam.h"

namespace greatx::render {

namespace {

constexpr double endless = std::numeric_limits<double>::infinity();

dvec3 direction_at(double z, double phi) {
  const double level = std::sqrt(std::max(1.0 - z * z, 0.0));
  return {level * std::cos(phi), level * std::sin(phi), z};
}

}  // namespace

SkyLight::SkyLight(const Sky& sky) : sky_(sky) {
  // Every cell keeps a twentieth of the mean, so that no light is missed whose cell's middle is dark.
  std::vector<double> weights;
  double sum = 0.0;
  for (uint32_t i = 0; i < rings; ++i)
    for (uint32_t k = 0; k < sectors; ++k) {
      const double z = 1.0 - (2.0 * i + 1.0) / rings;
      weights.push_back(luminance(sky.radiance(direction_at(z, 2.0 * pi * (k + 0.5) / sectors))));
      sum += weights.back();
    }
  double total = 0.0;
  for (const double weight : weights) {
    total += sum > 0.0 ? 0.95 * weight / sum + 0.05 / double(weights.size()) : 1.0 / double(weights.size());
    cumulative_.push_back(total);
  }
  for (double& value : cumulative_) value /= total;
}

LightSample SkyLight::draw(double choice, double u, double v) const {
  const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end() - 1, choice);
  const auto cell = static_cast<uint32_t>(found - cumulative_.begin());
  LightSample sample;
  sample.to_light =
      direction_at(1.0 - 2.0 * (cell / sectors + u) / rings, 2.0 * pi * (cell % sectors + v) / sectors);
  sample.radiance = radiance(sample.to_light);
  sample.density = density(sample.to_light);
  sample.distance = endless;
  return sample;
}

double SkyLight::density(const dvec3& direction) const {
  const double turn = std::atan2(direction.y, direction.x) / (2.0 * pi);
  const auto ring =
      std::min(static_cast<uint32_t>(std::max(0.5 * (1.0 - direction.z) * rings, 0.0)), rings - 1);
  const auto sector =
      std::min(static_cast<uint32_t>((turn < 0.0 ? turn + 1.0 : turn) * sectors), sectors - 1);
  const size_t cell = size_t{ring} * sectors + sector;
  const double probability = cumulative_[cell] - (cell > 0 ? cumulative_[cell - 1] : 0.0);
  return probability * (rings * sectors / (4.0 * pi));
}

DiscLight::DiscLight(const Sky& sky, const KeyLight& key) : direction_(key.direction) {
  complete_frame(direction_, x_, y_);
  if (key.body == KeyLight::Body::none) return;
  cos_radius_ = std::cos(key.body == KeyLight::Body::sun ? sun_radius : moon_radius);
  const double solid_angle = 2.0 * pi * (1.0 - cos_radius_);
  density_ = 1.0 / solid_angle;
  radiance_ = sky.key_illuminance() / solid_angle;
}

LightSample DiscLight::draw(double u, double v) const {
  // 1 - cos is drawn evenly; its small value keeps its digits.
  const double fall = u * (1.0 - cos_radius_), level = std::sqrt(fall * (2.0 - fall)), phi = 2.0 * pi * v;
  LightSample sample;
  sample.to_light =
      glm::normalize(x_ * (level * std::cos(phi)) + y_ * (level * std::sin(phi)) + direction_ * (1.0 - fall));
  sample.radiance = radiance_;
  sample.density = density_;
  sample.distance = endless;
  return sample;
}

LampLight::LampLight(std::span<const scene::PunctualLight> lights, std::span<const Pose> body_poses) {
  for (const scene::PunctualLight& light : lights) {
    const Pose& pose = body_poses[light.body];
    Lamp lamp{light.type, pose.apply(light.position), glm::normalize(pose.rotate(light.direction)),
              dvec3(light.color) * double(light.intensity)};
    const double reach = lamp_reach(light);
    if (light.type != scene::PunctualLight::Type::directional)
      lamp.window = 1.0 / std::max(reach * reach, 1e-12);
    if (light.type == scene::PunctualLight::Type::spot) {
      // KHR_lights_punctual, "Inner and Outer Cone Angles".
      const double inner = std::cos(double(light.inner_cone)), outer = std::cos(double(light.outer_cone));
      lamp.cone_scale = 1.0 / std::max(0.001, inner - outer);
      lamp.cone_offset = -outer * lamp.cone_scale;
      lamp.passing = light.beam == scene::PunctualLight::Beam::passing;
      lamp.right = glm::normalize(glm::cross(lamp.direction, pose.rotate({0.0, 0.0, 1.0})));
      lamp.up = glm::cross(lamp.right, lamp.direction);
    }
    lamps_.push_back(lamp);
  }
}

LightSample LampLight::of(const Lamp& lamp, const dvec3& position) {
  LightSample sample;
  if (lamp.type == scene::PunctualLight::Type::directional) {
    sample.to_light = -lamp.direction;
    sample.radiance = lamp.color;
    sample.distance = endless;
    return sample;
  }
  const dvec3 apart = lamp.position - position;
  const double distance2 = std::max(glm::dot(apart, apart), 1e-4), distance = std::sqrt(distance2);
  sample.to_light = apart / distance;
  sample.distance = std::max(distance - clearance_m, 0.0);
  const double ratio = distance2 * lamp.window;
  const double cone =
      std::clamp(lamp.cone_offset - glm::dot(sample.to_light, lamp.direction) * lamp.cone_scale, 0.0, 1.0);
  double shape = cone * cone;
  if (lamp.passing && shape > 0.0) {
    const dvec3 away = -sample.to_light / -glm::dot(sample.to_light, lamp.direction);
    shape *= double(shared::passing_beam(float(glm::dot(away, lamp.right)), float(glm::dot(away, lamp.up))));
  }
  sample.radiance = lamp.color * (shape * std::clamp(1.0 - ratio * ratio, 0.0, 1.0) / distance2);
  return sample;
}

std::optional<LightSample> LampLight::draw(const dvec3& position, const dvec3& normal, double choice) const {
  const auto weight = [&](const LightSample& sample) {
    return luminance(sample.radiance) * std::max(glm::dot(sample.to_light, normal), 0.0);
  };
  double sum = 0.0;
  for (const Lamp& lamp : lamps_) sum += weight(of(lamp, position));
  if (!(sum > 0.0)) return std::nullopt;
  double left = choice * sum;
  std::optional<LightSample> chosen;
  for (const Lamp& lamp : lamps_) {
    LightSample sample = of(lamp, position);
    const double share = weight(sample);
    if (share <= 0.0) continue;
    sample.density = share / sum;
    chosen = sample;
    left -= share;
    if (left < 0.0) break;
  }
  return chosen;
}

}  // namespace greatx::render
