// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/echoes/echo_tracer.h"

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/error.h"
#include "core/largest.h"
#include "core/parallel.h"
#include "rf/radar/signal/lanes.h"
#include "shaders/shared/radar.h"

namespace greatx::rf {
namespace {

constexpr uint32_t tubes_at_once = 256;
/// Distance by which a reflected ray starts away from its surface, as a fraction of the largest coordinate.
/// lib/trace.glsl uses the same value. A facet that lies in the same plane, except for the rounding of its
/// fp32 corners, is then not met.
constexpr double lift = 4.2e-7;
/// Length by which cones are followed past the farthest point of a body, metres.
constexpr double past_m = 1e-3;
/// Fraction of a coordinate by which balls are widened, sixteen times the rounding error of fp32.
constexpr double fp32_share = 1e-6;

using Lane [[gnu::vector_size(32), gnu::may_alias]] = float;
using Bits [[gnu::vector_size(32), gnu::may_alias]] = int32_t;

/// Returns one bit for each lane that is not 0.
inline uint32_t mask_of(const Bits& lanes) {
#if defined(__SSE2__)
  const __m128* halves = reinterpret_cast<const __m128*>(&lanes);
  return static_cast<uint32_t>(_mm_movemask_ps(halves[0]) | (_mm_movemask_ps(halves[1]) << 4));
#else
  uint32_t mask = 0;
  for (int k = 0; k < 8; ++k) mask |= (static_cast<uint32_t>(lanes[k]) & 1u) << k;
  return mask;
#endif
}

}  // namespace

inline void EchoTracer::test(const Piece* pieces, uint32_t index, const Side* sides, Query& query) {
  const Piece& piece = pieces[index];
  if (piece.facet == query.leaving) return;
  const double towards = glm::dot(piece.normal, query.direction);
  const double t = (piece.offset - glm::dot(piece.normal, query.origin)) / towards;
  if (!(t > 0.0 && t <= query.nearest) || (t == query.nearest && piece.facet >= query.facet)) return;
  const dvec3 at = query.origin + t * query.direction;
  for (uint32_t i = 0; i < piece.side_count; ++i) {
    const Side& side = sides[piece.first_side + i];
    if (glm::dot(side.normal, at) + side.offset < -piece.room) return;
  }
  query.nearest = t, query.facet = piece.facet, query.piece = index;
}

GREATX_LANES void EchoTracer::meet(const Node* nodes, const Piece* pieces, const Side* sides, uint32_t root,
                                   Query& query) {
  struct Entry {
    uint32_t node;
    float at;
  };
  std::array<Entry, 256> stack;
  uint32_t depth = 0;
  float origin[3], inverse[3];
  uint32_t far[3];  // the end of a box by which the ray leaves
  for (int axis = 0; axis < 3; ++axis) {
    const double d = query.direction[axis];
    origin[axis] = static_cast<float>(query.origin[axis]);
    inverse[axis] = static_cast<float>(1.0 / (std::abs(d) < 1e-20 ? 1e-20 : d));
    far[axis] = inverse[axis] > 0.0f ? 1u : 0u;
  }
  stack[depth++] = {root, 0.0f};
  while (depth > 0) {
    const Entry entry = stack[--depth];
    if (entry.at > query.nearest) continue;
    const Node& node = nodes[entry.node];
    Lane in{}, out = in + static_cast<float>(query.nearest) * 1.000001f;
    for (int axis = 0; axis < 3; ++axis) {
      const Lane* ends = reinterpret_cast<const Lane*>(node.box[axis]);
      const Lane low = (ends[1u - far[axis]] - origin[axis]) * inverse[axis];
      const Lane high = (ends[far[axis]] - origin[axis]) * inverse[axis];
      in = in > low ? in : low;
      out = out < high ? out : high;
    }
    uint32_t met = mask_of(in * 0.999998f <= out * 1.000002f);
    const uint32_t bottom = depth;
    for (; met != 0; met &= met - 1) {
      const uint32_t k = static_cast<uint32_t>(std::countr_zero(met));
      if (node.count[k] > 0) {
        for (uint32_t i = 0; i < node.count[k]; ++i) test(pieces, node.child[k] + i, sides, query);
        if (query.any && query.facet != ~0u) return;
        continue;
      }
      const float at = in[k];
      uint32_t place = depth++;  // the nearest child is tested first
      while (place > bottom && stack[place - 1].at < at) stack[place] = stack[place - 1], --place;
      stack[place] = {node.child[k], at};
    }
  }
}

EchoTracer::Poses EchoTracer::standing(const FacetWorld& world, const Hidden& hidden) const {
  Poses all;
  uint32_t owner = 0;  // of the last group
  for (const Tree& tree : trees_) {
    if (tree.body != 0 && (tree.owner == hidden[0] || tree.owner == hidden[1])) continue;
    Standing& one = all.trees.emplace_back();
    one.tree = &tree;
    if (tree.body != 0) {
      const Pose& pose = world.motion(tree.body).pose;
      const dvec3 size = tree.bounds.size();
      one.back = pose.inverse();
      one.center = pose.apply(tree.bounds.center());
      one.squared_radius = 0.25 * glm::dot(size, size);
    }
    if (all.groups.empty() || tree.body == 0 || all.groups.back().is_static || owner != tree.owner)
      all.groups.push_back({static_cast<uint32_t>(all.trees.size()) - 1, 0, tree.body == 0});
    ++all.groups.back().count;
    owner = tree.owner;
  }
  for (Group& group : all.groups) {
    if (group.is_static) continue;
    const std::span<const Standing> trees = std::span(all.trees).subspan(group.first, group.count);
    for (const Standing& one : trees) group.center += one.center / double(group.count);
    for (const Standing& one : trees)
      group.radius =
          std::max(group.radius, glm::distance(group.center, one.center) + std::sqrt(one.squared_radius));
    group.radius += 1e-9 * (group.radius + largest(group.center));  // more than the rounding errors
  }
  all.balls.resize((all.groups.size() + wide - 1) / wide);
  for (size_t i = 0; i < wide * all.balls.size(); ++i) {
    Poses::EightBalls& eight = all.balls[i / wide];
    const Group group = i < all.groups.size() ? all.groups[i] : Group{};
    eight.x.lane[i % wide] = static_cast<float>(group.center.x);
    eight.y.lane[i % wide] = static_cast<float>(group.center.y);
    eight.z.lane[i % wide] = static_cast<float>(group.center.z);
    eight.radius.lane[i % wide] = static_cast<float>(group.radius + fp32_share * largest(group.center));
  }
  return all;
}

void EchoTracer::meet_body(const Standing& one, double squared, Query& query) const {
  const dvec3 across = glm::cross(one.center - query.origin, query.direction);
  if (glm::dot(across, across) > one.squared_radius * squared) return;
  Query own = query;
  own.origin = one.back.apply(query.origin), own.direction = one.back.rotate(query.direction);
  meet(nodes_.data(), pieces_.data(), sides_.data(), one.tree->root, own);
  query.nearest = own.nearest;
  if (query.facet != own.facet) query.facet = own.facet, query.piece = Query::none;
}

/// Sets the bits of the balls, eight in each word of `near`, that the ray comes near. Everything is relative
/// to the origin of the ray.
GREATX_LANES void EchoTracer::near_balls(const Poses::EightBalls* balls, uint32_t count, const float* origin,
                                         const float* direction, float to, float slope, uint32_t* near) {
  const float squared =
                  direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2],
              share = static_cast<float>(fp32_share),
              room = share * std::max({std::abs(origin[0]), std::abs(origin[1]), std::abs(origin[2])});
  for (uint32_t i = 0; i < count; ++i) {
    const Lane x = *reinterpret_cast<const Lane*>(balls[i].x.lane) - origin[0],
               y = *reinterpret_cast<const Lane*>(balls[i].y.lane) - origin[1],
               z = *reinterpret_cast<const Lane*>(balls[i].z.lane) - origin[2],
               radius = *reinterpret_cast<const Lane*>(balls[i].radius.lane);
    const Lane cx = y * direction[2] - z * direction[1], cy = z * direction[0] - x * direction[2],
               cz = x * direction[1] - y * direction[0];
    // No shorter than the distance.
    const Lane longest = (x < 0.0f ? -x : x) + (y < 0.0f ? -y : y) + (z < 0.0f ? -z : z);
    Lane reach = longest + radius + 0.01f;
    reach = reach < to ? reach : Lane{} + to;
    const Lane most = radius + room + share * longest + reach * slope;
    near[i] = mask_of(cx * cx + cy * cy + cz * cz <= most * most * squared * 1.00001f);
  }
}

