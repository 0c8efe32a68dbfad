// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/search/beam_scene.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "core/error.h"

namespace greatx::rf {
namespace {

/// Describes a corner of a triangle before it is welded.
struct Corner {
  dvec3 position{0.0};
  uint32_t body = 0;
  uint32_t place = 0;  ///< 3 * triangle + corner
};

bool same_place(const Corner& a, const Corner& b) { return a.body == b.body && a.position == b.position; }

/// Numbers the positions of corners: equal coordinates of one body are one vertex, because the traced mesh
/// has no gap there. Corners that are merely near each other are not welded.
std::vector<uint32_t> weld(std::vector<Corner>& corners, std::vector<dvec3>& vertices) {
  std::sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) {
    return std::tie(a.body, a.position.x, a.position.y, a.position.z, a.place) <
           std::tie(b.body, b.position.x, b.position.y, b.position.z, b.place);
  });
  std::vector<uint32_t> vertex_of(corners.size());
  for (size_t i = 0; i < corners.size(); ++i) {
    if (i == 0 || !same_place(corners[i - 1], corners[i])) vertices.push_back(corners[i].position);
    vertex_of[corners[i].place] = static_cast<uint32_t>(vertices.size() - 1);
  }
  return vertex_of;
}

/// Holds convex pieces of a facet and joins them.
class Pieces {
 public:
  /// `normal` is the normal of their plane. `vertices` holds all positions.
  Pieces(const std::vector<dvec3>& vertices, const dvec3& normal) : vertices_(vertices), normal_(normal) {}
  void add(std::array<uint32_t, 3> triangle) {
    const double doubled = turn(triangle[0], triangle[1], triangle[2]);
    if (doubled < 0.0) std::swap(triangle[1], triangle[2]);
    loops_.emplace_back(triangle.begin(), triangle.end());
  }
  /// Joins pieces across edges that belong to exactly two of them, as long as the result is convex (S.
  /// Hertel, K. Mehlhorn, 1983).
  void join();
  const std::vector<std::vector<uint32_t>>& loops() const { return loops_; }

 private:
  double turn(uint32_t a, uint32_t b, uint32_t c) const {
    return glm::dot(normal_, glm::cross(vertices_[b] - vertices_[a], vertices_[c] - vertices_[b]));
  }
  uint32_t owner(uint32_t loop) {
    while (owner_[loop] != loop) loop = owner_[loop] = owner_[owner_[loop]];
    return loop;
  }
  void try_to_join(uint32_t first, uint32_t second, uint32_t from, uint32_t to);

  const std::vector<dvec3>& vertices_;
  dvec3 normal_;
  std::vector<std::vector<uint32_t>> loops_;
  std::vector<uint32_t> owner_;
};

void Pieces::join() {
  std::map<std::pair<uint32_t, uint32_t>, std::vector<uint32_t>> edges;  // directed
  for (uint32_t loop = 0; loop < loops_.size(); ++loop)
    for (size_t i = 0; i < 3; ++i) edges[{loops_[loop][i], loops_[loop][(i + 1) % 3]}].push_back(loop);
  owner_.resize(loops_.size());
  std::iota(owner_.begin(), owner_.end(), 0u);
  for (const auto& [edge, loops] : edges) {
    if (edge.first >= edge.second || loops.size() != 1) continue;
    const auto back = edges.find({edge.second, edge.first});
    if (back == edges.end() || back->second.size() != 1) continue;
    const uint32_t first = owner(loops[0]), second = owner(back->second[0]);
    if (first != second) try_to_join(first, second, edge.first, edge.second);
  }
  std::erase_if(loops_, [](const std::vector<uint32_t>& loop) { return loop.empty(); });
}

/// Joins two pieces. `first` follows the edge from `from` to `to`, and `second` follows it back.
void Pieces::try_to_join(uint32_t first, uint32_t second, uint32_t from, uint32_t to) {
  if (loops_[first].size() + loops_[second].size() - 2 > BeamPolygon::most_corners) return;
  const auto opened = [&](const std::vector<uint32_t>& loop, uint32_t start) {  // once around from `start`
    std::vector<uint32_t> turned(loop);
    std::rotate(turned.begin(), std::find(turned.begin(), turned.end(), start), turned.end());
    return turned;
  };
  std::vector<uint32_t> joined = opened(loops_[first], to);         // to ... from
  const std::vector<uint32_t> rest = opened(loops_[second], from);  // from ... to
  joined.insert(joined.end(), rest.begin() + 1, rest.end() - 1);
  const size_t count = joined.size();
  for (size_t i = 0; i < count; ++i) {
    const uint32_t a = joined[i], b = joined[(i + 1) % count], c = joined[(i + 2) % count];
    const bool ahead = glm::dot(vertices_[b] - vertices_[a], vertices_[c] - vertices_[b]) > 0.0;
    if (const double turned = turn(a, b, c); turned < 0.0 || (turned == 0.0 && !ahead)) return;
  }
  loops_[first] = std::move(joined);
  loops_[second].clear();
  owner_[second] = first;
}

