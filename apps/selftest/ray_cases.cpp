// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Rays against triangles. The driver's ray queries are judged by the rule that the product uses where nothing
// may slip through (rf/paths/crossings.h), and in directions of no particular kind, as a LiDAR and the search
// use them. The tree is judged by rays that aim at edges and corners.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>

#include "apps/selftest/catalogue.h"
#include "core/units.h"

namespace greatx::apps::selftest {

namespace {

using gpu::Tracer;
using shared::ProbeHit;
using shared::ProbeRay;

constexpr uint32_t ray_count = 4096;

double hits_of(std::span<const ProbeHit> hits) {
  return static_cast<double>(
      std::ranges::count_if(hits, [](const ProbeHit& hit) { return hit.primitive != 0; }));
}
double blocked_of(std::span<const rf::Crossing> crossings) {
  return static_cast<double>(
      std::ranges::count_if(crossings, [](const rf::Crossing& crossing) { return crossing.blocked; }));
}

/// Returns a ray from `from` to `target` and the segment that goes on as far behind the target again.
struct Aimed {
  std::vector<ProbeRay> rays;
  std::vector<rf::Segment> segments;
  void add(const dvec3& from, const dvec3& target) {
    rays.push_back(ray_towards(from, target));
    segments.push_back({.a = from, .b = target + (target - from), .walls = 3});
  }
};

/// Adds the rows of a surface that every aimed ray must meet, and meet once.
void add_closed(const Lab& lab, Rows& rows, const Stage& opaque, const Stage& thin, const Aimed& aimed) {
  const double count = static_cast<double>(aimed.rays.size());
  const scene::Scene solid = opaque.build(), sheet = thin.build();
  const auto once = [](const rf::Crossing& c) { return !c.blocked && c.walls.size() == 1; };
  for (const Tracer tracer : lab.tracers()) {
    rows.add("segments blocked", precision_of(tracer), count,
             blocked_of(lab.crossings(solid, aimed.segments, tracer)), 0.0);
    const std::vector<rf::Crossing> passed = lab.crossings(sheet, aimed.segments, tracer, true);
    rows.add("thin walls passed once", precision_of(tracer), count,
             static_cast<double>(std::ranges::count_if(passed, once)), 0.0);
  }
  rows.add("rays that hit", precision_of(Tracer::tree), count,
           hits_of(lab.probe(solid, aimed.rays, Tracer::tree)), 0.0);
}

/// Makes the same stage twice: of an opaque material, and of a thin wall that lets waves through.
template <typename Build>
std::pair<Stage, Stage> opaque_and_thin(const Lab& lab, const Build& build) {
  Stage opaque = lab.stage(), thin = lab.stage();
  build(opaque, 0u);
  build(thin, thin.material(3.0, 0.01, 0.1));
  return {std::move(opaque), std::move(thin)};
}

/// One roof of two triangles that share an edge, in one object or in two.
void shared_edge(const Lab& lab, Rows& rows, bool two_objects, uint32_t seed) {
  const dvec3 a(-3, 0.25, 0.5), b(4, -0.5, 1.0);
  const auto build = [&](Stage& stage, uint32_t material) {
    stage.object("left", material).triangle(a, b, {1, 5, -2});
    if (two_objects) stage.object("right", material);
    stage.triangle(b, a, {0, -4, -1});
  };
  const auto [opaque, thin] = opaque_and_thin(lab, build);
  RandomStream random(seed, 1);
  Aimed aimed;
  for (uint32_t i = 0; i < ray_count; ++i)
    aimed.add({random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(5, 40)},
              dvec3(vec3(a)) + random.uniform(0.02, 0.98) * (b - a));
  add_closed(lab, rows, opaque, thin, aimed);
}
void n01_shared_edge(const Lab& lab, Rows& rows) { shared_edge(lab, rows, false, 1); }
void n03_two_objects(const Lab& lab, Rows& rows) { shared_edge(lab, rows, true, 3); }

void n02_fan(const Lab& lab, Rows& rows) {
  const dvec3 tip(0.25, -0.125, 1.75);
  const auto build = [&](Stage& stage, uint32_t material) {
    constexpr int blades = 9;
    const auto rim = [](int i) {
      return dvec3(4 * std::cos(2 * pi * (i % blades) / blades), 4 * std::sin(2 * pi * (i % blades) / blades),
                   0);
    };
    stage.object("fan", material);
    for (int i = 0; i < blades; ++i) stage.triangle(tip, rim(i), rim(i + 1));
  };
  const auto [opaque, thin] = opaque_and_thin(lab, build);
  RandomStream random(2, 1);
  Aimed aimed;
  for (uint32_t i = 0; i < ray_count; ++i)
    aimed.add({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(5, 40)}, tip);
  add_closed(lab, rows, opaque, thin, aimed);
}

void n05_slivers(const Lab& lab, Rows& rows) {
  Stage stage = lab.stage();
  stage.quad({-1, -1, -1}, {-1, 1, -1}, {1, 1, -1}, {1, -1, -1})
      .quad({-1, -1, -1}, {1, -1, -1}, {1, -1, 1}, {-1, -1, 1})
      .quad({-1, 1, -1}, {-1, 1, 1}, {1, 1, 1}, {1, 1, -1})
      .quad({-1, -1, -1}, {-1, -1, 1}, {-1, 1, 1}, {-1, 1, -1})
      .quad({1, -1, -1}, {1, 1, -1}, {1, 1, 1}, {1, -1, 1});
  std::vector<double> cuts;
  for (int i = 0; i < 20; ++i) cuts.insert(cuts.end(), {-1 + 0.1 * i, -1 + 0.1 * i + 1e-4});
  cuts.push_back(1.0);
  for (size_t i = 0; i + 1 < cuts.size(); ++i)
    stage.quad({cuts[i], -1, 1}, {cuts[i + 1], -1, 1}, {cuts[i + 1], 1, 1}, {cuts[i], 1, 1});
  const scene::Scene scene = stage.build();
  RandomStream random(5, 1);
  Aimed aimed;
  std::vector<ProbeRay> general;
  for (uint32_t i = 0; i < ray_count; ++i) {
    const dvec3 from(random.uniform(-0.9, 0.9), random.uniform(-0.9, 0.9), random.uniform(-0.9, 0.9));
    const double cut = cuts[random.below(static_cast<uint32_t>(cuts.size()))];
    aimed.add(from, {cut + (i % 2) * random.uniform(0, 1e-4), random.uniform(-0.999, 0.999), 1});
    general.push_back({vec3(from), vec3(random_direction(random))});
  }
  std::vector<ProbeRay> all_rays = general;
  all_rays.insert(all_rays.end(), aimed.rays.begin(), aimed.rays.end());
  for (const Tracer tracer : lab.tracers()) {
    rows.add("segments blocked", precision_of(tracer), ray_count,
             blocked_of(lab.crossings(scene, aimed.segments, tracer)), 0.0);
    const std::vector<ProbeRay>& rays = tracer == Tracer::tree ? all_rays : general;
    rows.add("rays that hit", precision_of(tracer), static_cast<double>(rays.size()),
             hits_of(lab.probe(scene, rays, tracer)), 0.0);
  }
}

void n06_in_the_plane(const Lab& lab, Rows& rows) {
  Stage stage = lab.stage();
  const dvec3 half = lab.given(dvec3(1.0));
  stage.object("box").box(-half, half);
  stage.object("sheet").quad({-0.5, -0.5, 0}, {0.5, -0.5, 0}, {0.5, 0.5, 0}, {-0.5, 0.5, 0});
  const scene::Scene scene = stage.build();
  RandomStream random(6, 1);
  std::vector<ProbeRay> rays;
  std::vector<double> expected;
  for (uint32_t i = 0; i < ray_count; ++i) {
    const double azimuth = random.uniform(0, 2 * pi);
    const vec3 from(random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4), 0);
    const vec3 along(std::cos(azimuth), std::sin(azimuth), 0);
    rays.push_back({from, along});
    const auto exit = [](double at, double speed) { return (std::copysign(1.0, speed) - at) / speed; };
    expected.push_back(std::min(exit(from.x, along.x), exit(from.y, along.y)));
  }
  for (const Tracer tracer : lab.tracers()) {
    double worst = 0.0;
    const std::vector<ProbeHit> hits = lab.probe(scene, rays, tracer);
    for (size_t i = 0; i < hits.size(); ++i) worst = std::max(worst, std::abs(hits[i].t - expected[i]));
    // A distance of up to 2 m has a rounding of 1.2e-7 m; the corners and the ray have three more each.
    rows.add("largest error of distance, m", precision_of(tracer), 0.0, worst, 1e-6);
  }
}

void n07_utm(const Lab& lab, Rows& rows) {
  const dvec3 utm(500000.0, 5411000.0, 35.0);
  RandomStream random(7, 1);
  Stage stage = lab.stage();
  for (int i = 0; i < 200; ++i) {
    const auto point = [&](double reach) {
      const auto on_grid = [&] { return std::round(random.uniform(-reach, reach) * 0x1p10) * 0x1p-10; };
      const double x = on_grid(), y = on_grid();
      return dvec3(x, y, on_grid());
    };
    const dvec3 a = point(60.0), b = a + point(9.0);
    stage.triangle(a, b, a + point(9.0));
  }
  std::vector<ProbeRay> rays, shifted;
  for (uint32_t i = 0; i < ray_count; ++i) {
    const dvec3 from(random.uniform(-50, 50), 1.0, 2.0), along = random_direction(random);
    rays.push_back({vec3(from), vec3(along)});
    shifted.push_back({vec3(lab.given(from)), vec3(along)});
  }
  const scene::Scene here = stage.build(), there = stage.build(utm, utm);
  for (const Tracer tracer : lab.tracers()) {
    const std::vector<ProbeHit> near = lab.probe(here, rays, tracer), far = lab.probe(there, shifted, tracer);
    double differ = 0.0;
    for (size_t i = 0; i < near.size(); ++i) differ += std::memcmp(&near[i], &far[i], sizeof(ProbeHit)) != 0;
    rows.add("answers that differ at UTM coordinates", precision_of(tracer), 0.0, differ, 0.0);
  }
}

void n08_tiny_part(const Lab& lab, Rows& rows) {
  Stage stage = lab.stage();
  const dvec3 part(3, 4, 1);
  stage.object("tile").quad({-5000, -5000, 0}, {5000, -5000, 0}, {5000, 5000, 0}, {-5000, 5000, 0});
  stage.object("part").triangle(part, part + dvec3(1e-4, 0, 0), part + dvec3(0, 1e-4, 0));
  const scene::Scene scene = stage.build();
  RandomStream random(8, 1);
  std::vector<ProbeRay> rays;
  for (uint32_t i = 0; i < ray_count; ++i) {
    const double u = random.uniform(0.1, 0.8), v = random.uniform(0.1, 0.9 - u);
    const dvec3 target = part + 1e-4 * dvec3(u, v, 0);
    rays.push_back(ray_towards(target + dvec3(random.uniform(-2, 2), random.uniform(-2, 2), 4), target));
  }
  for (const Tracer tracer : lab.tracers()) {
    double part_hits = 0.0;
    for (const ProbeHit& hit : lab.probe(scene, rays, tracer)) part_hits += hit.primitive == 2;
    rows.add("rays that hit 0.1 mm beside 10 km", precision_of(tracer), ray_count, part_hits, 0.0);
  }
}

/// Adds a sphere of 128 triangles: an octahedron subdivided twice.
void add_sphere(Stage& stage, double radius) {
  std::vector<Triangle> triangles;
  for (const double z : {1.0, -1.0})
    for (int i = 0; i < 4; ++i) {
      const dvec3 a(std::round(std::cos(0.5 * pi * i)), std::round(std::sin(0.5 * pi * i)), 0),
          b(-a.y, a.x, 0);
      triangles.push_back(z > 0 ? Triangle{a, b, dvec3(0, 0, z)} : Triangle{b, a, dvec3(0, 0, z)});
    }
  for (int level = 0; level < 2; ++level) {
    std::vector<Triangle> finer;
    for (const Triangle& t : triangles) {
      const dvec3 ab = glm::normalize(t[0] + t[1]), bc = glm::normalize(t[1] + t[2]),
                  ca = glm::normalize(t[2] + t[0]);
      finer.insert(finer.end(), {{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}});
    }
    triangles = finer;
  }
  for (const Triangle& t : triangles) stage.triangle(radius * t[0], radius * t[1], radius * t[2]);
}

void n10_self_hits(const Lab& lab, Rows& rows) {
  std::map<Tracer, double> blocked, held;
  double inside = 0.0;
  for (const double radius : {1e-2, 1.0, 100.0, 1e4}) {
    Stage stage = lab.stage();
    add_sphere(stage, radius);
    const scene::Scene scene = stage.build();
    const rf::FacetWorld world(scene);
    RandomStream random(10, static_cast<uint32_t>(radius * 100));
    std::vector<rf::Segment> outwards, through;
    for (uint32_t facet = 0; facet < world.facet_count(); ++facet) {
      const rf::PosedFacet& f = world.facet(facet);
      through.push_back({.a = dvec3(0.0), .b = 2.0 * f.centroid});
      for (int i = 0; i < 8; ++i) {
        dvec3 along = random_direction(random);
        if (glm::dot(along, f.normal) < 0.0) along = -along;
        outwards.push_back({.a = f.centroid, .b = f.centroid + 3.0 * radius * along, .facet_a = facet});
      }
    }
    inside += 128.0;
    for (const Tracer tracer : lab.tracers()) {
      blocked[tracer] += blocked_of(lab.crossings(scene, outwards, tracer));
      held[tracer] += blocked_of(lab.crossings(scene, through, tracer));
    }
  }
  for (const Tracer tracer : lab.tracers()) {
    rows.add("rays off a convex solid that hit it, of 1e-2 to 1e4 m", precision_of(tracer), 0.0,
             blocked[tracer], 0.0);
    rows.add("segments out of the solid that are blocked", precision_of(tracer), inside, held[tracer], 0.0);
  }
}

void n11_on_a_surface(const Lab& lab, Rows& rows) {
  Stage stage = lab.stage();
  stage.quad({-50, -50, 2}, {50, -50, 2}, {50, 50, 2}, {-50, 50, 2});
  const scene::Scene scene = stage.build();
  RandomStream random(11, 1);
  std::vector<rf::Segment> on, in_front;
  for (uint32_t i = 0; i < ray_count; ++i) {
    const dvec3 at(random.uniform(-40, 40), random.uniform(-40, 40), 2.0);
    const dvec3 eye = at + dvec3(random.uniform(-5, 5), random.uniform(-5, 5), i % 2 ? 9.0 : -9.0);
    on.push_back(
        {.a = lab.given(eye), .b = at + dvec3(0, 0, 10.0 * (lab.given(1.0) - 1.0) * (i % 2 ? -1 : 1))});
    // Half of the eyes are in front of the surface, like the point.
    in_front.push_back({.a = eye, .b = at + dvec3(0, 0, 5e-3)});
  }
  for (const Tracer tracer : lab.tracers()) {
    rows.add("points on a surface that a side does not see", precision_of(tracer), 0.0,
             blocked_of(lab.crossings(scene, on, tracer)), 0.0);
    rows.add("points 5 mm in front that only one side sees", precision_of(tracer), 0.5 * ray_count,
             blocked_of(lab.crossings(scene, in_front, tracer)), 0.0);
  }
}

void n64_nothing_to_hit(const Lab& lab, Rows& rows) {
  Stage stage = lab.stage();
  if (lab.given(1.0) != 1.0) stage.box({-9, -9, 3}, {9, 9, 4});
  stage.object("empty");
  const scene::Scene scene = stage.build();
  const std::vector<ProbeRay> rays(64, {vec3(0.0f), vec3(0, 0, 1)});
  const std::vector<rf::Segment> segments(64, {.a = dvec3(0.0), .b = dvec3(0, 0, 9)});
  for (const Tracer tracer : lab.tracers()) {
    rows.add("hits in an empty scene", precision_of(tracer), 0.0, hits_of(lab.probe(scene, rays, tracer)),
             0.0);
    rows.add("segments blocked in an empty scene", precision_of(tracer), 0.0,
             blocked_of(lab.crossings(scene, segments, tracer)), 0.0);
  }
}

constexpr Case list_of_ray_cases[] = {
    {1, "shared edge of two triangles", n01_shared_edge},
    {2, "vertex of a closed fan", n02_fan},
    {3, "edge shared by two objects", n03_two_objects},
    {5, "slivers of 0.1 mm in a closed mesh", n05_slivers},
    {6, "rays in the plane of a triangle", n06_in_the_plane},
    {7, "scene at UTM coordinates", n07_utm},
    {8, "part of 0.1 mm beside a tile of 10 km", n08_tiny_part},
    {10, "self-hits", n10_self_hits},
    {11, "end exactly on a surface", n11_on_a_surface},
    {64, "nothing to hit", n64_nothing_to_hit},
};

}  // namespace

std::span<const Case> ray_cases() { return list_of_ray_cases; }

}  // namespace greatx::apps::selftest
