// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks poles and wires thinner than a pixel: their share of the picture, that they neither flicker nor
// break over a slow pan, and that depth and ids stay those of the pixels' centres.
#include "renderer/camera/thin_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "tests/renderer/camera_rig.h"

namespace greatx::test {
namespace {

constexpr float white = 0.8f;
constexpr uint32_t size = 128;
constexpr double sun_deg = 5.0;  ///< elevation

void make_poles(scene::Scene& scene) {
  for (scene::Instance& instance : scene.instances)
    if (instance.name.starts_with("line")) instance.semantic_class = scene::SemanticClass::pole;
}

/// Adds the sides of a prism of `count` sides around the line between two points.
void add_prism(TinyScene& tiny, const dvec3& from, const dvec3& to, double radius, int count) {
  const dvec3 along = glm::normalize(to - from);
  const dvec3 u = glm::normalize(
                  glm::cross(along, std::abs(along.z) < 0.9 ? dvec3(0, 0, 1) : dvec3(1, 0, 0))),
              v = glm::cross(along, u);
  const auto corner = [&](const dvec3& middle, int i) {
    const double angle = 2.0 * pi * (i % count) / count;
    return middle + radius * (std::cos(angle) * u + std::sin(angle) * v);
  };
  for (int i = 0; i < count; ++i)
    tiny.quad(corner(from, i), corner(from, i + 1), corner(to, i + 1), corner(to, i));
}

/// A horizontal wire of square section, 5 m ahead, which is `width_px` pixels of plain_camera(128) high.
constexpr double ahead_m = 5.0, pixel_m = ahead_m / (0.5 * size);
scene::Scene wire(double width_px, int pieces = 1) {
  TinyScene tiny;
  const uint32_t paint = tiny.material_as(optical_material("paint", white));
  tiny.object("line", 0, paint);
  const double half = 0.5 * width_px * pixel_m, end = 20.0;
  for (int i = 0; i < pieces; ++i)
    tiny.box({ahead_m, -end + 2.0 * end * i / pieces, -half},
             {ahead_m + 0.2 * half, -end + 2.0 * end * (i + 1) / pieces, half});
  scene::Scene scene = tiny.build();
  make_poles(scene);
  return scene;
}

render::CameraEffects open_light(bool lines) {
  render::CameraEffects effects = lambertian();
  effects.static_shadows = false;
  effects.thin_lines = lines;
  return effects;
}

/// Light from behind the camera alone, before a black sky: a surface that faces the camera has the radiance
/// white / pi times the sun's illuminance there.
render::CameraEffects sun_alone(bool lines) {
  render::CameraEffects effects = open_light(lines);
  effects.sky = false;
  return effects;
}
render::CameraDesc smooth_camera(uint32_t pixels = size) {
  render::CameraDesc desc = plain_camera(pixels);
  desc.smooth_edges = true;
  return desc;
}
double level(const render::Lighting& lighting) {
  return white / pi * lighting.sun_illuminance_lux * std::cos(radians(sun_deg));
}

struct Pan {
  double mean = 0.0;     ///< energy over that of the closed form
  double flicker = 0.0;  ///< largest change of that from one picture to the next
  double broken = 0.0;   ///< share of the columns of all pictures with less than half of their energy
  double worst = 0.0;    ///< largest relative error of a column's energy
};

/// Pans over the wire by a tenth of a pixel at a time, with the horizon `roll_deg` from level.
Pan pan_over(const scene::Scene& scene, double width_px, double roll_deg, bool lines) {
  const render::Lighting lighting = plain_light(180.0, sun_deg);
  CameraRig rig(scene, lighting, smooth_camera(), sun_alone(lines));
  const double expected = width_px / std::cos(radians(roll_deg));  // of each column, pixels
  constexpr int steps = 30;
  Pan pan;
  double before = 0.0;
  for (int k = 0; k < steps; ++k) {
    const Pose eye = look({0.0, 0.0, 0.1 * (k - 0.5 * steps) * pixel_m}, 0.0, 0.0, roll_deg);
    const render::CameraImages images = rig.shoot(eye);
    double all = 0.0;
    for (uint32_t column = 8; column < size - 8; ++column) {
      double sum = 0.0;
      for (uint32_t row = 0; row < size; ++row)
        sum += luminance_at(images, size_t{row} * size + column) / level(lighting) / expected;
      all += sum / (size - 16);
      pan.worst = std::max(pan.worst, std::abs(sum - 1.0));
      pan.broken += sum < 0.5 ? 1.0 / steps / (size - 16) : 0.0;
    }
    pan.mean += all / steps;
    if (k > 0) pan.flicker = std::max(pan.flicker, std::abs(all - before));
    before = all;
  }
  return pan;
}

void print(const char* what, const Pan& pan) {
  std::printf(
      "%s: mean %.4f of the closed form, flicker %.4f a picture, %.1f %% of the columns broken, "
      "columns within %.4f\n",
      what, pan.mean, pan.flicker, 100.0 * pan.broken, pan.worst);
}

TEST(ThinLines, AWireOfAFifthOfAPixelNeitherFlickersNorBreaks) {
  for (const double roll : {0.0, 7.0, 30.0, 45.0}) {
    const Pan with = pan_over(wire(0.2), 0.2, roll, true), without = pan_over(wire(0.2), 0.2, roll, false);
    std::printf("turned by %.0f degrees\n", roll);
    print("  with   ", with);
    print("  without", without);
    EXPECT_NEAR(with.mean, 1.0, 0.01);
    EXPECT_LT(with.flicker, 0.01);
    EXPECT_EQ(with.broken, 0.0);
    EXPECT_LT(with.worst, 0.05);
    EXPECT_GT(without.broken, 0.5);
  }
}

TEST(ThinLines, EveryWidthUpToTwoPixelsKeepsItsShare) {
  for (const double width : {0.02, 0.1, 0.5, 0.9, 1.3, 1.9}) {
    const Pan with = pan_over(wire(width), width, 7.0, true);
    std::printf("%.2f pixels\n", width);
    print("  with   ", with);
    print("  without", pan_over(wire(width), width, 7.0, false));
    EXPECT_NEAR(with.mean, 1.0, 0.02) << width;
    EXPECT_LT(with.flicker, 0.01) << width;
    EXPECT_EQ(with.broken, 0.0) << width;
  }
}

TEST(ThinLines, PiecesJoinWithoutGaps) {
  const Pan pan = pan_over(wire(0.3, 12), 0.3, 7.0, true);
  print("twelve pieces", pan);
  EXPECT_NEAR(pan.mean, 1.0, 0.01);
  EXPECT_LT(pan.worst, 0.05);
}

TEST(ThinLines, DepthAndIdsStayThoseOfTheCentres) {
  const scene::Scene scene = wire(0.6);
  const Pose eye = look({0.0, 0.0, 0.4}, 0.0, 1.0, 7.0);
  CameraRig with(scene, plain_light(180.0, sun_deg), smooth_camera(), sun_alone(true)),
      without(scene, plain_light(180.0, sun_deg), smooth_camera(), sun_alone(false));
  const render::CameraImages a = with.shoot(eye), b = without.shoot(eye);
  EXPECT_EQ(a.depth, b.depth);
  EXPECT_EQ(a.instance, b.instance);
  EXPECT_EQ(a.semantic, b.semantic);
  EXPECT_EQ(a.material, b.material);
  EXPECT_NE(a.hdr, b.hdr);
  EXPECT_GT(std::ranges::count(a.instance, 1u), 20);
}

TEST(ThinLines, WallsHideThem) {
  TinyScene tiny;
  const uint32_t paint = tiny.material_as(optical_material("paint", white)),
                 dark = tiny.material_as(optical_material("dark", 0.1f));
  tiny.object("line", 0, paint).box({20, -60, -0.03}, {20.06, 60, 0.03});
  tiny.object("wall", 0, dark).quad({10, 30, -30}, {10, -30, -30}, {10, -30, 30}, {10, 30, 30});
  scene::Scene scene = tiny.build();
  make_poles(scene);
  CameraRig with(scene, plain_light(180.0, sun_deg), smooth_camera(), sun_alone(true)),
      without(scene, plain_light(180.0, sun_deg), smooth_camera(), sun_alone(false));
  EXPECT_EQ(with.shoot(look({0, 0, 0}, 0, 0, 7)).hdr, without.shoot(look({0, 0, 0}, 0, 0, 7)).hdr);
}

/// A street of poles and wires before a wall and a ground, in sun and sky.
scene::Scene street() {
  TinyScene tiny;
  const uint32_t paint = tiny.material_as(optical_material("paint", 0.6f)),
                 dark = tiny.material_as(optical_material("dark", 0.05f)),
                 stone = tiny.material_as(optical_material("stone", 0.3f));
  tiny.object("ground", 0, stone).quad({-10, -60, 0}, {120, -60, 0}, {120, 60, 0}, {-10, 60, 0});
  tiny.object("wall", 0, stone).quad({100, 60, 0}, {100, -60, 0}, {100, -60, 12}, {100, 60, 12});
  tiny.object("line poles", 0, paint);
  for (double x = 22.0; x < 100.0; x += 13.0)
    for (const double y : {-9.0, 7.5}) add_prism(tiny, {x, y, -0.1}, {x, y, 8.0}, 0.1, 6);
  tiny.object("line wires", 0, dark);
  for (double x = 22.0; x < 87.0; x += 13.0)
    for (int i = 0; i < 6; ++i) {
      const auto at = [&](int k) {
        const double t = k / 6.0;
        return dvec3(x + 13.0 * t, 7.5, 7.8 - 1.2 * t * (1.0 - t));
      };
      add_prism(tiny, at(i), at(i + 1), 0.02, 3);
    }
  scene::Scene scene = tiny.build();
  make_poles(scene);
  return scene;
}

/// Returns a picture's luminance as the mean of `by` x `by` samples a pixel, each without smoothed edges.
std::vector<double> supersampled(const scene::Scene& scene, const Pose& eye, uint32_t by) {
  CameraRig rig(scene, plain_light(120.0, 40.0), plain_camera(size * by), open_light(false));
  const render::CameraImages images = rig.shoot(eye);
  std::vector<double> result(size_t{size} * size);
  for (uint32_t row = 0; row < size * by; ++row)
    for (uint32_t column = 0; column < size * by; ++column)
      result[size_t{row / by} * size + column / by] +=
          luminance_at(images, size_t{row} * size * by + column) / (by * by);
  return result;
}

/// Returns the difference from the wanted picture over the pixels that lie near a line. `bare` is the wanted
/// picture without lines.
struct Difference {
  double rms = 0.0;    ///< over the mean of the wanted luminance
  double lines = 0.0;  ///< what lines change in the picture, over what they should change
};
Difference difference_from(const render::CameraImages& images, const std::vector<double>& wanted,
                           const std::vector<double>& bare) {
  double sum = 0.0, mean = 0.0, change = 0.0, wanted_change = 0.0;
  size_t count = 0;
  for (size_t i = 0; i < wanted.size(); ++i) {
    if (std::abs(wanted[i] - bare[i]) < 0.002 * wanted[i]) continue;
    sum += std::pow(luminance_at(images, i) - wanted[i], 2.0);
    mean += wanted[i];
    change += luminance_at(images, i) - bare[i];
    wanted_change += wanted[i] - bare[i];
    ++count;
  }
  EXPECT_GT(count, 200u);
  return {std::sqrt(sum / double(count)) / (mean / double(count)), change / wanted_change};
}

TEST(ThinLines, AStreetOfPolesAgreesWithManySamples) {
  const scene::Scene scene = street();
  const Pose eye = look({0.0, 0.4, 2.0}, 3.0, -6.0);
  const std::vector<double> wanted = supersampled(scene, eye, 16);
  TinyScene tiny;
  const uint32_t stone = tiny.material_as(optical_material("stone", 0.3f));
  tiny.object("ground", 0, stone).quad({-10, -60, 0}, {120, -60, 0}, {120, 60, 0}, {-10, 60, 0});
  tiny.object("wall", 0, stone).quad({100, 60, 0}, {100, -60, 0}, {100, -60, 12}, {100, 60, 12});
  const std::vector<double> bare = supersampled(tiny.build(), eye, 16);
  std::array<Difference, 2> from{};
  for (const bool lines : {false, true}) {
    CameraRig rig(scene, plain_light(120.0, 40.0), smooth_camera(), open_light(lines));
    from[lines] = difference_from(rig.shoot(eye), wanted, bare);
  }
  std::printf("against 256 samples: rms %.4f with, %.4f without; lines %.3f with, %.3f without\n",
              from[1].rms, from[0].rms, from[1].lines, from[0].lines);
  EXPECT_LT(from[1].rms, 0.1);
  EXPECT_LT(from[1].rms, 0.45 * from[0].rms);
  EXPECT_NEAR(from[1].lines, 1.0, 0.1);
}

TEST(ThinLines, AViewWithoutThemHasTheBytesAndTheWorkOfNone) {
  const scene::Scene scene = street();
  const auto shoot = [&](bool lines, const Pose& eye) {
    CameraRig rig(scene, plain_light(120.0, 40.0), smooth_camera(), open_light(lines));
    rig.shoot(eye);  // the first picture draws what lasts
    const uint64_t before = device().counters().dispatches;
    const render::CameraImages images = rig.shoot(eye);
    return std::pair(images, device().counters().dispatches - before);
  };
  const Pose away = look({0.0, 0.4, 2.0}, 180.0, 20.0);
  const auto [with, dispatches_with] = shoot(true, away);
  const auto [without, dispatches_without] = shoot(false, away);
  EXPECT_EQ(with.hdr, without.hdr);
  EXPECT_EQ(with.rgb, without.rgb);
  EXPECT_EQ(with.depth, without.depth);
  EXPECT_EQ(dispatches_with, dispatches_without);
  EXPECT_EQ(shoot(true, look({0.0, 0.4, 2.0}, 3.0, -6.0)).second, dispatches_with + 1);
}

/// Returns the mean sum of eight rows around the horizon. There, a wire of 0.4 pixels that shines with 2000
/// cd/m^2 hangs 2 m ahead, a screen of 500 cd/m^2 stands 5 m ahead, and a pane at `pane_m`.
constexpr double wire_px = 0.4, wire_cd_m2 = 2000.0, screen_cd_m2 = 500.0;
double through_pane(double pane_m, bool lines) {
  const auto glowing = [](double cd_m2) {
    scene::Material material = optical_material("glow", 0.0f);
    material.pbr.emissive = vec3(float(cd_m2 / 1000.0));
    return material;
  };
  scene::Material glass = optical_material("glass", 1.0f, 0.0f, 0.05f);
  glass.pbr.transmission = 1.0f;
  TinyScene tiny;
  const double half = 0.5 * wire_px * 2.0 / (0.5 * size);
  tiny.object("line", 0, tiny.material_as(glowing(wire_cd_m2)))
      .box({2.0, -9.0, -half}, {2.0 + 0.2 * half, 9.0, half});
  tiny.object("screen", 0, tiny.material_as(glowing(screen_cd_m2)))
      .quad({5, 9, -9}, {5, -9, -9}, {5, -9, 9}, {5, 9, 9});
  tiny.object("pane", 0, tiny.material_as(glass))
      .quad({pane_m, 9, -9}, {pane_m, -9, -9}, {pane_m, -9, 9}, {pane_m, 9, 9});
  scene::Scene scene = tiny.build();
  make_poles(scene);
  render::CameraEffects effects;
  effects.sun = effects.sky = false;
  effects.panes = true;
  effects.thin_lines = lines;
  CameraRig rig(scene, plain_light(), smooth_camera(), effects);
  const render::CameraImages images = rig.shoot(look({0.0, 0.0, 0.013}));
  double sum = 0.0;
  for (uint32_t row = size / 2 - 4; row < size / 2 + 4; ++row)
    for (uint32_t column = size / 2 - 4; column < size / 2 + 4; ++column)
      sum += luminance_at(images, size_t{row} * size + column) / 8.0;
  return sum;
}

TEST(ThinLines, PanesWeakenWhatIsBehindThemAlone) {
  const double passes = 0.96 / 1.04;  // at right angles, of both faces
  const double behind = passes * (wire_px * wire_cd_m2 + (8.0 - wire_px) * screen_cd_m2),
               before = wire_px * wire_cd_m2 + passes * (8.0 - wire_px) * screen_cd_m2;
  std::printf("wire behind a pane %.1f of %.1f, before it %.1f of %.1f\n", through_pane(1.5, true), behind,
              through_pane(3.0, true), before);
  EXPECT_NEAR(through_pane(1.5, true), behind, 2e-3 * behind);
  EXPECT_NEAR(through_pane(3.0, true), before, 2e-3 * before);
  EXPECT_GT(std::abs(through_pane(1.5, false) - behind), 2e-2 * behind);
}

TEST(ThinLines, PartsOfAnExposureSumToTheWhole) {
  const scene::Scene scene = street();
  const Pose eye = look({0.0, 0.4, 2.0}, 3.0, -6.0);
  render::CameraDesc parted = smooth_camera();
  parted.parts = true;
  CameraRig whole(scene, plain_light(120.0, 40.0), smooth_camera(), open_light(true)),
      parts(scene, plain_light(120.0, 40.0), parted, open_light(true)),
      bare(scene, plain_light(120.0, 40.0), smooth_camera(), open_light(false));
  const render::CameraImages a = whole.shoot(eye), b = parts.shoot_parts(eye, 4), c = bare.shoot(eye);
  double largest = 0.0, of_lines = 0.0;
  for (size_t i = 0; i < size_t{size} * size; ++i) {
    const double level = luminance_at(a, i);
    largest = std::max(largest, std::abs(luminance_at(b, i) - level) / level);
    of_lines = std::max(of_lines, std::abs(luminance_at(c, i) - level) / level);
  }
  std::printf("four parts differ from the whole by %.5f; lines change pixels by up to %.3f\n", largest,
              of_lines);
  EXPECT_LT(largest, 4e-3);  // halves, rounded once a part
  EXPECT_GT(of_lines, 0.1);
}

TEST(ThinLines, FindsSlimPrismsOfPolesAlone) {
  TinyScene tiny;
  tiny.object("line prisms");
  add_prism(tiny, {0, 0, 0}, {0, 0, 6}, 0.1, 3);
  add_prism(tiny, {1, 0, 0}, {1, 0, 6}, 0.1, 8);
  tiny.box({2, 0, 0}, {2.2, 0.2, 6});
  tiny.box({3, 0, 0}, {3.2, 0.2, 0.9});               // too short
  tiny.box({4, 0, 0}, {4.4, 0.4, 6});                 // too wide
  tiny.object("wall").box({5, 0, 0}, {5.1, 0.1, 6});  // of another class
  tiny.object("line body", tiny.body("mover")).box({6, 0, 0}, {6.1, 0.1, 6});
  scene::Scene scene = tiny.build();
  make_poles(scene);
  EXPECT_EQ(render::ThinLines(scene).size(), 3u);
}

}  // namespace
}  // namespace greatx::test
