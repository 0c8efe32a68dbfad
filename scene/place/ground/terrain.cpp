// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/ground/terrain.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "scene/place/ground/cover_map.h"
#include "scene/place/plane/cleaning.h"
#include "scene/place/plane/noding.h"

namespace greatx::scene::place {

namespace {

/// Parts of the rings within the rectangle, as segments. A segment that leaves the rectangle is cut there.
void add_segments(const Ring& ring, const Box& box, std::vector<Segment>& out) {
  for (size_t i = 0; i < ring.size(); ++i) {
    dvec2 a = ring[i], b = ring[(i + 1) % ring.size()];
    // Liang and Barsky's clipping.
    double t0 = 0.0, t1 = 1.0;
    const dvec2 d = b - a;
    bool outside = false;
    for (int axis = 0; axis < 2; ++axis)
      for (const double sign : {-1.0, 1.0}) {
        const double along = sign * d[axis];
        const double room = sign > 0.0 ? box.high[axis] - a[axis] : a[axis] - box.low[axis];
        if (along == 0.0) {
          outside = outside || room < 0.0;
        } else if (along < 0.0) {
          t0 = std::max(t0, room / along);
        } else {
          t1 = std::min(t1, room / along);
        }
      }
    if (outside || t0 >= t1) continue;
    out.push_back({a + d * t0, a + d * t1});
  }
}

class Builder {
 public:
  Builder(const HeightField& field, const GroundLevel& level, const std::vector<GroundArea>& areas,
          const TerrainOptions& options)
      : field_(field),
        level_(level),
        options_(options),
        cells_(areas, options.rectangle),
        mesh_(outlines(areas, options)) {
    for (const HeightGrid& grid : field.grids())
      for (const dvec3& sample : grid.samples)
        if (!std::isnan(sample.z) && options.rectangle.holds(dvec2(sample)) && counts(field, sample))
          samples_.push_back(sample);
  }

  TerrainMesh run() {
    set_heights();
    // A corner that one of the two adds may take the other beyond its bound.
    (void)refine_borders();
    do {
      refine();
    } while (refine_borders());
    double worst = 0.0;
    for (const dvec3& sample : samples_) worst = std::max(worst, error(sample));
    std::vector<Cover> covers;
    for (const Triangulation::Triangle& triangle : mesh_.triangles()) {
      dvec2 middle(0.0);
      for (const uint32_t corner : triangle.corners) middle += to_metres(mesh_.points()[corner]) / 3.0;
      covers.push_back(cells_.at(middle));
    }
    return {std::move(mesh_), std::move(heights_), std::move(covers), worst, samples_.size()};
  }

 private:
  static Triangulation outlines(const std::vector<GroundArea>& areas, const TerrainOptions& options) {
    std::vector<Segment> segments;
    const Box& box = options.rectangle;
    for (const GroundArea& area : areas) {
      if (!area.box.meets(box)) continue;
      for (const Polygon& polygon : area.polygons) {
        add_segments(polygon.outer, box, segments);
        for (const Ring& hole : polygon.holes) add_segments(hole, box, segments);
      }
    }
    // The rectangle's sides take part, so that cut ends lie on them.
    const dvec2 a = box.low, b(box.high.x, box.low.y), c = box.high, d(box.low.x, box.high.y);
    for (const Segment& side : {Segment{a, b}, Segment{b, c}, Segment{c, d}, Segment{d, a}})
      segments.push_back(side);
    return triangulate_noded(
        to_grid(box.low), to_grid(box.high),
        cleaned(node(segments, options.grid_m), {0.08, options.simplify_m, options.grid_m}));
  }

  /// A sample of a grid that lies in an earlier grid does not count.
  static bool counts(const HeightField& field, const dvec3& sample) {
    const auto z = field.at(dvec2(sample));
    return z && std::abs(*z - sample.z) < 1e-3;
  }

  void set_heights() {
    while (heights_.size() < mesh_.points().size())
      heights_.push_back(on_grid(level_(to_metres(mesh_.points()[heights_.size()]))));
  }

