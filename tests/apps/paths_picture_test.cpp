// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "draw/paths/draw.h"
#include "tests/apps/sample_paths.h"

namespace greatx::apps {
namespace {

constexpr float sky = std::numeric_limits<float>::infinity();

/// Returns a view that looks along +y from (0, -100, 0) with 200 x 100 pixels. 1 m at the origin is 1 pixel.
PictureView side_view() {
  PictureView view;
  view.width = 200;
  view.height = 100;
  view.fx = view.fy = 100.0;
  view.cx = 100.0;
  view.cy = 50.0;
  view.local_from_sensor = {{0, -100, 0}, orientation_from_yaw_pitch_roll(0.5 * pi, 0, 0)};
  return view;
}

TEST(PictureView, ProjectsLikeAPinhole) {
  const dvec3 p = side_view().project({10, 0, 5});
  EXPECT_NEAR(p.x, 110.0, 1e-12);
  EXPECT_NEAR(p.y, 45.0, 1e-12);
  EXPECT_NEAR(p.z, 100.0, 1e-12);
  EXPECT_LT(side_view().project({0, -200, 0}).z, 0.0);
  const dvec3 half = side_view().scaled(100).project({10, 0, 5});
  EXPECT_NEAR(half.x, 55.0, 1e-12);
  EXPECT_NEAR(half.y, 22.5, 1e-12);
}

/// Returns the side view through a barrel lens.
PictureView barrel_view() {
  PictureView view = side_view();
  view.set_lens({.k1 = -0.08, .p1 = 0.004, .p2 = -0.006}, "eye");
  return view;
}

TEST(PictureView, ProjectsThroughItsLens) {
  const PictureView view = barrel_view();
  // The point lies to the right by 0.3 and up by 0.2 of the depth: r^2 = 0.13.
  const dvec3 p = view.project({30, 0, 20});
  const double x = 0.3, y = -0.2, radial = 1.0 - 0.08 * 0.13;
  EXPECT_NEAR(p.x, 100.0 + 100.0 * (x * radial + 0.008 * x * y - 0.006 * (0.13 + 2.0 * x * x)), 1e-9);
  EXPECT_NEAR(p.y, 50.0 + 100.0 * (y * radial + 0.004 * (0.13 + 2.0 * y * y) - 0.012 * x * y), 1e-9);
  EXPECT_NEAR(p.z, 100.0, 1e-12);
  // The same point in a picture of twice the size.
  PictureView twice = side_view().scaled(400);
  twice.set_lens(view.distortion, "eye");
  EXPECT_NEAR(twice.project({30, 0, 20}).x, 2.0 * p.x, 1e-9);
  // The radial part alone would fold a direction at 3.5 times the depth back to 7 pixels off the axis.
  const dvec3 folded = view.project({350, 0, 0});
  EXPECT_LT(folded.z, 0.0);
  EXPECT_THROW(side_view().scaled(100).set_lens({.k1 = -0.5}, "eye"), UserError);
}

TEST(PictureView, FitsEveryPointAndTouchesTwoMargins) {
  RandomStream random(1, 0);
  const PictureMargins margins{80.0, 40.0, 30.0, 20.0};
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<dvec3> points;
    for (int i = 0; i < 12; ++i)
      points.push_back({300.0 * random.uniform(), 200.0 * random.uniform(), 50.0 * random.uniform()});
    const double azimuth = 2.0 * pi * random.uniform(), elevation = 0.2 + 1.2 * random.uniform();
    const PictureView view = fit_view(points, azimuth, elevation, 1600, 1000, margins, 0.0);
    dvec2 low(1e300), high(-1e300);
    for (const dvec3& point : points) {
      const dvec3 p = view.project(point);
      ASSERT_GT(p.z, view.near_m);
      low = glm::min(low, dvec2(p));
      high = glm::max(high, dvec2(p));
    }
    const double left = low.x - 80.0, right = 1560.0 - high.x, top = low.y - 30.0, bottom = 980.0 - high.y;
    for (const double room : {left, right, top, bottom}) EXPECT_GT(room, -1e-6);
    // The camera is as near as possible: in one of the directions no room is left.
    EXPECT_NEAR(std::min(std::max(left, right), std::max(top, bottom)), 0.0, 1e-6);
    // The camera is above the points, on the requested side.
    const dvec3 forward = view.local_from_sensor.rotate({1, 0, 0});
    EXPECT_NEAR(forward.z, -std::sin(elevation), 1e-12);
    EXPECT_NEAR(forward.x, -std::cos(azimuth) * std::cos(elevation), 1e-12);
  }
}

TEST(PictureView, OnePointIsSeenFromAfar) {
  const std::vector<dvec3> point{{5, 6, 7}};
  const PictureView view = fit_view(point, 0.3, 0.6, 800, 500, {}, 10.0);
  const dvec3 p = view.project(point[0]);
  EXPECT_NEAR(p.x, 400.0, 1e-6);
  EXPECT_NEAR(p.y, 250.0, 1e-6);
  EXPECT_GT(p.z, 10.0);
}

TEST(PictureView, ChoosesASideThatIsFree) {
  const SampleScene sample;
  const std::vector<PathLink> links{sample_link()};
  const auto choose = [&](double blocked_azimuth) {
    return choose_view(links, sample.view(), 640, 400, [&](const PictureView& view) {
      const dvec3 forward = view.local_from_sensor.rotate({1, 0, 0});
      const dvec3 blocked(std::cos(blocked_azimuth), std::sin(blocked_azimuth), 0.0);
      // A wall stands before the lens unless the camera is far from the blocked side.
      const bool free = glm::dot(-forward, blocked) < -0.3;
      return std::vector<float>(size_t{view.width} * view.height, free ? sky : 1.0f);
    });
  };
  for (const double azimuth : {0.0, 0.5 * pi, pi, 1.5 * pi}) {
    const dvec3 stands = -choose(azimuth).local_from_sensor.rotate({1, 0, 0});
    EXPECT_LT(stands.x * std::cos(azimuth) + stands.y * std::sin(azimuth), -0.3) << azimuth;
  }
}

TEST(Stretches, AWallHidesWhatIsBehindIt) {
  const PictureView view = side_view();
  std::vector<float> depth(200 * 100, sky);
  for (size_t y = 0; y < 100; ++y)
    for (size_t x = 120; x < 140; ++x) depth[y * 200 + x] = 50.0f;
  const std::vector<Stretch> runs = stretches_of(view, depth, {0, 0, 0}, {60, 0, 0});
  ASSERT_EQ(runs.size(), 3u);
  EXPECT_FALSE(runs[0].hidden);
  EXPECT_TRUE(runs[1].hidden);
  EXPECT_FALSE(runs[2].hidden);
  EXPECT_NEAR(runs[0].a.x, 100.0, 1e-9);
  EXPECT_NEAR(runs[1].a.x, 120.0, 1.0);
  EXPECT_NEAR(runs[1].b.x, 140.0, 1.0);
  EXPECT_NEAR(runs[2].b.x, 160.0, 1e-9);
}

TEST(Stretches, DepthAlongASlantingStretchIsThatOfSpaceNotOfThePicture) {
  const PictureView view = side_view();
  // The stretch goes from 10 m deep at x = 190 to 190 m deep at x = 110.5. A surface at 100 m hides the half
  // beyond it. This half begins in the middle of the stretch, not in the middle of its picture.
  const std::vector<float> depth(200 * 100, 100.0f);
  const std::vector<Stretch> runs = stretches_of(view, depth, {9, -90, 0}, {20, 90, 0});
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_FALSE(runs[0].hidden);
  EXPECT_TRUE(runs[1].hidden);
  EXPECT_NEAR(runs[1].a.x, 114.5, 1.5);
}

TEST(Stretches, APathOnASurfaceIsInSight) {
  const std::vector<float> depth(200 * 100, 100.0f);
  const std::vector<Stretch> runs = stretches_of(side_view(), depth, {-50, 0, 0}, {50, 0, 0});
  ASSERT_EQ(runs.size(), 1u);
  EXPECT_FALSE(runs[0].hidden);
}

TEST(Stretches, WhatIsBehindTheCameraOrOutsideIsCutOff) {
  const PictureView view = side_view();
  const std::vector<float> depth(200 * 100, sky);
  EXPECT_TRUE(stretches_of(view, depth, {0, -150, 0}, {50, -200, 0}).empty());
  EXPECT_TRUE(stretches_of(view, depth, {500, 0, 0}, {600, 0, 0}).empty());
  EXPECT_TRUE(stretches_of(view, depth, {500, 0, 300}, {-500, 0, 300}).empty());
  const std::vector<Stretch> through = stretches_of(view, depth, {0, -300, 0}, {1, 300, 0});
  ASSERT_EQ(through.size(), 1u);
  EXPECT_TRUE(std::isfinite(through[0].a.x) && std::isfinite(through[0].b.x));
  const std::vector<Stretch> wide = stretches_of(view, depth, {-1e6, 0, 0}, {1e6, 0, 0});
  ASSERT_EQ(wide.size(), 1u);
  EXPECT_GE(wide[0].a.x, -9.0);
  EXPECT_LE(wide[0].b.x, 209.0);
}

TEST(Stretches, ALensBendsThem) {
  const PictureView view = barrel_view();
  // A surface at half the depth covers columns of the picture as the lens shows it.
  std::vector<float> depth(200 * 100, sky);
  for (size_t y = 0; y < 100; ++y)
    for (size_t x = 120; x < 140; ++x) depth[y * 200 + x] = 50.0f;
  const std::vector<Stretch> chords = stretches_of(view, depth, {-1e5, 0, 30}, {1e5, 0, 30});
  ASSERT_GT(chords.size(), 10u);
  double hidden_from = 1e9, hidden_to = -1e9;
  for (size_t i = 0; i < chords.size(); ++i) {
    const Stretch& c = chords[i];
    if (i > 0) {
      EXPECT_EQ(c.a, chords[i - 1].b);
    }
    EXPECT_LE(glm::distance(c.a, c.b), 12.0);
    if (c.hidden) hidden_from = std::min(hidden_from, c.a.x), hidden_to = std::max(hidden_to, c.b.x);
    // The point lies on the picture of the line: its row is the one to which the lens maps the point of the
    // line that appears in this column.
    double low = -160.0, high = 160.0;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      (view.bent(dvec2(view.project_straight({middle, 0, 30}))).x < c.b.x ? low : high) = middle;
    }
    EXPECT_NEAR(view.bent(dvec2(view.project_straight({low, 0, 30}))).y, c.b.y, 1e-6) << i;
  }
  EXPECT_NEAR(hidden_from, 120.0, 1.5);
  EXPECT_NEAR(hidden_to, 140.0, 1.5);
  // The line crosses the whole picture and is bent: it is lower at the sides, where the picture is smaller.
  EXPECT_LT(chords.front().a.x, 1.0);
  EXPECT_GT(chords.back().b.x, 199.0);
  EXPECT_GT(chords.front().a.y, view.project({0, 0, 30}).y + 3.0);
}

