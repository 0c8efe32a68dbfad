// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds the path tracer against closed forms.
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "core/units.h"
#include "renderer/daylight/haze.h"
#include "renderer/reference/path_tracer.h"
#include "renderer/reference/reference_picture.h"
#include "renderer/reference/scatter.h"
#include "scene/description/lamps.h"
#include "tests/support/tiny_scene.h"

namespace greatx::test {
namespace {

using render::luminance;

scene::Material matt(double albedo, double glow_cd_m2 = 0.0) {
  scene::Material material;
  material.name = "matt";
  material.pbr.base_color = vec4(vec3(float(albedo)), 1.0f);
  material.pbr.metallic = 0.0f;
  material.pbr.emissive = vec3(float(glow_cd_m2 / 1000.0));
  return material;
}

render::CameraEffects matt_effects() {
  render::CameraEffects effects;
  effects.specular = false;
  return effects;
}

/// A white sky of the same radiance all around, ground included, and no sun.
render::Lighting white_world(double sky_lux) {
  render::Lighting lighting;
  lighting.sky_model = render::SkyModel::uniform;
  lighting.sun_illuminance_lux = 0.0;
  lighting.sky_illuminance_lux = sky_lux;
  return lighting;
}

/// The light from above alone.
render::Lighting noon(double lux) {
  render::Lighting lighting;
  lighting.sun_illuminance_lux = lux;
  return lighting;
}

struct Estimate {
  double mean = 0.0, error = 0.0;  ///< luminance and its standard error
};

/// Returns the mean luminance of paths along one ray.
Estimate look_along(const scene::Scene& scene, const render::Lighting& lighting,
                    const render::CameraEffects& effects, uint32_t bounces, const dvec3& eye,
                    const dvec3& direction, uint32_t samples = 20000) {
  const std::vector<Pose> poses(scene.bodies.size());
  const render::PathTracer tracer(scene, poses, lighting, effects, {.bounces = bounces});
  double sum = 0.0, squares = 0.0;
  for (uint32_t i = 0; i < samples; ++i) {
    render::PathDraws draws(3, 7, i);
    const double value = luminance(tracer.trace({eye, glm::normalize(direction)}, 0.0, draws).radiance);
    sum += value;
    squares += value * value;
  }
  const double mean = sum / samples;
  return {mean, std::sqrt(std::max(squares / samples - mean * mean, 0.0) / samples)};
}

/// Expects the closed form within 4.5 standard errors (one draw in 150,000 is outside), and the error within
/// 1 % so that the test can fail.
void expect_form(const Estimate& estimate, double expected) {
  EXPECT_LT(estimate.error, 0.01 * expected);
  EXPECT_NEAR(estimate.mean, expected, 4.5 * estimate.error + 2e-6 * expected);
}

void ground(TinyScene& tiny, double half = 1000.0) {
  tiny.quad({-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0});
}

TEST(Reference, WhiteSurfacesAreInvisibleInAWhiteWorld) {
  // A corner of three white walls. All light that comes in goes out again, after however many bounces.
  TinyScene tiny;
  const uint32_t white = tiny.material_as(matt(1.0));
  tiny.object("corner", 0, white)
      .quad({0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0})
      .quad({0, 0, 0}, {0, 4, 0}, {0, 4, 4}, {0, 0, 4})
      .quad({0, 0, 0}, {0, 0, 4}, {4, 0, 4}, {4, 0, 0});
  expect_form(
      look_along(tiny.build(), white_world(1000.0 * pi), matt_effects(), 1000, {3, 3, 3}, {-1, -1, -3}),
      1000.0);
}

TEST(Reference, ShinyWhiteSurfacesKeepNearlyAllLight) {
  // brdf.h compensates for multiple scattering to 3 % for direct light (docs/camera.md).
  for (const float roughness : {0.2f, 0.5f, 1.0f}) {
    TinyScene tiny;
    scene::Material material = matt(1.0);
    material.pbr.roughness = roughness;
    tiny.object("ground", 0, tiny.material_as(material));
    ground(tiny);
    render::CameraEffects effects;
    const Estimate found =
        look_along(tiny.build(), white_world(1000.0 * pi), effects, 0, {0, 0, 2}, {1, 0, -1});
    EXPECT_NEAR(found.mean, 1000.0, 30.0) << roughness;
  }
}

TEST(Reference, ALampWithItsGlassCountsOnce) {
  // A lamp of 500 cd at 3 m lights matt ground with 500 / 9 lx. Its glass of 0.3 m glows, too.
  TinyScene tiny;
  tiny.object("ground", 0, tiny.material_as(matt(0.5)));
  ground(tiny);
  tiny.object("glass", 0, tiny.material_as(matt(0.5, 14000.0)))
      .quad({-0.15, -0.15, 3.05}, {-0.15, 0.15, 3.05}, {0.15, 0.15, 3.05}, {0.15, -0.15, 3.05});
  scene::Scene scene = tiny.build();
  scene.lights.push_back({.name = "lamp", .position = {0, 0, 3}, .intensity = 500.0f});
  const render::Lighting night = white_world(0.0);
  expect_form(look_along(scene, night, matt_effects(), 0, {0, 0, 2}, {0, 0, -1}), 0.5 / pi * 500.0 / 9.0);
}

TEST(Reference, LambertPlaneHasTheLuminanceOfItsIlluminance) {
  TinyScene tiny;
  tiny.object("ground", 0, tiny.material_as(matt(0.3)));
  ground(tiny);
  render::Lighting lighting;
  lighting.sun_direction = render::Lighting::direction(0.4, radians(40.0));
  lighting.sun_illuminance_lux = 90000.0;
  lighting.sky_illuminance_lux = 12000.0;
  const double expected = 0.3 * (90000.0 * std::sin(radians(40.0)) + 12000.0) / pi;
  const Estimate found = look_along(tiny.build(), lighting, matt_effects(), 4, {0, 0, 2}, {1, 0, -2});
  // The sky's illuminance is scaled by a product rule of 96 x 128 cells.
  EXPECT_NEAR(found.mean, expected, 4.5 * found.error + 1e-3 * expected);
  EXPECT_LT(found.error, 0.002 * expected);
}

TEST(Reference, CanyonHasItsShareOfTheSky) {
  // T. Oke, "Canyon geometry and the nocturnal urban heat island" (1981): cos(atan(2 H / W)) in the middle of
  // the floor.
  for (const auto& [width, height] : {std::pair(20.0, 10.0), std::pair(20.0, 30.0)}) {
    TinyScene tiny;
    tiny.object("street", 0, tiny.material_as(matt(0.5)));
    ground(tiny, 4000.0);
    for (const double x : {-0.5 * width, 0.5 * width})
      tiny.quad({x, -4000, 0}, {x, 4000, 0}, {x, 4000, height}, {x, -4000, height});
    expect_form(
        look_along(tiny.build(), white_world(1000.0 * pi), matt_effects(), 0, {0, 0, 1}, {0, 0.1, -1}, 60000),
        0.5 * 1000.0 * std::cos(std::atan(2.0 * height / width)));
  }
}

TEST(Reference, OneBounceHasTheFormFactorOfASquare) {
  // A small plate looks down on a sunlit square. Form factor of a rectangle seen from a point over its
  // corner: J. Howell, "A Catalog of Radiation Heat Transfer Configuration Factors", B-3.
  const double half = 2.0, height = 1.5, x = half / height;
  TinyScene tiny;
  tiny.object("square", 0, tiny.material_as(matt(0.6)));
  ground(tiny, half);
  tiny.object("plate", 0, tiny.material_as(matt(0.4)))
      .quad({-0.005, -0.005, height}, {0.005, -0.005, height}, {0.005, 0.005, height},
            {-0.005, 0.005, height});
  const double root = std::sqrt(1.0 + x * x);
  const double factor = 4.0 / (2.0 * pi) * 2.0 * (x / root) * std::atan(x / root);
  render::CameraEffects effects = matt_effects();
  effects.sky = false;
  const dvec3 eye(0.3, 0.2, 1.0);
  expect_form(look_along(tiny.build(), noon(50000.0), effects, 1, eye, dvec3(0, 0, height) - eye, 60000),
              0.4 / pi * factor * 0.6 * 50000.0);
  EXPECT_EQ(look_along(tiny.build(), noon(50000.0), effects, 0, eye, dvec3(0, 0, height) - eye, 100).mean,
            0.0);
}

TEST(Reference, CornerReflectsBetweenItsWallsWithoutEnd) {
  // Every point of an infinite right corner sees the other wall by a factor of 1/2, so the radiosity is
  // rho pi L (1 - F) / (1 - rho F).
  const double far = 20000.0, albedo = 0.7;
  TinyScene tiny;
  tiny.object("corner", 0, tiny.material_as(matt(albedo)))
      .quad({0, -far, 0}, {far, -far, 0}, {far, far, 0}, {0, far, 0})
      .quad({0, -far, 0}, {0, far, 0}, {0, far, far}, {0, -far, far});
  expect_form(
      look_along(tiny.build(), white_world(1000.0 * pi), matt_effects(), 1000, {1, 0, 1}, {0, 0.1, -1}),
      1000.0 * albedo * 0.5 / (1.0 - 0.5 * albedo));
}

TEST(Reference, GlowingRoomIsAGeometricSeries) {
  // Each bounce multiplies the light of a closed room by its albedo.
  TinyScene tiny;
  tiny.object("room", 0, tiny.material_as(matt(0.5, 100.0))).box({-2, -2, 0}, {2, 2, 3});
  render::CameraEffects effects = matt_effects();
  effects.sky = effects.sun = false;
  for (const auto& [bounces, expected] :
       {std::pair(0u, 150.0), std::pair(1u, 175.0), std::pair(2u, 187.5), std::pair(1000u, 200.0)}) {
    const Estimate found = look_along(tiny.build(), {}, effects, bounces, {0.5, 0, 1}, {1, 0.3, 0.2}, 4000);
    EXPECT_NEAR(found.mean, expected, 4.5 * found.error + 1e-3) << bounces;
    EXPECT_LT(found.error, 1.0);
  }
}

TEST(Reference, LampFallsWithTheSquareOfTheDistance) {
  TinyScene tiny;
  tiny.object("ground", 0, tiny.material_as(matt(0.5)));
  ground(tiny);
  scene::Scene scene = tiny.build();
  scene::PunctualLight lamp;
  lamp.position = {3.0, 0.0, 4.0};
  lamp.intensity = 700.0f;
  lamp.range_m = 20.0f;
  scene.lights.push_back(lamp);
  render::CameraEffects effects = matt_effects();
  effects.sky = effects.sun = false;
  // KHR_lights_punctual: the window is 1 - (d / range)^4.
  const double lux = 700.0 / 25.0 * 0.8 * (1.0 - std::pow(5.0 / 20.0, 4.0));
  const Estimate found = look_along(scene, {}, effects, 0, {0, 0, 1}, {0, 0, -1}, 100);
  EXPECT_NEAR(found.mean, 0.5 / pi * lux, 1e-6 * lux);
  lamp.range_m = 4.9f;  // it ends before the ground
  scene.lights = {lamp};
  EXPECT_EQ(look_along(scene, {}, effects, 0, {0, 0, 1}, {0, 0, -1}, 100).mean, 0.0);
}

TEST(Reference, MirrorShowsWhatStandsBeforeIt) {
  scene::Material mirror = matt(0.9);
  mirror.pbr.metallic = 1.0f;
  mirror.pbr.roughness = 0.0f;
  TinyScene tiny;
  tiny.object("mirror", 0, tiny.material_as(mirror)).quad({-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0});
  tiny.object("wall", 0, tiny.material_as(matt(0.0, 500.0)))
      .quad({5, -50, -50}, {5, -50, 50}, {5, 50, 50}, {5, 50, -50});
  render::CameraEffects effects;
  effects.sky = effects.sun = false;
  const Estimate found = look_along(tiny.build(), {}, effects, 0, {-1, 0, 1}, {1, 0, -1}, 4000);
  EXPECT_NEAR(found.mean, 0.9 * 500.0, 0.02 * 450.0);
}

TEST(Reference, LaterRoughnessLeavesTheFirstMirrorSharp) {
  // Mirror, mirror, glowing half space: only the second reflection is spread, beyond the half space's rim.
  scene::Material mirror = matt(1.0);
  mirror.pbr.metallic = 1.0f;
  mirror.pbr.roughness = 0.0f;
  TinyScene tiny;
  const uint32_t shiny = tiny.material_as(mirror);
  tiny.object("mirrors", 0, shiny)
      .quad({-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0})
      .quad({3, -9, 0}, {3, 9, 0}, {3, 9, 9}, {3, -9, 9});
  tiny.object("glow", 0, tiny.material_as(matt(0.0, 500.0)))
      .quad({-50, -50, 6}, {-50, 50, 6}, {-50, 50, 60}, {-50, -50, 60});
  render::CameraEffects effects;
  effects.sky = effects.sun = false;
  const scene::Scene scene = tiny.build();
  const std::vector<Pose> poses(1);
  const auto mean = [&](uint32_t bounces, double later) {
    const render::PathTracer tracer(scene, poses, {}, effects,
                                    {.bounces = bounces, .later_roughness = later});
    double sum = 0.0;
    for (uint32_t i = 0; i < 4000; ++i) {
      render::PathDraws draws(1, 0, i);
      sum += luminance(tracer.trace({{-1, 0, 1}, glm::normalize(dvec3(1, 0, -1))}, 0.0, draws).radiance);
    }
    return sum / 4000;
  };
  const double sharp = mean(1, 0.0);
  EXPECT_NEAR(sharp, 500.0, 10.0);
  EXPECT_LT(mean(1, 0.8), 0.95 * sharp);
  EXPECT_GT(mean(1, 0.8), 0.2 * sharp);
}

TEST(Reference, ScatterIsTheSharedFunctionAndItsDensityHasWeightOne) {
  render::RaySurface surface;
  surface.base_color = {0.6, 0.4, 0.2};
  surface.roughness = 0.25;
  surface.metallic = 0.3;
  const dvec3 to_eye = glm::normalize(dvec3(1, 0.2, 0.7)), light = glm::normalize(dvec3(-0.5, 0.3, 1.0));
  const render::Scatter scatter(surface, to_eye, true);
  const shared::Reflectance r =
      shared::reflectance_of(vec3(surface.base_color), 0.3f, 0.25f, float(to_eye.z));
  const dvec3 half = glm::normalize(to_eye + light);
  const dvec3 expected =
      (dvec3(r.diffuse) / pi +
       dvec3(shared::specular_brdf(r, float(light.z), float(half.z), float(glm::dot(light, half))))) *
      light.z;
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(scatter.reflected(light)[c], expected[c], 1e-5);
  // The integral of the density over all directions, by a product rule.
  double integral = 0.0;
  constexpr int rings = 800, sectors = 800;
  for (int i = 0; i < rings; ++i)
    for (int k = 0; k < sectors; ++k) {
      const double z = 1.0 - (2.0 * i + 1.0) / rings, phi = 2.0 * pi * (k + 0.5) / sectors,
                   level = std::sqrt(1.0 - z * z);
      integral += scatter.density({level * std::cos(phi), level * std::sin(phi), z}) * 4.0 * pi /
                  (rings * double(sectors));
    }
  EXPECT_NEAR(integral, 1.0, 1e-3);
}

TEST(Reference, HolesAndBodiesAreWhereTheyAre) {
  TinyScene tiny;
  scene::Material holes = matt(0.0, 10.0);
  holes.pbr.base_color.a = 0.2f;
  holes.pbr.alpha_mode = scene::AlphaMode::mask;
  tiny.object("holes", 0, tiny.material_as(holes)).quad({5, -9, -9}, {5, 9, -9}, {5, 9, 9}, {5, -9, 9});
  const uint32_t body = tiny.body("board");
  tiny.object("board", body, tiny.material_as(matt(0.0, 70.0)))
      .quad({0, -1, -1}, {0, 1, -1}, {0, 1, 1}, {0, -1, 1});
  const scene::Scene scene = tiny.build();
  render::CameraEffects effects = matt_effects();
  effects.sky = effects.sun = false;
  std::vector<Pose> poses(2);
  poses[1].position = {20, 8, 0};
  const render::PathTracer tracer(scene, poses, {}, effects, {});
  const auto seen = [&](const dvec3& direction, std::optional<uint32_t> excluded = {}) {
    render::PathDraws draws(0, 0, 0);
    return luminance(tracer.trace({dvec3(0.0), glm::normalize(direction)}, 0.1, draws, excluded).radiance);
  };
  EXPECT_NEAR(seen({20, 8, 0}), 70.0, 1e-4);
  EXPECT_EQ(seen({20, 8, 0}, body), 0.0);
  EXPECT_EQ(seen({20, 6.9, 0}), 0.0);
  effects.alpha_mask = false;
  render::PathDraws draws(0, 0, 0);
  EXPECT_NEAR(luminance(render::PathTracer(scene, poses, {}, effects, {})
                            .trace({dvec3(0.0), dvec3(1, 0, 0)}, 0.1, draws)
                            .radiance),
              10.0, 1e-5);
}

TEST(Reference, SwitchedLampsFollowTheirFactors) {
  TinyScene tiny;
  scene::Material lens = matt(0.0, 80.0);
  lens.name = "switched_stop";
  const uint32_t material = tiny.material_as(lens);
  tiny.object("left", 0, material).quad({5, 0, -9}, {5, 9, -9}, {5, 9, 9}, {5, 0, 9});
  tiny.object("right", 0, material).quad({5, -9, -9}, {5, 0, -9}, {5, 0, 9}, {5, -9, 9});
  const scene::Scene scene = tiny.build();
  ASSERT_EQ(scene::switched_lamps(scene).lamps.size(), 2u);
  render::CameraEffects effects = matt_effects();
  effects.sky = effects.sun = false;
  const auto seen = [&](double y, std::vector<float> factors) {
    const render::PathTracer tracer(scene, std::vector<Pose>(1), {}, effects,
                                    {.lamp_factors = std::move(factors)});
    render::PathDraws draws(0, 0, 0);
    const dvec3 direction = glm::normalize(dvec3(5.0, y, 0.0));
    return luminance(tracer.trace({dvec3(0.0), direction}, 0.1, draws).radiance);
  };
  EXPECT_NEAR(seen(1.0, {0.25f, 0.0f}), 20.0, 1e-4);
  EXPECT_EQ(seen(-1.0, {0.25f, 0.0f}), 0.0);
  EXPECT_NEAR(seen(-1.0, {}), 80.0, 1e-4) << "without factors all shine";
}

TEST(Reference, HazeLiesBeforeSurfaces) {
  TinyScene tiny;
  tiny.object("wall", 0, tiny.material_as(matt(0.0)))
      .quad({50, -99, -99}, {50, 99, -99}, {50, 99, 99}, {50, -99, 99});
  render::Lighting lighting = white_world(1000.0 * pi);
  lighting.haze_extinction_per_m = 0.02;
  render::CameraEffects effects = matt_effects();
  effects.haze = true;
  const render::Sky sky(lighting, true);
  const Estimate found = look_along(tiny.build(), lighting, effects, 0, {0, 0, 0}, {1, 0, 0}, 10);
  EXPECT_NEAR(found.mean, (1.0 - std::exp(-1.0)) * luminance(sky.haze_ambient()), 1e-6 * found.mean);
}

/// A camera before a box on the ground, in the light of sun and sky.
render::ReferencePicture small_picture(uint32_t samples, uint32_t threads, uint64_t seed = 1) {
  TinyScene tiny;
  tiny.object("ground", 0, tiny.material_as(matt(0.4)));
  ground(tiny, 50.0);
  tiny.object("box", 0, tiny.material_as(matt(0.6))).box({4, -1, 0}, {6, 1, 2});
  const scene::Scene scene = tiny.build();
  render::CameraDesc desc;
  desc.width = 24;
  desc.height = 16;
  desc.fx = desc.fy = 12.0;
  desc.cx = 12.0;
  desc.cy = 8.0;
  const std::vector<Pose> poses(1);
  render::ReferenceOptions options;
  options.samples = samples;
  options.threads = threads;
  options.seed = seed;
  return render::trace_reference(scene, poses, render::Lighting{}, matt_effects(), desc,
                                 Pose{{0, 0, 1.5}, dquat(1, 0, 0, 0)}, options);
}

double sum_of(const std::vector<float>& values) {
  double sum = 0.0;
  for (const float value : values) sum += value;
  return sum;
}

TEST(Reference, VarianceFallsWithTheNumberOfPathsAndIsTrue) {
  const render::ReferencePicture few = small_picture(16, 0), many = small_picture(256, 0),
                                 other = small_picture(16, 0, 2);
  EXPECT_NEAR(sum_of(few.variance) / sum_of(many.variance), 16.0, 3.0);
  // The squares of the true differences of two independent pictures are twice the variance that each states.
  double squares = 0.0;
  for (size_t i = 0; i < few.variance.size(); ++i) {
    const auto value = [&](const render::ReferencePicture& picture) {
      return luminance(
          dvec3(picture.radiance[3 * i], picture.radiance[3 * i + 1], picture.radiance[3 * i + 2]));
    };
    squares += std::pow(value(few) - value(other), 2.0);
  }
  EXPECT_NEAR(squares / (2.0 * sum_of(few.variance)), 1.0, 0.35);
}

TEST(Reference, ThreadsChangeNoByte) {
  const render::ReferencePicture one = small_picture(4, 1), three = small_picture(4, 3);
  EXPECT_EQ(one.radiance, three.radiance);
  EXPECT_EQ(one.variance, three.variance);
}

TEST(Reference, ErrorsAreThoseOfTheDifference) {
  render::ReferencePicture reference = small_picture(4, 0);
  std::fill(reference.variance.begin(), reference.variance.end(), 0.0f);
  std::fill(reference.radiance.begin(), reference.radiance.end(), 100.0f);
  std::vector<float> brighter(reference.radiance.size(), 110.0f);
  std::vector<uint8_t> counted(reference.variance.size(), 1);
  counted[0] = 0;
  brighter[0] = 1e6f;  // not counted
  const render::ReferenceError error = render::compare_with(reference, brighter, counted, 1e4);
  EXPECT_EQ(error.pixels, counted.size() - 1);
  EXPECT_NEAR(error.rmse, 0.1, 1e-6);
  EXPECT_NEAR(error.bias, 0.1, 1e-6);
  // Beyond the saturation both are the same white.
  EXPECT_EQ(render::compare_with(reference, brighter, counted, 50.0).rmse, 0.0);
}

}  // namespace
}  // namespace greatx::test
