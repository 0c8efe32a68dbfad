// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/paths/edge_pairs.h"

#include <algorithm>
#include <cmath>

#include "rf/edges/diffraction.h"
#include "rf/search/beam_search.h"

namespace greatx::rf {
namespace {

/// What is hidden is hidden by this much, as in the search.
constexpr double clearance_m = BeamSearchOptions{}.clearance_m;

scene::Bounds bounds_of(std::span<const dvec3> points) {
  scene::Bounds bounds;
  for (const dvec3& point : points) bounds.add(point);
  return bounds;
}

/// Tells whether the segment from `a` misses the box. `inverse` holds the reciprocals of its components.
bool passes_by(const scene::Bounds& box, const dvec3& a, const dvec3& inverse) {
  const dvec3 to_min = (box.min - a) * inverse, to_max = (box.max - a) * inverse;
  const dvec3 low = glm::min(to_min, to_max), high = glm::max(to_min, to_max);
  return std::max({low.x, low.y, low.z, 0.0}) > std::min({high.x, high.y, high.z, 1.0});
}

/// Returns the least of normal . x over a set of points given by its bounds.
double least_over(const scene::Bounds& box, const dvec3& normal) {
  return std::min(normal.x * box.min.x, normal.x * box.max.x) +
         std::min(normal.y * box.min.y, normal.y * box.max.y) +
         std::min(normal.z * box.min.z, normal.z * box.max.z);
}

}  // namespace

/// The narrow side of a wedge, where no wave is, as two half-spaces.
struct EdgePairs::Inside {
  dvec3 a{0.0}, normal_0{0.0}, normal_n{0.0};  ///< normals into the exterior

  explicit Inside(const scene::Wedge& wedge)
      : a(wedge.a), normal_0(wedge.normal_0), normal_n(face_n_normal(wedge)) {}
  bool holds(const scene::Bounds& box) const {
    const auto behind = [&](const dvec3& normal) {
      return -least_over(box, -normal) - glm::dot(normal, a) < -clearance_m;
    };
    return behind(normal_0) && behind(normal_n);
  }
};

EdgePairs::EdgePairs(const BeamScene& still, std::span<const scene::Wedge> wedges, uint32_t max_walls)
    : wedges_(wedges), max_walls_(max_walls), rows_(wedges.size()) {
  std::vector<scene::Bounds> boxes;
  for (uint32_t f = 0; f < still.facet_count(); ++f) {
    const BeamFacet& facet = still.facet(f);
    for (const BeamPolygon& polygon : still.polygons(facet)) {
      Blind blind{facet.normal,
                  facet.offset,
                  std::max(clearance_m, 4.0 * facet.tolerance_m),
                  static_cast<uint32_t>(corners_.size()),
                  polygon.count,
                  f,
                  facet.kind == FacetKind::wall};
      for (const uint32_t corner : still.corners(polygon)) corners_.push_back(still.vertex(corner));
      blinds_.push_back(blind);
      boxes.push_back(bounds_of(corners(blind)));
    }
  }
  blind_tree_ = scene::BoxTree(boxes);
  boxes.clear();
  for (uint32_t i = 0; i < still.wedge_count(); ++i) listed_.push_back(still.wedge(i).index);
  std::sort(listed_.begin(), listed_.end());
  for (uint32_t i = 0; i < wedges_.size(); ++i)
    if (wedges_[i].body != 0) moving_.push_back(i);
  for (const uint32_t wedge : listed_) {
    const dvec3 ends[2] = {wedges_[wedge].a, wedges_[wedge].b};
    boxes.push_back(bounds_of(ends));
  }
  wedge_tree_ = scene::BoxTree(boxes);
}

/// Looks out from one wedge.
class EdgePairs::Looker {
 public:
  Looker(const EdgePairs& pairs, const scene::Wedge& wedge)
      : pairs_(pairs), wedge_(wedge), middle_(0.5 * (wedge.a + wedge.b)), inside_(wedge) {}