template <typename Visit>
void EchoTracer::near_groups(const Poses& poses, const dvec3& origin, const dvec3& direction, double to,
                             double slope, const Visit& visit) {
  constexpr uint32_t at_once = 32;
  for (const Group& group : poses.groups)
    if (group.is_static && visit(group)) return;
  const float from[3] = {static_cast<float>(origin.x), static_cast<float>(origin.y),
                         static_cast<float>(origin.z)},
              along[3] = {static_cast<float>(direction.x), static_cast<float>(direction.y),
                          static_cast<float>(direction.z)};
  std::array<uint32_t, at_once> near;
  const uint32_t count = static_cast<uint32_t>(poses.balls.size());
  for (uint32_t first = 0; first < count; first += at_once) {
    const uint32_t some = std::min(at_once, count - first);
    near_balls(poses.balls.data() + first, some, from, along, static_cast<float>(std::min(to, 1e30)),
               static_cast<float>(slope), near.data());
    for (uint32_t i = 0; i < some; ++i)
      for (uint32_t bits = near[i]; bits != 0; bits &= bits - 1) {
        const size_t group = size_t{wide} * (first + i) + std::countr_zero(bits);
        if (group < poses.groups.size() && !poses.groups[group].is_static && visit(poses.groups[group]))
          return;
      }
  }
}