TEST(ShapeCoverage, OverlapsAreNotDenser) {
  io::Canvas canvas(40, 20, io::Color{0, 0, 0});
  ShapeCoverage coverage(40, 20);
  coverage.line({5, 10}, {20, 10}, 4.0);
  coverage.line({20, 10}, {35, 10}, 4.0);
  coverage.paint(canvas, {0, 0}, {200, 200, 200}, 0.5);
  const Array image = canvas.image();
  const auto at = [&](int x, int y) { return int{image.as<uint8_t>()[static_cast<size_t>(y * 40 + x) * 3]}; };
  EXPECT_EQ(at(20, 10), 100);
  EXPECT_EQ(at(10, 10), 100);
  EXPECT_EQ(at(10, 15), 0);
  coverage.paint(canvas, {0, 0}, {255, 0, 0}, 1.0);
  EXPECT_EQ(image.bytes, canvas.image().bytes) << "nothing is left over";
}

TEST(ShapeCoverage, ALineIsAsWideAsItSays) {
  io::Canvas canvas(60, 60, io::Color{0, 0, 0});
  ShapeCoverage coverage(60, 60);
  coverage.line({10, 10}, {50, 40}, 3.0);  // the line is 50 pixels long
  coverage.paint(canvas, {0, 0}, {250, 250, 250}, 1.0);
  double area = 0.0;
  const Array image = canvas.image();
  for (size_t i = 0; i < image.bytes.size(); i += 3) area += image.as<uint8_t>()[i] / 250.0;
  EXPECT_NEAR(area, 50.0 * 3.0 + pi * 1.5 * 1.5, 2.0);
}