  double height_in(uint32_t triangle, const dvec2& p) const {
    return place::height_in(mesh_, heights_, triangle, p);
  }
  double error(const dvec3& sample) const {
    return std::abs(height_in(mesh_.find(to_grid(dvec2(sample))), dvec2(sample)) - sample.z);
  }

  /// Returns the smallest distance of neighbouring samples, m.
  double spacing() const {
    double least = 1e300;
    for (const HeightGrid& grid : field_.grids())
      for (const size_t next : {size_t{1}, size_t{grid.columns}})
        least = std::min(least, glm::distance(dvec2(grid.samples[0]), dvec2(grid.samples[next])));
    return std::max(0.25, least);
  }

  /// Returns the place on an edge where the terrain is farthest from the edge, if that is beyond the bound.
  std::optional<dvec2> worst_on_edge(uint32_t from, uint32_t to, double step) const {
    const dvec2 a = to_metres(mesh_.points()[from]), b = to_metres(mesh_.points()[to]);
    const int steps = static_cast<int>(std::ceil(glm::distance(a, b) / step));
    double worst = options_.error_m;
    std::optional<dvec2> place;
    for (int k = 1; k < steps; ++k) {
      const double share = static_cast<double>(k) / steps;
      const dvec2 here = glm::mix(a, b, share);
      const std::optional<double> ground = field_.at(here);
      if (!ground) continue;
      if (const double off = std::abs(glm::mix(heights_[from], heights_[to], share) - *ground); off > worst) {
        worst = off;
        place = here;
      }
    }
    return place;
  }

  /// Divides borders of areas until they follow the terrain within the bound. Samples lie beside a border and
  /// not on it, so that without this a long border could cut through the ground between two rows of samples.
  /// Returns whether it has divided any.
  bool refine_borders() {
    if (field_.empty()) return false;
    const double step = 0.5 * spacing();
    bool any = false;
    for (bool divided = true; divided; any = any || divided) {
      divided = false;
      for (uint32_t t = 0; t < mesh_.triangles().size(); ++t)
        for (uint32_t side = 0; side < 3; ++side) {
          const Triangulation::Triangle& triangle = mesh_.triangles()[t];
          const uint32_t from = triangle.corners[(side + 1) % 3], to = triangle.corners[(side + 2) % 3];
          // The triangle on the other side has the edge the other way round.
          if (!triangle.fixed[side] || (from > to && triangle.across[side] != Triangulation::none)) continue;
          const std::optional<dvec2> place = worst_on_edge(from, to, step);
          if (!place || !mesh_.divide(t, side, to_grid(*place))) continue;
          set_heights();
          divided = true;
        }
    }
    return any;
  }