void EchoTracer::meet_all(const Poses& poses, Query& query, uint32_t guess) const {
  const double squared = glm::dot(query.direction, query.direction);
  near_groups(poses, query.origin, query.direction, 1e30, 0.0, [&](const Group& group) {
    if (group.is_static) {
      if (guess != Query::none) test(pieces_.data(), guess, sides_.data(), query);
      meet(nodes_.data(), pieces_.data(), sides_.data(), poses.trees[group.first].tree->root, query);
      return query.any && query.facet != ~0u;
    }
    const dvec3 across = glm::cross(group.center - query.origin, query.direction);
    if (glm::dot(across, across) > group.radius * group.radius * squared) return false;
    for (uint32_t i = group.first; i < group.first + group.count; ++i) {
      meet_body(poses.trees[i], squared, query);
      if (query.any && query.facet != ~0u) return true;
    }
    return false;
  });
}

bool EchoTracer::sees(const Poses& poses, const dvec3& from, const dvec3& to, uint32_t leaving) const {
  Query query{from, to - from, 1.0, leaving, ~0u, true};
  meet_all(poses, query);
  return query.facet == ~0u;
}

EchoTracer::View EchoTracer::view(const FacetWorld& world, uint32_t hidden_owner, uint32_t another) const {
  View view;
  view.poses_ = standing(world, {hidden_owner, another});
  return view;
}

bool EchoTracer::clear(const View& view, const dvec3& from, const dvec3& to, uint32_t leaving) const {
  return sees(view.poses_, from, to, leaving);
}