TEST(Markers, EveryShapeHoldsItsCentreAndEndsNearItsRadius) {
  for (const rf::InteractionType type : path_kinds) {
    EXPECT_LT(marker_distance(type, {0, 0}, 5.0), 0.0) << kind_name(type);
    for (int i = 0; i < 32; ++i) {
      const dvec2 out(std::cos(2.0 * pi * i / 32), std::sin(2.0 * pi * i / 32));
      EXPECT_GT(marker_distance(type, 9.0 * out, 5.0), 0.0) << kind_name(type);
    }
  }
}

TEST(GainScale, CoversTheGainsInTensAndSaysWhatIsWeaker) {
  PathLink link = sample_link();  // gains of -75.4 dB, and of 10 dB and 1 dB less
  GainScale scale = gain_scale(std::span(&link, 1), 3.5e9);
  EXPECT_EQ(scale.high_db, -70.0);
  EXPECT_EQ(scale.low_db, -90.0);
  EXPECT_FALSE(scale.weaker);
  link.paths.push_back(path_through({{0, 0, 2}, {40, 0, 2}}, {}, 1e-5));
  scale = gain_scale(std::span(&link, 1), 3.5e9);
  EXPECT_EQ(scale.low_db, -130.0);
  EXPECT_TRUE(scale.weaker);
  EXPECT_EQ(scale.at(-200.0), 0.0);
  EXPECT_EQ(gain_scale({}, 3.5e9).high_db, -60.0);
}

