// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks pictures that are drawn as several views: depth, ids and flow against fp64 rays and points, seams
// where two faces of the cube meet, the image circle, and bands of rows of different instants.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "renderer/lens/lens_rays.h"
#include "tests/renderer/truth_rig.h"

namespace greatx::test {
namespace {

using render::LensModel;
using render::LensRays;

CameraDesc fisheye_camera(uint32_t size, uint32_t msaa = 1) {
  CameraDesc desc = truth_camera(size, msaa);
  desc.wide = {.model = LensModel::fisheye, .k1 = -0.02, .k2 = 0.003, .half_angle = radians(100.0)};
  desc.fx = desc.fy = 0.5 * size / desc.wide.shown(desc.wide.half_angle);
  desc.cx = desc.cy = 0.5 * size + 0.25;
  return desc;
}
CameraDesc equirectangular_camera(uint32_t height, uint32_t msaa = 1) {
  CameraDesc desc = truth_camera(2 * height, msaa);
  desc.height = height;
  desc.wide.model = LensModel::equirectangular;
  desc.fx = desc.fy = height / pi;
  desc.cx = height;
  desc.cy = 0.5 * height;
  return desc;
}
dvec3 in_local(const Pose& camera, const dvec3& optical) {
  return camera.rotate({optical.z, -optical.x, -optical.y});
}
dvec3 in_optical(const Pose& camera, const dvec3& point) {
  const dvec3 p = glm::conjugate(camera.orientation) * (point - camera.position);
  return {-p.y, -p.z, p.x};
}

/// Things on all sides of the eye.
TinyScene surroundings() {
  TinyScene scene;
  scene.object("ground").quad({-60, -60, -2}, {60, -60, -2}, {60, 60, -2}, {-60, 60, -2});
  scene.object("left wall").quad({-20, 9, -2}, {25, 12, -2}, {25, 12, 8}, {-20, 9, 8});
  scene.object("roof").quad({-3, -8, 5}, {4, -8, 5}, {4, 2, 6}, {-3, 2, 6});
  for (int i = 0; i < 12; ++i) {
    const double bearing = radians(30.0 * i + 4.0), range = 4.0 + i;
    const dvec3 at(range * std::cos(bearing), range * std::sin(bearing), -1.0 + 0.3 * i);
    scene.object("box " + std::to_string(i)).box(at - dvec3(0.8, 0.6, 1.1), at + dvec3(0.8, 0.6, 1.1));
  }
  return scene;
}

struct Agreement {
  int pixels = 0, same = 0, exact = 0, surfaces = 0, normals = 0;
};
Agreement compare_with_rays(TruthRig& rig, const CameraDesc& desc, const Moment& now) {
  const Picture picture = rig.shoot(now, now);
  const std::vector<dvec3> rays = LensRays(render::lens_geometry(desc)).centers();
  Agreement result;
  for (size_t i = 0; i < rays.size(); ++i) {
    const uint32_t id = picture.images.instance[i];
    const float depth = picture.images.depth[i];
    EXPECT_TRUE(depth == picture.truth.depth_ray[i]);
    if (rays[i] == dvec3(0.0)) {
      EXPECT_TRUE(id == 0 && std::isinf(depth));
      continue;
    }
    const std::optional<Hit> hit =
        cast(rig.scene(), now.bodies, now.camera.position, in_local(now.camera, rays[i]));
    ++result.pixels;
    if (id != (hit ? rig.scene().primitives[hit->primitive].instance + 1 : 0)) continue;
    ++result.same;
    if (!hit) continue;
    ++result.surfaces;
    if (!(std::abs(double(depth) - hit->distance) < 1e-5 * hit->distance)) continue;
    ++result.exact;
    // The scene is flat-shaded.
    const scene::Scene& scene = rig.scene();
    const auto corner = [&](uint32_t c) {
      return dvec3(scene.positions[scene.indices[3 * hit->triangle + c]]);
    };
    const dvec3 flat = glm::normalize(glm::cross(corner(1) - corner(0), corner(2) - corner(0))),
                normal(picture.truth.normals[3 * i], picture.truth.normals[3 * i + 1],
                       picture.truth.normals[3 * i + 2]),
                ray = in_local(now.camera, rays[i]);
    if (std::abs(glm::dot(flat, normal)) > 1.0 - 1e-5 && glm::dot(normal, ray) < 0.0) ++result.normals;
  }
  return result;
}

TEST(Faces, DepthAndIdsAreThoseOfThePixelsRays) {
  for (const uint32_t msaa : {1u, 4u})
    for (const CameraDesc& desc : {fisheye_camera(120, msaa), equirectangular_camera(72, msaa)}) {
      TruthRig rig(surroundings().build(), desc);
      const Agreement found = compare_with_rays(rig, desc, {look({0.3, -0.2, 0.1}, 8, 4, 5)});
      EXPECT_GT(found.same, 0.993 * found.pixels) << msaa;
      EXPECT_GT(found.exact, 0.99 * found.surfaces) << msaa;
      EXPECT_GT(found.normals, 0.995 * found.exact) << msaa;
      EXPECT_GT(found.surfaces, 4000);
    }
}

TEST(Faces, FlowIsThePointProjectedAnew) {
  for (const CameraDesc& desc : {fisheye_camera(120), equirectangular_camera(72)}) {
    TinyScene tiny = surroundings();
    const uint32_t car = tiny.body("car");
    tiny.object("car", car).box({-1, -1, -1}, {1, 1, 1});
    TruthRig rig(tiny.build(), desc);
    const Moment now{look({0.3, -0.2, 0.1}, 3, 2, 5), {{}, look({-6, -3, -1}, 30)}},
        next{look({0.5, -0.1, 0.15}, 1, 3.5, 4), {{}, look({-5.5, -2.6, -1}, 41)}};
    const Picture picture = rig.shoot(now, next);
    const LensRays lens(render::lens_geometry(desc));
    const std::vector<dvec3> rays = lens.centers();
    double largest = 0.0;
    int compared = 0, lost = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      const dvec2 flow(picture.truth.flow[2 * i], picture.truth.flow[2 * i + 1]);
      if (rays[i] == dvec3(0.0)) {
        EXPECT_TRUE(std::isnan(flow.x));
        continue;
      }
      const dvec3 ray = in_local(now.camera, rays[i]);
      const std::optional<Hit> hit = cast(rig.scene(), now.bodies, now.camera.position, ray);
      if ((hit ? rig.scene().primitives[hit->primitive].instance + 1 : 0) != picture.images.instance[i])
        continue;
      // On the edge between two sides of a box the other one may be seen.
      if (hit && std::abs(picture.images.depth[i] - hit->distance) > 1e-5 * hit->distance) continue;
      const dvec3 there = hit ? in_optical(next.camera, carried(rig.scene(), *hit, now, next))
                              : in_optical({dvec3(0.0), next.camera.orientation}, ray);
      const std::optional<dvec2> pixel = lens.pixel(there);
      if (!pixel) {
        EXPECT_TRUE(std::isnan(flow.x));
        ++lost;
        continue;
      }
      dvec2 expected = *pixel - dvec2(double(i % desc.width) + 0.5, double(i / desc.width) + 0.5);
      // The shorter way round the panorama.
      if (!desc.wide.fisheye()) expected.x -= desc.width * std::round(expected.x / desc.width);
      // Near the poles of the panorama azimuths turn without bounds.
      if (!desc.wide.fisheye() && std::abs(rays[i].y) > 0.99) continue;
      largest = std::max(largest, glm::length(flow - expected));
      ++compared;
    }
    EXPECT_LT(largest, 1e-4);
    EXPECT_GT(compared, 7000);
    EXPECT_TRUE(lost > 0 || !desc.wide.fisheye());
  }
}

/// A panorama turned by 45 degrees is the same picture an eighth further, but the faces meet elsewhere. What
/// differs is therefore what a seam shows.
TEST(Faces, SeamsDoNotShow) {
  CameraDesc desc = equirectangular_camera(128);
  desc.outputs.hdr = true;
  // A texture whose contrast depends on how it is filtered.
  TinyScene tiny = surroundings();
  scene::Texture specks;
  specks.name = "specks";
  specks.width = specks.height = 256;
  specks.srgb = false;
  std::mt19937 draw(3);
  for (uint32_t i = 0; i < 256 * 256; ++i) {
    const auto shade = static_cast<uint8_t>(draw() % 256);
    specks.rgba.insert(specks.rgba.end(), {shade, shade, shade, uint8_t{255}});
  }
  scene::Material painted = optical_material("painted", 1.0f);
  painted.pbr.base_color_texture = int32_t(tiny.texture(specks));
  tiny.object("carpet", 0, tiny.material_as(painted))
      .quad({-40, -40, -1.9}, {40, -40, -1.9}, {40, 40, -1.9}, {-40, 40, -1.9});
  CameraRig rig(tiny.build(), plain_light(30, 40), desc);
  const render::CameraImages straight = rig.shoot(look({0.3, -0.2, 0.1})),
                             turned = rig.shoot(look({0.3, -0.2, 0.1}, 45.0));
  const uint32_t shift = desc.width / 8;
  int other = 0, brighter = 0;
  for (uint32_t row = 0; row < desc.height; ++row)
    for (uint32_t column = 0; column < desc.width; ++column) {
      const size_t a = size_t{row} * desc.width + column,
                   b = size_t{row} * desc.width + (column + shift) % desc.width;
      if (straight.instance[a] != turned.instance[b]) {
        ++other;
        continue;
      }
      const double x = luminance_at(straight, a), y = luminance_at(turned, b);
      brighter += std::abs(x - y) > 2e-3 * std::max(x, y) ? 1 : 0;
    }
  const int pixels = static_cast<int>(desc.width * desc.height);
  EXPECT_LT(other, pixels / 500);                 // outlines
  EXPECT_LT(brighter, pixels / 250) << brighter;  // edges of shadows
}

TEST(Faces, OutsideTheImageCircleNothingIsSeen) {
  CameraDesc desc = fisheye_camera(80);
  desc.wide.half_angle = radians(60.0);
  desc.outputs.hdr = desc.outputs.rgb = true;
  CameraRig rig(surroundings().build(), plain_light(), desc);
  const render::CameraImages images = rig.shoot(look({0, 0, 0}));
  const std::vector<dvec3> rays = LensRays(render::lens_geometry(desc)).centers();
  int outside = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    if (rays[i] != dvec3(0.0)) {
      EXPECT_GT(luminance_at(images, i), 0.0);
      continue;
    }
    ++outside;
    EXPECT_EQ(luminance_at(images, i), 0.0);
    EXPECT_TRUE(images.rgb[3 * i] == 0 && images.instance[i] == 0 && std::isinf(images.depth[i]));
  }
  EXPECT_GT(outside, 2500);
}

