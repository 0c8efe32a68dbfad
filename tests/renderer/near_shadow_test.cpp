// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks the cascades of static shadows on a scene of 900 m against rays to the sun.
#include "renderer/light/near_shadow.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/renderer/camera_rig.h"

namespace greatx::test {
namespace {

struct House {
  dvec3 low, high;
};

/// Returns houses 12 m wide and of several heights, 40 m apart, about the origin.
std::vector<House> houses() {
  std::vector<House> all;
  for (int i = -6; i <= 6; ++i)
    for (int j = -6; j <= 6; ++j) {
      const dvec2 at(40.0 * i + 3.1 * j, 40.0 * j - 2.3 * i);
      all.push_back({{at.x - 6, at.y - 6, 0}, {at.x + 6, at.y + 6, 6.0 + 2.0 * ((i * 5 + j * 3 + 90) % 7)}});
    }
  return all;
}

scene::Scene wide_scene() {
  TinyScene tiny;
  tiny.object("ground", 0, tiny.material_as(optical_material("grey", 0.5f)))
      .quad({-450, -450, 0}, {450, -450, 0}, {450, 450, 0}, {-450, 450, 0});
  tiny.object("houses");
  for (const House& house : houses()) tiny.box(house.low, house.high);
  return tiny.build();
}

render::CameraEffects effects_with(bool cascades) {
  render::CameraEffects effects = lambertian();
  effects.sky = false;
  effects.shadow_cascades = cascades;
  return effects;
}

constexpr double sun_azimuth = 33.0, sun_elevation = 45.0;

/// Returns the sun with the map over the whole scene as fine as that of a scenario.
render::Lighting wide_light() {
  render::Lighting light = plain_light(sun_azimuth, sun_elevation);
  light.static_shadow_texels = 4096;
  return light;
}

/// Returns whether a house, grown by a margin, stands between a point of the ground and the sun.
bool shaded(const dvec3& p, const dvec3& to_sun, double by) {
  return std::ranges::any_of(houses(), [&](const House& house) {
    const dvec3 a = (house.low - by - p) / to_sun, b = (house.high + by - p) / to_sun;
    const dvec3 near = glm::min(a, b), far = glm::max(a, b);
    return std::max({near.x, near.y, near.z, 0.0}) < std::min({far.x, far.y, far.z});
  });
}

/// Holds how far a picture's shadows on the ground are from those of rays.
struct ShadowError {
  double mean = 0.0;    ///< of the share of the sun
  double widest = 0.0;  ///< m: the smallest margin of a house that explains every pixel
  size_t pixels = 0;
};

ShadowError error_of(const render::CameraImages& images, const render::CameraDesc& desc, const Pose& sensor,
                     const render::Lighting& light, double most_m) {
  const double lit = 0.5 / pi * light.sun_illuminance_lux * light.sun_direction.z;
  ShadowError error;
  for (uint32_t row = 0; row < desc.height; row += 2)
    for (uint32_t column = 0; column < desc.width; column += 2) {
      const size_t i = size_t(row) * desc.width + column;
      if (images.instance[i] != 1 || double(images.depth[i]) > most_m) continue;
      const dvec3 p = sensor.apply(pixel_ray(desc, column, row) * double(images.depth[i]));
      const double share = luminance_at(images, i) / lit;
      const bool exact = shaded(p, light.sun_direction, 0.0);
      error.mean += std::abs(share - (exact ? 0.0 : 1.0));
      ++error.pixels;
      for (const double margin : {0.06, 0.12, 0.25, 0.5, 1.0, 2.0}) {
        const bool explained = exact ? share < 0.01 || !shaded(p, light.sun_direction, -margin)
                                     : share > 0.99 || shaded(p, light.sun_direction, margin);
        if (explained) break;
        error.widest = std::max(error.widest, 2.0 * margin);
      }
    }
  error.mean /= double(std::max<size_t>(error.pixels, 1));
  return error;
}

TEST(NearShadow, CascadesAreChosenByTheTexelOfTheWholeMap) {
  using render::cascade_texels;
  EXPECT_EQ(cascade_texels(0.2), (std::vector<double>{0.0625}));
  EXPECT_EQ(cascade_texels(0.26), (std::vector<double>{0.0625, 0.125}));
  EXPECT_EQ(cascade_texels(1.1), (std::vector<double>{0.0625, 0.25}));
  EXPECT_EQ(cascade_texels(4.0), (std::vector<double>{0.0625, 0.5}));
}

TEST(NearShadow, EdgesStandWhereRaysToTheSunSay) {
  const render::Lighting light = wide_light();
  render::CameraDesc desc = plain_camera(320, 1);
  const Pose sensor = look({20.0, 17.0, 9.0}, 20.0, 24.0);
  ShadowError errors[2];
  for (const bool cascades : {false, true}) {
    CameraRig rig(wide_scene(), light, desc, effects_with(cascades));
    EXPECT_EQ(rig.camera().near_shadows() != nullptr, cascades);
    errors[cascades] = error_of(rig.shoot(sensor), desc, sensor, light, 40.0);
    RecordProperty(cascades ? "mean_with" : "mean_without", std::to_string(errors[cascades].mean));
    RecordProperty(cascades ? "widest_with" : "widest_without", std::to_string(errors[cascades].widest));
  }
  EXPECT_GT(errors[1].pixels, 4000u);
  EXPECT_LE(errors[1].widest, 0.25) << "m, of a texel of 0.0625 m that the light stretches by 1.4";
  EXPECT_GE(errors[0].widest, 0.5) << "the map over the whole scene";
  EXPECT_LT(errors[1].mean, 0.4 * errors[0].mean);
}

TEST(NearShadow, EveryCascadeAndItsSeamsAreRight) {
  // From 150 m above, the picture shows all cascades and the whole map around them.
  const render::Lighting light = wide_light();
  render::CameraDesc desc = plain_camera(300, 1);
  const Pose sensor = look({5.0, -7.0, 150.0}, 0.0, 90.0);
  CameraRig rig(wide_scene(), light, desc, effects_with(true));
  const render::CameraImages images = rig.shoot(sensor);
  const render::NearShadows& maps = *rig.camera().near_shadows();
  ASSERT_EQ(maps.cascades(), 2u);
  EXPECT_LT(maps.reach_m(1), 120.0);
  const ShadowError error = error_of(images, desc, sensor, light, 1e9);
  EXPECT_GT(error.pixels, 15000u);
  EXPECT_LE(error.widest, 1.0) << "m, of the whole map's texels of 0.3 m";
  CameraRig coarse(wide_scene(), light, desc, effects_with(false));
  EXPECT_LT(error.mean, error_of(coarse.shoot(sensor), desc, sensor, light, 1e9).mean);
}

TEST(NearShadow, ShadowsDoNotCrawlWhenTheCameraMoves) {
  // A camera that looks down from 31.25 m sees 0.125 m in a pixel. It moves by whole pixels and by parts of
  // texels, and what it sees moves with it.
  render::CameraDesc desc = plain_camera(250, 1);
  desc.fx = desc.fy = 250.0;
  CameraRig rig(wide_scene(), wide_light(), desc, effects_with(true));
  const auto at = [&](double x) { return look({x, 3.0, 31.25}, 0.0, 90.0); };  // columns run along -y
  const render::CameraImages first = rig.shoot(at(0.0));
  for (const int steps : {1, 5, 40, 120}) {
    const render::CameraImages next = rig.shoot(at(0.125 * steps));
    size_t compared = 0, changed = 0;
    double most = 0.0;
    for (uint32_t row = 0; row + steps < desc.height; ++row)
      for (uint32_t column = 0; column < desc.width; ++column) {
        const size_t a = size_t(row) * desc.width + column, b = size_t(row + steps) * desc.width + column;
        if (first.instance[a] != 1 || next.instance[b] != 1) continue;
        const double difference = std::abs(luminance_at(first, a) - luminance_at(next, b));
        ++compared;
        changed += difference > 1e-3 * 1e5;
        most = std::max(most, difference / (0.5 / pi * 1e5 * std::sin(radians(sun_elevation))));
      }
    EXPECT_GT(compared, 10000u);
    EXPECT_EQ(changed, 0u) << steps << " steps, " << most << " of the sunlight";
  }
}

TEST(NearShadow, APictureDoesNotDependOnWhereTheCameraWas) {
  const render::CameraDesc desc = plain_camera(64, 1);
  const Pose here = look({20.0, 17.0, 9.0}, 20.0, 24.0);
  CameraRig fresh(wide_scene(), wide_light(), desc, effects_with(true));
  CameraRig walked(wide_scene(), wide_light(), desc, effects_with(true));
  for (const double x : {-130.0, -90.0, -33.0, 21.0, 180.0}) walked.shoot(look({x, 30.0 - x, 2.0}));
  const uint64_t before = walked.camera().near_shadows()->drawn_pages();
  EXPECT_EQ(walked.shoot(here).hdr, fresh.shoot(here).hdr);
  const uint64_t after = walked.camera().near_shadows()->drawn_pages();
  EXPECT_GT(after, before);
  EXPECT_EQ(fresh.camera().near_shadows()->drawn_pages(), 2u * render::near_pages * render::near_pages);
  walked.shoot(look({20.1, 17.0, 9.0}, 80.0, 0.0));
  EXPECT_EQ(walked.camera().near_shadows()->drawn_pages(), after) << "turning and small steps draw nothing";
}

TEST(NearShadow, CamerasDoNotDisturbEachOther) {
  const render::CameraDesc desc = plain_camera(64, 1);
  const Pose here = look({20.0, 17.0, 9.0}, 20.0, 24.0);
  CameraRig alone(wide_scene(), wide_light(), desc, effects_with(true)),
      among(wide_scene(), wide_light(), desc, effects_with(true));
  const std::array<Pose, 2> others{look({-150.0, 100.0, 5.0}), look({150.0, -100.0, 5.0}, 90.0)};
  EXPECT_EQ(among.shoot_among(others, here).hdr, alone.shoot(here).hdr);
}

}  // namespace
}  // namespace greatx::test