  /// Tells whether no line from the wedge reaches anything in the box.
  bool hidden(const scene::Bounds& box) {
    if (inside_.holds(box)) return true;
    const dvec3 along = 0.5 * (box.min + box.max) - middle_, inverse = 1.0 / along;
    walls_.clear();
    // The polygon that hid the last box often hides this one.
    if (last_ != none && blocks(pairs_.blinds_[last_], box)) return true;
    return pairs_.blind_tree_.visit_until(
        [&](const scene::Bounds& bounds) { return passes_by(bounds, middle_, inverse); },
        [&](uint32_t index) {
          if (!blocks(pairs_.blinds_[index], box)) return false;
          if (!pairs_.blinds_[index].wall) last_ = index;
          return true;
        });
  }

 private:
  static constexpr uint32_t none = ~0u;

  /// Counts walls; tells whether nothing behind the polygon can be reached.
  bool blocks(const Blind& blind, const scene::Bounds& box) {
    if (!covers(blind, box)) return false;
    if (!blind.wall) return true;
    if (std::find(walls_.begin(), walls_.end(), blind.facet) != walls_.end()) return false;
    walls_.push_back(blind.facet);
    return walls_.size() > pairs_.max_walls_;
  }

  bool covers(const Blind& blind, const scene::Bounds& box) const {
    const double from_a = glm::dot(blind.normal, wedge_.a) - blind.offset,
                 from_b = glm::dot(blind.normal, wedge_.b) - blind.offset;
    const double side = from_a > 0.0 ? 1.0 : -1.0;
    if (side * from_a <= blind.clear_m || side * from_b <= blind.clear_m) return false;
    // The box must be wholly on the other side.
    if (least_over(box, -side * blind.normal) + side * blind.offset <= blind.clear_m) return false;
    const auto corners = pairs_.corners(blind);
    return in_pyramid(wedge_.a, side, corners, box) && in_pyramid(wedge_.b, side, corners, box);
  }

  /// Tells whether the box lies in the pyramid that the polygon cuts out as seen from `apex`. The corners
  /// turn counter-clockwise as seen from the side of the normal; `side`: the apex is on that side (+1), or
  /// not.
  static bool in_pyramid(const dvec3& apex, double side, std::span<const dvec3> corners,
                         const scene::Bounds& box) {
    for (size_t i = 0; i < corners.size(); ++i) {
      const dvec3 &p = corners[i], &q = corners[i + 1 == corners.size() ? 0 : i + 1];
      const dvec3 across = side * glm::cross(p - apex, q - apex);  // inwards, seen from the apex
      const double length = glm::length(across);
      if (length <= 0.0) return false;
      const dvec3 inwards = -across / length;
      if (least_over(box, inwards) - glm::dot(inwards, apex) < clearance_m) return false;
    }
    return true;
  }

  const EdgePairs& pairs_;
  const scene::Wedge& wedge_;
  dvec3 middle_;
  Inside inside_;
  uint32_t last_ = none;
  std::vector<uint32_t> walls_;
};

void EdgePairs::add_seen(uint32_t wedge, std::vector<uint32_t>& seen) const {
  const scene::Wedge& from = wedges_[wedge];
  Looker looker(*this, from);
  const dvec3 ends[2] = {from.a, from.b};
  const scene::Bounds own = bounds_of(ends);
  wedge_tree_.visit_until([&](const scene::Bounds& box) { return looker.hidden(box); },
                          [&](uint32_t index) {
                            const scene::Wedge& to = wedges_[listed_[index]];
                            const dvec3 to_ends[2] = {to.a, to.b};
                            if (!Inside(to).holds(own) && !looker.hidden(bounds_of(to_ends)))
                              seen.push_back(listed_[index]);
                            return false;
                          });
}

std::span<const uint32_t> EdgePairs::seen_from(uint32_t wedge) {
  Row& row = rows_[wedge];
  std::call_once(row.once, [&] {
    row.seen = moving_;
    if (wedges_[wedge].body == 0)
      add_seen(wedge, row.seen);
    else
      row.seen.insert(row.seen.end(), listed_.begin(), listed_.end());
    std::erase(row.seen, wedge);
    std::sort(row.seen.begin(), row.seen.end());
  });
  return row.seen;
}

}  // namespace greatx::rf