/// Takes pictures in bands, each with the scene as it is at the band's instant.
class BandRig {
 public:
  BandRig(scene::Scene scene, const CameraDesc& desc)
      : scene_(std::move(scene)),
        gpu_(device(), scene_, {.acceleration_structure = false, .textures = true}),
        lighting_(gpu_, plain_light(), {}),
        camera_(lighting_, desc),
        ring_(device(), 2, 1 << 16, 1 << 20) {}
  /// `moment` gives the poses at a time from -0.5 to 0.5 of the readout.
  template <typename MomentAt>
  render::CameraImages shoot(const MomentAt& moment) {
    gpu::TickSlot& slot = ring_.begin();
    for (uint32_t band = 0; band < camera_.bands(); ++band) {
      Moment now = moment(camera_.middle_of_band(band));
      now.bodies.resize(scene_.bodies.size());
      gpu_.record_update(slot, now.bodies);
      lighting_.record(slot, now.bodies);
      camera_.record(slot, now.camera, {},
                     {.first = band == 0, .last = band + 1 == camera_.bands(), .band = band});
    }
    ring_.submit(slot);
    ring_.wait(slot);
    return camera_.collect(slot);
  }
  const render::CameraPass& camera() const { return camera_; }

 private:
  scene::Scene scene_;
  scene::GpuScene gpu_;
  render::SceneLighting lighting_;
  render::CameraPass camera_;
  gpu::TickRing ring_;
};

