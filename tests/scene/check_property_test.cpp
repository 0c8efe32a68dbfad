// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Plants random holes and flips in random closed meshes, and measures how often rays find a hole of a known
// size.
#include <set>

#include "core/random.h"
#include "core/units.h"
#include "tests/scene/check_shapes.h"

namespace greatx::scene::test {
namespace {

/// A closed mesh in a random place and attitude, with hills and hollows.
Shape random_body(RandomStream& random) {
  Shape body = sphere(1.0, 2 + static_cast<int>(random.below(2)));
  const dvec3 a(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2));
  const double size = random.uniform(0.5, 40.0), roughness = random.uniform(0.0, 0.3);
  const dvec3 scale(random.uniform(0.4, 1.0), random.uniform(0.4, 1.0), random.uniform(0.4, 1.0));
  for (dvec3& corner : body.corners)
    corner *= size * scale * (1.0 + roughness * std::sin(3.0 * glm::dot(a, corner)));
  return body;
}

json random_node(RandomStream& random) {
  const dquat turn = glm::normalize(
      dquat(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
  const double reach = random.below(2) == 0 ? 50.0 : 5000.0;
  return {{"translation",
           {random.uniform(-reach, reach), random.uniform(-50, 50), random.uniform(-reach, reach)}},
          {"rotation", {turn.x, turn.y, turn.z, turn.w}}};
}

/// Chooses up to `count` triangles of which no two have a common corner.
std::set<uint32_t> apart(const Shape& shape, uint32_t count, RandomStream& random) {
  std::set<uint32_t> chosen, taken;
  for (uint32_t i = 0; i < 20 * count && chosen.size() < count; ++i) {
    const uint32_t t = random.below(static_cast<uint32_t>(shape.count()));
    const uint32_t* c = shape.indices.data() + 3 * t;
    if (std::any_of(c, c + 3, [&](uint32_t corner) { return taken.count(corner) > 0; })) continue;
    chosen.insert(t);
    taken.insert(c, c + 3);
  }
  return chosen;
}

CheckOptions without_sizes() {
  CheckOptions options;
  options.sliver_m = options.facet_m = 0.0;
  options.rays = 64;
  return options;
}

TEST(SceneCheckProperty, RandomClosedBodiesAreClean) {
  for (uint32_t seed = 0; seed < 40; ++seed) {
    RandomStream random(seed, 1);
    SceneWriter scene;
    scene.add("body", random_body(random), random_node(random));
    const SceneFaults faults = scene.check(without_sizes());
    EXPECT_EQ(kinds_of(faults), "") << seed;
    EXPECT_EQ(faults.figures.closed_parts, 1u);
  }
}

TEST(SceneCheckProperty, EveryHoleIsFoundOnceInItsPlace) {
  for (uint32_t seed = 0; seed < 60; ++seed) {
    RandomStream random(seed, 2);
    Shape body = random_body(random);
    const std::set<uint32_t> gone = apart(body, 1 + random.below(6), random);
    double length = 0.0;
    for (const uint32_t t : gone)
      for (size_t i = 0; i < 3; ++i) length += glm::distance(body.corner(t, i), body.corner(t, (i + 1) % 3));
    for (auto t = gone.rbegin(); t != gone.rend(); ++t) body.remove(*t);
    SceneWriter scene;
    scene.add("body", body, random_node(random));
    CheckOptions options = without_sizes();
    options.rays = 0;
    const SceneFaults faults = scene.check(options);
    ASSERT_NE(faults.find("hole"), nullptr) << seed << ": " << kinds_of(faults);
    EXPECT_EQ(faults.find("hole")->count, gone.size()) << seed;
    EXPECT_EQ(faults.faults.size(), 1u) << seed << ": " << kinds_of(faults);
    EXPECT_NEAR(faults.find("hole")->total, length, 1e-3 * length) << seed;
  }
}

TEST(SceneCheckProperty, EveryFlipIsFoundOnceInItsPlace) {
  for (uint32_t seed = 0; seed < 60; ++seed) {
    RandomStream random(seed, 3);
    Shape body = random_body(random);
    std::set<uint32_t> flips;
    while (flips.size() < 1 + seed % 9) flips.insert(random.below(static_cast<uint32_t>(body.count())));
    for (const uint32_t t : flips) body.flip(t);
    SceneWriter scene;
    scene.add("body", body);
    const SceneFaults faults = scene.check(without_sizes());
    ASSERT_NE(faults.find("flipped"), nullptr) << seed << ": " << kinds_of(faults);
    EXPECT_EQ(faults.find("flipped")->count, flips.size()) << seed;
    EXPECT_EQ(faults.faults.size(), 1u) << seed << ": " << kinds_of(faults);
    for (const FaultPlace& place : faults.find("flipped")->places)
      EXPECT_TRUE(std::ranges::any_of(flips, [&](uint32_t t) {
        return glm::distance(body.center(t), place.at) < 1e-4;
      })) << seed;
  }
}

TEST(SceneCheckProperty, EveryDuplicateIsFoundOnce) {
  for (uint32_t seed = 0; seed < 30; ++seed) {
    RandomStream random(seed, 4);
    Shape body = random_body(random);
    const std::set<uint32_t> twice = apart(body, 1 + random.below(6), random);
    Shape copies;
    for (const uint32_t t : twice) copies.triangle(body.corner(t, 0), body.corner(t, 1), body.corner(t, 2));
    body.append(copies);
    SceneWriter scene;
    scene.add("body", body, random_node(random));
    const SceneFaults faults = scene.check(without_sizes());
    ASSERT_NE(faults.find("duplicate"), nullptr) << seed << ": " << kinds_of(faults);
    EXPECT_EQ(faults.find("duplicate")->count, twice.size()) << seed;
    EXPECT_EQ(faults.find("hole"), nullptr) << seed << ": " << kinds_of(faults);
  }
}

TEST(SceneCheckProperty, ThreadsChangeNothing) {
  RandomStream random(7, 5);
  SceneWriter scene;
  for (int i = 0; i < 12; ++i) {
    Shape body = random_body(random);
    body.remove(5 * static_cast<size_t>(i));
    scene.add("body_" + std::to_string(i), body, random_node(random));
  }
  CheckOptions options;
  options.threads = 1;
  const SceneFaults one = scene.check(options);
  options.threads = 4;
  const SceneFaults four = scene.check(options);
  ASSERT_EQ(kinds_of(one), kinds_of(four));
  EXPECT_EQ(one.figures.rays_out, four.figures.rays_out);
  for (size_t i = 0; i < one.faults.size(); ++i)
    for (size_t k = 0; k < one.faults[i].places.size(); ++k) {
      EXPECT_EQ(one.faults[i].places[k].at, four.faults[i].places[k].at);
      EXPECT_EQ(one.faults[i].places[k].size, four.faults[i].places[k].size);
    }
}

/// The centre of the sphere is the middle of every chord along a normal, but for the facets. A hole of one of
/// 320 triangles then takes 1/320 of the directions, and 256 rays find it with 1 - (1 - 1/320)^256 = 0.551.
TEST(SceneCheckRays, AHoleIsFoundAsOftenAsItsShareSays) {
  Shape body = sphere(5.0, 2);
  body.remove(123);
  SceneWriter scene;
  scene.add("body", body);
  const Model model = scene.load();
  constexpr int seeds = 600;
  int found = 0;
  for (int seed = 0; seed < seeds; ++seed) {
    CheckOptions options;
    options.seed = static_cast<uint64_t>(seed);
    found += check_scene(model, options).find("ray_leak") != nullptr;
  }
  const double expected = 1.0 - std::pow(1.0 - 1.0 / 320.0, 256.0);
  const double sigma = std::sqrt(expected * (1.0 - expected) / seeds);
  EXPECT_NEAR(static_cast<double>(found) / seeds, expected, 4.0 * sigma);
}

/// Returns the solid angle of the rectangle [0, x] x [0, y] seen from a height d above its corner.
double corner_angle(double x, double y, double d) {
  return std::atan(x * y / (d * std::sqrt(x * x + y * y + d * d)));
}

/// Rays of a cube without its roof: points lie on the two vertical middle planes, uniformly, and their rays
/// leave by the share of the roof's solid angle. Rays up from the floor leave at once.
TEST(SceneCheckRays, ACubeWithoutARoofLeaksByTheSolidAngle) {
  SceneWriter scene;
  scene.add("body", box({0, 0, 0}, {1, 1, 1}, all_faces & ~top));
  const Model model = scene.load();
  uint64_t rays = 0, out = 0;
  constexpr uint64_t seeds = 400;
  for (uint64_t seed = 0; seed < seeds; ++seed) {
    CheckOptions options;
    options.seed = seed;
    const CheckFigures figures = check_scene(model, options).figures;
    rays += figures.rays, out += figures.rays_out;
  }
  // A point is on the floor with 1/5, and then its ray counts alone.
  double share = 0.0;
  constexpr int n = 200;
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < n; ++k) {
      const double y = (i + 0.5) / n, d = (k + 0.5) / n;
      const double angle = 2.0 * (corner_angle(0.5, y, d) + corner_angle(0.5, 1.0 - y, d));
      share += angle / (4.0 * pi) / (n * n);
    }
  const double expected_out = seeds * 8.0 * (0.2 + 0.8 * 32.0 * share);
  const double expected_rays = seeds * 8.0 * (0.2 + 0.8 * 32.0);
  EXPECT_NEAR(static_cast<double>(rays), expected_rays, 0.02 * expected_rays);
  EXPECT_NEAR(static_cast<double>(out), expected_out, 0.05 * expected_out);
}

}  // namespace
}  // namespace greatx::scene::test
