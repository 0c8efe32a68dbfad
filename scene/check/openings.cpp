// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/check/openings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>
#include <tuple>

#include "core/parallel.h"
#include "core/random.h"
#include "core/units.h"
#include "scene/material/lossless.h"

namespace greatx::scene::check {
namespace {

constexpr FaultList::Kind hole{FaultSeverity::fault, "hole", "holes in solids", "m"};
constexpr FaultList::Kind hidden_opening{FaultSeverity::doubt, "hidden_opening",
                                         "openings of solids behind or beneath another surface", "m"};
constexpr FaultList::Kind open_sheet{FaultSeverity::doubt, "open_sheet", "borders of open sheets", "m"};
constexpr FaultList::Kind ground_hole{FaultSeverity::doubt, "ground_hole", "holes and cracks in the ground",
                                      "m"};
constexpr FaultList::Kind t_junction{FaultSeverity::doubt, "t_junction",
                                     "corners on the inside of another triangle's edge", ""};

struct Interval {
  double from = 0.0, to = 1.0;
};

/// Cuts the interval to where low <= a + t (b - a) holds.
void keep_above(double a, double b, double low, Interval& interval) {
  const double slope = b - a;
  if (slope == 0.0) {
    if (a < low) interval.to = interval.from - 1.0;
    return;
  }
  const double t = (low - a) / slope;
  if (slope > 0.0)
    interval.from = std::max(interval.from, t);
  else
    interval.to = std::min(interval.to, t);
}

/// Returns the part of the edge that lies in the slab of a triangle.
std::optional<Interval> in_slab(const OpenEdge& edge, const FacetTriangle& triangle, const dvec3& normal,
                                double tolerance) {
  Interval interval;
  const dvec3* c = triangle.corners;
  const double a = glm::dot(edge.a - c[0], normal), b = glm::dot(edge.b - c[0], normal);
  keep_above(a, b, -tolerance, interval);
  keep_above(-a, -b, -tolerance, interval);
  for (int i = 0; i < 3 && interval.from < interval.to; ++i) {
    const dvec3 side = c[(i + 1) % 3] - c[i];
    const dvec3 inwards = glm::normalize(glm::cross(normal, side));
    keep_above(glm::dot(edge.a - c[i], inwards), glm::dot(edge.b - c[i], inwards), -tolerance, interval);
  }
  if (!(interval.from < interval.to)) return std::nullopt;
  return interval;
}

double uncovered(std::vector<Interval>& intervals) {
  std::ranges::sort(intervals, {}, &Interval::from);
  double open = 0.0, reached = 0.0;
  for (const Interval& interval : intervals) {
    if (interval.from > reached) open += interval.from - reached;
    reached = std::max(reached, interval.to);
  }
  return open + std::max(0.0, 1.0 - reached);
}

/// What the surfaces around one open edge do to it.
struct Closed {
  double open_m = 0.0;
  bool crowd = false;            ///< not all neighbours were looked at
  std::vector<uint32_t> parts;   ///< whose triangles lie along the edge
  std::vector<dvec3> junctions;  ///< corners on the inside of the edge
};

Closed close_edge(const OpenEdge& edge, const Soup& soup, const Topology& topology, const SoupTree& tree,
                  double weld_m) {
  Closed result;
  const dvec3 along = edge.b - edge.a;
  const double length = glm::length(along);
  const double tolerance = std::min(weld_m, 0.1 * length);
  std::vector<Interval> intervals;
  size_t seen = 0;
  const auto look_at = [&](uint32_t t) {
    if (t == edge.triangle) return;
    const auto interval = in_slab(edge, soup.triangles[t], soup.normals[t], tolerance);
    if (!interval) return;
    intervals.push_back(*interval);
    // Triangles that touch an end of the edge alone do not close it.
    if ((interval->to - interval->from) * length > 4.0 * tolerance) result.parts.push_back(topology.part[t]);
    for (const dvec3& corner : soup.triangles[t].corners) {
      const double t_corner = glm::dot(corner - edge.a, along) / (length * length);
      const double from_end = std::min(t_corner, 1.0 - t_corner) * length;
      const bool on_edge = glm::distance(corner, edge.a + t_corner * along) <= tolerance;
      if (on_edge && from_end > 2.0 * tolerance) result.junctions.push_back(corner);
    }
  };
  result.crowd = tree.boxes().visit_until(
      [&](const Bounds& box) { return !ray_meets(box, edge.a, along, 1.0, tolerance); },
      [&](uint32_t t) {
        if (ray_meets(tree.box(t), edge.a, along, 1.0, tolerance)) look_at(t), ++seen;
        return seen > most_neighbors;
      });
  // Surfaces that touch the ends alone leave the whole edge open.
  const double open = result.parts.empty() ? length : uncovered(intervals) * length;
  result.open_m = open > std::max(2.0 * tolerance, 1e-9 * length) ? open : 0.0;
  std::ranges::sort(result.parts);
  result.parts.erase(std::unique(result.parts.begin(), result.parts.end()), result.parts.end());
  return result;
}

/// Adds each junction once: edges of several triangles end in one corner.
class Junctions {
 public:
  Junctions(double tolerance, const Soup& soup, FaultList& faults)
      : tolerance_(tolerance), soup_(soup), faults_(faults) {}

