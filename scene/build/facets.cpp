// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/build/facets.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "core/error.h"
#include "core/units.h"
#include "scene/build/edge_table.h"

namespace greatx::scene {
namespace {

/// The largest angle by which normals may differ, also where rounding may turn the normal of a thin triangle
/// further.
constexpr double most_angle_rad = 0.5;

/// Fits a plane to weighted triangles. The sums are relative to a near point, so that they keep their
/// precision far from the origin.
class PlaneFit {
 public:
  explicit PlaneFit(const dvec3& about) : about_(about) {}

  /// `weight` is the length of `doubled_area_normal`.
  void add(const dvec3& doubled_area_normal, double weight, const dvec3& centroid) {
    normal_sum_ += doubled_area_normal;
    centroid_sum_ += weight * (centroid - about_);
    weight_sum_ += weight;
    normal_ = glm::normalize(normal_sum_);
    point_ = about_ + centroid_sum_ / weight_sum_;
  }
  const dvec3& normal() const { return normal_; }
  const dvec3& normal_sum() const { return normal_sum_; }
  double offset() const { return glm::dot(normal_, point_); }
  double distance(const dvec3& corner) const { return std::abs(glm::dot(normal_, corner - point_)); }

 private:
  dvec3 about_, normal_sum_{0.0}, centroid_sum_{0.0}, normal_{0.0}, point_{0.0};
  double weight_sum_ = 0.0;
};

/// Sorts many triangles around one edge by the direction of their normals about the edge.
class Fan {
 public:
  /// The angle by which the plane's normal may turn while an answer of near() remains valid, rad.
  static constexpr double margin_rad = 0.01;
  uint64_t settled = 0;  ///< Merger::changes_ when all triangles were last tried and none joined