  /// Adds samples until none is off by more than the bound. In each round every triangle gets its worst one.
  void refine() {
    std::vector<uint32_t> all(samples_.size());
    for (uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    std::vector<std::vector<uint32_t>> inside;
    (void)mesh_.take_changed();
    while (!all.empty()) {
      inside.resize(mesh_.triangles().size());
      std::vector<uint32_t> touched;
      for (const uint32_t i : all) {
        const uint32_t triangle = mesh_.find(to_grid(dvec2(samples_[i])));
        inside[triangle].push_back(i);
        touched.push_back(triangle);
      }
      std::sort(touched.begin(), touched.end());
      touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
      std::vector<uint32_t> chosen;
      for (const uint32_t triangle : touched) {
        double worst = options_.error_m;
        int64_t which = -1;
        for (const uint32_t i : inside[triangle])
          if (const double off = std::abs(height_in(triangle, dvec2(samples_[i])) - samples_[i].z);
              off > worst) {
            worst = off;
            which = i;
          }
        if (which >= 0) chosen.push_back(static_cast<uint32_t>(which));
      }
      all.clear();
      if (chosen.empty()) return;
      for (const uint32_t i : chosen) insert(samples_[i]);
      for (const uint32_t triangle : mesh_.take_changed())
        if (triangle < inside.size()) {
          all.insert(all.end(), inside[triangle].begin(), inside[triangle].end());
          inside[triangle].clear();
        }
    }
  }

  /// Adds a sample as a corner with its height. A sample beside a fixed edge would make a sliver there: the
  /// edge is divided at the place nearest to it instead, unless that has been done already.
  void insert(const dvec3& sample) {
    constexpr double beside_m = 0.25;
    const GridPoint here = to_grid(dvec2(sample));
    const uint32_t number = mesh_.find(here);
    const Triangulation::Triangle triangle = mesh_.triangles()[number];
    for (uint32_t side = 0; side < 3; ++side) {
      if (!triangle.fixed[side]) continue;
      const dvec2 a = to_metres(mesh_.points()[triangle.corners[(side + 1) % 3]]),
                  b = to_metres(mesh_.points()[triangle.corners[(side + 2) % 3]]);
      const double length = glm::distance(a, b), at = glm::dot(dvec2(sample) - a, b - a) / length;
      const dvec2 foot = a + (b - a) * (at / length);
      if (glm::distance(foot, dvec2(sample)) > beside_m || at < beside_m || at > length - beside_m) continue;
      if (!mesh_.divide(number, side, to_grid(foot))) continue;
      set_heights();
      return;
    }
    const uint32_t corner = mesh_.add(here);
    set_heights();
    heights_[corner] = on_grid(sample.z);
  }

  const HeightField& field_;
  const GroundLevel& level_;
  TerrainOptions options_;
  CoverMap cells_;
  Triangulation mesh_;
  std::vector<double> heights_;
  std::vector<dvec3> samples_;
};

}  // namespace

double height_in(const Triangulation& plan, const std::vector<double>& heights, uint32_t triangle,
                 const dvec2& place) {
  const auto& c = plan.triangles()[triangle].corners;
  const dvec2 a = to_metres(plan.points()[c[0]]), b = to_metres(plan.points()[c[1]]) - a,
              d = to_metres(plan.points()[c[2]]) - a, q = place - a;
  const double twice = b.x * d.y - b.y * d.x;
  const double u = (q.x * d.y - q.y * d.x) / twice, v = (b.x * q.y - b.y * q.x) / twice;
  return heights[c[0]] + u * (heights[c[1]] - heights[c[0]]) + v * (heights[c[2]] - heights[c[0]]);
}

double TerrainMesh::height_at(const dvec2& place) const {
  return height_in(plan, heights, plan.find(to_grid(place)), place);
}

GroundLevel::GroundLevel(const HeightField& field) : field_(field) {
  for (const HeightGrid& grid : field.grids()) {
    const auto known = [&](uint32_t x, uint32_t y) {
      return !std::isnan(grid.samples[size_t{y} * grid.columns + x].z);
    };
    for (uint32_t y = 0; y < grid.rows; ++y)
      for (uint32_t x = 0; x < grid.columns; ++x) {
        if (!known(x, y)) continue;
        bool border = x == 0 || y == 0 || x + 1 == grid.columns || y + 1 == grid.rows;
        for (uint32_t k = 0; k < 9 && !border; ++k) border = !known(x + k % 3 - 1, y + k / 3 - 1);
        if (border) known_.push_back(grid.samples[size_t{y} * grid.columns + x]);
      }
  }
}

double GroundLevel::operator()(const dvec2& place) const {
  if (field_.empty()) return 0.0;
  if (const auto z = field_.at(place)) return *z;
  ++filled_;
  return nearest(place);
}

double GroundLevel::nearest(const dvec2& place) const {
  double least = 1e300, z = 0.0;
  for (const dvec3& sample : known_)
    if (const double off = glm::distance(dvec2(sample), place); off < least) {
      least = off;
      z = sample.z;
    }
  return z;
}

TerrainMesh make_terrain(const HeightField& field, const GroundLevel& level,
                         const std::vector<GroundArea>& areas, const TerrainOptions& options) {
  return Builder(field, level, areas, options).run();
}

}  // namespace greatx::scene::place