  void add(const dvec3& corner, uint32_t triangle) {
    std::array<int64_t, 3> cell;
    for (size_t axis = 0; axis < 3; ++axis) cell[axis] = cell_of(corner[static_cast<int>(axis)], tolerance_);
    if (is_known(corner, cell)) return;
    kept_[cell].push_back(corner);
    faults_.add(t_junction, {corner, soup_.object[triangle], nothing, soup_.material[triangle], 0.0});
  }

 private:
  bool is_known(const dvec3& corner, const std::array<int64_t, 3>& cell) const {
    for (int i = 0; i < 27; ++i)
      if (const auto found = kept_.find({cell[0] + i % 3 - 1, cell[1] + i / 3 % 3 - 1, cell[2] + i / 9 - 1});
          found != kept_.end())
        for (const dvec3& other : found->second)
          if (glm::distance(other, corner) <= tolerance_) return true;
    return false;
  }

  double tolerance_;
  const Soup& soup_;
  FaultList& faults_;
  /// Corners by cells as wide as the tolerance: those near a corner are in its cell or in one beside it.
  std::map<std::array<int64_t, 3>, std::vector<dvec3>> kept_;
};

bool lies_on_ground(SemanticClass semantic_class) {
  return semantic_class == SemanticClass::ground || semantic_class == SemanticClass::road ||
         semantic_class == SemanticClass::pavement || semantic_class == SemanticClass::lane_marking ||
         semantic_class == SemanticClass::water;
}

const Material& material_of(const Soup& soup, const Topology& topology, const Part& part) {
  return soup.model->materials[soup.material[topology.part_triangles[part.first]]];
}

/// Returns whether the part must enclose a volume for radio.
bool is_foliage(const Soup& soup, const Topology& topology, const Part& part) {
  const Material& material = material_of(soup, topology, part);
  return material.radio && material.radio->foliage && !is_lossless(material);
}

/// Returns whether another surface that faces up is above the point, no higher than the top of the part.
bool is_beneath(const dvec3& point, const Part& part, const Soup& soup, const Topology& topology,
                const SoupTree& tree, uint32_t part_index) {
  const double height = part.bounds.max.z - point.z;
  if (!(height > 0.0)) return false;
  std::vector<uint32_t> near;
  tree.near_segment(point, point + dvec3(0.0, 0.0, height), 0.0, near);
  return std::ranges::any_of(near, [&](uint32_t t) {
    if (topology.part[t] == part_index || std::abs(soup.normals[t].z) < 0.5) return false;
    const auto at = line_meets_triangle(point, dvec3(0.0, 0.0, 1.0), soup.triangles[t]);
    return at && *at > 0.0 && *at <= height;
  });
}

/// Returns the first triangle on a ray, or `nothing`.
uint32_t first_on_ray(const dvec3& origin, const dvec3& direction, double beyond, const Soup& soup,
                      const SoupTree& tree) {
  double nearest = 1e300;
  uint32_t first = nothing;
  tree.boxes().visit_until(
      [&](const Bounds& box) {
        return !ray_meets(box, origin, direction, nearest, 1e-9 * glm::length(box.max - origin));
      },
      [&](uint32_t t) {
        const auto at = line_meets_triangle(origin, direction, soup.triangles[t]);
        if (at && *at > beyond && *at < nearest) nearest = *at, first = t;
        return false;
      });
  return first;
}

/// The edges of one loop that stay open, those that hang together.
struct Opening {
  std::vector<uint32_t> edges;
  double length_m = 0.0;
};

/// Returns whether most rays out of an opening first meet the back of a surface.
bool leads_into_another(const Opening& opening, const Soup& soup, const Topology& topology,
                        const SoupTree& tree, uint64_t seed) {
  constexpr uint32_t rays = 128;
  dvec3 center{0.0}, outwards{0.0};
  for (const uint32_t e : opening.edges)
    center += 0.5 * (topology.open_edges[e].a + topology.open_edges[e].b) /
              static_cast<double>(opening.edges.size());
  for (const uint32_t e : opening.edges) {
    const OpenEdge& edge = topology.open_edges[e];
    const dvec3 cap = glm::cross(edge.b - center, edge.a - center);
    outwards += topology.turned[edge.triangle] ? -cap : cap;
  }
  RandomStream random(seed, 10, opening.edges.front());
  uint32_t backs = 0;
  for (uint32_t i = 0; i < rays; ++i) {
    const OpenEdge& edge =
        topology.open_edges[opening.edges[random.below(static_cast<uint32_t>(opening.edges.size()))]];
    const dvec3 start = glm::mix(edge.a, edge.b, random.uniform());
    const double z = random.uniform(-1.0, 1.0), azimuth = random.uniform(0.0, 2.0 * pi);
    const double r = std::sqrt(1.0 - z * z);
    dvec3 direction(r * std::cos(azimuth), r * std::sin(azimuth), z);
    if (glm::dot(direction, outwards) < 0.0) direction = -direction;
    // A step towards the middle leaves the surfaces that the edge touches.
    const dvec3 origin = start + 0.01 * (center - start);
    const uint32_t t = first_on_ray(origin, direction, 0.0, soup, tree);
    if (t != nothing && glm::dot(soup.normals[t], direction) > 0.0) ++backs;
  }
  return 2 * backs > rays;
}

std::vector<Opening> openings_of(const Loop& loop, const Topology& topology) {
  std::vector<Opening> openings;
  std::map<uint32_t, size_t> at_corner;  // corner -> opening
  for (const uint32_t e : loop.edges) {
    const OpenEdge& edge = topology.open_edges[e];
    if (edge.closed) continue;
    std::set<size_t> touched;
    for (const uint32_t corner : {edge.from, edge.to})
      if (const auto found = at_corner.find(corner); found != at_corner.end()) touched.insert(found->second);
    const size_t into = touched.empty() ? openings.size() : *touched.begin();
    if (touched.empty()) openings.emplace_back();
    if (touched.size() > 1) {
      Opening& second = openings[*touched.rbegin()];
      openings[into].edges.insert(openings[into].edges.end(), second.edges.begin(), second.edges.end());
      for (const uint32_t other : second.edges)
        for (const uint32_t corner : {topology.open_edges[other].from, topology.open_edges[other].to})
          at_corner[corner] = into;
      second.edges.clear();
    }
    openings[into].edges.push_back(e);
    at_corner[edge.from] = at_corner[edge.to] = into;
  }
  std::erase_if(openings, [](const Opening& opening) { return opening.edges.empty(); });
  for (Opening& opening : openings)
    for (const uint32_t e : opening.edges) opening.length_m += topology.open_edges[e].open_m;
  return openings;
}

/// The open edges of sheets of ground that nothing closes.
class GroundEdges {
 public:
  GroundEdges(const Soup& soup, const Topology& topology, const SoupTree& tree)
      : soup_(soup), topology_(topology), tree_(tree) {
    std::vector<Bounds> boxes;
    for (uint32_t e = 0; e < topology.open_edges.size(); ++e) {
      const OpenEdge& edge = topology.open_edges[e];
      if (edge.closed || soup.class_of(soup.object[edge.triangle]) != SemanticClass::ground) continue;
      edges_.push_back(e);
      Bounds& box = boxes.emplace_back();
      box.add(edge.a), box.add(edge.b);
    }
    boxes_ = BoxTree(boxes);
  }

