// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Outlines of buildings: the walls that a level plane cuts, each once.
#include "sim/world/instance_outlines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"

namespace greatx::sim {
namespace {

/// Adds walls of `height` over a closed ring of corners, and a flat roof; each wall has two triangles.
void add_house(scene::Scene& scene, const std::string& name, scene::SemanticClass what,
               const std::vector<dvec2>& ring, double foot, double height) {
  scene::Instance& instance = scene.instances.emplace_back();
  instance.name = name, instance.semantic_class = what;
  scene::Primitive& primitive = scene.primitives.emplace_back();
  primitive.instance = static_cast<uint32_t>(scene.instances.size() - 1);
  primitive.first_index = static_cast<uint32_t>(scene.indices.size());
  const auto corner = [&](const dvec2& at, double z) {
    const dvec3 place = dvec3(at, z) - scene.origin;
    instance.bounds.add(place);
    scene.positions.emplace_back(place);
    scene.indices.push_back(static_cast<uint32_t>(scene.positions.size() - 1));
  };
  for (size_t i = 0; i < ring.size(); ++i) {
    const dvec2 a = ring[i], b = ring[(i + 1) % ring.size()];
    for (const auto& [at, z] : {std::pair(a, foot),
                                {b, foot},
                                {b, foot + height},
                                {a, foot},
                                {b, foot + height},
                                {a, foot + height}})
      corner(at, z);
  }
  for (size_t i = 1; i + 1 < ring.size(); ++i)
    for (const dvec2& at : {ring[0], ring[i], ring[i + 1]}) corner(at, foot + height);
  primitive.index_count = static_cast<uint32_t>(scene.indices.size()) - primitive.first_index;
}

double length_of(const InstanceOutline& outline) {
  double sum = 0.0;
  for (const auto& line : outline.lines) sum += glm::length(line.to - line.from);
  return sum;
}

std::vector<std::optional<InstanceOutline>> outlines_of(const scene::Scene& scene) {
  const World world{scene, {}, {}};
  return instance_outlines(world);
}

/// An L-shaped house on a slope of a place with large coordinates, turned by 30 degrees: six walls.
TEST(InstanceOutlines, WallsAreLinesOfTheWorld) {
  scene::Scene scene;
  scene.origin = {500000.0, 5000000.0, 200.0};
  std::vector<dvec2> ring;
  const double c = std::cos(radians(30.0)), s = std::sin(radians(30.0));
  for (const dvec2& p : {dvec2(0, 0), dvec2(20, 0), dvec2(20, 8), dvec2(8, 8), dvec2(8, 18), dvec2(0, 18)})
    ring.push_back(dvec2(500010.0 + c * p.x - s * p.y, 5000020.0 + s * p.x + c * p.y));
  add_house(scene, "house", scene::SemanticClass::building, ring, 203.0, 9.0);
  const auto outlines = outlines_of(scene);
  ASSERT_TRUE(outlines[0]);
  EXPECT_NEAR(outlines[0]->height_m, 207.5, 1e-3);
  ASSERT_EQ(outlines[0]->lines.size(), 6u) << "two triangles of a wall make one line";
  EXPECT_NEAR(length_of(*outlines[0]), 76.0, 0.01);
  for (const auto& line : outlines[0]->lines)
    for (const dvec2& end : {line.from, line.to})
      EXPECT_TRUE(std::ranges::any_of(ring, [&](const dvec2& p) { return glm::length(p - end) < 2e-3; }));
}

TEST(InstanceOutlines, OnlyTallThingsThatNeverMoveHaveOne) {
  using enum scene::SemanticClass;
  const std::vector<dvec2> square{{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  scene::Scene scene;
  add_house(scene, "house", building, square, 0.0, 3.0);
  add_house(scene, "step", building, square, 0.0, 1.9);
  add_house(scene, "tree", vegetation, square, 0.0, 9.0);
  add_house(scene, "thing", unlabeled, square, 0.0, 9.0);
  add_house(scene, "crane", building, square, 0.0, 9.0);
  scene.instances.back().body = 1;
  const auto outlines = outlines_of(scene);
  ASSERT_EQ(outlines.size(), 5u);
  std::vector<bool> found;
  for (const auto& outline : outlines) found.push_back(outline.has_value());
  EXPECT_THAT(found, testing::ElementsAre(true, false, false, true, false));
}

/// What has more lines than a building has none at all, rather than a part of them.
TEST(InstanceOutlines, ABoundKeepsOutWhatIsNoBuilding) {
  for (const size_t corners : {most_outline_lines, most_outline_lines + 1}) {
    std::vector<dvec2> ring;
    for (size_t i = 0; i < corners; ++i) {
      const double angle = 2.0 * pi * static_cast<double>(i) / static_cast<double>(corners);
      // A star, so that no line goes straight on.
      ring.push_back((i % 2 == 0 ? 500.0 : 480.0) * dvec2(std::cos(angle), std::sin(angle)));
    }
    scene::Scene scene;
    add_house(scene, "star", scene::SemanticClass::building, ring, 0.0, 5.0);
    EXPECT_EQ(outlines_of(scene)[0].has_value(), corners == most_outline_lines) << corners;
  }
}

}  // namespace
}  // namespace greatx::sim
