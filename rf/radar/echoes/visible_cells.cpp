// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/echoes/visible_cells.h"

#include <algorithm>
#include <array>
#include <optional>

namespace greatx::rf {
namespace {

constexpr double nearest_m = 1e-5;   ///< distance from the source below which nothing is seen
constexpr double same_reach = 1e-9;  ///< relative difference below which two distances are the same

/// Holds a piece after cuts by two planes, each of which adds at most one corner.
struct SpaceCorners {
  std::array<dvec3, FacetTrees::most_corners + 2> points;
  uint32_t count = 0;
  SpaceCorners() {}
};

/// Keeps the part where normal . x + offset >= 0.
void cut(SpaceCorners& corners, const dvec3& normal, double offset) {
  double least = 1e300;
  for (uint32_t i = 0; i < corners.count; ++i)
    least = std::min(least, glm::dot(normal, corners.points[i]) + offset);
  if (least >= 0.0) return;
  SpaceCorners kept;
  for (uint32_t i = 0; i < corners.count; ++i) {
    const dvec3 &a = corners.points[i], &b = corners.points[i + 1 < corners.count ? i + 1 : 0];
    const double at_a = glm::dot(normal, a) + offset, at_b = glm::dot(normal, b) + offset;
    if (at_a >= 0.0) kept.points[kept.count++] = a;
    if (((at_a > 0.0 && at_b < 0.0) || (at_a < 0.0 && at_b > 0.0)) && kept.count < kept.points.size())
      kept.points[kept.count++] = a + (b - a) * (at_a / (at_a - at_b));
  }
  corners = kept;
}

/// Holds the half-spaces outside which the beam sees nothing: those of around(), and what is in front of the
/// source.
class SeenSpace {
 public:
  SeenSpace(const TubeBeam& beam, std::span<const KeptSide> sides) : count_(sides.size() + 1) {
    std::copy(sides.begin(), sides.end(), sides_.begin());
    sides_[count_ - 1] = {beam.axis, -glm::dot(beam.axis, beam.source) - nearest_m};
    for (size_t i = 0; i < count_; ++i) lengths_[i] = glm::length(sides_[i].normal);
  }
  /// Returns whether all corners of a piece within `ball` are outside the same half-space. seen() would
  /// return an empty polygon for it.
  bool without(const FacetTrees::Ball& ball) const {
    for (size_t i = 0; i < count_; ++i)
      if (glm::dot(sides_[i].normal, ball.center) + sides_[i].offset < -ball.radius * lengths_[i])
        return true;
    return false;
  }

 private:
  size_t count_;
  std::array<KeptSide, 6> sides_;
  std::array<double, 6> lengths_;
};

/// Holds the half-planes whose intersection is a polygon.
struct Cover {
  std::array<dvec2, Polygon::capacity> normals;
  std::array<double, Polygon::capacity> offsets;
  uint32_t count = 0;
  explicit Cover(const Polygon& polygon) : count(polygon.size()) {
    for (uint32_t i = 0; i < count; ++i) {
      const HalfPlane side = polygon.inside(i);
      normals[i] = side.normal, offsets[i] = side.offset;
    }
  }
  /// Returns the sides that cut `part`, one bit each, or nullopt if all of the part is outside.
  std::optional<uint32_t> cutting(const Polygon& part) const {
    uint32_t cuts = 0;
    for (uint32_t side = 0; side < count; ++side) {
      double least = 1e300, most = -1e300;
      for (uint32_t i = 0; i < part.size(); ++i) {
        const double at = glm::dot(normals[side], part[i]) + offsets[side];
        least = std::min(least, at), most = std::max(most, at);
      }
      if (most <= 0.0) return std::nullopt;
      if (least < 0.0) cuts |= 1u << side;
    }
    return cuts;
  }
};

/// Returns whether all corners of a piece lie in the plane of `facet` or on the side away from the beam's
/// source, so that the piece hides nothing of this facet.
bool behind_plane(const FacetWorld& world, const TubeBeam& beam, std::span<const dvec3> corners,
                  uint32_t facet) {
  if (facet == VisibleCell::nothing) return false;
  const PosedFacet& posed = world.facet(facet);
  const double side = posed.distance(beam.source) > 0.0 ? 1.0 : -1.0;
  return std::none_of(corners.begin(), corners.end(),
                      [&](const dvec3& corner) { return side * posed.distance(corner) > posed.tolerance_m; });
}

/// Compares the distances of the planes of two facets along the rays of a beam. The reach of a plane is s/c
/// with c linear in u and v, so that the rays along which one plane is nearer fill a half-plane.
class DistanceOrder {
 public:
  DistanceOrder(const TubeBeam& beam, const PosedFacet& facet, const PosedFacet& other)
      : facet_(beam, facet), other_(beam, other) {}
  /// Finds out whether the first facet is nearer or farther at corners of `part`.
  void look(const Polygon& part) {
    nearer_ = farther_ = false;
    for (uint32_t i = 0; i < part.size(); ++i) {
      const double reach = facet_.reach(part[i]), other = other_.reach(part[i]);
      nearer_ = nearer_ || reach < other * (1.0 - same_reach);
      farther_ = farther_ || other < reach * (1.0 - same_reach);
    }
  }
  bool nearer() const { return nearer_; }    ///< somewhere
  bool farther() const { return farther_; }  ///< somewhere
  /// Returns where the first facet is nearer.
  HalfPlane where() const {
    return {other_.s * facet_.normal - facet_.s * other_.normal,
            other_.s * facet_.offset - facet_.s * other_.offset};
  }

