// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/reference/path_tracer.h"

#include <algorithm>
#include <cmath>

#include "renderer/daylight/haze.h"
#include "renderer/reference/scatter.h"

namespace greatx::render {

namespace {

/// The reflections after which a path may end by chance (Russian roulette).
constexpr uint32_t certain_bounces = 3;

}  // namespace

PathTracer::PathTracer(const scene::Scene& scene, std::span<const Pose> body_poses, const Lighting& lighting,
                       const CameraEffects& effects, const PathOptions& options)
    : effects_(effects),
      options_(options),
      sky_(lighting, effects.haze && lighting.haze_extinction_per_m > 0.0),
      rays_(scene, body_poses, effects, options.lamp_factors),
      sky_light_(sky_),
      disc_(sky_, effects.sun ? key_light(lighting) : KeyLight{}),
      lamps_(effects.punctual_lights ? std::span<const scene::PunctualLight>(scene.lights)
                                     : std::span<const scene::PunctualLight>(),
             body_poses),
      shows_disc_(key_light(lighting).body == KeyLight::Body::sun),
      key_direction_(key_light(lighting).direction),
      haze_extinction_(effects.haze ? lighting.haze_extinction_per_m : 0.0) {}

dvec3 PathTracer::airlight(const dvec3& direction) const {
  const double g = haze_asymmetry, base = 1.0 + g * g - 2.0 * g * glm::dot(direction, key_direction_);
  return sky_.haze_ambient() + sky_.haze_directed() / (base * std::sqrt(base));
}

dvec3 PathTracer::background(const dvec3& direction) const {
  if (!effects_.sky) return dvec3(0.0);
  dvec3 radiance =
      haze_extinction_ > 0.0 && direction.z <= 0.0 ? airlight(direction) : sky_light_.radiance(direction);
  if (shows_disc_ && disc_.shines() && disc_.holds(direction)) radiance += disc_.radiance();
  return radiance;
}

/// One path from its first surface on.
class PathTracer::Path {
 public:
  Path(const PathTracer& tracer, PathDraws& draws) : tracer_(tracer), draws_(draws) {}

  PathLight follow(const Ray& first, const RayHit& first_hit) {
    Ray ray = first;
    RayHit hit = first_hit;
    dvec3 weight(1.0);
    for (uint32_t bounce = 0;; ++bounce) {
      RaySurface surface = tracer_.rays_.surface(ray, hit);
      if (bounce > 0) surface.roughness = std::max(surface.roughness, tracer_.options_.later_roughness);
      if (bounce == 0) {
        light_.roughness = surface.roughness;
        light_.radiance += surface.glow;
      }
      const Scatter scatter(surface, -ray.direction, tracer_.effects_.specular);
      const Ray from{surface.position + surface.geometric * tracer_.rays_.clearance(surface.position), {}};
      sample_lights(surface, scatter, from, weight, bounce == 0);
      ray = {from.origin, scatter.draw(draws_.next(), draws_.next(), draws_.next())};
      const dvec3 reflected = scatter.reflected(ray.direction);
      const double density = scatter.density(ray.direction);
      if (reflected == dvec3(0.0) || !(density > 0.0)) break;
      weight *= reflected / density;
      hit = next_hit(ray, weight);
      if (!hit.any()) {
        add_outside(ray.direction, density, weight, bounce == 0);
        break;
      }
      if (tracer_.effects_.emissive || tracer_.effects_.switched_lamps) {
        const dvec3 glow = tracer_.rays_.surface(ray, hit).glow;
        if (glow != dvec3(0.0) && !tracer_.rays_.is_lamp_glass(hit)) light_.radiance += weight * glow;
      }
      if (bounce >= tracer_.options_.bounces) break;
      if (bounce >= certain_bounces) {
        const double survives = std::min(0.95, std::max({weight.x, weight.y, weight.z}));
        if (draws_.next() >= survives) break;
        weight /= survives;
      }
    }
    return light_;
  }
  PathLight& light() { return light_; }

