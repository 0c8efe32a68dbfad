// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks the light that reaches the eye against closed forms. Pictures hold half floats with a relative
// precision of 2^-11.
#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/build/build.h"
#include "shaders/shared/develop.h"
#include "tests/renderer/camera_rig.h"

namespace greatx::test {
namespace {

constexpr double half_float = 1e-3;

TinyScene ground(const scene::Material& material, double half = 30.0) {
  TinyScene tiny;
  tiny.object("ground", 0, tiny.material_as(material))
      .quad({-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0});
  return tiny;
}

TEST(Shading, LevelLambertianPlaneIsExact) {
  // L = rho (E_sun sin(elevation) + E_sky) / pi holds at every pixel, without shadow acne or light leaks.
  for (const double elevation : {5.0, 40.0, 90.0}) {
    CameraRig rig(ground(optical_material("grey", 0.5f)).build(), plain_light(70.0, elevation),
                  plain_camera(48, 4), lambertian());
    const render::CameraImages images = rig.shoot(look({0, 0, 12}, 15.0, 80.0));
    const double expected = 0.5 * (100000.0 * std::sin(radians(elevation)) + 15000.0) / pi;
    for (size_t i = 0; i < images.depth.size(); ++i)
      EXPECT_NEAR(luminance_at(images, i) / expected, 1.0, half_float) << i << " " << elevation;
  }
}

TEST(Shading, BelowTheHorizonTheSunGivesNothing) {
  CameraRig rig(ground(optical_material("grey", 0.5f)).build(), plain_light(0.0, -10.0), plain_camera(16, 1),
                lambertian());
  const render::CameraImages images = rig.shoot(look({0, 0, 12}, 0.0, 90.0));
  for (size_t i = 0; i < images.depth.size(); ++i)
    EXPECT_NEAR(luminance_at(images, i) / (0.5 * 15000.0 / pi), 1.0, half_float);
}

TEST(Shading, BothSidesOfASheetAreLit) {
  // Each side of a sheet shows the light that falls on this side, for either order of the corners. The sun
  // lights one side only.
  for (const bool turned : {false, true}) {
    TinyScene tiny;
    const uint32_t grey = tiny.material_as(optical_material("grey", 0.5f));
    const dvec3 a(5, 9, -9), b(5, -9, -9), c(5, -9, 9), d(5, 9, 9);
    tiny.object("sheet", 0, grey);
    if (turned)
      tiny.quad(a, d, c, b);
    else
      tiny.quad(a, b, c, d);
    render::CameraEffects effects = lambertian();
    effects.sky = false;
    CameraRig rig(tiny.build(), plain_light(180.0, 30.0), plain_camera(16, 1), effects);
    const render::CameraImages front = rig.shoot(look({0, 0, 0})), back = rig.shoot(look({10, 0, 0}, 180.0));
    for (size_t i = 0; i < front.depth.size(); ++i) {
      EXPECT_NEAR(luminance_at(front, i) / (0.5 * 1e5 * std::cos(radians(30.0)) / pi), 1.0, half_float);
      EXPECT_EQ(luminance_at(back, i), 0.0);
    }
  }
}

TEST(Shading, FurnaceHasNoEdges) {
  // A white surface in a uniformly white world reflects all incident light at any angle, roughness and
  // metalness.
  const render::Lighting furnace = white_world();
  for (const float metallic : {0.0f, 1.0f})
    for (const float roughness : {0.1f, 0.5f, 1.0f}) {
      TinyScene tiny;
      tiny.object("cube", 0, tiny.material_as(optical_material("white", 1.0f, metallic, roughness)))
          .box({-1, -1, -1}, {1, 1, 1});
      CameraRig rig(tiny.build(), furnace, plain_camera(48, 4));
      const render::CameraImages images = rig.shoot(look({-3, -2, 2.5}, 33.7, 35.0));
      for (size_t i = 0; i < images.depth.size(); ++i)
        EXPECT_NEAR(luminance_at(images, i) / (15000.0 / pi), 1.0, 4e-3)
            << metallic << " " << roughness << " " << i;
    }
}

TEST(Shading, ShadowOfABoxFallsWhereGeometrySays) {
  const dvec3 low(-1.0, -1.5, 0.0), high(1.0, 1.5, 3.0);
  for (const bool moving : {false, true}) {
    TinyScene tiny = ground(optical_material("grey", 0.5f), 12.0);
    const Pose placed{{0.7, -0.4, 0.0}, {1, 0, 0, 0}};
    const uint32_t body = moving ? tiny.body("box") : 0;
    if (moving)
      tiny.object("box", body).box(low, high);
    else
      tiny.object("box").box(low + placed.position, high + placed.position);
    render::CameraEffects effects = lambertian();
    effects.sky = false;
    const render::Lighting lighting = plain_light(35.0, 40.0);
    const render::CameraDesc desc = plain_camera(96, 1);
    CameraRig rig(tiny.build(), lighting, desc, effects);
    const Pose sensor = look({0, 0, 10}, 0.0, 90.0);
    const render::CameraImages images = rig.shoot(sensor, {placed});
    const double lit = 0.5 * 1e5 * std::sin(radians(40.0)) / pi;
    // Returns whether the line from p to the sun meets the box grown by `by`.
    const auto blocked = [&](const dvec3& p, double by) {
      const dvec3 a = (low + placed.position - by - p) / lighting.sun_direction,
                  b = (high + placed.position + by - p) / lighting.sun_direction;
      const dvec3 n = glm::min(a, b), f = glm::max(a, b);
      return std::max({n.x, n.y, n.z, 0.0}) < std::min({f.x, f.y, f.z});
    };
    size_t shadowed = 0, sunny = 0;
    for (uint32_t row = 0; row < desc.height; ++row)
      for (uint32_t column = 0; column < desc.width; ++column) {
        const size_t i = row * desc.width + column;
        if (images.instance[i] != 1) continue;
        const dvec3 p = sensor.apply(pixel_ray(desc, column, row) * double(images.depth[i]));
        const double margin = 0.2;  // two texels of the shadow maps and their filter
        if (!blocked(p, margin)) {
          EXPECT_NEAR(luminance_at(images, i) / lit, 1.0, half_float) << p.x << " " << p.y;
          ++sunny;
        } else if (blocked(p, -margin)) {
          EXPECT_EQ(luminance_at(images, i), 0.0) << p.x << " " << p.y;
          ++shadowed;
        }
      }
    EXPECT_GT(shadowed, 150u);
    EXPECT_GT(sunny, 3000u);
    if (!moving) continue;
    const render::CameraImages later = rig.shoot(sensor, {Pose{{-4.0, 5.0, 0.5}, {1, 0, 0, 0}}});
    EXPECT_NE(images.hdr, later.hdr);
  }
}

TEST(Shading, NegativeScaleIsLitLikeItsMirrorImage) {
  // A cube mirrored in x is the same cube and must get the same light.
  TinyScene tiny;
  tiny.object("cube").box({-1, -1, -1}, {1, 1, 1});
  const scene::Scene cube = tiny.build();
  scene::Model model;
  model.file = "cube";
  model.meshes.push_back({"cube", {}});
  scene::ModelPrimitive primitive;
  primitive.positions = cube.positions;
  primitive.normals = cube.normals;
  primitive.uvs = cube.uvs;
  primitive.indices = cube.indices;
  model.meshes[0].primitives.push_back(primitive);
  model.materials.push_back(optical_material("plaster", 0.6f, 0.0f, 0.4f));
  model.instances.push_back({"cube", 0, dmat4(1.0), {}});
  const auto shot = [&](const dvec3& scale) {
    scene::ModelPlacement placement;
    placement.name = "it";
    placement.model = &model;
    placement.scale = scale;
    scene::BuildOptions options;
    options.origin = dvec3(0.0);
    CameraRig rig(scene::build_scene({placement}, options), plain_light(30.0, 50.0), plain_camera(64, 4));
    return rig.shoot(look({4, 3, 2.5}, -143.0, 27.0));
  };
  const render::CameraImages plain = shot({1, 1, 1}), mirrored = shot({-1, 1, 1}),
                             stretched = shot({1, -1, 1});
  size_t seen = 0;
  for (size_t i = 0; i < plain.depth.size(); ++i) {
    if (plain.instance[i] == 0) continue;
    ++seen;
    EXPECT_NEAR(luminance_at(mirrored, i) / luminance_at(plain, i), 1.0, 2e-2) << i;
    EXPECT_NEAR(luminance_at(stretched, i) / luminance_at(plain, i), 1.0, 2e-2) << i;
  }
  EXPECT_GT(seen, 200u);
}

TEST(Shading, PointLightFollowsTheInverseSquare) {
  scene::Scene scene = ground(optical_material("grey", 0.5f)).build();
  scene::PunctualLight lamp;
  lamp.name = "lamp";
  lamp.position = {1.0, 0.5, 4.0};
  lamp.intensity = 800.0f;
  scene.lights.push_back(lamp);
  render::CameraEffects effects = lambertian();
  effects.sky = effects.sun = false;
  render::CameraDesc desc = plain_camera(48, 1);
  desc.exposure_ev100 = 5.0;
  const Pose sensor = look({0, 0, 6}, 0.0, 90.0);
  const auto check = [&](const scene::Scene& with, double range, double cone) {
    CameraRig rig(with, plain_light(), desc, effects);
    const render::CameraImages images = rig.shoot(sensor);
    for (uint32_t row = 0; row < desc.height; ++row)
      for (uint32_t column = 0; column < desc.width; ++column) {
        const dvec3 to_lamp = lamp.position - sensor.apply(pixel_ray(desc, column, row) * 6.0);
        const double d = glm::length(to_lamp), cosine = to_lamp.z / d;
        double expected = 0.5 / pi * 800.0 * cosine / (d * d);
        if (range > 0.0) expected *= std::max(0.0, 1.0 - std::pow(d / range, 4.0));
        if (cone > 0.0 && std::acos(cosine) > cone - 0.02 && std::acos(cosine) < cone + 0.02) continue;
        if (cone > 0.0 && std::acos(cosine) > cone) expected = 0.0;
        EXPECT_NEAR(luminance_at(images, row * desc.width + column), expected, 2e-3 * expected + 1e-3);
      }
  };
  check(scene, 0.0, 0.0);
  scene.lights[0].range_m = 6.0f;
  check(scene, 6.0, 0.0);
  scene.lights[0].range_m = 0.0f;
  scene.lights[0].type = scene::PunctualLight::Type::spot;  // points straight down
  scene.lights[0].outer_cone = 0.5f;
  scene.lights[0].inner_cone = 0.495f;
  check(scene, 0.0, 0.5);
}

TEST(Shading, EmissionIsAThousandNits) {
  scene::Material glow = optical_material("glow", 0.0f);
  glow.pbr.emissive = vec3(2.0f, 1.0f, 0.5f);
  render::CameraEffects effects;
  effects.sky = effects.sun = false;
  CameraRig rig(ground(glow).build(), plain_light(), plain_camera(8, 1), effects);
  const render::CameraImages images = rig.shoot(look({0, 0, 6}, 0.0, 90.0));
  EXPECT_NEAR(images.hdr[0], 2000.0, 2.0);
  EXPECT_NEAR(images.hdr[1], 1000.0, 1.0);
  EXPECT_NEAR(images.hdr[2], 500.0, 0.5);
}

/// Lamps that switch shine by their factors, more of them than one element of the buffer holds, on the static
/// world and on a body, also where a material has holes. Their neighbours keep their light.
TEST(Shading, SwitchedLampsShineByTheirFactors) {
  constexpr int count = 14;
  const auto scene = [] {
    TinyScene tiny;
    scene::Material lamp = optical_material("switched_red", 0.0f), glow = optical_material("glow", 0.0f);
    lamp.pbr.emissive = vec3(2.0f, 1.0f, 0.5f);
    glow.pbr.emissive = vec3(0.3f);
    scene::Material masked = lamp;
    masked.name = "switched_green";
    masked.pbr.alpha_mode = scene::AlphaMode::mask;
    const uint32_t lamp_of = tiny.material_as(lamp), glow_of = tiny.material_as(glow),
                   masked_of = tiny.material_as(masked), body = tiny.body("car");
    for (int i = 0; i < count; ++i) {
      const double x = i;
      tiny.object(fmt::format("lamp_{}", i), i == 5 ? body : 0, i == 7 ? masked_of : lamp_of)
          .quad({x, -9, 0}, {x + 1, -9, 0}, {x + 1, 0, 0}, {x, 0, 0});
    }
    tiny.object("glow", 0, glow_of).quad({0, 0, 0}, {count, 0, 0}, {count, 9, 0}, {0, 9, 0});
    return tiny.build();
  };
  render::CameraEffects effects;
  effects.sky = effects.sun = false;
  const Pose above = look({0.5 * count, 0.0, 0.5 * count}, 0.0, 90.0);
  const auto red_at = [](const render::CameraImages& images, int lamp, uint32_t column) {
    const auto row = static_cast<size_t>(4 * count - 3 - 4 * lamp);
    return double(images.hdr[3 * (row * images.width + column)]);
  };
  for (const uint32_t msaa : {1u, 4u}) {
    CameraRig rig(scene(), plain_light(), plain_camera(4 * count, msaa), effects);
    const scene::SwitchedLamps& lamps = rig.gpu().switched_lamps();
    ASSERT_EQ(lamps.lamps.size(), size_t{count});
    std::vector<float> factors;
    for (size_t i = 0; i < lamps.lamps.size(); ++i) factors.push_back(0.0625f * float((5 * i) % count));
    const auto check = [&] {
      const render::CameraImages images = rig.shoot(above);
      for (size_t i = 0; i < lamps.lamps.size(); ++i) {
        const std::string& name = rig.scene().instances[lamps.lamps[i].instance].name;
        const int place = std::stoi(name.substr(5));
        EXPECT_NEAR(red_at(images, place, 3 * count), 2000.0 * double(factors[i]), 2.0) << name;
        EXPECT_NEAR(red_at(images, place, count), 300.0, 0.3) << name;
      }
    };
    rig.gpu().set_lamps(factors);
    check();
    std::ranges::reverse(factors);
    rig.gpu().set_lamps(factors);
    check();
  }
  // Without the effect they are dark. By day they shine without the effect `emissive`.
  effects.switched_lamps = false;
  CameraRig dark(scene(), plain_light(), plain_camera(4 * count), effects);
  EXPECT_EQ(red_at(dark.shoot(above), 3, 3 * count), 0.0);
  effects.switched_lamps = true;
  effects.emissive = false;
  CameraRig day(scene(), plain_light(), plain_camera(4 * count), effects);
  EXPECT_NEAR(red_at(day.shoot(above), 3, 3 * count), 2000.0, 2.0);
  EXPECT_EQ(red_at(day.shoot(above), 3, count), 0.0);
}

TEST(Shading, PictureIsTheDevelopedRadiance) {
  CameraRig rig(ground(optical_material("grey", 0.3f)).build(), plain_light(20.0, 50.0), plain_camera(31, 4));
  const render::CameraImages images = rig.shoot(look({0, 0, 2}, 0.0, 5.0));
  const auto scale = float(render::saturation_luminance(15.0));
  for (size_t i = 0; i < images.depth.size(); ++i) {
    const vec3 color =
        shared::tone_map(vec3(images.hdr[3 * i], images.hdr[3 * i + 1], images.hdr[3 * i + 2]) / scale);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(images.rgb[3 * i + size_t(c)], shared::srgb_byte(color[c]), 1);
  }
}

scene::Texture flat_texture(const std::string& name, uint8_t r, uint8_t g, uint8_t b, bool srgb) {
  scene::Texture texture;
  texture.name = name;
  texture.width = texture.height = 4;
  texture.srgb = srgb;
  for (int i = 0; i < 16; ++i) texture.rgba.insert(texture.rgba.end(), {r, g, b, 255});
  return texture;
}

TEST(Shading, TexturesAreDecodedFromSrgb) {
  TinyScene tiny;
  scene::Material painted = optical_material("painted", 0.5f);
  painted.pbr.base_color_texture = int32_t(tiny.texture(flat_texture("grey", 118, 118, 118, true)));
  tiny.object("ground", 0, tiny.material_as(painted)).quad({-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0});
  CameraRig rig(tiny.build(), plain_light(), plain_camera(16, 4), lambertian());
  const render::CameraImages images = rig.shoot(look({0, 0, 4}, 0.0, 90.0));
  const double texel = std::pow((118.0 / 255.0 + 0.055) / 1.055, 2.4);
  for (size_t i = 0; i < images.depth.size(); ++i)
    EXPECT_NEAR(luminance_at(images, i) / (0.5 * texel * 115000.0 / pi), 1.0,
                6e-3);  // precision of 8-bit texels
}

TEST(Shading, NormalMapTurnsTheNormal) {
  // Every texel leans 30 degrees towards the tangent (+x). The sun is 30 degrees from the zenith, towards +x.
  TinyScene tiny;
  scene::Material bumpy = optical_material("bumpy", 0.5f);
  const auto byte = [](double v) { return uint8_t(std::lround(255.0 * (0.5 * v + 0.5))); };
  bumpy.pbr.normal_texture =
      int32_t(tiny.texture(flat_texture("lean", byte(0.5), byte(0.0), byte(std::sqrt(0.75)), false)));
  tiny.object("ground", 0, tiny.material_as(bumpy)).quad({-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0});
  scene::Scene scene = tiny.build();
  for (vec4& tangent : scene.tangents) tangent = vec4(1, 0, 0, 1);
  for (const bool on : {true, false}) {
    render::CameraEffects effects = lambertian();
    effects.sky = false;
    effects.normal_maps = on;
    CameraRig rig(scene, plain_light(0.0, 60.0), plain_camera(16, 1), effects);
    const render::CameraImages images = rig.shoot(look({0, 0, 4}, 0.0, 90.0));
    const double expected = 0.5 * 1e5 / pi * (on ? 1.0 : std::sin(radians(60.0)));
    for (size_t i = 0; i < images.depth.size(); ++i)
      EXPECT_NEAR(luminance_at(images, i) / expected, 1.0, on ? 5e-3 : half_float);
  }
}

}  // namespace
}  // namespace greatx::test
