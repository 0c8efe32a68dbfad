// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks the trees of a scene (scene/device/scene_trees.h, shaders/lib/tree_walk.glsl) against the
// driver's ray queries, and along the edges and vertices of closed meshes, where every ray must hit.
#include "shaders/shared/tree.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <sched.h>

#include <gtest/gtest.h>

#include "scene/device/scene_trees.h"
#include "tests/gpu/tracing.h"

namespace greatx {
namespace {

using namespace test::tracing;
using gpu::Tracer;
using shared::TreeTestResult;
using test::TinyScene;
using test::Triangle;

std::vector<TreeTestResult> hits(const scene::Scene& scene, std::span<const TraceTestRay> rays, Tracer tracer,
                                 const std::vector<Pose>& bodies = {Pose{}},
                                 uint64_t most_table_bytes = ~uint64_t{0}) {
  scene::GpuSceneOptions options;
  options.tracer = tracer;
  options.most_table_bytes = most_table_bytes;
  scene::GpuScene gpu_scene(test::device(), scene, options);
  return answers_of<TreeTestResult>("tests/tree.comp", gpu_scene, rays, bodies);
}

/// Makes triangles of all sizes and directions, some of them in clusters.
TinyScene clutter(RandomStream& random, int count, double reach) {
  TinyScene tiny;
  for (int i = 0; i < count; ++i) {
    if (i % 100 == 0) tiny.object("object" + std::to_string(i));
    const double size = reach * std::pow(10.0, random.uniform(-3.0, -0.7));
    const dvec3 center =
        reach * dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-0.3, 0.3));
    tiny.triangle(center + size * random_direction(random), center + size * random_direction(random),
                  center + size * random_direction(random));
  }
  return tiny;
}

std::vector<TraceTestRay> random_rays(RandomStream& random, int count, double reach) {
  std::vector<TraceTestRay> rays;
  for (int i = 0; i < count; ++i) {
    const dvec3 from = reach * dvec3(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-1, 1));
    rays.push_back(ray(from, std::pow(10.0, random.uniform(-2.0, 2.0)) * random_direction(random)));
  }
  return rays;
}

/// The t in fp64 at which a ray meets the plane of a triangle, and a bound of the fp32 error. The bound is a
/// few roundings of the coordinates, and grows as the ray meets the plane at a flatter angle.
struct Exact {
  double t = 0.0, bound = 0.0;
};
Exact exact_hit(const scene::Scene& scene, const std::vector<Pose>& bodies, const TraceTestRay& ray,
                const TreeTestResult& hit) {
  const uint32_t body = scene.instances[scene.primitives[hit.primitive].instance].body;
  dvec3 corners[3];
  for (uint32_t i = 0; i < 3; ++i)
    corners[i] = bodies[body].apply(dvec3(scene.positions[scene.indices[3 * hit.triangle + i]]));
  const dvec3 normal = glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0])),
              origin(ray.origin), direction(ray.direction);
  const double speed = std::abs(glm::dot(normal, direction)),
               t = glm::dot(normal, corners[0] - origin) / glm::dot(normal, direction);
  return {t, 0x1p-21 * (glm::length(origin) + glm::length(corners[0]) + glm::length(corners[1])) / speed};
}

/// Expects the same triangle from both tracers, at the t of its plane and on the same side. Up to `grazing`
/// rays, which pass an edge within rounding errors, may differ.
void expect_same(const scene::Scene& scene, std::span<const TraceTestRay> rays, size_t grazing,
                 const std::vector<Pose>& bodies = {Pose{}}) {
  if (!test::device().info().has_ray_query()) GTEST_SKIP() << "the driver traces no rays";
  const auto tree = hits(scene, rays, Tracer::tree, bodies),
             driver = hits(scene, rays, Tracer::driver, bodies);
  size_t hit = 0, other = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    hit += driver[i].triangle != none;
    other += tree[i].triangle != driver[i].triangle;
    if (tree[i].triangle == none || tree[i].triangle != driver[i].triangle) continue;
    EXPECT_EQ(tree[i].primitive, driver[i].primitive);
    EXPECT_EQ(tree[i].front, driver[i].front);
    const Exact exact = exact_hit(scene, bodies, rays[i], tree[i]);
    EXPECT_NEAR(tree[i].t, exact.t, exact.bound) << i;
    EXPECT_NEAR(tree[i].t, driver[i].t, exact.bound) << i;
  }
  EXPECT_GT(hit, rays.size() / 20);
  EXPECT_LE(other, grazing);
}