TEST(DrawPaths, LinesInSightAreStrongAndHiddenOnesFaint) {
  const SampleScene sample;
  PathLink link = sample_link();
  link.paths.resize(1);
  PictureView view = side_view();
  view.width = 640;  // wide enough for the picture's head
  view.height = 300;
  view.cx = 320.0;
  view.cy = 150.0;
  view.fx = view.fy = 500.0;
  const std::vector<uint8_t> grey(size_t{640} * 300 * 3, 128);
  std::vector<float> depth(size_t{640} * 300, sky);
  for (size_t y = 0; y < 300; ++y)
    for (size_t x = 420; x < 470; ++x) depth[y * 640 + x] = 50.0f;
  const Array image = draw_paths(view, grey, depth, std::span(&link, 1), sample.view(), PathColors::kind,
                                 {"sample", "tick 0", "bs/panel"});
  ASSERT_EQ(image.shape, (std::vector<int64_t>{300 + picture_head + picture_foot, 640, 3}));
  // The line of sight lies in row 150 - 500 * 2 / 100.
  const auto pixel = [&](int x, int y) {
    const uint8_t* p = image.as<uint8_t>().data() +
                       (static_cast<size_t>(y + picture_head) * 640 + static_cast<size_t>(x)) * 3;
    return std::array<int, 3>{p[0], p[1], p[2]};
  };
  const io::Color color = color_of_kind(rf::InteractionType::none);
  EXPECT_EQ(pixel(390, 140), (std::array<int, 3>{color.r, color.g, color.b}));
  const auto hidden = pixel(445, 140), ground = pixel(445, 100);
  EXPECT_NE(hidden, ground);
  EXPECT_LT(hidden[1], (ground[1] + color.g) / 2 + 1) << "faint: nearer the ground than the colour";
  EXPECT_LT(ground[1], 128) << "the scene is subdued";
}

}  // namespace
}  // namespace greatx::apps
