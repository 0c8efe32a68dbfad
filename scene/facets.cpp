// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/facets.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <unordered_map>
#include <utility>

#include "core/error.h"
#include "core/units.h"

namespace greatx::scene {
namespace {

/// A plane from weighted triangles, with sums taken about a near point so that no digits are lost far from the origin.
class PlaneFit {
 public:
  explicit PlaneFit(const dvec3& about) : about_(about) {}

  void add(const dvec3& doubled_area_normal, const dvec3& centroid) {
    const double weight = glm::length(doubled_area_normal);
    normal_sum_ += doubled_area_normal;
    centroid_sum_ += weight * (centroid - about_);
    weight_sum_ += weight;
    normal_ = glm::normalize(normal_sum_);
    point_ = about_ + centroid_sum_ / weight_sum_;
  }
  const dvec3& normal() const { return normal_; }
  double offset() const { return glm::dot(normal_, point_); }
  double distance(const dvec3& corner) const { return std::abs(glm::dot(normal_, corner - point_)); }

 private:
  dvec3 about_, normal_sum_{0.0}, centroid_sum_{0.0}, normal_{0.0}, point_{0.0};
  double weight_sum_ = 0.0;
};

/// For every triangle and side, the triangles that share that edge, as entries that follow one another.
class EdgeTable {
 public:
  struct Range {
    size_t begin = 0, end = 0;
  };
  explicit EdgeTable(const std::vector<uint32_t>& vertices) {
    const size_t count = vertices.size() / 3;
    entries_.reserve(count * 3);
    for (uint32_t triangle = 0; triangle < count; ++triangle) {
      for (uint32_t side = 0; side < 3; ++side) {
        const uint32_t from = vertices[triangle * 3 + side], to = vertices[triangle * 3 + (side + 1) % 3];
        entries_.push_back({std::min(from, to), std::max(from, to), triangle, side});
      }
    }
    std::sort(entries_.begin(), entries_.end());
    ranges_.resize(count * 3);
    for (size_t begin = 0; begin < entries_.size();) {
      size_t end = begin + 1;
      while (end < entries_.size() && entries_[end].low == entries_[begin].low &&
             entries_[end].high == entries_[begin].high) {
        ++end;
      }
      for (size_t index = begin; index < end; ++index) {
        ranges_[entries_[index].triangle * 3 + entries_[index].side] = {begin, end};
      }
      begin = end;
    }
  }

  const Range& range(uint32_t triangle, uint32_t side) const { return ranges_[triangle * 3 + side]; }
  uint32_t triangle(size_t entry) const { return entries_[entry].triangle; }
  uint32_t side(size_t entry) const { return entries_[entry].side; }
  size_t size() const { return entries_.size(); }

 private:
  struct Entry {
    uint32_t low, high, triangle, side;
    auto operator<=>(const Entry&) const = default;
  };
  std::vector<Entry> entries_;  ///< sorted: equal edges stand together
  std::vector<Range> ranges_;   ///< [triangle * 3 + side] into entries_
};

/// The triangles of one edge that very many share (a fan about an axis), by the direction of their normals about the edge:
/// a facet that grows asks for those alone that may join it, where asking all of them each time is quadratic.
///
/// A neighbour joins if its normal n is within A <= 0.5 rad of that of the plane it would help to make, normal S + n. All
/// that wait are no larger than the facet's seed, so |S| >= |n|, and n is within 2 A of S. Seen along the edge, to which n is
/// almost perpendicular (up to `most_tilt`), S and n then differ by asin(sin(2 A) / cos(tilt)) at most.
class CrowdedEdge {
 public:
  CrowdedEdge(size_t first_entry, const dvec3& along) : first_entry_(first_entry) {
    const dvec3 edge = glm::normalize(along),
                seed = std::abs(edge.x) < 0.5 ? dvec3(1.0, 0.0, 0.0) : dvec3(0.0, 1.0, 0.0);
    x_ = glm::normalize(glm::cross(edge, seed));
    y_ = glm::cross(edge, x_);
  }

  /// The next entry; `allowed`: A of its triangle.
  void add(const dvec3& normal, double allowed) {
    const size_t entry = first_entry_ + places_.size();
    const Direction direction = direction_of(normal);
    // An edge without length has no direction about it: all are asked always.
    places_.push_back({std::isfinite(direction.angle) ? direction.angle : 0.0, unordered});
    if (direction.projected >= std::cos(most_tilt))
      places_.back().group = std::clamp(std::ilogb(std::min(allowed, 0.5)), least_group, -1);
    put(entry);
  }
  void put(size_t entry) {
    const Place& place = places_[entry - first_entry_];
    waiting_[place.group].insert({place.angle, entry});
  }
  void take(size_t entry) {
    const Place& place = places_[entry - first_entry_];
    waiting_[place.group].erase({place.angle, entry});
  }