TEST(Tree, AgreesWithTheDriverOnRandomRays) {
  RandomStream random(21, 1);
  for (const double reach : {0.01, 1.0, 300.0, 20000.0}) {
    const scene::Scene scene = clutter(random, 3000, reach).build();
    const std::vector<TraceTestRay> rays = random_rays(random, 8192, reach);
    expect_same(scene, rays, 1);
  }
}

TEST(Tree, AgreesFarFromTheOrigin) {
  // Coordinates are 5e5 m, as in a scene without a local origin.
  RandomStream random(22, 1);
  TinyScene tiny;
  const dvec3 far(5e5, -4e5, 100.0);
  for (int i = 0; i < 500; ++i) {
    const dvec3 center =
        far + 400.0 * dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    tiny.triangle(center + 40.0 * random_direction(random), center + 40.0 * random_direction(random),
                  center + 40.0 * random_direction(random));
  }
  std::vector<TraceTestRay> rays;
  for (int i = 0; i < 4096; ++i)
    rays.push_back(ray(far + 500.0 * random_direction(random), random_direction(random)));
  // A coordinate is rounded to 0.03 m. Rays that pass an edge by less may differ.
  expect_same(tiny.build(), rays, 8);
}

TEST(Tree, PassesOverFacetsAndBodies) {
  RandomStream random(23, 1);
  TinyScene tiny = clutter(random, 1000, 10.0);
  const uint32_t body = tiny.body("drone"), other = tiny.body("car");
  tiny.object("drone", body).box({-1, -1, -1}, {1, 1, 1});
  tiny.object("car", other).box({-2, -1, -1}, {2, 1, 1});
  const scene::Scene scene = tiny.build();
  const std::vector<Pose> poses{Pose{}, Pose{{3, 1, 0}, glm::angleAxis(0.4, dvec3(0, 0, 1))},
                                Pose{{-4, 2, 1}, glm::angleAxis(1.4, dvec3(1, 0, 0))}};
  std::vector<TraceTestRay> rays = random_rays(random, 8192, 4.0);
  for (size_t i = 0; i < rays.size(); ++i) {
    if (i % 2 == 0) rays[i].skip_facet = random.below(1000);
    if (i % 3 == 0) rays[i].skip_body = i % 2 == 0 ? body : other;
    if (i % 7 == 0) rays[i].skip_body = 0;
    if (i % 5 == 0) rays[i].t_min = static_cast<float>(random.uniform(0, 0.5));
    if (i % 11 == 0) rays[i].t_max = static_cast<float>(random.uniform(0.5, 20));
  }
  expect_same(scene, rays, 1, poses);
  size_t of_bodies = 0;
  for (const TreeTestResult& result : hits(scene, rays, Tracer::tree, poses))
    of_bodies += result.triangle != none && result.triangle >= 1000;
  EXPECT_GT(of_bodies, 100u);
}

/// Places `count` bodies of random shapes at random poses around `center`. Returns their poses, [0] of the
/// static world.
std::vector<Pose> add_bodies(TinyScene& tiny, RandomStream& random, int count, const dvec3& center,
                             double reach) {
  std::vector<Pose> poses{Pose{}};
  for (int i = 0; i < count; ++i) {
    const std::string name = "body" + std::to_string(i);
    tiny.object(name, tiny.body(name));
    for (const Triangle& t :
         sphere(i % 3, random.uniform(0.02, 0.1) * reach, 0.05 * reach * dvec3(1, -1, 0.5)))
      tiny.triangle(t[0], t[1], t[2]);
    const dvec3 place =
        center + reach * dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    poses.push_back({place, glm::angleAxis(random.uniform(0, 6), random_direction(random))});
  }
  return poses;
}