CameraDesc rolling_camera(uint32_t size, uint32_t bands) {
  CameraDesc desc = plain_camera(size);
  desc.bands = bands;
  return desc;
}

TEST(RollingShutter, BandsOfOneInstantAreThePicture) {
  for (const bool smooth : {false, true}) {
    CameraDesc desc = plain_camera(100), rolling = rolling_camera(100, 5);
    desc.smooth_edges = rolling.smooth_edges = smooth;
    const Pose camera = look({0.3, -0.2, 0.1}, 8, 4, 5);
    CameraRig whole(surroundings().build(), plain_light(), desc);
    BandRig bands(surroundings().build(), rolling);
    EXPECT_EQ(bands.camera().bands(), 5u);
    const render::CameraImages a = whole.shoot(camera),
                               b = bands.shoot([&](double) { return Moment{camera}; });
    int ids = 0, depths = 0, colors = 0;
    for (size_t i = 0; i < a.depth.size(); ++i) {
      ids += a.instance[i] != b.instance[i] ? 1 : 0;
      depths += a.depth[i] != b.depth[i] && !(std::abs(a.depth[i] - b.depth[i]) < 1e-5f * a.depth[i]) ? 1 : 0;
      colors += std::abs(luminance_at(a, i) - luminance_at(b, i)) > 2e-3 * luminance_at(a, i) ? 1 : 0;
    }
    EXPECT_LE(ids, 10);
    EXPECT_LE(depths, 20);
    EXPECT_LE(colors, smooth ? 150 : 50);  // outlines along the borders of bands stay sharp
  }
}

