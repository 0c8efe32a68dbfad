// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Meshes as files have them: triangles that lose their area, coordinates far from the origin, scales that
// mirror and stretch, planes that are not quite flat.
#include <algorithm>
#include <cmath>
#include <map>

#include "apps/selftest/catalogue.h"
#include "core/units.h"
#include "rf/search/candidate_search.h"

namespace greatx::apps::selftest {

namespace {

using gpu::Tracer;
using rf::Path;
using shared::ProbeHit;
using shared::ProbeRay;

constexpr uint32_t mesh_rays = 4096;

/// Returns the corners of a triangle as the device has them.
Triangle device_triangle(const scene::Scene& scene, size_t triangle) {
  const auto corner = [&](size_t i) { return dvec3(scene.positions[scene.indices[3 * triangle + i]]); };
  return {corner(0), corner(1), corner(2)};
}

dvec3 doubled_area(const Triangle& t) { return glm::cross(t[1] - t[0], t[2] - t[0]); }

void n04_no_area(const Lab& lab, Rows& rows) {
  // At x = 65536 m a rounding of fp32 is 8 mm, so that the corners of each needle, 1 mm wide and 2 m long,
  // are on one line. Needles of no area in the file never come so far (13).
  const double far = 65536.0;
  constexpr int needles_per_axis = 4;
  Stage stage = lab.stage();
  stage.object("box").box({-8, -8, -8}, {8, 8, 8});
  stage.object("needles");
  std::vector<dvec3> targets;
  for (int i = 0; i < needles_per_axis; ++i)
    for (int j = 0; j < needles_per_axis; ++j)
      for (const double z : {-3.0, 3.0}) {
        const dvec3 at(i - 1.5, 2.0 * j - 4.0, z);
        stage.triangle(at, at + dvec3(1e-3, 0, 0), at + dvec3(0, 2, 0));
        targets.push_back(at);
      }
  const scene::Scene scene = stage.build({far, 0, 0});
  double collapsed = 0.0;
  for (size_t i = 0; i < scene.triangle_count(); ++i)
    collapsed += doubled_area(device_triangle(scene, i)) == dvec3(0.0);
  rows.add("triangles that lose their area in fp32", host, static_cast<double>(targets.size()), collapsed,
           0.0);

  RandomStream random(4, 1);
  std::vector<ProbeRay> rays;
  for (uint32_t i = 0; i < mesh_rays; ++i) {
    const dvec3& needle = targets[i % targets.size()];
    const dvec3 target = dvec3(far, 0, 0) + needle + dvec3(0, 2.0 * (i % 5) / 4.0, 0);  // with both corners
    // Half of the rays are upright, and so go through the needle to the bit.
    const double aside = i % 2 == 0 ? 0.0 : 1.0;
    const dvec3 from(target.x + aside * random.uniform(-1, 1), target.y + aside * random.uniform(-1, 1),
                     0.001 * (lab.given(1.0) - 1.0));
    rays.push_back(ray_towards(from, target));
  }
  for (const Tracer tracer : lab.tracers()) {
    double on_needles = 0.0, on_box = 0.0, worst = 0.0;
    for (const ProbeHit& hit : lab.probe(scene, rays, tracer)) {
      on_needles += hit.primitive == 2;
      on_box += hit.primitive == 1;
      // The box is at 8 m, the needle at 3 m, and the distance is in lengths of the ray to the needle.
      worst = std::isfinite(hit.t) ? std::max(worst, std::abs(3.0 * hit.t - 8.0)) : std::nan("");
    }
    rows.add("rays that hit a triangle without area", precision_of(tracer), 0.0, on_needles, 0.0);
    rows.add("rays that hit the wall behind it", precision_of(tracer), mesh_rays, on_box, 0.0);
    // A distance of 8 m has a rounding of 4.8e-7 m; the corners and the ray have three more each.
    rows.add("largest error of distance, m", precision_of(tracer), 0.0, worst, 4e-6);
  }
}

void n09_start_far_away(const Lab& lab, Rows& rows) {
  // Two mirrors 1 m apart at 5e5 m, where a rounding is 31 mm. A start that is moved by 256 roundings to
  // leave its mirror, as is usual, is moved by 8 m and passes the other one. The product's bound is 0.21 m.
  const dvec3 far(5e5, 4e5, 0);
  Stage stage = lab.stage();
  for (const double x : {0.0, 1.0})
    stage.object("mirror").quad({x, 50, -50}, {x, -50, -50}, {x, -50, 50}, {x, 50, 50});
  const scene::Scene scene = stage.build(far);
  const dvec3 from(0.25, -1, 0), to(0.75, 1, 0.5);

  scene::GpuScene gpu(lab.device(), scene, {});
  rf::CandidateSearchOptions options;
  options.rays = mesh_rays;
  options.max_depth = 3;
  options.moving_bodies = false;
  const std::vector<Pose> bodies(scene.bodies.size());
  const rf::CandidateList list = rf::CandidateSearch(gpu, options).search(bodies, far + from).list;
  rows.add("orders in which rays meet mirrors 1 m apart at 5e5 m", precision_of(lab.device().tracer()), 6.0,
           static_cast<double>(list.size()), 0.0);

  Links links(lab, scene, {.max_depth = 3});
  std::vector<double> found, exact;
  for (const Path& path : links.solve(far + from, far + lab.given(to))) found.push_back(path.length_m);
  for (int n = -3; n <= 3; ++n) {
    const double image = n % 2 == 0 ? n + from.x : n + 1 - from.x;
    exact.push_back(glm::length(dvec3(image - to.x, from.y - to.y, from.z - to.z)));
  }
  std::ranges::sort(found);
  std::ranges::sort(exact);
  rows.add("paths between mirrors 1 m apart at 5e5 m", lab.host_and_tracer(), 7.0,
           static_cast<double>(found.size()), 0.0);
  double worst = found.size() == exact.size() ? 0.0 : std::nan("");
  for (size_t i = 0; i < std::min(found.size(), exact.size()); ++i)
    worst = std::max(worst, std::abs(found[i] - exact[i]));
  // A coordinate of 5e5 m has a rounding of 5.8e-11 m in fp64; three images and the point add some.
  rows.add("largest error of length, m", host, 0.0, worst, 1e-9);
}

void n14_scale(const Lab& lab, Rows& rows) {
  double volume = 0.0, outwards = 0.0, turned = 0.0;
  std::map<Tracer, double> distance;
  const dvec3 scales[] = {{-1, 1, 1}, {1, -2, 1}, {-1, -1, -3}, {-0.5, -4, 1}, {2, 3, 0.5}};
  for (const dvec3& scale : scales) {
    Stage stage = lab.stage();
    stage.box({-1, -1, -1}, {1, 1, 1});
    const scene::Scene scene = stage.build(dvec3(0.0), dvec3(0.0), lab.given(scale));
    // Corners that run counter-clockwise as seen from outside enclose a positive volume.
    double enclosed = 0.0;
    for (size_t i = 0; i < scene.triangle_count(); ++i) {
      const Triangle t = device_triangle(scene, i);
      enclosed += glm::dot(t[0], glm::cross(t[1], t[2])) / 6.0;
    }
    volume = std::max(volume, std::abs(enclosed / std::abs(8.0 * scale.x * scale.y * scale.z) - 1.0));
    for (const scene::Facet& facet : scene.facets)
      outwards += glm::dot(facet.normal, dvec3(scene.facet_triangles[facet.first_triangle].corners[0])) > 0.0;

    RandomStream random(14, 1);
    std::vector<ProbeRay> rays;
    std::vector<double> expected;
    const dvec3 half = glm::abs(scale);
    for (uint32_t i = 0; i < mesh_rays / 4; ++i) {
      const vec3 along(random_direction(random));
      rays.push_back({vec3(0.0f), along});
      expected.push_back(
          std::min({half.x / std::abs(along.x), half.y / std::abs(along.y), half.z / std::abs(along.z)}));
    }
    for (const Tracer tracer : lab.tracers()) {
      const std::vector<ProbeHit> hits = lab.probe(scene, rays, tracer);
      for (size_t i = 0; i < hits.size(); ++i)
        distance[tracer] = std::max(distance[tracer], std::abs(hits[i].t - expected[i]));
    }

    // A slope with the normal of its plane, as files with smooth normals have it. The plane x = y becomes
    // x/s_x = y/s_y, whose normal is (-1/s_x, 1/s_y, 0).
    Stage slope = lab.stage();
    slope.object("slope").triangle({0, 0, 0}, {0, 0, 1}, {1, 1, 0});
    slope.object("smooth").normal(glm::normalize(dvec3(-1, 1, 0))).triangle({0, 0, 0}, {0, 0, 1}, {1, 1, 0});
    const scene::Scene tilted = slope.build(dvec3(0.0), dvec3(0.0), scale);
    const dvec3 plane = glm::normalize(dvec3(-1.0 / scale.x, 1.0 / scale.y, 0.0));
    for (const vec3& normal : tilted.normals) turned = std::max(turned, glm::length(dvec3(normal) - plane));
  }
  rows.add("largest relative error of the volume of a scaled box", host, 0.0, volume, 1e-12);
  rows.add("faces of scaled boxes that face outwards", host, 6.0 * std::size(scales), outwards, 0.0);
  rows.add("largest error of a normal of a scaled slope", host, 0.0, turned, 1e-6);
  for (const auto& [tracer, worst] : distance)
    rows.add("largest error of distance in a scaled box, m", precision_of(tracer), 0.0, worst, 2e-6);
}

/// Adds a plate of `cells` x `cells` cells, whose corners are at origin + i u + j v + height(i, j) n.
template <typename Height>
void add_plate(Stage& stage, const dvec3& origin, const dvec3& u, const dvec3& v, int cells,
               const Height& height) {
  const dvec3 normal = glm::normalize(glm::cross(u, v));
  const auto at = [&](int i, int j) {
    return origin + static_cast<double>(i) * u + static_cast<double>(j) * v + height(i, j) * normal;
  };
  for (int i = 0; i < cells; ++i)
    for (int j = 0; j < cells; ++j) stage.quad(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
}

void n22_edges_of_bins(const Lab& lab, Rows& rows) {
  // Heights on the edge of every decimal grid, with a jitter that crosses it and is below the tolerance.
  constexpr double heights[] = {0.0, 0.5e-4, 1e-4, 0.5e-3, 0.5, 1.0, 12.345}, jitter = 4e-5;
  double facets = 0.0, reflections = 0.0, worst = 0.0;
  for (const double height : heights) {
    Stage stage = lab.stage();
    add_plate(stage, {-12, -12, height}, {4, 0, 0}, {0, 4, 0}, 6,
              [](int i, int j) { return (i + j) % 2 == 0 ? jitter : -jitter; });
    const scene::Scene scene = stage.build();
    facets += static_cast<double>(scene.facets.size());
    // The reflection is in the origin, a corner of four cells.
    Links links(lab, scene, {});
    const dvec3 from(-3, -5, 2), to(3, 5, 2), up(0, 0, height);
    for (const Path& path : links.solve(from + up, lab.given(to) + up)) {
      if (path.interactions.size() != 1) continue;
      ++reflections;
      worst = std::max(worst, std::abs(path.length_m - std::hypot(6.0, 10.0, 4.0)));
    }
  }
  rows.add("facets of planes at the edges of bins", host, std::size(heights), facets, 0.0);
  rows.add("reflections off them", lab.host_and_tracer(), std::size(heights), reflections, 0.0);
  // The facet's plane is within the jitter of its height; the length changes by 2 * jitter * cos(theta).
  rows.add("largest error of length, m", host, 0.0, worst, jitter);

  double tilted = 0.0;
  constexpr int steps = 5;
  for (int step = -steps; step <= steps; ++step) {
    const double angle = pi / 4 + step * 1e-5, c = std::cos(angle), s = std::sin(angle);
    Stage stage = lab.stage();
    add_plate(stage, {0, 0, 0}, {c * c, s * c, -s}, {-s, c, 0}, 4, [](int, int) { return 0.0; });
    tilted += static_cast<double>(stage.build().facets.size());
  }
  rows.add("facets of planes with normals at the edges of bins", host, 2.0 * steps + 1.0, tilted, 0.0);
}

constexpr Case list_of_mesh_cases[] = {
    {4, "triangles that lose their area", n04_no_area},
    {9, "start of a ray at 5e5 m", n09_start_far_away},
    {14, "stretching and mirroring scales", n14_scale},
    {22, "planes at the edges of bins", n22_edges_of_bins},
};

}  // namespace

std::span<const Case> mesh_cases() { return list_of_mesh_cases; }

}  // namespace greatx::apps::selftest