 private:
  struct Plane {
    double s, offset;
    dvec2 normal;
    Plane(const TubeBeam& beam, const PosedFacet& facet) {
      const double away = -facet.distance(beam.source), sign = away < 0.0 ? -1.0 : 1.0;
      s = sign * away, offset = sign * glm::dot(facet.normal, beam.axis);
      normal = sign * dvec2(glm::dot(facet.normal, beam.e1), glm::dot(facet.normal, beam.e2));
    }
    double reach(const dvec2& at) const {
      const double c = glm::dot(normal, at) + offset;
      return c > 0.0 ? s / c : 1e300;
    }
  };
  Plane facet_, other_;
  bool nearer_ = false, farther_ = false;
};

/// Reduces a polygon to its overlap with a cover. `rest` receives the remainder as convex pieces.
void divide(Polygon& part, const Cover& cover, uint32_t cuts, double smallest, std::vector<Polygon>& rest) {
  rest.clear();
  for (uint32_t side = 0; side < cover.count && !part.empty(); ++side) {
    if (((cuts >> side) & 1u) == 0) continue;
    const HalfPlane inside{cover.normals[side], cover.offsets[side]};
    const Polygon beyond = part.clipped({-inside.normal, -inside.offset});
    if (beyond.area() > smallest) rest.push_back(beyond);
    part = part.clipped(inside);
  }
}

/// Holds a piece of a facet as a beam sees it, and cuts it out of the parts that it hides.
class Hider {
 public:
  Hider(const FacetWorld& world, const TubeBeam& beam, const BeamStart& start, uint32_t facet,
        const Polygon& outline, double smallest)
      : world_(world),
        beam_(beam),
        start_(start),
        posed_(world.facet(facet)),
        cover_(outline),
        around_(outline),
        smallest_(smallest) {}
  /// Returns whether the piece may lie before a part with this box.
  bool meets(const PartBox& box) const { return around_.meets(box); }
  /// Reduces `part`, which falls on the facet `behind`, to where the piece is nearer. `rest` receives the
  /// remainder. Returns false if the piece is nowhere nearer; both are of no use then.
  bool take(Polygon& part, uint32_t behind, std::vector<Polygon>& rest) const {
    const std::optional<uint32_t> cuts = cover_.cutting(part);
    if (!cuts) return false;
    divide(part, cover_, *cuts, smallest_, rest);
    if (!(part.area() > smallest_) || !in_front(part.centroid())) return false;
    if (behind == VisibleCell::nothing) return true;
    DistanceOrder order(beam_, posed_, world_.facet(behind));
    order.look(part);
    if (!order.nearer()) return false;
    if (!order.farther()) return true;
    // The two facets pass through each other.
    const HalfPlane where = order.where();
    const Polygon farther = part.clipped({-where.normal, -where.offset});
    part = part.clipped(where);
    if (!(part.area() > smallest_)) return false;
    if (farther.area() > smallest_) rest.push_back(farther);
    return true;
  }

 private:
  bool in_front(const dvec2& at) const {
    const dvec3 direction = beam_.along(at);
    const double reach = beam_.reach(posed_, direction);
    return reach > 0.0 &&
           (start_.facet == nullptr || reach > beam_.reach(*start_.facet, direction) * (1.0 + 1e-12));
  }

