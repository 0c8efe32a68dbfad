// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/search/beam_scene.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "core/error.h"

namespace greatx::rf {
namespace {

constexpr double least_sine = 0.1;
constexpr uint32_t facets_per_box = 4;

/// A corner of a triangle on its way to being welded.
struct Corner {
  dvec3 position{0.0};
  uint32_t body = 0;
  uint32_t place = 0;  ///< 3 * triangle + corner
};

bool same_place(const Corner& a, const Corner& b) { return a.body == b.body && a.position == b.position; }

/// Numbers the places that corners stand at: equal coordinates of one body are one vertex, for the mesh that is traced
/// has no gap there. Corners that merely stand near each other are not welded.
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

/// A side of a triangle, turned so that the triangle is on its left as the facet's normal sees it.
struct Side {
  uint32_t low, high;  ///< vertices
  bool upwards;        ///< from low to high
  bool certain;        ///< the triangle knows which side of it is which
};

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
    if (kinds[index] == FacetKind::foliage || (facet.body != 0 && !moving_bodies)) continue;
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
  number_edges();
  list_vertices();
  add_wedges(wedges);
  order_.resize(facets_.size());
  std::iota(order_.begin(), order_.end(), 0u);
  boxes_.reserve(facets_.size() + 1);
  boxes_.emplace_back();
  build_boxes(0, 0, facet_count());
}

void BeamScene::add(const FacetWorld& world, uint32_t index, FacetKind kind,
                    std::span<const std::array<uint32_t, 3>> triangles) {
  const PosedFacet& posed = world.facet(index);
  BeamFacet facet;
  facet.index = index;
  facet.kind = kind;
  facet.body = posed.body;
  facet.normal = posed.normal;
  facet.offset = posed.offset;
  facet.tolerance_m = posed.tolerance_m;
  facet.reference =
      posed.offset * posed.normal + posed.offset_u * posed.axis_u + posed.offset_v * posed.axis_v;
  facet.first_border = static_cast<uint32_t>(borders_.size());
  facet.low = dvec3(1e300), facet.high = dvec3(-1e300);

  std::vector<Side> sides;
  for (const auto& triangle : triangles) {
    const dvec3 corner[3] = {vertices_[triangle[0]], vertices_[triangle[1]], vertices_[triangle[2]]};
    const double doubled = glm::dot(posed.normal, glm::cross(corner[1] - corner[0], corner[2] - corner[0]));
    double longest = 0.0;
    for (int k = 0; k < 3; ++k) {
      longest = std::max(longest, glm::length(corner[(k + 1) % 3] - corner[k]));
      facet.low = glm::min(facet.low, corner[k]);
      facet.high = glm::max(facet.high, corner[k]);
      facet.deviation_m = std::max(facet.deviation_m, std::abs(posed.distance(corner[k])));
    }
    const bool certain = std::abs(doubled) > 1e-9 * longest * longest;
    for (int k = 0; k < 3; ++k) {
      const uint32_t from = triangle[k], to = triangle[(k + 1) % 3];
      if (from == to) continue;
      sides.push_back({std::min(from, to), std::max(from, to), (from < to) == (doubled > 0.0), certain});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.upwards, a.certain) < std::tie(b.low, b.high, b.upwards, b.certain);
  });
  for (size_t first = 0; first < sides.size();) {
    size_t end = first + 1;
    while (end < sides.size() && sides[end].low == sides[first].low && sides[end].high == sides[first].high)
      ++end;
    const Side& side = sides[first];
    const size_t uses = end - first;
    const bool inner =
        uses == 2 && side.upwards != sides[first + 1].upwards && side.certain && sides[first + 1].certain;
    if (!inner)
      borders_.push_back({0, side.upwards ? side.low : side.high, side.upwards ? side.high : side.low});
    if (!inner && (uses > 1 || !side.certain)) facet.regular = false;
    first = end;
  }
  facet.border_count = static_cast<uint32_t>(borders_.size()) - facet.first_border;

  facet.axis_a = posed.axis_u;
  double longest = 0.0;
  for (const BeamBorder& border : borders(facet)) {
    dvec3 along = vertices_[border.to] - vertices_[border.from];
    along -= glm::dot(along, facet.normal) * facet.normal;
    if (const double length = glm::length(along); length > longest) {
      longest = length;
      facet.axis_a = along / length;
    }
  }
  facet.axis_b = glm::cross(facet.normal, facet.axis_a);
  facet.offset_a = glm::dot(facet.axis_a, facet.reference);
  facet.offset_b = glm::dot(facet.axis_b, facet.reference);
  facet.min_a = facet.min_b = 1e300, facet.max_a = facet.max_b = -1e300;
  for (const BeamBorder& border : borders(facet)) {
    const dvec3 from_reference = vertices_[border.from] - facet.reference;
    const double a = glm::dot(facet.axis_a, from_reference), b = glm::dot(facet.axis_b, from_reference);
    facet.min_a = std::min(facet.min_a, a), facet.max_a = std::max(facet.max_a, a);
    facet.min_b = std::min(facet.min_b, b), facet.max_b = std::max(facet.max_b, b);
  }
  facets_.push_back(facet);
}