TEST(Tree, FindsManyMovingBodies) {
  // Coordinates reach 1e5 m, as in a scene without a local origin of its own.
  RandomStream random(26, 1);
  for (const dvec3& center : {dvec3(0.0), dvec3(1e5, -7e4, 50.0)})
    for (const int count : {1, 2, 3, 100}) {
      TinyScene tiny;
      const double reach = 30.0;
      const dvec3 low = center - dvec3(reach, reach, reach),
                  high = center + dvec3(reach, reach, -0.9 * reach);
      tiny.object("ground").box(low, high);
      const std::vector<Pose> poses = add_bodies(tiny, random, count, center, reach);
      std::vector<TraceTestRay> rays;
      for (int i = 0; i < 4096; ++i) {
        const Pose& body = poses[1 + random.below(static_cast<uint32_t>(count))];
        const dvec3 from = center + reach * random_direction(random),
                    target = body.apply(dvec3(0.05, -0.05, 0.025) * reach);
        rays.push_back(i % 2 == 0 ? ray_towards(from, target + 0.02 * reach * random_direction(random))
                                  : ray(from, random_direction(random)));
        if (i % 5 == 0) rays.back().skip_body = 1 + random.below(static_cast<uint32_t>(count));
      }
      const scene::Scene scene = tiny.build();
      // Far away the driver takes rays into a body's frame by products of 1e5 m, which it rounds to
      // centimetres. The tree subtracts first.
      expect_same(scene, rays, glm::length(center) > 0.0 ? 64 : 2, poses);
      size_t of_bodies = 0;
      for (const TreeTestResult& result : hits(scene, rays, Tracer::tree, poses))
        of_bodies += result.triangle != none && result.triangle >= 12;
      EXPECT_GT(of_bodies, 200u) << count;
    }
}

TEST(Tree, OfTrianglesAtOnePlaceTheFirstIsMet) {
  // Duplicates stand in any order in the tree, and rays along a shared edge are inside both triangles.
  TinyScene tiny;
  for (int i = 0; i < 40; ++i) tiny.triangle({-1, -1, 0}, {2, -1, 0}, {-1, 2, 0});
  std::vector<TraceTestRay> rays;
  for (int i = 0; i < 64; ++i) rays.push_back(ray({-0.9 + 0.02 * i, -0.9 + 0.01 * i, 3}, {0, 0, -1}));
  for (const TreeTestResult& result : hits(tiny.build(), rays, Tracer::tree)) EXPECT_EQ(result.triangle, 0u);
}

TEST(Tree, ReadByItsAddressIsTheSame) {
  RandomStream random(27, 1);
  TinyScene tiny = clutter(random, 2000, 30.0);
  const std::vector<Pose> poses = add_bodies(tiny, random, 5, dvec3(0.0), 30.0);
  const scene::Scene scene = tiny.build();
  const std::vector<TraceTestRay> rays = random_rays(random, 8192, 30.0);
  const auto near = hits(scene, rays, Tracer::tree, poses), far = hits(scene, rays, Tracer::tree, poses, 64);
  EXPECT_EQ(std::memcmp(near.data(), far.data(), near.size() * sizeof(near[0])), 0);
}

