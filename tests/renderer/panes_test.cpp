// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds what cameras see through panes of glass against closed forms and the path-traced reference.
#include "renderer/camera/panes.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderer/reference/path_tracer.h"
#include "renderer/surface/closed_bodies.h"
#include "renderer/surface/pane_color.h"
#include "scene/build/build.h"
#include "scene/generator/generate.h"
#include "scene/generator/shapes.h"
#include "shaders/shared/brdf.h"
#include "shaders/shared/pane.h"
#include "tests/renderer/camera_rig.h"

namespace greatx::test {
namespace {

constexpr double glow_cd_m2 = 2000.0;

scene::Material glass(const vec3& color = vec3(1.0f), float transmission = 1.0f) {
  scene::Material material;
  material.name = "glass";
  material.pbr.base_color = vec4(color, 1.0f);
  material.pbr.metallic = 0.0f;
  material.pbr.roughness = 0.05f;
  material.pbr.transmission = transmission;
  return material;
}

scene::Material glowing() {
  scene::Material material = optical_material("screen", 0.0f);
  material.pbr.emissive = vec3(float(glow_cd_m2 / 1000.0));
  return material;
}

/// A screen that glows at x = 5, and upright panes at the given x before it.
scene::Scene behind_glass(const std::vector<double>& panes, const vec3& color = vec3(1.0f)) {
  TinyScene tiny;
  tiny.object("screen", 0, tiny.material_as(glowing())).quad({5, 9, -9}, {5, -9, -9}, {5, -9, 9}, {5, 9, 9});
  const uint32_t pane = tiny.material_as(glass(color));
  for (const double x : panes)
    tiny.object("pane", 0, pane).quad({x, 9, -9}, {x, -9, -9}, {x, -9, 9}, {x, 9, 9});
  return tiny.build();
}

/// Nothing shines but what glows.
render::CameraEffects dark(bool panes = true) {
  render::CameraEffects effects;
  effects.sun = effects.sky = false;
  effects.panes = panes;
  return effects;
}

/// Returns (1 - R) / (1 + R) for unpolarized light, from Fresnel's equations by angles.
double pane_transmittance(double cosine) {
  const double angle = std::acos(cosine), inner = std::asin(std::sin(angle) / 1.5);
  double sum = 0.0;
  if (angle < 1e-9) return 0.96 / 1.04;
  for (const double r :
       {std::sin(angle - inner) / std::sin(angle + inner), std::tan(angle - inner) / std::tan(angle + inner)})
    sum += 0.5 * (1.0 - r * r) / (1.0 + r * r);
  return sum;
}

TEST(Panes, ReflectAndPassAllLight) {
  EXPECT_NEAR(shared::pane_reflectance(1.0f, 1.5f, 1.0f), 0.08 / 1.04, 1e-6);
  for (const double degrees : {10.0, 45.0, 60.0, 75.0, 85.0}) {
    const double cosine = std::cos(radians(degrees));
    EXPECT_NEAR(1.0 - double(shared::pane_reflectance(float(cosine), 1.5f, 1.0f)), pane_transmittance(cosine),
                2e-6)
        << degrees;
    const shared::Reflectance r = shared::pane_reflectance_of(vec3(0.3f), 0.05f, float(cosine));
    EXPECT_NEAR(double(r.albedo.x), 1.0 - pane_transmittance(cosine), 2e-6);
    // The Fresnel term of its lobe is that of the pane in the mirror's direction.
    EXPECT_NEAR(double(shared::schlick_fresnel(r.f0, float(1.0 - cosine)).x), double(r.albedo.x), 2e-6);
  }
}

TEST(Panes, AreMaterialsThatSayWhatPasses) {
  scene::PbrMaterial pbr = glass(vec3(0.5f, 0.6f, 0.7f), 0.8f).pbr;
  EXPECT_EQ(render::pane_color(pbr), 0.8f * vec3(0.5f, 0.6f, 0.7f));
  EXPECT_FLOAT_EQ(render::solid_color(pbr).x, 0.5f * (1.0f - 0.8f));
  const auto is_pane = [&](const auto& change) {
    scene::PbrMaterial other = pbr;
    change(other);
    return render::pane_color(other).has_value();
  };
  EXPECT_FALSE(is_pane([](auto& p) { p.transmission = 0.0f; }));
  EXPECT_FALSE(is_pane([](auto& p) { p.roughness = 0.5f; }));
  EXPECT_FALSE(is_pane([](auto& p) { p.metallic = 1.0f; }));
  EXPECT_FALSE(is_pane([](auto& p) { p.base_color_texture = 0; }));
  EXPECT_FALSE(is_pane([](auto& p) { p.alpha_mode = scene::AlphaMode::mask; }));
  pbr.base_color.a = 0.2f;  // alpha covers a share of the surface and does not tint
  EXPECT_EQ(render::pane_color(pbr), vec3(0.8f));
}

/// The light of the screen is weakened by every pane, whatever their number and order.
TEST(Panes, WeakenTheLightBehindThemByFresnel) {
  // The corners of the picture see all panes from less than the distance at which they fade.
  const std::vector<std::vector<double>> rows{{0.95, 0.6}, {0.5, 0.6, 0.7, 0.8, 0.9}};
  for (const uint32_t msaa : {1u, 4u})
    for (const std::vector<double>& panes : rows) {
      const render::CameraDesc desc = plain_camera(64, msaa);
      CameraRig rig(behind_glass(panes), plain_light(), desc, dark());
      const render::CameraImages images = rig.shoot(look({0, 0, 0}));
      for (const uint32_t column : {1u, 8u, 31u, 40u, 62u})
        for (const uint32_t row : {2u, 31u, 50u}) {
          const double cosine = 1.0 / glm::length(pixel_ray(desc, column, row));
          const double expected = glow_cd_m2 * std::pow(pane_transmittance(cosine), double(panes.size()));
          // Halves keep 11 bits, and each pane rounds once.
          EXPECT_NEAR(luminance_at(images, row * 64 + column) / expected, 1.0,
                      6e-4 * (2.0 + double(panes.size())))
              << panes.size() << " panes, " << msaa << " samples, " << column << ", " << row;
        }
    }
}

TEST(Panes, TintByTheirColour) {
  const vec3 color(0.9f, 0.6f, 0.3f);
  CameraRig rig(behind_glass({0.6, 0.9}, color), plain_light(), plain_camera(), dark());
  const render::CameraImages images = rig.shoot(look({0, 0, 0}));
  const size_t middle = 32 * 64 + 32;
  const double through =
      std::pow(pane_transmittance(1.0 / glm::length(pixel_ray(plain_camera(), 32, 32))), 2.0);
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(images.hdr[3 * middle + size_t(c)], glow_cd_m2 * color[c] * color[c] * through, 3.0) << c;
}

/// Depth and ids report the nearest pane, with the same bytes as where panes are solid.
TEST(Panes, DepthAndIdsAreTheirs) {
  for (const uint32_t msaa : {1u, 4u}) {
    TinyScene tiny;
    tiny.object("screen", 0, tiny.material_as(glowing()))
        .quad({5, 9, -9}, {5, -9, -9}, {5, -9, 9}, {5, 9, 9});
    tiny.object("post", 0, tiny.material_as(optical_material("post", 0.5f)))
        .box({0.4, -0.05, -1}, {0.5, 0.05, 1});
    const uint32_t pane = tiny.material_as(glass());
    tiny.object("far pane", 0, pane).quad({1.0, 9, -9}, {1.0, 0.1, -9}, {1.0, 0.1, 9}, {1.0, 9, 9});
    tiny.object("pane", 0, pane).quad({0.8, 0.4, -0.5}, {0.8, -0.6, -0.5}, {0.8, -0.6, 0.4}, {0.8, 0.4, 0.4});
    const scene::Scene scene = tiny.build();
    const auto shoot = [&](bool panes) {
      CameraRig rig(scene, plain_light(), plain_camera(64, msaa), dark(panes));
      return rig.shoot(look({0, 0, 0}, 4.0, 3.0));
    };
    const render::CameraImages with = shoot(true), without = shoot(false);
    EXPECT_EQ(with.depth, without.depth);
    EXPECT_EQ(with.instance, without.instance);
    EXPECT_EQ(with.material, without.material);
    EXPECT_NE(with.hdr, without.hdr);
    EXPECT_GT(std::ranges::count(with.material, with.material[32 * 64 + 34]), 20);
  }
}

TEST(Panes, MoveWithTheirBodies) {
  TinyScene tiny;
  tiny.object("screen", 0, tiny.material_as(glowing())).quad({5, 9, -9}, {5, -9, -9}, {5, -9, 9}, {5, 9, 9});
  const uint32_t car = tiny.body("car");
  tiny.object("window", car, tiny.material_as(glass())).quad({0, 1, -1}, {0, -1, -1}, {0, -1, 1}, {0, 1, 1});
  tiny.object("door", car, tiny.material_as(optical_material("door", 0.5f)))
      .quad({0, 1, -2}, {0, -1, -2}, {0, -1, -1}, {0, 1, -1});
  CameraRig rig(tiny.build(), plain_light(), plain_camera(), dark());
  const auto middle = [&](const Pose& pose) {
    return luminance_at(rig.shoot(look({0, 0, 0}), {pose}), 32 * 64 + 32);
  };
  const double ray = glm::length(pixel_ray(plain_camera(), 32, 32));
  EXPECT_NEAR(middle({{0.8, 0, 0}, {}}) / (glow_cd_m2 * pane_transmittance(1.0 / ray)), 1.0, 2e-3);
  EXPECT_EQ(middle({{0.8, 0, 1.5}, {}}), 0.0);  // the door
  EXPECT_NEAR(middle({{0.8, 3, 0}, {}}) / glow_cd_m2, 1.0, 1e-3);
  // Turned by 60 degrees.
  const Pose turned = look({0.8, 0, 0}, 60.0);
  const dvec3 normal = turned.rotate(dvec3(1, 0, 0)),
              direction = glm::normalize(pixel_ray(plain_camera(), 32, 32));
  EXPECT_NEAR(middle(turned) / (glow_cd_m2 * pane_transmittance(std::abs(glm::dot(normal, direction)))), 1.0,
              2e-3);
}

TEST(Panes, FadeWithDistanceUntilTheyAreSolid) {
  const render::CameraDesc desc = plain_camera();
  const render::CameraView view(render::pinhole_of(desc), desc.near_m, look({0, 0, 0}),
                                render::SunFrame({0, 0, 1}), 1.0);
  const double reach = render::pane_reach(view);
  EXPECT_NEAR(reach, shared::pane_dark_pixel * desc.fx, 1e-6);
  for (const double share : {0.5, 0.8, 0.95, 1.05}) {
    CameraRig rig(behind_glass({share * reach}), plain_light(), desc, dark());
    const double ray = glm::length(pixel_ray(desc, 32, 32));
    const double shows = double(shared::pane_shows(float(share * reach * ray / desc.fx)));
    EXPECT_NEAR(luminance_at(rig.shoot(look({0, 0, 0})), 32 * 64 + 32),
                glow_cd_m2 * shows * pane_transmittance(1.0 / ray), 4.0)
        << share;
  }
}

/// In a world that is equally bright all around, clear panes are invisible. The camera leaves out what panes
/// behind the nearest mirror: it shows R + T^n, and lacks at most the rest.
TEST(Panes, LackOnlyWhatPanesBehindTheNearestMirror) {
  const render::Lighting lighting = white_world(1000.0 * pi);
  render::CameraEffects effects;
  effects.sun = false;
  effects.panes = true;
  for (const size_t count : {size_t{1}, size_t{2}, size_t{3}}) {
    TinyScene tiny;
    const uint32_t pane = tiny.material_as(glass());
    for (size_t i = 0; i < count; ++i) {
      const double x = 0.6 + 0.2 * double(i);
      tiny.object("pane", 0, pane).quad({x, 9, -9}, {x, -9, -9}, {x, -9, 9}, {x, 9, 9});
    }
    const scene::Scene scene = tiny.build();
    CameraRig rig(scene, lighting, plain_camera(), effects);
    const render::CameraImages images = rig.shoot(look({0, 0, 0}));
    const std::vector<Pose> poses(1);
    const render::PathTracer tracer(scene, poses, lighting, effects, {.bounces = 40});
    for (const uint32_t column : {2u, 31u}) {
      const dvec3 ray = pixel_ray(plain_camera(), column, 31);
      const double through = pane_transmittance(1.0 / glm::length(ray));
      const double shown = luminance_at(images, 31 * 64 + column);
      EXPECT_NEAR(shown, 1000.0 * (1.0 - through + std::pow(through, double(count))), 8.0) << count;
      double sum = 0.0;
      constexpr int paths = 4000;
      for (int i = 0; i < paths; ++i) {
        render::PathDraws draws(1, column, uint32_t(i));
        sum += render::luminance(tracer.trace({dvec3(0.0), glm::normalize(ray)}, 0.0, draws).radiance);
      }
      // The reference holds the sum of all images, less what narrow lobes lose.
      EXPECT_NEAR(sum / paths, 1000.0, 15.0) << count;
    }
  }
}

/// A pane before a lit room glows as far as a camera does not look through it.
TEST(Panes, LitPanesGlowWhereTheyDoNotClear) {
  const render::CameraDesc desc = plain_camera();
  const double reach = double(shared::pane_dark_pixel) * desc.fx, own_cd_m2 = 300.0;
  for (const double share : {0.5, 0.8, 0.95, 1.05})
    for (const bool panes : {true, false}) {
      TinyScene tiny;
      tiny.object("screen", 0, tiny.material_as(glowing()))
          .quad({5, 9, -9}, {5, -9, -9}, {5, -9, 9}, {5, 9, 9});
      scene::Material lit = glass();
      lit.name = "lit_pane_of_a_bus";
      lit.pbr.emissive = vec3(float(own_cd_m2 / 1000.0));
      const double x = share * reach;
      tiny.object("pane", 0, tiny.material_as(lit)).quad({x, 9, -9}, {x, -9, -9}, {x, -9, 9}, {x, 9, 9});
      CameraRig rig(tiny.build(), plain_light(), desc, dark(panes));
      const double ray = glm::length(pixel_ray(desc, 32, 32));
      const double shows = panes ? double(shared::pane_shows(float(x * ray / desc.fx))) : 0.0;
      EXPECT_NEAR(luminance_at(rig.shoot(look({0, 0, 0})), 32 * 64 + 32),
                  glow_cd_m2 * shows * pane_transmittance(1.0 / ray) + own_cd_m2 * (1.0 - shows), 4.0)
          << share << panes;
    }
}

TEST(Panes, HazeLiesBeforeAndBehindThem) {
  render::Lighting lighting = plain_light();
  lighting.haze_extinction_per_m = 0.2;
  render::CameraEffects effects = dark();
  effects.sky = effects.haze = true;
  effects.specular = false;
  const scene::Scene scene = behind_glass({1.2});
  CameraRig rig(scene, lighting, plain_camera(), effects);
  const render::CameraImages images = rig.shoot(look({0, 0, 0}));
  const std::vector<Pose> poses(1);
  const render::PathTracer tracer(scene, poses, lighting, effects, {.bounces = 0});
  for (const uint32_t column : {10u, 32u}) {
    double sum = 0.0;
    for (uint32_t i = 0; i < 500; ++i) {
      render::PathDraws draws(1, column, i);
      sum += render::luminance(
          tracer.trace({dvec3(0.0), glm::normalize(pixel_ray(plain_camera(), column, 32))}, 0.0, draws)
              .radiance);
    }
    EXPECT_NEAR(luminance_at(images, 32 * 64 + column) / (sum / 500.0), 1.0, 0.01) << column;
  }
}

TEST(Panes, LetLightInWhereThePathTracerLooks) {
  // A matt floor under a pane, lit by a white sky: albedo T(mean) of the light comes in, and goes out again.
  TinyScene tiny;
  tiny.object("floor", 0, tiny.material_as(optical_material("floor", 0.5f)))
      .quad({-90, -90, 0}, {90, -90, 0}, {90, 90, 0}, {-90, 90, 0});
  tiny.object("pane", 0, tiny.material_as(glass()))
      .quad({-90, -90, 1}, {90, -90, 1}, {90, 90, 1}, {-90, 90, 1});
  const render::Lighting lighting = white_world(1000.0 * pi);
  render::CameraEffects effects;
  effects.specular = false;
  effects.panes = true;
  const scene::Scene scene = tiny.build();
  const std::vector<Pose> poses(1);
  const render::PathTracer tracer(scene, poses, lighting, effects, {.bounces = 0});
  double mean = 0.0;
  constexpr int paths = 20000;
  for (int i = 0; i < paths; ++i) {
    render::PathDraws draws(5, 1, uint32_t(i));
    mean += render::luminance(tracer.trace({{0, 0, 0.5}, {0, 0, -1}}, 0.0, draws).radiance) / paths;
  }
  double hemisphere = 0.0;  // of T cos, over pi
  for (int i = 0; i < 1000; ++i) {
    const double level = (i + 0.5) / 1000.0;  // sin^2
    hemisphere += pane_transmittance(std::sqrt(1.0 - level)) / 1000.0;
  }
  EXPECT_NEAR(mean / (500.0 * hemisphere), 1.0, 0.01);
}

/// A body with a roof of glass. Its inside is a sheet below the roof, or lies within the floor.
scene::Scene with_inside(bool inside) {
  TinyScene tiny;
  tiny.quad({-90, -90, 0}, {90, -90, 0}, {90, 90, 0}, {-90, 90, 0});
  const uint32_t car = tiny.body("car"), paint = tiny.material_as(optical_material("paint", 0.5f));
  tiny.object("car", car, paint).open_box({-2, -1, 0.3}, {2, 1, 1.5});
  tiny.object("roof", car, tiny.material_as(glass(vec3(0.8f))))
      .quad({-2, -1, 1.5}, {2, -1, 1.5}, {2, 1, 1.5}, {-2, 1, 1.5});
  if (inside)
    tiny.object("seat", car, tiny.material_as(glowing()))
        .quad({-1, -0.5, 1.2}, {1, -0.5, 1.2}, {1, 0.5, 1.2}, {-1, 0.5, 1.2});
  return tiny.build();
}

/// Insides, which far cameras do not draw, would not show there.
TEST(Panes, InsidesShowNearByAlone) {
  ASSERT_EQ(render::insides(with_inside(true)), (std::vector<bool>{false, false, false, true}));
  ASSERT_TRUE(render::closed_surfaces(with_inside(true)).bodies[1]);
  ASSERT_FALSE(render::closed_bodies(with_inside(true))[1]);
  const render::CameraDesc desc = plain_camera(128);
  const double reach = double(shared::pane_dark_pixel) * desc.fx;
  CameraRig with(with_inside(true), plain_light(60.0, 35.0), desc, dark()),
      without(with_inside(false), plain_light(60.0, 35.0), desc, dark());
  for (int k = 0; k < 6; ++k) {
    const Pose car{{0.3 * k, -0.2 * k, 0.0}, orientation_from_yaw_pitch_roll(0.7 * k, 0.02 * k, -0.1 * k)};
    const Pose far = look({-reach - 6.0, 1, 3.0}, 0.0, 15.0), near = look({-2.5, 0, 4.5}, 0.0, 60.0);
    EXPECT_EQ(with.shoot(far, {car}).hdr, without.shoot(far, {car}).hdr);
    EXPECT_NE(with.shoot(near, {car}).hdr, without.shoot(near, {car}).hdr);
  }
}

TEST(Panes, InsidesAreHiddenFromAllSides) {
  const auto found = [](const dvec3& a, const dvec3& b, const dvec3& c, bool open = false) -> bool {
    TinyScene tiny;
    const uint32_t body = tiny.body("case"), pane = tiny.material_as(glass());
    tiny.object("case", body, pane).box({0, 0, 0}, {2, 2, 2});
    if (open) tiny.quad({2, 2, 2}, {2, 3, 2}, {2, 3, 3}, {2, 2, 3});
    tiny.object("thing", body).triangle(a, b, c);
    return render::insides(tiny.build())[1];
  };
  EXPECT_TRUE(found({0.5, 0.5, 0.5}, {1.5, 0.5, 0.5}, {0.5, 1.5, 1.5}));
  EXPECT_FALSE(found({0.5, 0.5, 0.5}, {2.5, 0.5, 0.5}, {0.5, 1.5, 1.5})) << "a corner sticks out";
  EXPECT_FALSE(found({-9, 1, 1}, {9, 1, 1}, {1, 9, 1})) << "it cuts the case, and all corners are outside";
  EXPECT_FALSE(found({4, 0, 0}, {5, 0, 0}, {4, 1, 0})) << "beside the case";
  EXPECT_FALSE(found({0.5, 0.5, 0.5}, {1.5, 0.5, 0.5}, {0.5, 1.5, 1.5}, true)) << "the case is not closed";
}

/// Far away a generated vehicle is its closed shell, without its inside.
TEST(Panes, GeneratedVehiclesHideTheirInsides) {
  for (const scene::VehicleShape& shape : scene::vehicle_shapes()) {
    if (shape.two_wheeler) continue;
    const scene::Model model = scene::load_model(
        "v.glb", scene::generate_glb({.kind = "vehicle", .seed = 5, .variant = shape.variant}), {});
    const scene::Scene scene = scene::build_scene({{.name = "v", .model = &model, .moving = true}}, {});
    const render::ClosedSurfaces surfaces = render::closed_surfaces(scene);
    std::set<std::string> hidden, shown;
    for (size_t i = 0; i < scene.primitives.size(); ++i)
      (surfaces.insides[i] ? hidden : shown).insert(scene.materials[scene.primitives[i].material].name);
    EXPECT_THAT(shown, testing::Not(testing::Contains(testing::AnyOf("cabin", "seat", "bus_seat", "bus_pole",
                                                                     "bus_floor", "bus_ceiling"))))
        << shape.variant;
    EXPECT_FALSE(hidden.empty()) << shape.variant;
    EXPECT_TRUE(surfaces.bodies[1]) << shape.variant;
  }
}

}  // namespace
}  // namespace greatx::test