  explicit Fan(const dvec3& edge) {
    const dvec3 along = glm::normalize(edge);
    x_ = glm::normalize(glm::cross(along, std::abs(along.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
    y_ = glm::cross(along, x_);
  }
  void add(uint32_t triangle, const dvec3& normal, double allowed_rad) {
    if (!(allowed_rad < most_angle_rad)) {
      anyway_.push_back(triangle);  // too thin for its normal to be trusted
      return;
    }
    by_angle_.emplace_back(angle_of(normal), triangle);
    reach_ = std::max(reach_, allowed_rad);
  }
  void finish() { std::sort(by_angle_.begin(), by_angle_.end()); }

  /// Finds at least the triangles that may join a facet with this normal, from `least_triangle` on,
  /// ascending. A triangle is no larger than the facet that it joins, since the largest triangles are the
  /// seeds. It therefore turns the sum of the normals by at most the angle that remains between the new sum
  /// and its own normal. Hence the facet's normal before the join is within twice the allowed angle.
  void near(const dvec3& normal, uint32_t least_triangle, std::vector<uint32_t>& found) const {
    found.clear();
    const double window = 2.0 * reach_ + 2.0 * margin_rad, at = angle_of(normal);
    const auto take = [&](double low, double high) {
      for (auto i = std::lower_bound(by_angle_.begin(), by_angle_.end(), std::pair(low, 0u));
           i != by_angle_.end() && i->first <= high; ++i)
        if (i->second >= least_triangle) found.push_back(i->second);
    };
    take(at - window, at + window);
    if (at - window < -pi) take(at - window + 2.0 * pi, pi);
    if (at + window > pi) take(-pi, at + window - 2.0 * pi);
    for (const uint32_t triangle : anyway_)
      if (triangle >= least_triangle) found.push_back(triangle);
    std::sort(found.begin(), found.end());
  }

 private:
  double angle_of(const dvec3& normal) const {
    return std::atan2(glm::dot(normal, y_), glm::dot(normal, x_));
  }
  dvec3 x_, y_;
  std::vector<std::pair<double, uint32_t>> by_angle_;
  std::vector<uint32_t> anyway_;
  double reach_ = 0.0;
};

class Merger {
 public:
  Merger(const FacetInput& input, const BuildOptions& options, uint32_t crowd)
      : input_(input),
        options_(options),
        crowd_(crowd),
        edges_(input.vertices),
        taken_(input.corners.size() / 3) {
    const size_t count = taken_.size();
    triangles_.reserve(count);
    grown_.reserve(count);
    for (size_t triangle = 0; triangle < count; ++triangle) {
      const dvec3* corners = &input.corners[triangle * 3];
      Triangle entry;
      entry.normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
      entry.weight = glm::length(entry.normal);
      double longest = 0.0;
      for (int side = 0; side < 3; ++side)
        longest = std::max(longest, glm::distance(corners[side], corners[(side + 1) % 3]));
      const double height = entry.weight / longest;  // the smallest height of the triangle
      entry.allowed_rad = options.coplanar_angle_rad + 2.0 * input.noise_m / height;
      const double tangent = std::tan(std::min(entry.allowed_rad, most_angle_rad));
      entry.surely_off = tangent * tangent * (1.0 + 1e-6) + 1e-24;
      triangles_.push_back(entry);
    }
  }

  FacetGroups run() {
    // Large triangles determine their plane best, so they seed the facets.
    std::vector<std::pair<double, uint32_t>> order;
    order.reserve(triangles_.size());
    for (uint32_t triangle = 0; triangle < triangles_.size(); ++triangle)
      order.emplace_back(triangles_[triangle].weight, triangle);
    std::stable_sort(order.begin(), order.end(),
                     [](const auto& left, const auto& right) { return left.first > right.first; });
    for (const auto& [weight, seed] : order)
      if (!taken_[seed]) grow_checked(seed);
    return in_order();
  }

 private:
  struct Triangle {
    dvec3 normal{0.0};    ///< its length is twice the area
    double weight = 0.0;  ///< the length of `normal`
    double allowed_rad = 0.0;
    /// Square of the tangent of an angle that is larger than allowed_rad for any rounding.
    double surely_off = 0.0;
  };

  dvec3 centroid(uint32_t triangle) const {
    const dvec3* corners = &input_.corners[size_t{triangle} * 3];
    return (corners[0] + corners[1] + corners[2]) / 3.0;
  }

  bool lies_in(const PlaneFit& plane, uint32_t triangle) const {
    const dvec3* corners = &input_.corners[size_t{triangle} * 3];
    return std::all_of(corners, corners + 3, [&](const dvec3& corner) {
      return plane.distance(corner) <= options_.coplanar_distance_m;
    });
  }

  bool faces_along(const PlaneFit& plane, uint32_t triangle) const {
    const dvec3& normal = triangles_[triangle].normal;
    // atan2 keeps small angles exact. acos of a rounded cosine does not.
    const double angle =
        std::atan2(glm::length(glm::cross(plane.normal(), normal)), glm::dot(plane.normal(), normal));
    return angle <= std::min(triangles_[triangle].allowed_rad, most_angle_rad);
  }

  /// Rejects most neighbours, which face another direction by far, without a square root or an angle.
  bool surely_faces_elsewhere(const dvec3& plane_normal, const Triangle& triangle) const {
    const double along = glm::dot(plane_normal, triangle.normal);
    const dvec3 across = glm::cross(plane_normal, triangle.normal);
    return along < 0.0 || glm::dot(across, across) > triangle.surely_off * (along * along);
  }

  /// Adds `neighbour` to the facet that grows, if it belongs to the facet. If `fixed`, the plane remains that
  /// of the seed.
  void join(uint32_t neighbour, bool fixed, PlaneFit& plane) {
    if (taken_[neighbour]) return;
    const Triangle& triangle = triangles_[neighbour];
    if (surely_faces_elsewhere(fixed ? plane.normal() : plane.normal_sum() + triangle.normal, triangle))
      return;
    // The neighbour is tested against the plane that includes it, since a small first triangle determines its
    // own plane badly.
    PlaneFit trial = plane;
    if (!fixed) trial.add(triangle.normal, triangle.weight, centroid(neighbour));
    if (!faces_along(trial, neighbour) || !lies_in(trial, neighbour)) return;
    plane = trial;
    taken_[neighbour] = true;
    grown_.push_back(neighbour);
    ++changes_;
  }

  Fan& fan_of(const EdgeTable::Edge& edge, uint32_t triangle, uint32_t side) {
    const dvec3* corners = &input_.corners[size_t{triangle} * 3];
    const auto [entry, is_new] = fans_.try_emplace(edge.first, corners[(side + 1) % 3] - corners[side]);
    if (is_new) {
      for (const uint32_t other : edges_.triangles(edge))
        entry->second.add(other, triangles_[other].normal, triangles_[other].allowed_rad);
      entry->second.finish();
    }
    return entry->second;
  }

  /// Gives the result of a loop over all triangles of the fan, in the same order, and asks the fan again when
  /// the plane has turned. Every triangle of the facet that lies around the edge calls this function. If
  /// nothing has changed since a call in which no triangle joined, no triangle can join now.
  void join_fan(Fan& fan, bool fixed, PlaneFit& plane) {
    if (fan.settled == changes_) return;
    const uint64_t before = changes_;
    ask_fan(fan, fixed, plane);
    if (changes_ == before) fan.settled = before;
  }
  void ask_fan(const Fan& fan, bool fixed, PlaneFit& plane) {
    for (uint32_t next = 0;;) {
      const dvec3 asked = plane.normal();
      fan.near(asked, next, near_);
      bool turned = false;
      for (const uint32_t neighbour : near_) {
        join(neighbour, fixed, plane);
        turned = glm::distance(plane.normal(), asked) > Fan::margin_rad;
        if (!turned) continue;
        next = neighbour + 1;
        break;
      }
      if (!turned) return;
    }
  }

  /// Grows a facet from `seed` and appends its triangles to grown_. If `fixed`, the plane remains that of the
  /// seed; otherwise it follows the triangles that join.
  PlaneFit grow(uint32_t seed, bool fixed) {
    size_t next = grown_.size();
    PlaneFit plane(input_.corners[size_t{seed} * 3]);
    plane.add(triangles_[seed].normal, triangles_[seed].weight, centroid(seed));
    grown_.push_back(seed);
    taken_[seed] = true;
    ++changes_;
    for (; next < grown_.size(); ++next) {
      const uint32_t triangle = grown_[next];
      for (uint32_t side = 0; side < 3; ++side) {
        const EdgeTable::Edge edge = edges_.edge(triangle, side);
        if (edge.count >= crowd_)
          join_fan(fan_of(edge, triangle, side), fixed, plane);
        else
          for (const uint32_t neighbour : edges_.triangles(edge)) join(neighbour, fixed, plane);
      }
    }
    return plane;
  }

  /// Grows a facet and checks it. The plane that follows its triangles may leave the tolerance of early ones.
  /// In this case the facet grows again with the plane of the seed.
  void grow_checked(uint32_t seed) {
    const size_t first = grown_.size();
    PlaneFit plane = grow(seed, false);
    const auto begin = grown_.begin() + static_cast<std::ptrdiff_t>(first);
    if (!std::all_of(begin, grown_.end(), [&](uint32_t triangle) { return lies_in(plane, triangle); })) {
      std::for_each(begin, grown_.end(), [&](uint32_t triangle) { taken_[triangle] = false; });
      grown_.resize(first);
      plane = grow(seed, true);
    }
    groups_.push_back({plane.normal(), plane.offset(), static_cast<uint32_t>(first),
                       static_cast<uint32_t>(grown_.size() - first)});
  }

  /// Returns the groups in order of their first triangle, and the triangles of each in order.
  FacetGroups in_order() const {
    constexpr uint32_t none = 0xFFFFFFFFu;
    std::vector<uint32_t> group_of(grown_.size()), place_of(groups_.size(), none);
    for (uint32_t group = 0; group < groups_.size(); ++group)
      for (uint32_t i = 0; i < groups_[group].count; ++i) group_of[grown_[groups_[group].first + i]] = group;
    FacetGroups result;
    result.groups.reserve(groups_.size());
    uint32_t first = 0;
    for (const uint32_t group : group_of) {
      if (place_of[group] != none) continue;
      place_of[group] = static_cast<uint32_t>(result.groups.size());
      result.groups.push_back(groups_[group]);
      result.groups.back().first = first;
      first += std::exchange(result.groups.back().count, 0);
    }
    result.triangles.resize(grown_.size());
    for (uint32_t triangle = 0; triangle < group_of.size(); ++triangle) {
      FacetGroup& group = result.groups[place_of[group_of[triangle]]];
      result.triangles[group.first + group.count++] = triangle;
    }
    return result;
  }

  const FacetInput& input_;
  const BuildOptions& options_;
  uint32_t crowd_;
  EdgeTable edges_;
  std::vector<Triangle> triangles_;
  std::vector<uint8_t> taken_;
  std::unordered_map<uint32_t, Fan> fans_;  ///< by EdgeTable::Edge::first
  std::vector<uint32_t> near_;
  uint64_t changes_ = 0;  ///< number of changes of the growing plane and of taken_
  /// Triangles of one group after the other, in the order in which they joined.
  std::vector<uint32_t> grown_;
  std::vector<FacetGroup> groups_;  ///< in the order in which they grew, with ranges into grown_
};

}  // namespace

FacetGroups merge_coplanar(const FacetInput& input, const BuildOptions& options, uint32_t crowd) {
  GREATX_CHECK(input.corners.size() == input.vertices.size() && input.corners.size() % 3 == 0,
               "{} corners, {} vertices", input.corners.size(), input.vertices.size());
  return Merger(input, options, crowd).run();
}

}  // namespace greatx::scene