/// Returns the middle column of the pixels of an instance in a row; NaN without any.
double middle_of(const render::CameraImages& images, uint32_t row, uint32_t id) {
  double sum = 0.0;
  int count = 0;
  for (uint32_t column = 0; column < images.width; ++column)
    if (images.instance[size_t{row} * images.width + column] == id) {
      sum += column + 0.5;
      ++count;
    }
  return sum / count;
}

/// A camera that turns leftwards sees a pole move to the right by w t f near the axis: exactly by f tan(w t).
TEST(RollingShutter, ATurnSkewsAPole) {
  constexpr uint32_t size = 240;
  TinyScene tiny;
  tiny.object("pole").quad({20, 0.5, -30}, {20, -0.5, -30}, {20, -0.5, 30}, {20, 0.5, 30});
  BandRig rig(tiny.build(), rolling_camera(size, 30));
  const double turn = radians(12.0);  // during the readout
  const render::CameraImages images = rig.shoot([&](double t) {
    return Moment{look({0, 0, 0}, degrees(turn * t))};
  });
  const double focal = 0.5 * size;
  for (uint32_t row = 0; row < size; ++row) {
    const double t = rig.camera().middle_of_band(row / 8);
    // Pixels count by their centres, so the middle is within half a pixel.
    EXPECT_NEAR(middle_of(images, row, 1), 0.5 * size + focal * std::tan(turn * t), 0.5) << row;
    // A row is at most half a band away from its instant.
    const double exact = (row + 0.5) / size - 0.5;
    EXPECT_LE(std::abs(t - exact), 0.5 * 8 / size);
  }
  const double skew = middle_of(images, size - 4, 1) - middle_of(images, 3, 1);
  EXPECT_NEAR(skew, turn * focal * (size - 8.0) / size, 1.0);
}

/// The more bands, the less a row is off: half of the motion within a band.
TEST(RollingShutter, TheErrorIsHalfOfTheMotionWithinABand) {
  constexpr uint32_t size = 240;
  for (const uint32_t bands : {3u, 10u, 30u}) {
    TinyScene tiny;
    tiny.object("pole").quad({20, 0.5, -30}, {20, -0.5, -30}, {20, -0.5, 30}, {20, 0.5, 30});
    BandRig rig(tiny.build(), rolling_camera(size, bands));
    const double turn = radians(20.0), focal = 0.5 * size;
    const render::CameraImages images = rig.shoot([&](double t) {
      return Moment{look({0, 0, 0}, degrees(turn * t))};
    });
    double worst = 0.0;
    for (uint32_t row = 0; row < size; ++row) {
      const double exact = 0.5 * size + focal * std::tan(turn * ((row + 0.5) / size - 0.5));
      worst = std::max(worst, std::abs(middle_of(images, row, 1) - exact));
    }
    const double within_band = focal * turn / bands / std::pow(std::cos(0.5 * turn), 2);
    EXPECT_LE(worst, 0.5 * within_band + 0.5) << bands;
    EXPECT_GE(worst, 0.5 * within_band - 1.5) << bands;
  }
}

