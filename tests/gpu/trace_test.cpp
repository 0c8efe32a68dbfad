// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks rays against triangles through shaders/lib/trace.glsl: the hard cases 1-10 of the catalogue.
#include <cmath>
#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/gpu/tracing.h"

namespace greatx {
namespace {

using namespace test::tracing;
using test::TinyScene;
using test::Triangle;

GREATX_TRACER_TEST(Trace, HitsWhatItShould) {
  TinyScene tiny;
  tiny.quad({-1, -1, 5}, {1, -1, 5}, {1, 1, 5}, {-1, 1, 5})
      .quad({-1, -1, 7}, {1, -1, 7}, {1, 1, 7}, {-1, 1, 7});
  TraceTestRay through = ray({0.25, -0.5, 0}, {0, 0, 2});
  TraceTestRay skipping = through;
  skipping.skip_facet = 0;
  TraceTestRay short_one = ray({0.25, -0.5, 0}, {0, 0, 1}, 4.9);
  const auto results =
      trace(tracer, tiny.build(), std::vector{through, skipping, ray({3, 0, 0}, {0, 0, 1}), short_one});
  EXPECT_EQ(results[0].triangle, 0u);
  EXPECT_FLOAT_EQ(results[0].t, 2.5f);  // in units of the length of the direction
  EXPECT_EQ(results[0].next_triangle, 2u);
  EXPECT_FLOAT_EQ(results[0].next_t, 3.5f);
  EXPECT_EQ(results[0].any, 1u);
  EXPECT_EQ(results[0].point, vec3(0.25f, -0.5f, 5.0f));
  EXPECT_EQ(results[1].triangle, 0u);
  EXPECT_EQ(results[1].except_triangle, 2u);
  EXPECT_FLOAT_EQ(results[1].except_t, 3.5f);
  EXPECT_EQ(results[2].triangle, none);
  EXPECT_EQ(results[2].any, 0u);
  EXPECT_EQ(results[3].triangle, none);
  EXPECT_EQ(results[3].any, 0u);
}

GREATX_TRACER_TEST(Trace, PassesOverABodyExactly) {
  // A body's face and a wall are at the same place. The ray may hit the wall only.
  TinyScene tiny;
  tiny.object("wall").quad({-1, -1, 5}, {1, -1, 5}, {1, 1, 5}, {-1, 1, 5});
  const uint32_t body = tiny.body("drone");
  tiny.object("drone", body).quad({-1, -1, 2}, {1, -1, 2}, {1, 1, 2}, {-1, 1, 2});
  TraceTestRay up = ray({0.3, 0.1, 0}, {0, 0, 1});
  up.skip_body = body;
  const std::vector<Pose> poses{Pose{}, Pose{{0, 0, 3}, {1, 0, 0, 0}}};
  const auto results = trace(tracer, tiny.build(), std::vector{up}, poses);
  EXPECT_FLOAT_EQ(results[0].t, 5.0f);
  EXPECT_EQ(results[0].except_triangle, 0u);
  EXPECT_FLOAT_EQ(results[0].except_t, 5.0f);
}

GREATX_TRACER_TEST(HardCase, N01_SharedEdgeIsHitExactlyOnce) {
  RandomStream random(1, 1);
  for (int scene = 0; scene < 4; ++scene) {
    const dmat3 turn = random_rotation(random);
    const dvec3 a = turn * dvec3(-3, 0, 0), b = turn * dvec3(4, 0, 0);
    TinyScene tiny;
    tiny.triangle(a, b, turn * dvec3(1, 5, -2)).triangle(b, a, turn * dvec3(0, -4, -1));
    std::vector<TraceTestRay> rays;
    for (int i = 0; i < 8192; ++i)
      rays.push_back(
          ray_towards(turn * dvec3(random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(5, 40)),
                      a + random.uniform(0.02, 0.98) * (b - a)));
    int missed = 0, twice = 0;
    for (const TraceTestResult& result : trace(tracer, tiny.build(), rays)) {
      missed += result.triangle == none;
      twice += result.triangle != none && result.next_triangle != none;
    }
    EXPECT_EQ(missed, 0) << "scene " << scene;
    EXPECT_EQ(twice, 0) << "scene " << scene;
  }
}

GREATX_TRACER_TEST(HardCase, N02_VertexOfAClosedFanIsHitExactlyOnce) {
  RandomStream random(2, 1);
  const dvec3 tip(0.3, -0.2, 1.7);
  TinyScene tiny;
  constexpr int blades = 9;
  const auto rim = [](int i) {
    return dvec3(4 * std::cos(2 * M_PI * i / blades), 4 * std::sin(2 * M_PI * i / blades), 0);
  };
  for (int i = 0; i < blades; ++i) tiny.triangle(tip, rim(i % blades), rim((i + 1) % blades));
  std::vector<TraceTestRay> rays;
  for (int i = 0; i < 8192; ++i)
    rays.push_back(ray_towards({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(5, 40)}, tip));
  int missed = 0, twice = 0;
  for (const TraceTestResult& result : trace(tracer, tiny.build(), rays)) {
    missed += result.triangle == none;
    twice += result.triangle != none && result.next_triangle != none;
  }
  EXPECT_EQ(missed, 0);
  EXPECT_EQ(twice, 0);
}

GREATX_TRACER_TEST(HardCase, N03_TwoStaticObjectsThatShareAnEdgeDoNotLeak) {
  // Two instances belong to one body and so to one acceleration structure, whose edges are watertight.
  TinyScene tiny;
  tiny.object("left").triangle({-3, 0, 0.5}, {0, -5, 0}, {0, 5, 0});
  tiny.object("right").triangle({3, 0, 0.7}, {0, 5, 0}, {0, -5, 0});
  const scene::Scene scene = tiny.build();
  ASSERT_EQ(scene.instances.size(), 2u);
  ASSERT_EQ(scene.bodies.size(), 1u);
  RandomStream random(3, 1);
  std::vector<TraceTestRay> rays;
  for (int i = 0; i < 16384; ++i)
    rays.push_back(ray_towards({random.uniform(-1, 1), random.uniform(-2, 2), random.uniform(5, 40)},
                               {0, random.uniform(-4.8, 4.8), 0}));
  int missed = 0;
  for (const TraceTestResult& result : trace(tracer, scene, rays)) missed += result.triangle == none;
  EXPECT_EQ(missed, 0);
}

GREATX_TRACER_TEST(HardCase, N04_DegenerateTrianglesAreNeverHit) {
  TinyScene tiny;
  tiny.triangle({0, 0, 3}, {1, 0, 3}, {2, 0, 3})   // three corners on a line
      .triangle({0, 0, 2}, {0, 0, 2}, {0, 0, 2})   // a point
      .triangle({-1, 0, 1}, {1, 0, 1}, {1, 0, 1})  // a line twice
      .quad({-5, -5, 9}, {5, -5, 9}, {5, 5, 9}, {-5, 5, 9});
  std::vector<TraceTestRay> rays;
  for (const dvec3& target : {dvec3(1, 0, 3), dvec3(0, 0, 2), dvec3(0.5, 0, 1), dvec3(0.25, 0, 3)}) {
    rays.push_back(ray(dvec3(target.x, target.y, 0), {0, 0, 1}));
    rays.push_back(ray_towards({0.1, 0.2, 0}, target));
  }
  for (const TraceTestResult& result : trace(tracer, tiny.build(), rays)) {
    EXPECT_GE(result.triangle, 3u);  // the quad behind them
    EXPECT_LE(result.triangle, 4u);
    EXPECT_TRUE(std::isfinite(result.t));
    EXPECT_EQ(result.next_triangle, none);
  }
}

GREATX_TRACER_TEST(HardCase, N05_SliversOfAClosedMeshDoNotLeak) {
  // The lid of the box is made of strips 1e-4 m wide next to wide ones.
  TinyScene tiny;
  tiny.quad({-1, -1, -1}, {-1, 1, -1}, {1, 1, -1}, {1, -1, -1})
      .quad({-1, -1, -1}, {1, -1, -1}, {1, -1, 1}, {-1, -1, 1})
      .quad({-1, 1, -1}, {-1, 1, 1}, {1, 1, 1}, {1, 1, -1})
      .quad({-1, -1, -1}, {-1, -1, 1}, {-1, 1, 1}, {-1, 1, -1})
      .quad({1, -1, -1}, {1, 1, -1}, {1, 1, 1}, {1, -1, 1});
  std::vector<double> cuts;
  for (int i = 0; i <= 20; ++i) cuts.insert(cuts.end(), {-1 + 0.1 * i, std::min(1.0, -1 + 0.1 * i + 1e-4)});
  std::sort(cuts.begin(), cuts.end());
  for (size_t i = 0; i + 1 < cuts.size(); ++i)
    if (cuts[i + 1] > cuts[i])
      tiny.quad({cuts[i], -1, 1}, {cuts[i + 1], -1, 1}, {cuts[i + 1], 1, 1}, {cuts[i], 1, 1});
  RandomStream random(5, 1);
  std::vector<TraceTestRay> rays;
  for (int i = 0; i < 16384; ++i) {
    const dvec3 from(random.uniform(-0.9, 0.9), random.uniform(-0.9, 0.9), random.uniform(-0.9, 0.9));
    // A third of the rays go into the slivers, a third along their edges, and a third anywhere.
    const double cut = cuts[random.below(static_cast<uint32_t>(cuts.size()))];
    const dvec3 to(i % 3 == 0 ? cut + random.uniform(0, 1e-4) : cut, random.uniform(-0.999, 0.999), 1);
    rays.push_back(i % 3 == 2 ? ray(from, random_direction(random)) : ray_towards(from, to));
  }
  int leaked = 0;
  for (const TraceTestResult& result : trace(tracer, tiny.build(), rays)) leaked += result.triangle == none;
  EXPECT_EQ(leaked, 0);
}

GREATX_TRACER_TEST(Trace, RaysInGeneralDirectionsDoNotLeak) {
  // The rays start inside a closed room of 2400 tiles. The LiDAR and the candidate search rely on this
  // property.
  TinyScene tiny;
  const auto tiles = [&](const dvec3& corner, const dvec3& u, const dvec3& v) {
    for (int i = 0; i < 20; ++i)
      for (int j = 0; j < 20; ++j) {
        const dvec3 a = corner + u * (i / 20.0) + v * (j / 20.0);
        tiny.quad(a, a + u / 20.0, a + u / 20.0 + v / 20.0, a + v / 20.0);
      }
  };
  const dvec3 x(7, 0, 0), y(0, 5, 0), z(0, 0, 3);
  for (const auto& [u, v, w] : {std::tuple{x, y, z}, {y, z, x}, {z, x, y}}) {
    tiles(dvec3(0.0), u, v);
    tiles(w, u, v);
  }
  RandomStream random(11, 1);
  std::vector<TraceTestRay> rays;
  for (int i = 0; i < 65536; ++i)
    rays.push_back(ray({random.uniform(0.5, 6.5), random.uniform(0.5, 4.5), random.uniform(0.5, 2.5)},
                       random_direction(random)));
  size_t leaked = 0, differ = 0;
  for (const TraceTestResult& result : trace(tracer, tiny.build(), rays)) {
    leaked += result.plain_triangle == none;
    differ += result.plain_triangle != result.triangle;
  }
  EXPECT_EQ(leaked, 0u);
  EXPECT_EQ(differ, 0u);
}

GREATX_TRACER_TEST(HardCase, N06_RaysInTheTrianglesPlaneAreFiniteAndDoNotLeak) {
  TinyScene tiny;
  tiny.box({-1, -1, -1}, {1, 1, 1}).quad({-0.5, -0.5, 0}, {0.5, -0.5, 0}, {0.5, 0.5, 0}, {-0.5, 0.5, 0});
  RandomStream random(6, 1);
  std::vector<TraceTestRay> rays;
  for (int i = 0; i < 4096; ++i) {
    const double azimuth = random.uniform(0, 2 * M_PI);
    rays.push_back(ray({random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4), 0},
                       {std::cos(azimuth), std::sin(azimuth), 0}));
  }
  for (const TraceTestResult& result : trace(tracer, tiny.build(), rays)) {
    ASSERT_NE(result.triangle, none);  // the wall of the box
    ASSERT_LT(result.triangle, 12u);   // not the quad in whose plane the ray runs
    ASSERT_GE(result.t, 0.6f - 1e-6f);
    ASSERT_LE(result.t, 2.0f);
    ASSERT_TRUE(std::isfinite(result.start.x + result.start.y + result.start.z));
  }
}

GREATX_TRACER_TEST(HardCase, N07_SceneAtUtmCoordinatesGivesTheSameBytes) {
  const dvec3 utm(500000.0, 5411000.0, 35.0);
  RandomStream random(7, 1);
  TinyScene here, there;
  for (int i = 0; i < 200; ++i) {
    // Coordinates are multiples of 2^-20 m, which fp64 holds exactly at 5e6 m as well.
    const auto grid = [&](double reach) {
      return std::round(random.uniform(-reach, reach) * 0x1p20) * 0x1p-20;
    };
    const dvec3 a(grid(100), grid(100), grid(20)), b = a + dvec3(grid(9), grid(9), grid(9)),
                                                   c = a + dvec3(grid(9), grid(9), grid(9));
    here.triangle(a, b, c);
    there.triangle(a + utm, b + utm, c + utm);
  }
  std::vector<TraceTestRay> rays;
  for (int i = 0; i < 4096; ++i)
    rays.push_back(ray({random.uniform(-50, 50), 1.0, 2.0}, random_direction(random)));
  const auto near = trace(tracer, here.build(), rays), far = trace(tracer, there.build(utm), rays);
  EXPECT_EQ(std::memcmp(near.data(), far.data(), near.size() * sizeof(near[0])), 0);
}

GREATX_TRACER_TEST(HardCase, N08_ATinyPartBesideAHugeTileIsStillHit) {
  TinyScene tiny;
  tiny.quad({-5000, -5000, 0}, {5000, -5000, 0}, {5000, 5000, 0}, {-5000, 5000, 0});
  const dvec3 part(3, 4, 1);
  tiny.triangle(part, part + dvec3(1e-4, 0, 0), part + dvec3(0, 1e-4, 0));
  RandomStream random(8, 1);
  std::vector<TraceTestRay> rays;
  for (int i = 0; i < 4096; ++i) {
    const double u = random.uniform(0.1, 0.8), v = random.uniform(0.1, 0.9 - u);
    const dvec3 target = part + 1e-4 * dvec3(u, v, 0);
    rays.push_back(ray_towards(target + dvec3(random.uniform(-2, 2), random.uniform(-2, 2), 4), target));
  }
  int hit = 0;
  for (const TraceTestResult& result : trace(tracer, tiny.build(), rays)) hit += result.triangle == 2;
  EXPECT_EQ(hit, 4096);
}

GREATX_TRACER_TEST(HardCase, N09_AStartPointIsMovedByItsErrorAndNoMore) {
  // At 5e5 m without a local origin, the usual integer offset moves the point by 8 m.
  const dvec3 far(5e5, 4e5, 0);
  TinyScene tiny;
  tiny.quad(far + dvec3(-50, -50, 0), far + dvec3(50, -50, 0), far + dvec3(50, 50, 40),
            far + dvec3(-50, 50, 40));
  RandomStream random(9, 1);
  std::vector<TraceTestRay> rays;
  for (int i = 0; i < 4096; ++i)
    rays.push_back(ray_towards(far + dvec3(random.uniform(-200, 200), -200, 300),
                               far + dvec3(random.uniform(-40, 40), 10.0, 24.0)));
  for (const TraceTestResult& result : trace(tracer, tiny.build(), rays)) {
    ASSERT_NE(result.triangle, none);
    // The bound is seven roundings of coordinates of 5e5 m, projected on the normal: below 0.3 m, where a
    // rounding is 0.03 m.
    ASSERT_LE(glm::length(result.start - result.point), 0.3f);
    ASSERT_GT(glm::length(result.start - result.point), 0.0f);
    ASSERT_EQ(result.leaving_triangle, none);
  }
  // Near the local origin the offset is a few micrometres.
  TinyScene near;
  near.quad({-5, -5, 1}, {5, -5, 1}, {5, 5, 2}, {-5, 5, 2});
  const auto results = trace(tracer, near.build(), std::vector{ray({1, 1, 9}, {0, 0, -1})});
  EXPECT_LE(glm::length(results[0].start - results[0].point), 5e-6f);
}

GREATX_TRACER_TEST(HardCase, N10_SelfHitSweep) {
  // Convex solids have sizes from a millimetre to ten kilometres, some off the origin. A ray that is
  // reflected off a solid from outside meets nothing.
  RandomStream random(10, 1);
  for (const double radius : {1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0, 1e3, 1e4}) {
    for (const double offset : {0.0, 20.0}) {
      const dvec3 center = offset * radius * dvec3(1.0, -0.7, 0.3);
      TinyScene tiny;
      for (const Triangle& t : sphere(3, radius, center)) tiny.triangle(t[0], t[1], t[2]);
      std::vector<TraceTestRay> rays;
      for (int i = 0; i < 4096; ++i)
        rays.push_back(ray_towards(center + 3.0 * radius * random_direction(random),
                                   center + 0.9 * radius * random_direction(random)));
      int hits = 0, again = 0;
      for (const TraceTestResult& result : trace(tracer, tiny.build(), rays)) {
        hits += result.triangle != none;
        again += result.triangle != none && result.leaving_triangle != none;
      }
      EXPECT_GT(hits, 4000) << radius;
      EXPECT_EQ(again, 0) << "radius " << radius << " m, offset " << offset;
    }
  }
}

GREATX_TRACER_TEST(HardCase, N64_NothingToHit) {
  const auto results = trace(tracer, TinyScene().build(), std::vector{ray({0, 0, 0}, {0, 0, 1})});
  EXPECT_EQ(results[0].triangle, none);
  EXPECT_EQ(results[0].any, 0u);
  EXPECT_EQ(results[0].except_triangle, none);
}

}  // namespace
}  // namespace greatx