GREATX_LANES void EchoTracer::gather(const Node* nodes, const Piece* pieces, uint32_t root, const Cone& cone,
                                     std::vector<FacetPiece>& found) {
  std::array<uint32_t, 256> stack;
  uint32_t depth = 0;
  float origin[3], inverse[3];
  uint32_t far[3];
  for (int axis = 0; axis < 3; ++axis) {
    const double d = cone.direction[axis];
    origin[axis] = static_cast<float>(cone.origin[axis]);
    inverse[axis] = static_cast<float>(1.0 / (std::abs(d) < 1e-20 ? 1e-20 : d));
    far[axis] = inverse[axis] > 0.0f ? 1u : 0u;
  }
  const Lane from = Lane{} + static_cast<float>(cone.from) * 0.999998f,
             to = Lane{} + static_cast<float>(cone.to) * 1.000002f;
  const float slope = static_cast<float>(cone.slope) * 1.000002f,
              room = static_cast<float>(1e-6 * (1.0 + largest(cone.origin)));
  struct Side {
    float normal[3], offset;
  };
  std::array<Side, most_sides> sides;
  for (size_t i = 0; i < cone.sides.size(); ++i) {
    const dvec3& n = cone.sides[i].normal;
    for (int axis = 0; axis < 3; ++axis) sides[i].normal[axis] = static_cast<float>(n[axis]);
    const double above = glm::dot(n, cone.origin) + cone.sides[i].offset;
    const dvec3 sizes = glm::abs(n);
    sides[i].offset = static_cast<float>(above + 4.0 * room * (sizes.x + sizes.y + sizes.z));
  }
  stack[depth++] = root;
  while (depth > 0) {
    const Node& node = nodes[stack[--depth]];
    Lane in = from, out = to;
    // The first pass takes the radius at the end of the cone, the second that where the cone leaves a box.
    for (int pass = 0; pass < 2; ++pass) {
      const Lane radius = out * slope + room;
      in = from, out = to;
      for (int axis = 0; axis < 3; ++axis) {
        const Lane* ends = reinterpret_cast<const Lane*>(node.box[axis]);
        const Lane wider = far[axis] ? radius : -radius;
        const Lane low = (ends[1u - far[axis]] - origin[axis] - wider) * inverse[axis];
        const Lane high = (ends[far[axis]] - origin[axis] + wider) * inverse[axis];
        in = in > low ? in : low;
        out = out < high ? out : high;
      }
      out = out > 0.0f ? out : Lane{};
      if (mask_of(in <= out) == 0) break;
    }
    uint32_t met = mask_of(in <= out);
    for (size_t i = 0; i < cone.sides.size() && met != 0; ++i) {
      Lane most = Lane{} + sides[i].offset;  // of the corner of each box farthest inside
      for (int axis = 0; axis < 3; ++axis) {
        const float n = sides[i].normal[axis];
        most += n * (reinterpret_cast<const Lane*>(node.box[axis])[n > 0.0f ? 1 : 0] - origin[axis]);
      }
      met &= mask_of(most >= 0.0f);
    }
    for (; met != 0; met &= met - 1) {
      const uint32_t k = static_cast<uint32_t>(std::countr_zero(met));
      if (node.count[k] == 0) stack[depth++] = node.child[k];
      for (uint32_t i = 0; i < node.count[k]; ++i) {
        const Piece& piece = pieces[node.child[k] + i];
        found.push_back({piece.facet, piece.index});
      }
    }
  }
}

void EchoTracer::gather(const Standing& one, const Cone& cone, double squared,
                        std::vector<FacetPiece>& pieces) const {
  std::array<KeptSide, most_sides> sides;
  Cone own = cone;
  const scene::Bounds& box = one.tree->bounds;
  if (one.tree->body != 0) {
    own.origin = one.back.apply(cone.origin), own.direction = one.back.rotate(cone.direction);
  }
  // No point of the body is farther away than `most`.
  const dvec3 arm = box.center() - own.origin;
  const double around = 0.5 * glm::length(box.size()), most = glm::length(arm) + around;
  own.to = std::min(cone.to, most + past_m);  // the axis is at least 1 m long a unit
  const double radius = own.to * cone.slope;
  if (one.tree->body != 0) {
    const dvec3 across = glm::cross(arm, own.direction);
    if (glm::dot(across, across) > (around + radius) * (around + radius) * squared) return;
    const Pose pose = one.back.inverse();
    for (size_t i = 0; i < cone.sides.size(); ++i) sides[i] = in_body(cone.sides[i], pose);
    own.sides = std::span(sides).first(cone.sides.size());
  }
  gather(nodes_.data(), pieces_.data(), one.tree->root, own, pieces);
}

void EchoTracer::gather(const View& view, const Cone& cone, std::vector<FacetPiece>& pieces) const {
  const double squared = glm::dot(cone.direction, cone.direction);
  GREATX_CHECK(cone.sides.size() <= most_sides, "{} half-spaces", cone.sides.size());
  near_groups(view.poses_, cone.origin, cone.direction, cone.to, cone.slope, [&](const Group& group) {
    if (!group.is_static) {
      // A body of the group that the cone comes near has its centre within `most` of the ball's.
      const dvec3 arm = group.center - cone.origin, across = glm::cross(arm, cone.direction);
      const double reach = std::min(cone.to, glm::length(arm) + group.radius + past_m),
                   most = (group.radius + reach * cone.slope) * (1.0 + 1e-9);
      if (glm::dot(across, across) > most * most * squared) return false;
    }
    for (uint32_t i = group.first; i < group.first + group.count; ++i)
      gather(view.poses_.trees[i], cone, squared, pieces);
    return false;
  });
  std::sort(pieces.begin(), pieces.end());
}

