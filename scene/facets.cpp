// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/facets.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/error.h"

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

/// For every triangle and side, the triangles that share that edge.
class EdgeTable {
 public:
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

  template <typename Visit>
  void for_each_neighbour(uint32_t triangle, const Visit& visit) const {
    for (uint32_t side = 0; side < 3; ++side) {
      const auto [begin, end] = ranges_[triangle * 3 + side];
      for (size_t index = begin; index < end; ++index) {
        if (entries_[index].triangle != triangle) visit(entries_[index].triangle);
      }
    }
  }

 private:
  struct Entry {
    uint32_t low, high, triangle, side;
    auto operator<=>(const Entry&) const = default;
  };
  std::vector<Entry> entries_;                     ///< sorted: equal edges stand together
  std::vector<std::pair<size_t, size_t>> ranges_;  ///< [triangle * 3 + side] into entries_
};

class Merger {
 public:
  Merger(const FacetInput& input, const BuildOptions& options)
      : input_(input), options_(options), edges_(input.vertices), taken_(input.corners.size() / 3, false) {
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
    taken_[seed] = true;
    for (size_t next = 0; next < group.triangles.size(); ++next) {
      edges_.for_each_neighbour(group.triangles[next], [&](uint32_t neighbour) {
        if (taken_[neighbour]) return;
        // The neighbour is judged by the plane that it would help to make: a small first triangle knows its own badly.
        PlaneFit trial = plane;
        if (!fixed) trial.add(doubled_area_normals_[neighbour], centroid(neighbour));
        if (!faces_along(trial, neighbour) || !lies_in(trial, neighbour)) return;
        plane = trial;
        taken_[neighbour] = true;
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
      for (const uint32_t triangle : group.triangles) taken_[triangle] = false;
      group = grow(seed, true, plane);
    }
    group.normal = plane.normal();
    group.offset = plane.offset();
    std::sort(group.triangles.begin(), group.triangles.end());
    return group;
  }

  const FacetInput& input_;
  const BuildOptions& options_;
  EdgeTable edges_;
  std::vector<bool> taken_;
  std::vector<dvec3> doubled_area_normals_;
  std::vector<double> allowed_angles_;
};

}  // namespace

std::vector<FacetGroup> merge_coplanar(const FacetInput& input, const BuildOptions& options) {
  GREATX_CHECK(input.corners.size() == input.vertices.size() && input.corners.size() % 3 == 0,
               "{} corners, {} vertices", input.corners.size(), input.vertices.size());
  return Merger(input, options).run();
}

}  // namespace greatx::scene