  const FacetWorld& world_;
  const TubeBeam& beam_;
  const BeamStart& start_;
  const PosedFacet& posed_;
  Cover cover_;
  PartBox around_;
  double smallest_;
};

}  // namespace

BeamSpaces::BeamSpaces(const TubeBeam& beam, const BeamStart& start, const PartBox& box) {
  const auto side = [&](const dvec3& normal) { add({normal, -glm::dot(normal, beam.source)}); };
  side(beam.e1 - box.low.x * beam.axis), side(box.high.x * beam.axis - beam.e1);
  side(beam.e2 - box.low.y * beam.axis), side(box.high.y * beam.axis - beam.e2);
  if (start.facet != nullptr) add({start.side * start.facet->normal, -start.side * start.facet->offset});
}

Polygon seen(std::span<const dvec3> piece, const TubeBeam& beam, const BeamStart& start,
             const PartBox& within) {
  std::array<dvec2, FacetTrees::most_corners + 2> points;
  std::array<double, FacetTrees::most_corners> depths;
  uint32_t beyond = 15;  // sides of the box beyond which all corners lie
  double nearest = 1e300, lowest = 1e300;
  for (uint32_t i = 0; i < piece.size(); ++i) {
    const dvec3 arm = piece[i] - beam.source;
    const double x = glm::dot(arm, beam.e1), y = glm::dot(arm, beam.e2), z = glm::dot(arm, beam.axis);
    beyond &= (x < within.low.x * z ? 1u : 0u) | (x > within.high.x * z ? 2u : 0u) |
              (y < within.low.y * z ? 4u : 0u) | (y > within.high.y * z ? 8u : 0u);
    nearest = std::min(nearest, z);
    points[i] = {x, y};
    depths[i] = z;
    if (start.facet != nullptr) lowest = std::min(lowest, start.side * start.facet->distance(piece[i]));
  }
  if (beyond != 0) return {};
  if (nearest >= nearest_m && lowest >= 0.0) {
    for (uint32_t i = 0; i < piece.size(); ++i) points[i] /= depths[i];
    return Polygon(std::span(points.data(), piece.size()));
  }
  SpaceCorners corners;
  corners.count = static_cast<uint32_t>(piece.size());
  std::copy(piece.begin(), piece.end(), corners.points.begin());
  cut(corners, beam.axis, -glm::dot(beam.axis, beam.source) - nearest_m);
  if (start.facet != nullptr)
    cut(corners, start.side * start.facet->normal, -start.side * start.facet->offset);
  if (corners.count < 3) return {};
  PartBox box;
  for (uint32_t i = 0; i < corners.count; ++i) box.add(points[i] = beam.uv(corners.points[i]));
  if (!box.meets(within)) return {};
  return Polygon(std::span(points.data(), corners.count));
}

Polygon overlap(const Polygon& part, const Polygon& outline) {
  const Cover cover(outline);
  const std::optional<uint32_t> cuts = cover.cutting(part);
  if (!cuts) return Polygon(std::span<const dvec2>{});
  Polygon kept = part;
  for (uint32_t side = 0; side < cover.count && !kept.empty(); ++side)
    if (((*cuts >> side) & 1u) != 0) kept = kept.clipped({cover.normals[side], cover.offsets[side]});
  return kept;
}

bool covers(const FacetWorld& world, const FacetTrees& trees, const TubeBeam& beam, const BeamStart& start,
            const Polygon& part, uint32_t facet, VisibleScratch& scratch, const PosedFacet* covered) {
  if (covered != nullptr) {
    DistanceOrder order(beam, world.facet(facet), *covered);
    order.look(part);
    if (order.farther()) return false;
  }
  const PartBox box(part);
  trees.find(world, facet, BeamSpaces(beam, start, box).used(), scratch.indices);
  std::array<dvec3, FacetTrees::most_corners> room;
  for (const uint32_t piece : scratch.indices) {
    const Polygon outline = seen(trees.corners(world, facet, piece, room), beam, start, box);
    if (!outline.empty() && Cover(outline).cutting(part) == 0u) return true;
  }
  return false;
}

void find_visible(const FacetWorld& world, const FacetTrees& trees, const TubeBeam& beam,
                  const BeamStart& start, const Polygon& whole, std::span<const uint32_t> facets,
                  double smallest, VisibleScratch& scratch, std::vector<VisibleCell>& cells) {
  const BeamSpaces spaces(beam, start, PartBox(whole));
  scratch.pieces.clear();
  for (const uint32_t facet : facets) {
    trees.find(world, facet, spaces.used(), scratch.indices);
    for (const uint32_t piece : scratch.indices) scratch.pieces.push_back({facet, piece});
  }
  find_visible(world, trees, beam, start, whole, VisibleCell::nothing, scratch.pieces, smallest, scratch,
               cells);
}

void find_visible(const FacetWorld& world, const FacetTrees& trees, const TubeBeam& beam,
                  const BeamStart& start, const Polygon& whole, uint32_t at_first,
                  std::span<const FacetPiece> pieces, double smallest, VisibleScratch& scratch,
                  std::vector<VisibleCell>& cells) {
  cells.clear();
  const auto add_cell = [&](const Polygon& part, uint32_t facet) {
    VisibleCell& cell = cells.emplace_back();
    cell.part = part, cell.facet = facet;
    scratch.boxes.emplace_back(part);
  };
  scratch.boxes.clear();
  add_cell(whole, at_first);
  const PartBox within(whole);
  const BeamSpaces spaces(beam, start, within);
  const SeenSpace space(beam, spaces.used());
  std::array<dvec3, FacetTrees::most_corners> room;
  for (const auto& [facet, piece] : pieces) {
    if (facet == start.index || facet == at_first || space.without(trees.ball(world, facet, piece))) continue;
    const std::span<const dvec3> corners = trees.corners(world, facet, piece, room);
    if (cells.size() == 1 && behind_plane(world, beam, corners, cells[0].facet)) continue;
    const Polygon outline = seen(corners, beam, start, within);
    if (outline.empty()) continue;
    const Hider hider(world, beam, start, facet, outline, smallest);
    const size_t before = cells.size();
    for (size_t i = 0; i < before; ++i) {
      const uint32_t behind = cells[i].facet;
      if (behind == facet || !hider.meets(scratch.boxes[i]) ||
          (before > 1 && behind_plane(world, beam, corners, behind)))
        continue;
      Polygon nearer = cells[i].part;
      if (!hider.take(nearer, behind, scratch.rest)) continue;
      cells[i].part = nearer, cells[i].facet = facet;
      scratch.boxes[i] = PartBox(nearer);
      for (const Polygon& rest : scratch.rest) add_cell(rest, behind);
    }
  }
}

void find_unhidden(const FacetWorld& world, const FacetTrees& trees, const TubeBeam& beam,
                   const BeamStart& start, const Polygon& whole, uint32_t own,
                   std::span<const FacetPiece> pieces, double smallest, VisibleScratch& scratch,
                   std::vector<Polygon>& parts) {
  parts.assign(1, whole);
  std::vector<PartBox>& boxes = scratch.boxes;
  boxes.assign(1, PartBox(whole));
  const PartBox within = boxes[0];
  const BeamSpaces spaces(beam, start, within);
  const SeenSpace space(beam, spaces.used());
  std::array<dvec3, FacetTrees::most_corners> room;
  for (const auto& [facet, piece] : pieces) {
    if (facet == start.index || facet == own || space.without(trees.ball(world, facet, piece))) continue;
    const std::span<const dvec3> corners = trees.corners(world, facet, piece, room);
    if (behind_plane(world, beam, corners, own)) continue;
    const Polygon outline = seen(corners, beam, start, within);
    if (outline.empty()) continue;
    const Hider hider(world, beam, start, facet, outline, smallest);
    const size_t before = parts.size();
    size_t kept = 0;  // of those before
    for (size_t i = 0; i < before; ++i) {
      Polygon nearer = parts[i];
      if (hider.meets(boxes[i]) && hider.take(nearer, own, scratch.rest)) {
        for (const Polygon& rest : scratch.rest) parts.push_back(rest), boxes.emplace_back(rest);
        continue;
      }
      if (kept != i) parts[kept] = parts[i], boxes[kept] = boxes[i];
      ++kept;
    }
    parts.erase(parts.begin() + kept, parts.begin() + before);
    boxes.erase(boxes.begin() + kept, boxes.begin() + before);
    if (parts.empty()) return;
  }
}

}  // namespace greatx::rf