/// Appends, in ascending order, the boxes that are not outside any of the half-spaces.
template <typename BoundsOf>
void gather_boxes(const scene::BoxTree& tree, std::span<const HalfSpace> region, const BoundsOf& bounds_of,
                  std::vector<uint32_t>& found) {
  const auto outside = [&](const scene::Bounds& box) {
    return std::any_of(region.begin(), region.end(), [&](const HalfSpace& half) {
      const double most = std::max(half.normal.x * box.min.x, half.normal.x * box.max.x) +
                          std::max(half.normal.y * box.min.y, half.normal.y * box.max.y) +
                          std::max(half.normal.z * box.min.z, half.normal.z * box.max.z);
      return most < half.offset;
    });
  };
  const size_t begin = found.size();
  tree.visit_until(outside, [&](uint32_t index) {
    if (!outside(bounds_of(index))) found.push_back(index);
    return false;
  });
  std::sort(found.begin() + static_cast<ptrdiff_t>(begin), found.end());
}

}  // namespace

BeamScene::BeamScene(const FacetWorld& world, const FacetKinds& kinds, std::span<const scene::Wedge> wedges,
                     bool moving_bodies)
    : world_(&world) {
  GREATX_CHECK(kinds.size() == world.facet_count(), "kinds of {} facets, the world has {}", kinds.size(),
               world.facet_count());
  std::vector<Corner> corners;
  std::vector<uint32_t> taken;
  for (uint32_t index = 0; index < world.facet_count(); ++index) {
    const PosedFacet& facet = world.facet(index);
    if (kinds[index] == FacetKind::foliage || kinds[index] == FacetKind::absent) continue;
    if (facet.body != 0 && !moving_bodies) continue;
    if (facet.triangle_count == 0) continue;
    taken.push_back(index);
    for (uint32_t t = 0; t < facet.triangle_count; ++t)
      for (const dvec3& corner : world.corners(index, t))
        corners.push_back({corner, facet.body, static_cast<uint32_t>(corners.size())});
  }
  const std::vector<uint32_t> vertex_of = weld(corners, vertices_);
  for (const dvec3& vertex : vertices_)
    largest_coordinate_ =
        std::max({largest_coordinate_, std::abs(vertex.x), std::abs(vertex.y), std::abs(vertex.z)});

  size_t place = 0;
  std::vector<std::array<uint32_t, 3>> triangles;
  for (const uint32_t index : taken) {
    triangles.resize(world.facet(index).triangle_count);
    for (std::array<uint32_t, 3>& triangle : triangles)
      for (uint32_t& vertex : triangle) vertex = vertex_of[place++];
    add(world, index, kinds[index], triangles);
  }
  index_of_.assign(world.facet_count(), none);
  for (uint32_t i = 0; i < facet_count(); ++i) index_of_[facets_[i].index] = i;
  add_wedges(wedges);
  std::vector<scene::Bounds> boxes;
  boxes.reserve(facets_.size());
  for (const BeamFacet& facet : facets_) boxes.push_back(facet.bounds);
  facet_tree_ = scene::BoxTree(boxes);
  polygon_bounds_.resize(polygons_.size());
  for (size_t i = 0; i < polygons_.size(); ++i)
    for (const uint32_t corner : this->corners(polygons_[i])) polygon_bounds_[i].add(vertices_[corner]);
  polygon_tree_ = scene::BoxTree(polygon_bounds_);
  wedge_bounds_.resize(wedges_.size());
  for (size_t i = 0; i < wedges_.size(); ++i)
    for (const dvec3& end : {wedges_[i].a, wedges_[i].b}) wedge_bounds_[i].add(end);
  wedge_tree_ = scene::BoxTree(wedge_bounds_);
}