 private:
  /// Returns what the ray meets. It passes panes by chance, and then goes on from them.
  RayHit next_hit(Ray& ray, dvec3& weight) {
    for (;;) {
      const RayHit hit = tracer_.rays_.nearest(ray, 0.0);
      if (!hit.any() || !tracer_.rays_.is_pane(hit)) return hit;
      const RaySurface pane = tracer_.rays_.surface(ray, hit);
      const double chance = std::clamp(luminance(*pane.passes), 0.05, 0.95);
      if (draws_.next() >= chance) {
        weight /= 1.0 - chance;
        return hit;
      }
      weight *= *pane.passes / chance;
      ray.origin = pane.position - pane.geometric * tracer_.rays_.clearance(pane.position);
    }
  }

  /// Adds the light of lamps, key light and sky that reaches the point straight.
  void sample_lights(const RaySurface& surface, const Scatter& scatter, const Ray& from, const dvec3& weight,
                     bool first) {
    if (tracer_.effects_.sky) {
      const LightSample sky = tracer_.sky_light_.draw(draws_.next(), draws_.next(), draws_.next());
      add(sky, scatter, from, weight, scatter.density(sky.to_light));
    }
    if (tracer_.disc_.shines()) {
      const LightSample disc = tracer_.disc_.draw(draws_.next(), draws_.next());
      const dvec3 added = add(disc, scatter, from, weight, scatter.density(disc.to_light));
      if (first) light_.key += added;
    }
    if (const auto lamp = tracer_.lamps_.draw(surface.position, surface.normal, draws_.next()))
      add(*lamp, scatter, from, weight, 0.0);
  }

  /// Adds light from one direction. `other_density` is the density of drawing it by the surface.
  dvec3 add(const LightSample& sample, const Scatter& scatter, const Ray& from, const dvec3& weight,
            double other_density) {
    const dvec3 reflected = scatter.reflected(sample.to_light);
    if (reflected == dvec3(0.0) || sample.radiance == dvec3(0.0)) return dvec3(0.0);
    const dvec3 passed = tracer_.rays_.passed({from.origin, sample.to_light}, 0.0, sample.distance);
    if (passed == dvec3(0.0)) return dvec3(0.0);
    const dvec3 added = weight * passed * reflected * sample.radiance / (sample.density + other_density);
    light_.radiance += added;
    return added;
  }

  /// Adds the light of sky and disc along a drawn ray that meets nothing.
  void add_outside(const dvec3& direction, double density, const dvec3& weight, bool first) {
    if (tracer_.effects_.sky)
      light_.radiance += weight * tracer_.sky_light_.radiance(direction) *
                         (density / (density + tracer_.sky_light_.density(direction)));
    if (!tracer_.disc_.shines() || !tracer_.disc_.holds(direction)) return;
    const dvec3 added = weight * tracer_.disc_.radiance() * (density / (density + tracer_.disc_.density()));
    light_.radiance += added;
    if (first) light_.key += added;
  }

  const PathTracer& tracer_;
  PathDraws& draws_;
  PathLight light_;
};

PathLight PathTracer::trace(const Ray& first, double near_m, PathDraws& draws,
                            std::optional<uint32_t> excluded) const {
  PathLight light;
  Ray ray = first;
  dvec3 passes(1.0);
  double way = 0.0;
  // A camera's ray goes on through panes, and each adds the light of a path from its surface.
  for (bool behind = false;; behind = true) {
    const RayHit hit = rays_.nearest(ray, behind ? 0.0 : near_m, excluded);
    const double before = std::exp(-haze_extinction_ * way);
    if (!hit.any()) {
      // The sky has the haze of its whole way already, which begins at the eye.
      const dvec3 near_air = haze_extinction_ > 0.0 ? airlight(ray.direction) * (1.0 - before) : dvec3(0.0);
      light.radiance += passes * (background(ray.direction) - near_air);
      return light;
    }
    const double kept = before * std::exp(-haze_extinction_ * hit.distance);
    const PathLight surface = Path(*this, draws).follow(ray, hit);
    light.radiance += passes * surface.radiance * kept;
    light.key += passes * surface.key * kept;
    if (haze_extinction_ > 0.0) light.radiance += passes * airlight(ray.direction) * (before - kept);
    light.scene = true;
    if (!behind) light.roughness = surface.roughness;
    if (!rays_.is_pane(hit)) return light;
    const RaySurface pane = rays_.surface(ray, hit);
    passes *= *pane.passes;
    way += hit.distance;
    ray.origin = pane.position - pane.geometric * rays_.clearance(pane.position);
  }
}

}  // namespace greatx::render
