// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/check/inside_rays.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/parallel.h"
#include "core/random.h"
#include "core/units.h"

namespace greatx::scene::check {
namespace {

constexpr FaultList::Kind ray_leak{FaultSeverity::fault, "ray_leak",
                                   "solids that rays leave without meeting a surface", "of the rays"};
constexpr FaultList::Kind overlaps_itself{FaultSeverity::doubt, "overlaps_itself",
                                          "solids that reach into themselves", "of the rays"};
constexpr uint32_t points_of_a_part = 8;

struct Hit {
  double t = 0.0;
  uint32_t triangle = nothing;
};

/// Finds the first of some triangles on a ray.
class PartTracer {
 public:
  PartTracer(const Soup& soup, const Topology& topology, const Closing& closing, const BoxTree& all,
             uint32_t part)
      : soup_(soup), topology_(topology), closing_(closing), all_(all), part_(part) {
    std::vector<Bounds> boxes;
    own_ = topology.triangles_of(topology.parts[part]);
    boxes.reserve(own_.size());
    for (const uint32_t t : own_)
      for (Bounds& box = boxes.emplace_back(); const dvec3& corner : soup.triangles[t].corners)
        box.add(corner);
    tree_ = BoxTree(boxes);
  }

  std::optional<Hit> first(const dvec3& origin, const dvec3& direction, double beyond) const {
    Hit hit{1e300, nothing};
    // Boxes grow a little, since a flat one may lie at the edge of what fp64 tells apart.
    const auto outside = [&](const Bounds& box) {
      return !ray_meets(box, origin, direction, hit.t, 1e-9 * glm::length(box.max - origin));
    };
    const auto try_triangle = [&](uint32_t t) {
      const auto at = line_meets_triangle(origin, direction, soup_.triangles[t]);
      if (at && *at > beyond && *at < hit.t) hit = {*at, t};
    };
    tree_.visit_until(outside, [&](uint32_t i) {
      try_triangle(own_[i]);
      return false;
    });
    // Only a part with openings needs the others of its group, which may be many.
    if (!topology_.parts[part_].loops.empty())
      all_.visit_until(outside, [&](uint32_t t) {
        if (closing_.group[topology_.part[t]] == closing_.group[part_]) try_triangle(t);
        return false;
      });
    return hit.triangle == nothing ? std::nullopt : std::optional(hit);
  }

 private:
  const Soup& soup_;
  const Topology& topology_;
  const Closing& closing_;
  const BoxTree& all_;
  uint32_t part_;
  std::span<const uint32_t> own_;
  BoxTree tree_;
};

struct PartRays {
  uint64_t rays = 0, out = 0, on_front = 0;
  dvec3 out_from{0.0}, front_at{0.0};  ///< the first of each
};

class PartCaster {
 public:
  PartCaster(const Soup& soup, const Topology& topology, const PartTracer& tracer, uint32_t part,
             const CheckOptions& options)
      : soup_(soup),
        topology_(topology),
        tracer_(tracer),
        part_(part),
        rays_of_a_point_(std::max(1u, options.rays / points_of_a_part)),
        random_(options.seed, 9, part) {
    double sum = 0.0;
    for (const uint32_t t : topology.triangles_of(topology.parts[part]))
      areas_.push_back(sum += soup.areas[t]);
  }

  PartRays cast() {
    for (uint32_t i = 0; i < points_of_a_part; ++i)
      if (const auto point = inside_point())
        for (uint32_t j = 0; j < rays_of_a_point_; ++j) cast_from(*point);
    return result_;
  }

 private:
  bool turned(uint32_t t) const { return topology_.turned[t] != 0; }
  dvec3 outwards(uint32_t t) const { return turned(t) ? -soup_.normals[t] : soup_.normals[t]; }