void BeamScene::add(const FacetWorld& world, uint32_t index, FacetKind kind,
                    std::span<const std::array<uint32_t, 3>> triangles) {
  const PosedFacet& posed = world.facet(index);
  BeamFacet facet;
  facet.index = index;
  facet.kind = kind;
  facet.owner = posed.owner;
  facet.normal = posed.normal;
  facet.offset = posed.offset;
  facet.tolerance_m = posed.tolerance_m;
  facet.reference =
      posed.offset * posed.normal + posed.offset_u * posed.axis_u + posed.offset_v * posed.axis_v;
  facet.axis_a = posed.axis_u;
  add_polygons(facet, triangles);
  facet.axis_b = glm::cross(facet.normal, facet.axis_a);
  facet.offset_a = glm::dot(facet.axis_a, facet.reference);
  facet.offset_b = glm::dot(facet.axis_b, facet.reference);
  facet.min_a = facet.min_b = 1e300, facet.max_a = facet.max_b = -1e300;
  for (const BeamPolygon& polygon : polygons(facet))
    for (const uint32_t corner : corners(polygon)) {
      const dvec3 from_reference = vertices_[corner] - facet.reference;
      const double a = glm::dot(facet.axis_a, from_reference), b = glm::dot(facet.axis_b, from_reference);
      facet.min_a = std::min(facet.min_a, a), facet.max_a = std::max(facet.max_a, a);
      facet.min_b = std::min(facet.min_b, b), facet.max_b = std::max(facet.max_b, b);
    }
  facets_.push_back(facet);
}

void BeamScene::add_polygons(BeamFacet& facet, std::span<const std::array<uint32_t, 3>> triangles) {
  Pieces pieces(vertices_, facet.normal);
  for (const auto& triangle : triangles) pieces.add(triangle);
  pieces.join();
  facet.first_polygon = static_cast<uint32_t>(polygons_.size());
  double longest = 0.0;
  for (const std::vector<uint32_t>& loop : pieces.loops()) {
    polygons_.push_back({static_cast<uint32_t>(corners_.size()), static_cast<uint32_t>(loop.size()),
                         static_cast<uint32_t>(facets_.size())});
    for (size_t i = 0; i < loop.size(); ++i) {
      const dvec3 &from = vertices_[loop[i]], &to = vertices_[loop[(i + 1) % loop.size()]];
      corners_.push_back(loop[i]);
      facet.bounds.add(from);
      const dvec3 along = (to - from) - glm::dot(to - from, facet.normal) * facet.normal;
      if (const double length = glm::length(along); length > longest) {
        longest = length;
        facet.axis_a = along / length;
      }
    }
  }
  facet.polygon_count = static_cast<uint32_t>(polygons_.size()) - facet.first_polygon;
}

void BeamScene::add_wedges(std::span<const scene::Wedge> wedges) {
  for (uint32_t index = 0; index < wedges.size(); ++index) {
    const scene::Wedge& wedge = wedges[index];
    BeamWedge made{wedge.a, wedge.b, index};
    if (wedge.facet_0 != scene::no_facet) made.faces[0] = index_of(wedge.facet_0);
    if (wedge.facet_n != scene::no_facet) made.faces[1] = index_of(wedge.facet_n);
    if (made.faces[0] > made.faces[1]) std::swap(made.faces[0], made.faces[1]);
    if (made.faces[0] == ~0u) continue;
    if (wedge.body != 0) {
      const Pose& pose = world_->motion(wedge.body).pose;
      made.a = pose.apply(wedge.a), made.b = pose.apply(wedge.b);
    }
    wedges_.push_back(made);
  }
  std::stable_sort(wedges_.begin(), wedges_.end(),
                   [](const BeamWedge& a, const BeamWedge& b) { return a.faces[0] < b.faces[0]; });
}

void BeamScene::gather(std::span<const HalfSpace> region, std::vector<uint32_t>& facets) const {
  gather_boxes(
      facet_tree_, region, [&](uint32_t facet) { return facets_[facet].bounds; }, facets);
}

void BeamScene::gather_polygons(std::span<const HalfSpace> region, std::vector<uint32_t>& polygons) const {
  gather_boxes(
      polygon_tree_, region, [&](uint32_t polygon) { return polygon_bounds_[polygon]; }, polygons);
}

void BeamScene::gather_wedges(std::span<const HalfSpace> region, std::vector<uint32_t>& wedges) const {
  gather_boxes(
      wedge_tree_, region, [&](uint32_t wedge) { return wedge_bounds_[wedge]; }, wedges);
}

}  // namespace greatx::rf