  /// Returns whether the edge is no border of the whole ground. It is none if it is on an inner loop, or if
  /// the border of another part runs beside it; but it is one if there is other ground below, on which it
  /// lies.
  bool is_crack(uint32_t e, bool inner) const {
    constexpr double beside_m = 0.1, below_m = 1.0;
    const OpenEdge& edge = topology_.open_edges[e];
    const uint32_t part = topology_.part[edge.triangle];
    const dvec3 middle = 0.5 * (edge.a + edge.b);
    if (!inner) {
      const bool beside = boxes_.visit_until(
          [&](const Bounds& box) {
            return glm::any(glm::greaterThan(box.min - beside_m, middle)) ||
                   glm::any(glm::lessThan(box.max + beside_m, middle));
          },
          [&](uint32_t i) {
            const OpenEdge& other = topology_.open_edges[edges_[i]];
            if (topology_.part[other.triangle] == part) return false;
            return glm::distance(nearest_on_triangle(middle, {{other.a, other.b, other.b}}), middle) <=
                   beside_m;
          });
      if (!beside) return false;
    }
    std::vector<uint32_t> near;
    tree_.near_segment(middle, middle - dvec3(0.0, 0.0, below_m), 0.0, near);
    return std::ranges::none_of(near, [&](uint32_t t) {
      if (topology_.part[t] == part || std::abs(soup_.normals[t].z) < 0.5) return false;
      const auto at = line_meets_triangle(middle, dvec3(0.0, 0.0, -1.0), soup_.triangles[t]);
      return at && *at >= 0.0 && *at <= below_m;
    });
  }