/// A car that drives across is sheared: its upper edge is seen before its lower one. Depth and ids are those
/// of the rows' instants.
TEST(RollingShutter, AMovingBodyShears) {
  constexpr uint32_t size = 240;
  TinyScene tiny;
  const uint32_t car = tiny.body("car");
  tiny.object("car", car).box({0, -1, -4}, {1, 1, 4});
  BandRig rig(tiny.build(), rolling_camera(size, 30));
  const double way = -3.0, advance = 2.0;  // to the right and away, m during the readout
  const render::CameraImages images = rig.shoot([&](double t) {
    return Moment{look({0, 0, 0}), {{}, {dvec3(10.0 + advance * t, way * t, 0.0), dquat(1, 0, 0, 0)}}};
  });
  int rows = 0;
  for (uint32_t row = 0; row < size; ++row) {
    const double t = rig.camera().middle_of_band(row / 8), x = 10.0 + advance * t;
    if (std::abs((row + 0.5 - 0.5 * size) / (0.5 * size)) * x > 3.9) continue;
    const double middle = 0.5 * size - 0.5 * size * way * t / x;
    EXPECT_NEAR(middle_of(images, row, 1), middle, 1.5 + 0.5 * size * 0.1 * std::abs(way * t) / x) << row;
    EXPECT_NEAR(images.depth[size_t{row} * size + static_cast<uint32_t>(middle)], x, 1e-5 * x) << row;
    ++rows;
  }
  EXPECT_GT(rows, 80);
}

/// Bands also look through a fisheye.
TEST(RollingShutter, WorksBehindAFisheye) {
  CameraDesc desc = fisheye_camera(120), rolling = desc;
  desc.outputs.seen = rolling.outputs.seen = false;
  rolling.bands = 4;
  const Pose camera = look({0.3, -0.2, 0.1}, 8, 4, 5);
  CameraRig whole(surroundings().build(), plain_light(), desc);
  BandRig bands(surroundings().build(), rolling);
  const render::CameraImages a = whole.shoot(camera), b = bands.shoot([&](double) { return Moment{camera}; });
  int other = 0;
  for (size_t i = 0; i < a.instance.size(); ++i) other += a.instance[i] != b.instance[i] ? 1 : 0;
  EXPECT_LE(other, 10);
}

/// An edge at x from the axis appears at x times the factor in red and in blue, and green stays.
TEST(ChromaticAberration, MovesEdgesByTheFactor) {
  constexpr uint32_t size = 240;
  CameraDesc desc = plain_camera(size), prism = desc;
  prism.chromatic = {.red = 1.02, .blue = 0.97};
  TinyScene tiny;
  tiny.object("board").quad({10, 10, -30}, {10, 6, -30}, {10, 6, 30}, {10, 10, 30});
  const scene::Scene scene = tiny.build();
  CameraRig plain(scene, plain_light(), desc), split(scene, plain_light(), prism);
  const render::CameraImages a = plain.shoot(look({0, 0, 0})), b = split.shoot(look({0, 0, 0}));
  EXPECT_EQ(a.depth, b.depth);
  EXPECT_EQ(a.instance, b.instance);
  // The board's inner edge is 6/10 of the focal length left of the axis: at column 120 - 72.
  const uint32_t row = 60;
  for (const auto& [channel, factor] : {std::pair{0, 1.02}, std::pair{1, 1.0}, std::pair{2, 0.97}}) {
    const auto light = [&](uint32_t column) {
      return double(b.hdr[3 * (size_t{row} * size + column) + channel]);
    };
    const double board = light(20), sky = light(80), half = 0.5 * (board + sky);
    double edge = 0.0;
    for (uint32_t column = 30; column < 70; ++column)
      if ((light(column) - half) * (light(column + 1) - half) <= 0.0)
        edge = column + 0.5 + (half - light(column)) / (light(column + 1) - light(column));
    EXPECT_NEAR(edge, 120.0 - 72.0 * factor, 0.26) << channel;
    if (channel != 1) continue;
    for (uint32_t column = 0; column < size; ++column)
      EXPECT_EQ(light(column), double(a.hdr[3 * (size_t{row} * size + column) + 1]));
  }
}

}  // namespace
}  // namespace greatx::test