EchoTracer::Reach::Reach(const dvec3& from, const dvec3& along, double to_, double slope_)
    : origin{static_cast<float>(from.x), static_cast<float>(from.y), static_cast<float>(from.z)},
      direction{static_cast<float>(along.x), static_cast<float>(along.y), static_cast<float>(along.z)},
      to(static_cast<float>(std::min(to_, 1e30) * (1.0 + fp32_share))),
      slope(static_cast<float>(slope_ * (1.0 + fp32_share) + fp32_share)) {}

bool EchoTracer::moving_near(const View& view, const Reach& reach) const {
  const dvec3 origin(reach.origin[0], reach.origin[1], reach.origin[2]),
      direction(reach.direction[0], reach.direction[1], reach.direction[2]);
  const double length = glm::length(direction);
  bool is_near = false;
  near_groups(view.poses_, origin, direction, reach.to, reach.slope, [&](const Group& group) {
    if (group.is_static) return false;
    const dvec3 arm = group.center - origin;
    const double distance = glm::length(arm),
                 radius = group.radius + past_m + fp32_share * (largest(origin) + distance),
                 at = glm::dot(arm, direction) / length;
    const double most = radius + std::min<double>(reach.to, distance + radius) * reach.slope;
    if (at < -most || at > reach.to * length + most) return false;
    const dvec3 across = glm::cross(arm, direction);
    is_near = glm::dot(across, across) <= most * most * length * length;
    return is_near;
  });
  return is_near;
}

dvec3 EchoTracer::lifted(const dvec3& at, const dvec3& normal) { return at + lift * largest(at) * normal; }

EchoTracer::Met EchoTracer::first(const View& view, const dvec3& origin, const dvec3& direction,
                                  uint32_t leaving) const {
  Query query{origin, direction};
  query.leaving = leaving;
  meet_all(view.poses_, query);
  return {query.facet, query.nearest};
}

EchoTracer::Answer EchoTracer::trace(const FacetWorld& world, const EchoRays& rays, const RayGrid& grid,
                                     uint32_t max_bounces, bool monostatic,
                                     const std::function<bool(uint32_t facet)>& reflects,
                                     const std::function<uint32_t(uint32_t first, uint32_t second)>& last,
                                     uint32_t threads) const {
  Answer answer;
  const uint32_t tubes = grid.size();
  answer.words.assign(size_t{tubes} * max_bounces, shared::radar_none);
  const Poses own = standing(world, {rays.source_body, 0}),
              both = standing(world, {rays.source_body, rays.receiver_body});
  answer.direct = !monostatic && sees(both, rays.source, rays.receiver, ~0u);
  parallel_for((tubes + tubes_at_once - 1) / tubes_at_once, threads, [&](size_t part) {
    const uint32_t first = static_cast<uint32_t>(part) * tubes_at_once;
    // Neighbouring rays mostly meet the same pieces.
    std::vector<uint32_t> guesses(max_bounces, Query::none);
    for (uint32_t tube = first; tube < std::min(tubes, first + tubes_at_once); ++tube) {
      Query query{rays.source, grid.axis(tube)};
      uint32_t most = max_bounces, before = ~0u;
      for (uint32_t bounce = 0; bounce < most; ++bounce) {
        query.nearest = 1e30, query.facet = ~0u, query.piece = Query::none;
        meet_all(own, query, guesses[bounce]);
        if (query.facet == ~0u) break;
        if (query.piece != Query::none) guesses[bounce] = query.piece;
        if (bounce == 1) most = last(before, query.facet);
        before = query.facet;
        const PosedFacet& facet = world.facet(query.facet);
        const double towards = glm::dot(facet.normal, query.direction);
        const dvec3 normal = towards < 0.0 ? facet.normal : -facet.normal;
        const dvec3 at = query.origin + query.nearest * query.direction;
        query.origin = lifted(at, normal);
        query.leaving = query.facet;
        bool seen = monostatic && bounce == 0;
        if (!monostatic && glm::dot(rays.receiver - query.origin, normal) > 0.0)
          seen = sees(both, query.origin, rays.receiver, query.facet);
        answer.words[size_t{bounce} * tubes + tube] = query.facet | (seen ? shared::radar_sees_receiver : 0u);
        if (!reflects(query.facet)) break;
        query.direction -= 2.0 * towards * facet.normal;
      }
    }
  });
  return answer;
}

}  // namespace greatx::rf