TEST(Tree, DoesNotLeakAlongEdgesAndVertices) {
  RandomStream random(24, 1);
  for (const dvec3& center : {dvec3(0.0), dvec3(70, -30, 20), dvec3(3e4, 1e4, 10)}) {
    TinyScene tiny;
    const std::vector<Triangle> mesh = sphere(3, 5.0, center);
    for (const Triangle& t : mesh) tiny.triangle(t[0], t[1], t[2]);
    std::vector<TraceTestRay> rays;
    for (int i = 0; i < 16384; ++i) {
      const Triangle& t = mesh[random.below(static_cast<uint32_t>(mesh.size()))];
      const double along = i % 3 == 0 ? 0.0 : random.uniform(0.0, 1.0);
      // Rays start inside. Half of them start at the exact centre, from which the edges of an octahedron lie
      // in planes of the axes.
      const dvec3 from = center + (i % 2 == 0 ? 0.0 : 3.0) * random_direction(random);
      rays.push_back(ray_towards(from, t[0] + along * (t[1] - t[0])));
    }
    size_t leaked = 0;
    for (const TreeTestResult& result : hits(tiny.build(), rays, Tracer::tree))
      leaked += result.triangle == none;
    EXPECT_EQ(leaked, 0u) << center.x;
  }
}

TEST(Tree, DoesNotLeakOutOfABoxAlongTheAxes) {
  // Rays go along the directions of edges and exactly onto edges and corners. Directions have zeros, and rays
  // meet boxes on their faces.
  TinyScene tiny;
  for (int i = 0; i < 4; ++i)  // walls in strips, so that boxes of the tree lie side by side
    for (int j = 0; j < 4; ++j)
      for (const int side : {0, 4}) {
        const auto quad = [&](auto p) { tiny.quad(p(i, j), p(i + 1, j), p(i + 1, j + 1), p(i, j + 1)); };
        quad([&](int u, int v) { return dvec3(u, v, side); });
        quad([&](int u, int v) { return dvec3(u, side, v); });
        quad([&](int u, int v) { return dvec3(side, u, v); });
      }
  std::vector<TraceTestRay> rays;
  for (const dvec3& from : {dvec3(2, 2, 2), dvec3(1, 1, 1), dvec3(1, 2, 3), dvec3(0.5, 2, 1)})
    for (int x = -4; x <= 4; ++x)
      for (int y = -4; y <= 4; ++y)
        for (int z = -4; z <= 4; ++z)
          if (x != 0 || y != 0 || z != 0) rays.push_back(ray(from, {x, y, z}));
  for (const TreeTestResult& result : hits(tiny.build(), rays, Tracer::tree)) {
    ASSERT_NE(result.triangle, none);
    ASSERT_LE(result.t, 3.5f);
  }
}

TEST(Tree, OneTriangleNoneAndThoseWithoutArea) {
  const std::vector<TraceTestRay> rays{ray({0.2, 0.2, -1}, {0, 0, 1}), ray({0.2, 0.2, 1}, {0, 0, -3}),
                                       ray({2, 2, -1}, {0, 0, 1})};
  TinyScene one;
  one.triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  auto results = hits(one.build(), rays, Tracer::tree);
  EXPECT_EQ(results[0].triangle, 0u);
  EXPECT_FLOAT_EQ(results[0].t, 1.0f);
  EXPECT_EQ(results[0].front, 0u);
  EXPECT_FLOAT_EQ(results[0].barycentric.x, 0.2f);
  EXPECT_FLOAT_EQ(results[1].t, 1.0f / 3.0f);
  EXPECT_EQ(results[1].front, 1u);
  EXPECT_EQ(results[2].triangle, none);
  for (const TreeTestResult& result : hits(TinyScene().build(), rays, Tracer::tree))
    EXPECT_EQ(result.triangle, none);
  TinyScene flat;
  flat.triangle({0, 0, 0}, {1, 0, 0}, {2, 0, 0}).triangle({0.2, 0.2, 0}, {0.2, 0.2, 0}, {0.2, 0.2, 0});
  EXPECT_EQ(scene::make_scene_trees(flat.build()).triangles, 0u);
  for (const TreeTestResult& result : hits(flat.build(), rays, Tracer::tree))
    EXPECT_EQ(result.triangle, none);
}