  /// Calls `test(entry)` for all entries that wait and may join, and perhaps others, in their order. It may take some, and
  /// move the plane: `normal()` is of what it is then.
  template <typename Normal, typename Test>
  void for_each(const Normal& normal, const Test& test) const {
    size_t from = first_entry_;
    for (bool again = true; again;) {
      again = false;
      const Direction asked = direction_of(normal());
      for (const size_t entry : near(asked, from)) {
        test(entry);
        from = entry + 1;
        again = moved(asked, direction_of(normal()));
        if (again) break;
      }
    }
  }

 private:
  static constexpr double most_tilt = 0.1;  ///< rad; what is tilted more is asked always
  static constexpr double slack = 0.01;     ///< rad that the plane may turn before it is asked anew
  static constexpr int least_group = -20, unordered = 1;

  struct Direction {
    double angle = 0.0, projected = 0.0;  ///< about the edge; length perpendicular to it
    /// Else all that are tilted little are further off than 2 A.
    bool faces() const { return projected >= 0.36; }
  };
  struct Place {
    double angle;
    int group;  ///< exponent of A
  };

  Direction direction_of(const dvec3& normal) const {
    const double x = glm::dot(normal, x_), y = glm::dot(normal, y_);
    return {std::atan2(y, x), std::sqrt(x * x + y * y) / glm::length(normal)};
  }
  static bool moved(const Direction& from, const Direction& to) {
    if (!from.faces() && !to.faces()) return false;
    return from.faces() != to.faces() || std::abs(std::remainder(to.angle - from.angle, 2.0 * pi)) > slack;
  }

  std::vector<size_t> near(const Direction& asked, size_t from) const {
    std::vector<size_t> found;
    for (const auto& [group, entries] : waiting_) {
      const auto between = [&](double low, double high) {
        for (auto it = entries.lower_bound({low, 0}); it != entries.end() && it->first <= high; ++it)
          if (it->second >= from) found.push_back(it->second);
      };
      if (group == unordered) {
        between(-2.0 * pi, 2.0 * pi);
      } else if (asked.faces()) {
        const double widest = std::min(std::ldexp(2.0, group + 1), 1.0),  // A < 2^(group + 1)
            reach = std::asin(std::min(1.0, std::sin(widest) / std::cos(most_tilt))) + slack + 1e-6;
        for (const double turn : {-2.0 * pi, 0.0, 2.0 * pi})
          between(asked.angle + turn - reach, asked.angle + turn + reach);
      }
    }
    std::sort(found.begin(), found.end());
    return found;
  }

  size_t first_entry_;
  dvec3 x_{0.0}, y_{0.0};  ///< unit, perpendicular to the edge and each other
  std::vector<Place> places_;
  std::map<int, std::set<std::pair<double, size_t>>> waiting_;  ///< by group: angle, entry
};

class Merger {
 public:
  Merger(const FacetInput& input, const BuildOptions& options, size_t crowd)
      : input_(input),
        options_(options),
        crowd_(crowd),
        edges_(input.vertices),
        taken_(input.corners.size() / 3, false) {
    const size_t count = taken_.size();
    doubled_area_normals_.resize(count);
    allowed_angles_.resize(count);
    for (size_t triangle = 0; triangle < count; ++triangle) {
      const dvec3* corners = &input.corners[triangle * 3];
      const dvec3 cross = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
      double longest = 0.0;
      for (int side = 0; side < 3; ++side) {
        longest = std::max(longest, glm::distance(corners[side], corners[(side + 1) % 3]));
      }
      const double height = glm::length(cross) / longest;  // the least one
      doubled_area_normals_[triangle] = cross;
      allowed_angles_[triangle] = options.coplanar_angle_rad + 2.0 * input.noise_m / height;
    }
    find_crowds();
  }

  std::vector<FacetGroup> run() {
    // Large triangles know their plane best: they seed the facets.
    std::vector<uint32_t> order(taken_.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](uint32_t left, uint32_t right) {
      return glm::length(doubled_area_normals_[left]) > glm::length(doubled_area_normals_[right]);
    });
    std::vector<FacetGroup> groups;
    for (const uint32_t seed : order) {
      if (!taken_[seed]) groups.push_back(grow_checked(seed));
    }
    std::sort(groups.begin(), groups.end(), [](const FacetGroup& left, const FacetGroup& right) {
      return left.triangles.front() < right.triangles.front();
    });
    return groups;
  }

 private:
  void find_crowds() {
    for (size_t begin = 0; begin < edges_.size();) {
      const auto [first, end] = edges_.range(edges_.triangle(begin), edges_.side(begin));
      if (end - first > crowd_) {
        const dvec3* corners = &input_.corners[edges_.triangle(first) * 3];
        const uint32_t side = edges_.side(first);
        CrowdedEdge& crowd =
            crowds_.try_emplace(first, first, corners[(side + 1) % 3] - corners[side]).first->second;
        for (size_t entry = first; entry < end; ++entry) {
          const uint32_t triangle = edges_.triangle(entry);
          crowd.add(doubled_area_normals_[triangle], allowed_angles_[triangle]);
          crowded_[triangle].push_back({&crowd, entry});
        }
      }
      begin = end;
    }
  }