void BeamScene::add_wedges(std::span<const scene::Wedge> wedges) {
  std::vector<uint32_t> facet_of(world_->facet_count(), ~0u);
  for (uint32_t i = 0; i < facet_count(); ++i) facet_of[facets_[i].index] = i;
  for (uint32_t index = 0; index < wedges.size(); ++index) {
    const scene::Wedge& wedge = wedges[index];
    BeamWedge made{wedge.a, wedge.b, index};
    if (wedge.facet_0 != scene::no_facet) made.faces[0] = facet_of[wedge.facet_0];
    if (wedge.facet_n != scene::no_facet) made.faces[1] = facet_of[wedge.facet_n];
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
  for (uint32_t i = 0; i < wedges_.size(); ++i) {
    BeamFacet& facet = facets_[wedges_[i].faces[0]];
    if (facet.wedge_count++ == 0) facet.first_wedge = i;
  }
}

void BeamScene::number_edges() {
  std::vector<uint32_t> order(borders_.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto ends = [&](uint32_t border) -> std::pair<uint32_t, uint32_t> {
    return std::minmax(borders_[border].from, borders_[border].to);
  };
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    const auto ends_a = ends(a), ends_b = ends(b);
    return ends_a != ends_b ? ends_a < ends_b : a < b;
  });
  uint32_t edge = 0;
  for (size_t i = 0; i < order.size(); ++i) {
    if (i > 0 && ends(order[i]) != ends(order[i - 1])) ++edge;
    borders_[order[i]].edge = edge;
  }
}

void BeamScene::list_vertices() {
  first_facet_vertex_.push_back(0);
  for (const BeamFacet& facet : facets_) {
    const auto begin = static_cast<ptrdiff_t>(facet_vertices_.size());
    for (const BeamBorder& border : borders(facet)) {
      facet_vertices_.push_back(border.from);
      facet_vertices_.push_back(border.to);
    }
    std::sort(facet_vertices_.begin() + begin, facet_vertices_.end());
    facet_vertices_.erase(std::unique(facet_vertices_.begin() + begin, facet_vertices_.end()),
                          facet_vertices_.end());
    first_facet_vertex_.push_back(static_cast<uint32_t>(facet_vertices_.size()));
  }
}

void BeamScene::build_boxes(uint32_t node, uint32_t first, uint32_t count) {
  Box box;
  dvec3 low(1e300), high(-1e300);  // of the centres
  for (uint32_t i = first; i < first + count; ++i) {
    const BeamFacet& facet = facets_[order_[i]];
    box.low = glm::min(box.low, facet.low);
    box.high = glm::max(box.high, facet.high);
    low = glm::min(low, facet.low + facet.high);
    high = glm::max(high, facet.low + facet.high);
  }
  box.first = first, box.count = count;
  if (count > facets_per_box) {
    const dvec3 size = high - low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto begin = order_.begin() + first;
    std::nth_element(begin, begin + count / 2, begin + count, [&](uint32_t a, uint32_t b) {
      const double at_a = facets_[a].low[axis] + facets_[a].high[axis];
      const double at_b = facets_[b].low[axis] + facets_[b].high[axis];
      return at_a != at_b ? at_a < at_b : a < b;
    });
    box.first = static_cast<uint32_t>(boxes_.size()), box.count = 0;
    boxes_.resize(boxes_.size() + 2);
    build_boxes(box.first, first, count / 2);
    build_boxes(box.first + 1, first + count / 2, count - count / 2);
  }
  boxes_[node] = box;
}

bool BeamScene::has_vertex(uint32_t facet, uint32_t vertex) const {
  const auto begin = facet_vertices_.begin();
  return std::binary_search(begin + first_facet_vertex_[facet], begin + first_facet_vertex_[facet + 1],
                            vertex);
}

bool BeamScene::meet_at_an_angle(uint32_t a, uint32_t b) const {
  const dvec3 sine = glm::cross(facets_[a].normal, facets_[b].normal);
  if (glm::dot(sine, sine) < least_sine * least_sine) return false;
  const uint32_t* at_a = facet_vertices_.data() + first_facet_vertex_[a];
  const uint32_t* at_b = facet_vertices_.data() + first_facet_vertex_[b];
  const uint32_t* const end_a = facet_vertices_.data() + first_facet_vertex_[a + 1];
  const uint32_t* const end_b = facet_vertices_.data() + first_facet_vertex_[b + 1];
  while (at_a != end_a && at_b != end_b) {
    if (*at_a == *at_b) return true;
    if (*at_a < *at_b)
      ++at_a;
    else
      ++at_b;
  }
  return false;
}

void BeamScene::gather(std::span<const HalfSpace> region, std::vector<uint32_t>& facets) const {
  const auto outside = [&](const dvec3& low, const dvec3& high) {
    return std::any_of(region.begin(), region.end(), [&](const HalfSpace& half) {
      const double most = std::max(half.normal.x * low.x, half.normal.x * high.x) +
                          std::max(half.normal.y * low.y, half.normal.y * high.y) +
                          std::max(half.normal.z * low.z, half.normal.z * high.z);
      return most < half.offset;
    });
  };
  const size_t begin = facets.size();
  std::vector<uint32_t> stack{0};
  while (!stack.empty()) {
    const Box& box = boxes_[stack.back()];
    stack.pop_back();
    if (outside(box.low, box.high)) continue;
    if (box.count == 0 && box.first != 0) {
      stack.push_back(box.first);
      stack.push_back(box.first + 1);
      continue;
    }
    for (uint32_t i = box.first; i < box.first + box.count; ++i)
      if (!outside(facets_[order_[i]].low, facets_[order_[i]].high)) facets.push_back(order_[i]);
  }
  std::sort(facets.begin() + static_cast<ptrdiff_t>(begin), facets.end());
}

}  // namespace greatx::rf