 private:
  const Soup& soup_;
  const Topology& topology_;
  const SoupTree& tree_;
  std::vector<uint32_t> edges_;
  BoxTree boxes_;
};

double extent_of(const Loop& loop, const Topology& topology) {
  Bounds bounds;
  for (const uint32_t e : loop.edges) bounds.add(topology.open_edges[e].a);
  return glm::length(bounds.size());
}

/// Adds the openings of a sheet of ground that are no borders of it.
void find_ground_holes(const Soup& soup, const Topology& topology, const Part& part,
                       const GroundEdges& ground, FaultList& faults) {
  double most = 0.0;
  for (const Loop& loop : part.loops) most = std::max(most, extent_of(loop, topology));
  for (const Loop& loop : part.loops) {
    const bool inner = extent_of(loop, topology) < most;
    for (const Opening& opening : openings_of(loop, topology)) {
      double length = 0.0;
      uint32_t first = nothing;
      for (const uint32_t e : opening.edges) {
        if (!ground.is_crack(e, inner)) continue;
        length += topology.open_edges[e].open_m;
        if (first == nothing) first = e;
      }
      if (first == nothing) continue;
      const OpenEdge& edge = topology.open_edges[first];
      faults.add(ground_hole,
                 {0.5 * (edge.a + edge.b), part.object, nothing, soup.material[edge.triangle], length});
    }
  }
}

}  // namespace

Closing close_by_others(const Soup& soup, Topology& topology, const SoupTree& tree,
                        const CheckOptions& options, FaultList& faults) {
  std::vector<OpenEdge>& edges = topology.open_edges;
  Closing closing;
  closing.group.resize(topology.parts.size());
  std::iota(closing.group.begin(), closing.group.end(), 0u);
  const auto root = [&](uint32_t p) {
    while (closing.group[p] != p) p = closing.group[p] = closing.group[closing.group[p]];
    return p;
  };
  Junctions junctions(std::max(options.weld_m, 1e-9), soup, faults);
  // What is found along a few hundred edges is taken in before the next ones, since it may be much.
  constexpr size_t block = 512;
  std::vector<Closed> closed;
  for (size_t first = 0; first < edges.size(); first += block) {
    closed.assign(std::min(block, edges.size() - first), {});
    parallel_for(closed.size(), options.threads, [&](size_t i) {
      if (edges[first + i].shared_with == nothing)
        closed[i] = close_edge(edges[first + i], soup, topology, tree, options.weld_m);
      else
        closed[i].parts = {edges[first + i].shared_with};
    });
    for (size_t i = 0; i < closed.size(); ++i) {
      OpenEdge& edge = edges[first + i];
      closing.crowds += closed[i].crowd ? 1 : 0;
      edge.closed = closed[i].open_m == 0.0;
      edge.open_m = closed[i].open_m;
      for (const uint32_t other : closed[i].parts) {
        const uint32_t a = root(topology.part[edge.triangle]), b = root(other);
        closing.group[std::max(a, b)] = std::min(a, b);
      }
      for (const dvec3& corner : closed[i].junctions) junctions.add(corner, edge.triangle);
    }
  }
  for (uint32_t p = 0; p < closing.group.size(); ++p) closing.group[p] = root(p);
  return closing;
}

void find_openings(const Soup& soup, Topology& topology, const SoupTree& tree, const CheckOptions& options,
                   FaultList& faults) {
  const GroundEdges ground(soup, topology, tree);
  for (uint32_t p = 0; p < topology.parts.size(); ++p) {
    Part& part = topology.parts[p];
    const bool claims_solid = part.kind != PartKind::sheet || is_foliage(soup, topology, part);
    if (!claims_solid && soup.class_of(part.object) == SemanticClass::ground)
      find_ground_holes(soup, topology, part, ground, faults);
    if (!claims_solid && lies_on_ground(soup.class_of(part.object))) continue;
    // Leaves that radio does not see are sheets on purpose.
    if (!claims_solid && is_lossless(material_of(soup, topology, part))) continue;
    for (const Loop& loop : part.loops)
      for (const Opening& opening : openings_of(loop, topology)) {
        const auto beneath = [&](uint32_t e) {
          const OpenEdge& edge = topology.open_edges[e];
          return is_beneath(0.5 * (edge.a + edge.b), part, soup, topology, tree, p);
        };
        const bool hidden = claims_solid && (std::ranges::all_of(opening.edges, beneath) ||
                                             leads_into_another(opening, soup, topology, tree, options.seed));
        part.hidden_opening |= hidden;
        const OpenEdge& first = topology.open_edges[opening.edges.front()];
        faults.add(!claims_solid ? open_sheet
                   : hidden      ? hidden_opening
                                 : hole,
                   {0.5 * (first.a + first.b), part.object, nothing, soup.material[first.triangle],
                    opening.length_m});
      }
  }
}

}  // namespace greatx::scene::check