  void set_taken(uint32_t triangle, bool taken) {
    taken_[triangle] = taken;
    if (crowded_.empty()) return;
    if (const auto found = crowded_.find(triangle); found != crowded_.end())
      for (const auto& [crowd, entry] : found->second) taken ? crowd->take(entry) : crowd->put(entry);
  }

  /// `test(neighbour)` for those across each side that may join the facet, in order; `normal()`: of its plane then.
  template <typename Normal, typename Test>
  void for_each_neighbour(uint32_t triangle, const Normal& normal, const Test& test) const {
    for (uint32_t side = 0; side < 3; ++side) {
      const auto [begin, end] = edges_.range(triangle, side);
      if (end - begin > crowd_) {
        crowds_.at(begin).for_each(normal, [&](size_t entry) { test(edges_.triangle(entry)); });
        continue;
      }
      for (size_t entry = begin; entry < end; ++entry)
        if (edges_.triangle(entry) != triangle) test(edges_.triangle(entry));
    }
  }

  dvec3 centroid(uint32_t triangle) const {
    const dvec3* corners = &input_.corners[triangle * 3];
    return (corners[0] + corners[1] + corners[2]) / 3.0;
  }

  bool lies_in(const PlaneFit& plane, uint32_t triangle) const {
    const dvec3* corners = &input_.corners[triangle * 3];
    return std::all_of(corners, corners + 3, [&](const dvec3& corner) {
      return plane.distance(corner) <= options_.coplanar_distance_m;
    });
  }

  bool faces_along(const PlaneFit& plane, uint32_t triangle) const {
    const dvec3& normal = doubled_area_normals_[triangle];
    // atan2 keeps small angles exact, where acos of a rounded cosine does not.
    const double angle =
        std::atan2(glm::length(glm::cross(plane.normal(), normal)), glm::dot(plane.normal(), normal));
    return angle <= std::min(allowed_angles_[triangle], 0.5);
  }

  /// `fixed`: the plane stays the seed's; else it follows the triangles that join.
  FacetGroup grow(uint32_t seed, bool fixed, PlaneFit& plane) {
    plane = PlaneFit(input_.corners[seed * 3]);
    plane.add(doubled_area_normals_[seed], centroid(seed));
    FacetGroup group;
    group.triangles.push_back(seed);
    set_taken(seed, true);
    const auto normal = [&plane] { return plane.normal(); };
    for (size_t next = 0; next < group.triangles.size(); ++next) {
      for_each_neighbour(group.triangles[next], normal, [&](uint32_t neighbour) {
        if (taken_[neighbour]) return;
        // The neighbour is judged by the plane that it would help to make: a small first triangle knows its own badly.
        PlaneFit trial = plane;
        if (!fixed) trial.add(doubled_area_normals_[neighbour], centroid(neighbour));
        if (!faces_along(trial, neighbour) || !lies_in(trial, neighbour)) return;
        plane = trial;
        set_taken(neighbour, true);
        group.triangles.push_back(neighbour);
      });
    }
    return group;
  }

  /// The plane that follows its triangles may leave early ones behind; then the seed's plane decides alone.
  FacetGroup grow_checked(uint32_t seed) {
    PlaneFit plane{dvec3(0.0)};
    FacetGroup group = grow(seed, false, plane);
    const bool holds = std::all_of(group.triangles.begin(), group.triangles.end(),
                                   [&](uint32_t triangle) { return lies_in(plane, triangle); });
    if (!holds) {
      for (const uint32_t triangle : group.triangles) set_taken(triangle, false);
      group = grow(seed, true, plane);
    }
    group.normal = plane.normal();
    group.offset = plane.offset();
    std::sort(group.triangles.begin(), group.triangles.end());
    return group;
  }

  const FacetInput& input_;
  const BuildOptions& options_;
  size_t crowd_;
  EdgeTable edges_;
  std::map<size_t, CrowdedEdge> crowds_;  ///< by their first entry
  /// Of a triangle: its entries on crowded edges.
  std::unordered_map<uint32_t, std::vector<std::pair<CrowdedEdge*, size_t>>> crowded_;
  std::vector<bool> taken_;
  std::vector<dvec3> doubled_area_normals_;
  std::vector<double> allowed_angles_;
};

}  // namespace

std::vector<FacetGroup> merge_coplanar(const FacetInput& input, const BuildOptions& options, size_t crowd) {
  GREATX_CHECK(input.corners.size() == input.vertices.size() && input.corners.size() % 3 == 0,
               "{} corners, {} vertices", input.corners.size(), input.vertices.size());
  return Merger(input, options, crowd).run();
}

}  // namespace greatx::scene
