// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/buildings/roofs.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"

namespace greatx::scene::place {
namespace {

Polygon box(double w, double h, double turn = 0.0) {
  Polygon polygon;
  for (const dvec2& p : {dvec2(0, 0), dvec2(w, 0), dvec2(w, h), dvec2(0, h)})
    polygon.outer.emplace_back(std::cos(turn) * p.x - std::sin(turn) * p.y,
                               std::sin(turn) * p.x + std::cos(turn) * p.y);
  return polygon;
}

struct Measures {
  double area = 0.0, volume = 0.0, lowest = 1e300, highest = -1e300;
};
/// Area in plan and volume above z = 0 of a roof.
Measures measure(const std::vector<RoofFace>& roof) {
  Measures m;
  for (const RoofFace& face : roof)
    for (const Polygon& polygon : face.area) {
      const auto add = [&](const Ring& ring) {
        for (size_t i = 1; i + 1 < ring.size(); ++i) {
          const dvec2 a = ring[i] - ring[0], b = ring[i + 1] - ring[0];
          const double size = 0.5 * (a.x * b.y - a.y * b.x);
          m.area += size;
          m.volume += size * face.plane.z(ring[0] + (a + b) / 3.0);
        }
        for (const dvec2& p : ring) {
          m.lowest = std::min(m.lowest, face.plane.z(p));
          m.highest = std::max(m.highest, face.plane.z(p));
        }
      };
      add(polygon.outer);
      for (const Ring& hole : polygon.holes) add(hole);
    }
  return m;
}

// Closed forms over a rectangle of 12 x 8 m, eaves at 0 and ridge at 3 m.
struct Case {
  RoofShape shape;
  double volume;
  size_t faces;
};

TEST(PlaceRoofs, OverARectangleHaveTheirVolumes) {
  const double w = 12.0, h = 8.0, rise = 3.0;
  // Hipped: a prism in the middle (w - h) and two half pyramids, together one pyramid over h x h.
  const double hipped = 0.5 * rise * h * (w - h) + rise * h * h / 3.0;
  // Gambrel over half the width b: 0.4 b up to 0.65, then to 1.
  const double b = 0.5 * h, gambrel = 2.0 * w * rise * b * (0.4 * 0.65 / 2.0 + 0.6 * (0.65 + 1.0) / 2.0);
  const std::vector<Case> cases{
      {RoofShape::gabled, 0.5 * rise * w * h, 2},    {RoofShape::hipped, hipped, 4},
      {RoofShape::pyramidal, rise * w * h / 3.0, 4}, {RoofShape::skillion, 0.5 * rise * w * h, 1},
      {RoofShape::saltbox, 0.5 * rise * w * h, 2},   {RoofShape::gambrel, gambrel, 4}};
  for (const double turn : {0.0, 0.3, 1.2, 2.9})
    for (const Case& c : cases) {
      const std::vector<RoofFace> roof = make_roof(box(w, h, turn), {c.shape, 0.0, rise});
      const Measures m = measure(roof);
      EXPECT_EQ(roof.size(), c.faces) << name_of(c.shape);
      EXPECT_NEAR(m.area, w * h, 1e-6) << name_of(c.shape);
      EXPECT_NEAR(m.volume, c.volume, 1e-6) << name_of(c.shape) << " turned by " << turn;
      EXPECT_NEAR(m.highest, rise, 1e-9) << name_of(c.shape);
      EXPECT_NEAR(m.lowest, 0.0, 1e-9) << name_of(c.shape);
    }
}

TEST(PlaceRoofs, HalfHippedRoundMansardAndDomeLieBetweenTheirBounds) {
  const double w = 12.0, h = 8.0, rise = 3.0, gabled = 0.5 * rise * w * h, block = rise * w * h;
  const auto volume = [&](RoofShape shape) {
    return measure(make_roof(box(w, h), {shape, 0.0, rise})).volume;
  };
  EXPECT_LT(volume(RoofShape::hipped), volume(RoofShape::half_hipped));
  EXPECT_LT(volume(RoofShape::half_hipped), gabled);
  // Chords of four steps each: the half ellipse pi/4, less 1 - sin(x)/x with x = pi / 8 at most.
  EXPECT_NEAR(volume(RoofShape::round) / block, pi / 4.0, 0.03);
  EXPECT_LT(volume(RoofShape::round) / block, pi / 4.0);
  EXPECT_GT(volume(RoofShape::mansard), gabled);
  EXPECT_LT(volume(RoofShape::mansard), block);
  EXPECT_GT(volume(RoofShape::dome), gabled);
  EXPECT_LT(volume(RoofShape::dome), block);
  for (const RoofShape shape :
       {RoofShape::half_hipped, RoofShape::round, RoofShape::mansard, RoofShape::dome})
    EXPECT_NEAR(measure(make_roof(box(w, h), {shape, 0.0, rise})).area, w * h, 1e-6) << name_of(shape);
}

TEST(PlaceRoofs, SkillionFallsInItsDirection) {
  const std::vector<RoofFace> roof =
      make_roof(box(12, 8), {RoofShape::skillion, 5.0, 8.0, radians(-90.0), false});
  ASSERT_EQ(roof.size(), 1u);
  EXPECT_NEAR(roof[0].plane.z({3.0, 0.0}), 5.0, 1e-9);  // the south side is low
  EXPECT_NEAR(roof[0].plane.z({3.0, 8.0}), 8.0, 1e-9);
}

TEST(PlaceRoofs, RidgesMayRunAcross) {
  const std::vector<RoofFace> along = make_roof(box(12, 8), {RoofShape::gabled, 0.0, 3.0}),
                              across =
                                  make_roof(box(12, 8), {RoofShape::gabled, 0.0, 3.0, std::nullopt, true});
  const auto z = [](const std::vector<RoofFace>& roof, const dvec2& p) {
    for (const RoofFace& face : roof)
      for (const Polygon& polygon : face.area)
        if (contains(polygon, p)) return face.plane.z(p);
    return -1.0;
  };
  EXPECT_NEAR(z(along, {0.01, 4.0 - 1e-6}), 3.0, 1e-3);
  EXPECT_NEAR(z(across, {0.01, 4.0 - 1e-6}), 0.005, 1e-3);
  EXPECT_NEAR(z(across, {6.0 - 1e-6, 0.01}), 3.0, 1e-3);
}

TEST(PlaceRoofs, AnLHasTwoWingsThatMeetInAValley) {
  const Polygon l{{{0, 0}, {20, 0}, {20, 8}, {8, 8}, {8, 18}, {0, 18}}, {}};
  const std::vector<Rectangle> rectangles = wings(l);
  ASSERT_EQ(rectangles.size(), 2u);
  EXPECT_NEAR(rectangles[0].half.x, 10.0, 1e-9);
  EXPECT_NEAR(rectangles[1].half.x, 9.0, 1e-9);
  const std::vector<RoofFace> roof = make_roof(l, {RoofShape::hipped, 0.0, 4.0});
  const Measures m = measure(roof);
  EXPECT_NEAR(m.area, 20.0 * 8 + 10.0 * 8, 1e-6);
  EXPECT_NEAR(m.highest, 4.0, 1e-9);
  // Every point is as high as its distance from the nearest outer wall says, except at the inner corner's
  // valley, where both wings have the distance from their own far walls.
  for (const dvec2& p : {dvec2(1, 9), dvec2(15, 1), dvec2(4, 4), dvec2(7.5, 12), dvec2(4, 17)}) {
    double distance = 1e300;
    for (size_t i = 0; i < l.outer.size(); ++i) {
      const dvec2 a = l.outer[i], d = l.outer[(i + 1) % 6] - a;
      const double t = std::clamp(glm::dot(p - a, d) / glm::dot(d, d), 0.0, 1.0);
      distance = std::min(distance, glm::distance(p, a + d * t));
    }
    double z = -1.0;
    for (const RoofFace& face : roof)
      for (const Polygon& polygon : face.area)
        if (contains(polygon, p)) z = face.plane.z(p);
    EXPECT_NEAR(z, distance, 1e-6) << p.x << " " << p.y;
  }
}

TEST(PlaceRoofs, AskewFootprintsHaveNoWings) {
  EXPECT_TRUE(wings({{{0, 0}, {20, 3}, {17, 14}, {8, 8}, {2, 18}}, {}}).empty());
}

TEST(PlaceRoofs, NamesOfOpenStreetMapAreKnown) {
  EXPECT_EQ(roof_shape("half-hipped"), RoofShape::half_hipped);
  EXPECT_EQ(roof_shape("onion"), RoofShape::dome);
  EXPECT_FALSE(roof_shape("many"));
}

TEST(PlaceRoofs, SmallestRectangleOfATurnedBox) {
  const Rectangle r = smallest_rectangle(box(12, 8, 0.4).outer);
  EXPECT_NEAR(r.half.x, 6.0, 1e-9);
  EXPECT_NEAR(r.half.y, 4.0, 1e-9);
  EXPECT_NEAR(std::abs(glm::dot(r.along, dvec2(std::cos(0.4), std::sin(0.4)))), 1.0, 1e-9);
}

}  // namespace
}  // namespace greatx::scene::place