  /// Returns a point halfway between the surface and the next one behind it. Where there is none, the ray
  /// inwards has leaked.
  std::optional<dvec3> inside_point() {
    const std::span<const uint32_t> triangles = topology_.triangles_of(topology_.parts[part_]);
    const double wanted = random_.uniform() * areas_.back();
    const auto found = std::ranges::upper_bound(areas_, wanted);
    const uint32_t t =
        triangles[std::min<size_t>(static_cast<size_t>(found - areas_.begin()), triangles.size() - 1)];
    // Points uniform in a triangle (Osada et al., ACM Transactions on Graphics 21(4), 2002, eq. 1).
    const double u = std::sqrt(random_.uniform()), v = random_.uniform();
    const dvec3* c = soup_.triangles[t].corners;
    const dvec3 start = (1.0 - u) * c[0] + u * (1.0 - v) * c[1] + u * v * c[2];
    const dvec3 inwards = -outwards(t);
    const double size = glm::length(topology_.parts[part_].bounds.size());
    const auto hit = tracer_.first(start, inwards, 1e-9 * size);
    if (!hit) {
      ++result_.rays;
      leak(start);
      return std::nullopt;
    }
    return start + 0.5 * hit->t * inwards;
  }

  void cast_from(const dvec3& point) {
    const double z = random_.uniform(-1.0, 1.0), azimuth = random_.uniform(0.0, 2.0 * pi);
    const double r = std::sqrt(1.0 - z * z);
    const dvec3 direction(r * std::cos(azimuth), r * std::sin(azimuth), z);
    ++result_.rays;
    const auto hit = tracer_.first(point, direction, 0.0);
    if (!hit) {
      leak(point);
      return;
    }
    if (topology_.part[hit->triangle] != part_) return;  // a closing surface may be seen from either side
    if (glm::dot(outwards(hit->triangle), direction) >= 0.0) return;
    if (result_.on_front++ == 0) result_.front_at = point + hit->t * direction;
  }

  void leak(const dvec3& from) {
    if (result_.out++ == 0) result_.out_from = from;
  }

  const Soup& soup_;
  const Topology& topology_;
  const PartTracer& tracer_;
  uint32_t part_, rays_of_a_point_;
  RandomStream random_;
  std::vector<double> areas_;  ///< sums
  PartRays result_;
};

}  // namespace

RayCount find_leaks_by_rays(const Soup& soup, const Topology& topology, const Closing& closing,
                            const SoupTree& tree, const CheckOptions& options, FaultList& faults) {
  if (options.rays == 0) return {};
  std::vector<PartRays> results(topology.parts.size());
  parallel_for(topology.parts.size(), options.threads, [&](size_t p) {
    const Part& part = topology.parts[p];
    if (part.kind == PartKind::sheet || !part.one_sided || part.hidden_opening) return;
    const PartTracer tracer(soup, topology, closing, tree.boxes(), static_cast<uint32_t>(p));
    results[p] = PartCaster(soup, topology, tracer, static_cast<uint32_t>(p), options).cast();
  });
  RayCount count;
  for (uint32_t p = 0; p < results.size(); ++p) {
    const PartRays& rays = results[p];
    const Part& part = topology.parts[p];
    count.rays += rays.rays, count.out += rays.out;
    const uint32_t material = soup.material[topology.part_triangles[part.first]];
    const auto share = [&](uint64_t of) { return static_cast<double>(of) / static_cast<double>(rays.rays); };
    // No ray leaves a part without open edges from a point that it encloses. The point was outside: behind a
    // surface of the part that is folded through another.
    const bool leaks = rays.out > 0 && !part.loops.empty();
    if (leaks) faults.add(ray_leak, {rays.out_from, part.object, nothing, material, share(rays.out)});
    const uint64_t odd = rays.on_front + (leaks ? 0 : rays.out);
    if (odd > 0)
      faults.add(overlaps_itself, {rays.on_front > 0 ? rays.front_at : rays.out_from, part.object, nothing,
                                   material, share(odd)});
  }
  return count;
}

}  // namespace greatx::scene::check