TEST(Tree, ManyAtOnePlaceStayWithinTheDepth) {
  TinyScene tiny;
  for (int i = 0; i < 300; ++i) tiny.triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  // Each triangle is a quarter of the one before, so every split by area separates one at the end.
  for (int i = 0; i < 60; ++i) {
    const double size = std::ldexp(1.0, -2 * i);
    tiny.triangle({10 * size, 0, 0}, {12 * size, size, 0}, {10 * size, size, size});
  }
  const scene::SceneTrees tree = scene::make_scene_trees(tiny.build());
  EXPECT_EQ(tree.triangles, 360u);
  EXPECT_EQ(tree.leaves, tree.inner_nodes + 1);
  EXPECT_LE(tree.depth, shared::tree_most_depth);
  const auto results = hits(tiny.build(), std::vector{ray({0.3, 0.3, 1}, {0, 0, -1})}, Tracer::tree);
  EXPECT_LT(results[0].triangle, 300u);
}

TEST(Tree, AnyNumberOfThreadsMakesTheSameWords) {
  RandomStream random(25, 2);
  const scene::Scene scene = clutter(random, 50000, 300.0).build();
  const scene::SceneTrees all = scene::make_scene_trees(scene);
  cpu_set_t cores;
  ASSERT_EQ(sched_getaffinity(0, sizeof cores, &cores), 0);
  cpu_set_t one;
  CPU_ZERO(&one);
  for (int core = 0; core < CPU_SETSIZE && CPU_COUNT(&one) == 0; ++core)
    if (CPU_ISSET(core, &cores)) CPU_SET(core, &one);
  ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
  const scene::SceneTrees alone = scene::make_scene_trees(scene);
  ASSERT_EQ(sched_setaffinity(0, sizeof cores, &cores), 0);
  EXPECT_EQ(all.words, alone.words);
  EXPECT_EQ(all.depth, alone.depth);
}

TEST(Tree, BoxesHoldWhatIsBelowThemAndEveryTriangleIsThereOnce) {
  RandomStream random(25, 1);
  const scene::Scene scene = clutter(random, 5000, 300.0).build();
  const scene::SceneTrees tree = scene::make_scene_trees(scene);
  EXPECT_EQ(tree.words, scene::make_scene_trees(scene).words);
  const auto number = [&](size_t quad, int i) {
    return double{std::bit_cast<float>(tree.words[4 * quad + i])};
  };
  const dvec3 low(number(0, 0), number(0, 1), number(0, 2)), step(number(1, 0), number(1, 1), number(1, 2));
  std::vector<int> seen(scene.triangle_count(), 0);
  struct Visit {
    uint32_t reference;
    dvec3 min, max;
  };
  std::vector<Visit> visits{{tree.words[3], dvec3(-1e30), dvec3(1e30)}};
  while (!visits.empty()) {
    const Visit visit = visits.back();
    visits.pop_back();
    const uint32_t quad = visit.reference & (shared::tree_most_quads - 1);
    if (visit.reference < shared::tree_leaf) {
      for (uint32_t side = 0; side < 2; ++side) {
        const uint32_t* words = &tree.words[4 * (quad + side)];
        const dvec3 min(words[0] & 0xffff, words[0] >> 16, words[1] & 0xffff),
            max(words[1] >> 16, words[2] & 0xffff, words[2] >> 16);
        // The box is decoded from whole steps of the tree's frame, in fp64.
        visits.push_back({words[3], low + step * min, low + step * max});
      }
      continue;
    }
    const uint32_t count = visit.reference >> shared::tree_count_shift & shared::tree_most_in_leaf;
    for (uint32_t i = 0; i < count; ++i) {
      const uint32_t first = quad + 3 * i;
      ++seen[tree.words[4 * first + 3]];
      for (uint32_t corner = 0; corner < 3; ++corner)
        for (int axis = 0; axis < 3; ++axis) {
          EXPECT_GE(number(first + corner, axis), visit.min[axis] - 1e-9);
          EXPECT_LE(number(first + corner, axis), visit.max[axis] + 1e-9);
        }
    }
  }
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<long>(seen.size()));
}

}  // namespace
}  // namespace greatx
