// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/paths/path_solver.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "core/built_effects.h"
#include "core/error.h"
#include "core/parallel.h"
#include "rf/edges/diffraction.h"

namespace greatx::rf {

namespace {

constexpr size_t paths_at_once = 16;  ///< paths whose fields one thread computes in turn

/// Holds the facets that a path touches at a vertex and that therefore do not block it there.
struct Touched {
  uint32_t first = shared::rf_none, second = shared::rf_none;
};

Touched touched_at(const Interaction& interaction, const std::vector<scene::Wedge>& wedges) {
  if (interaction.type != InteractionType::diffraction) return {interaction.element, shared::rf_none};
  const scene::Wedge& wedge = wedges[interaction.element];
  return {wedge.facet_0, wedge.facet_n};
}

/// Returns the end of a segment at a vertex. An edge's end is seen from a place beside it.
dvec3 traced_end(const RadioModel& model, const GeometricPath& path, size_t vertex) {
  if (vertex == 0 || vertex > path.interactions.size()) return path.vertices[vertex];
  const Interaction& at = path.interactions[vertex - 1];
  if (at.type != InteractionType::diffraction || at.patch == 0) return path.vertices[vertex];
  return seen_corner(posed(model.wedges[at.element], model.facets), static_cast<Corner>(at.patch));
}

/// Describes a wall that a segment passes.
struct Passage {
  uint32_t facet = 0;
  double t = 0.0;  ///< along the segment, 0 to 1
  dvec3 point{0.0};
};

/// Returns the points where the segment meets the planes of these walls, in order along the segment. Two
/// walls in one plane that are met at one point (a seam, or a wall that the file holds twice) are one.
std::vector<Passage> passages(const FacetWorld& world, const std::vector<uint32_t>& walls, const dvec3& a,
                              const dvec3& b) {
  std::vector<Passage> list;
  for (const uint32_t facet : walls) {
    const double from = world.facet(facet).distance(a), to = world.facet(facet).distance(b);
    // The GPU found the wall in fp32. In fp64 it may lie beyond an end by a rounding, or along the segment.
    const double t = from == to ? 0.5 : std::clamp(from / (from - to), 0.0, 1.0);
    list.push_back({facet, t, a + t * (b - a)});
  }
  std::sort(list.begin(), list.end(),
            [](const Passage& p, const Passage& q) { return p.t != q.t ? p.t < q.t : p.facet < q.facet; });
  const auto same_wall = [&](const Passage& p, const Passage& q) {
    const PosedFacet &f = world.facet(p.facet), &g = world.facet(q.facet);
    return glm::length(p.point - q.point) <= 1e-6 && glm::length(glm::cross(f.normal, g.normal)) <= 1e-9;
  };
  list.erase(std::unique(list.begin(), list.end(), same_wall), list.end());
  return list;
}

/// Sets `full` to the path with its walls as interactions. Returns false if the path is blocked.
bool insert_walls(const FacetWorld& world, const GeometricPath& path, std::span<const Crossing> crossings,
                  GeometricPath& full) {
  if (std::any_of(crossings.begin(), crossings.end(), [](const Crossing& c) { return c.blocked; }))
    return false;
  full = {{}, {path.vertices.front()}, path.length_m, 0.0};
  full.patch_area_m2 = path.patch_area_m2;
  full.from_receiver = path.from_receiver;
  full.stratum = path.stratum;
  full.second_patch_area_m2 = path.second_patch_area_m2;
  full.draw_variance = path.draw_variance;
  for (size_t i = 0; i < crossings.size(); ++i) {
    const Crossing& crossing = crossings[i];
    if constexpr (all_effects_built) {
      full.foliage_m += crossing.foliage_m;
      for (const Passage& wall : passages(world, crossing.walls, path.vertices[i], path.vertices[i + 1])) {
        full.interactions.push_back({InteractionType::transmission, wall.facet});
        full.vertices.push_back(wall.point);
      }
    }
    if (i < path.interactions.size()) full.interactions.push_back(path.interactions[i]);
    full.vertices.push_back(path.vertices[i + 1]);
  }
  return true;
}

/// Returns the index of the interaction that is a diffraction or a scattering.
std::optional<size_t> bend_of(const GeometricPath& path) {
  for (size_t i = 0; i < path.interactions.size(); ++i)
    if (path.interactions[i].type == InteractionType::diffraction ||
        path.interactions[i].type == InteractionType::scattering)
      return i;
  return std::nullopt;
}

/// Holds the segments that lead straight from a patch to an end of the link (0: the transmitter, 1: the
/// receiver). All paths that this patch scatters share them. The maps are never iterated.
struct StraightToPatches {
  std::unordered_map<uint64_t, uint32_t> to[2];
};

/// Lets the segment `leader`, which leads straight from a patch to an end, have the answer of an earlier one.
void share_straight(const Interaction& patch, bool to_receiver, size_t leader, std::vector<Segment>& segments,
                    StraightToPatches& straight) {
  const uint64_t key = uint64_t{patch.element} << 32 | patch.patch;
  const auto [known, is_new] = straight.to[to_receiver].try_emplace(key, static_cast<uint32_t>(leader));
  // The paths with the fewest interactions, which may pass the most walls, come first. finish() counts the
  // walls again.
  if (!is_new && segments[known->second].walls >= segments[leader].walls)
    segments[leader].same_as = known->second;
}

/// Lets most segments of a path with a bend depend on one leader, because such paths are very many and most
/// of them are blocked. The leader is the segment between two bends, or else one next to the bend that leads
/// straight to an end, if there is one. The others are traced only if the leader is clear. The segments of
/// the path are `segments` from `first` on.
void hang_on_one(const GeometricPath& path, size_t bend, size_t first, std::vector<Segment>& segments,
                 StraightToPatches& straight) {
  const bool to_receiver = first + bend + 2 == segments.size(), to_transmitter = bend == 0;
  const bool two_bends =
      bend + 1 < path.interactions.size() && path.interactions[bend + 1].type == InteractionType::diffraction;
  const size_t leader = first + (to_receiver || !to_transmitter || two_bends ? bend + 1 : bend);
  for (size_t i = first; i < segments.size(); ++i)
    if (i != leader) segments[i].only_if = static_cast<uint32_t>(leader);
  const Interaction& patch = path.interactions[bend];
  if (patch.type == InteractionType::scattering && (to_receiver || to_transmitter))
    share_straight(patch, to_receiver, leader, segments, straight);
}

bool scatters(const GeometricPath& path) { return path.patch_area_m2 > 0.0; }

/// Lets the other segments of a path with a scattering and another bend depend on the last one as the wave
/// runs, the segments from `first` on. Everything before it has been tested against what is at rest, and the
/// paths that have one patch before the target share it, also with those of a single scattering.
void hang_on_last(const GeometricPath& path, size_t first, std::vector<Segment>& segments,
                  StraightToPatches& straight) {
  const bool to_receiver = !path.from_receiver;
  const size_t leader = to_receiver ? segments.size() - 1 : first;
  for (size_t i = first; i < segments.size(); ++i)
    if (i != leader) segments[i].only_if = static_cast<uint32_t>(leader);
  const Interaction& last = to_receiver ? path.interactions.back() : path.interactions.front();
  if (last.type == InteractionType::scattering) share_straight(last, to_receiver, leader, segments, straight);
}

bool has_two_bends_and_scatters(const GeometricPath& path) {
  return scatters(path) && std::ranges::count_if(path.interactions, [](const Interaction& i) {
                             return i.type == InteractionType::diffraction ||
                                    i.type == InteractionType::scattering;
                           }) > 1;
}

bool less(const GeometricPath& a, const GeometricPath& b) {
  return interactions_less(a.interactions, b.interactions);
}

/// Orders paths by type (reflections alone, then diffraction, then scattering) and then by number of
/// interactions.
bool matters_more(const GeometricPath& a, const GeometricPath& b) {
  const auto kind = [](const GeometricPath& path) {
    InteractionType most = InteractionType::reflection;
    for (const Interaction& interaction : path.interactions) most = std::max(most, interaction.type);
    return most;
  };
  const InteractionType kind_a = kind(a), kind_b = kind(b);
  return kind_a != kind_b ? kind_a < kind_b : a.interactions.size() < b.interactions.size();
}

}  // namespace

void keep_most(LinkGeometry& link, uint64_t most) {
  if (link.paths.size() <= most) return;
  link.overflow += link.paths.size() - most;
  std::stable_sort(link.paths.begin(), link.paths.end(), matters_more);
  link.paths.resize(most);
  std::sort(link.paths.begin(), link.paths.end(), less);
}

PathSolver::PathSolver(const RadioModel& model, const PathLimits& limits, bool moving_bodies,
                       std::shared_ptr<EdgeSearch> edges)
    : model_(&model), limits_(limits), field_(model.field_model()) {
  if (model.effects.diffraction || model.effects.scattering)
    midpoints_.emplace(model, limits, moving_bodies, std::move(edges));
}

void PathSolver::set_candidates(const CandidateList& candidates, const dvec3& source, Source end) {
  tree_.emplace(model_->facets, source, candidates, end);
  if (midpoints_) midpoints_->set_candidates(candidates, *tree_);
}

void PathSolver::find_edge_ways(uint32_t body, uint32_t threads) {
  GREATX_CHECK(tree_ && midpoints_, "ways to wedges without candidates or diffraction");
  midpoints_->find_edge_ways(*tree_, body, threads);
}

void PathSolver::move_source(const dvec3& source) {
  GREATX_CHECK(tree_.has_value(), "the source moved to ({}, {}, {}) before it had candidates", source.x,
               source.y, source.z);
  tree_->update(source);
  if (midpoints_) midpoints_->move(*tree_);
}

LinkGeometry PathSolver::geometry(const EndState& end, uint32_t threads, bool keep) const {
  const dvec3& target = end.position;
  GREATX_CHECK(tree_.has_value(), "no candidates for the target at ({}, {}, {})", target.x, target.y,
               target.z);
  LinkGeometry link;
  link.paths = tree_->solve(target);
  if (!model_->effects.line_of_sight)
    std::erase_if(link.paths, [](const GeometricPath& path) { return path.interactions.empty(); });
  if (!model_->effects.reflection)
    std::erase_if(link.paths, [](const GeometricPath& path) { return !path.interactions.empty(); });
  if (all_effects_built && midpoints_) {
    link.searched = midpoints_->solve(*tree_, {target, end.body, keep}, threads, link.paths);
    std::sort(link.paths.begin(), link.paths.end(), less);
  }
  keep_most(link, limits_.max_paths);
  return link;
}

/// Returns GeometricPath::edges_diffract. The diffraction at an edge of a reflecting facet takes the place of
/// the reflection in the sequence. It is found if the reflections on both of its sides are not too many, and
/// if the path has no other bend.
uint32_t PathSolver::edges_diffract(const GeometricPath& path) const {
  if (!all_effects_built || !field_.reflectors || !model_->effects.diffraction ||
      !model_->effects.diffraction_lit_region)
    return 0;
  if (bend_of(path)) return 0;
  const auto reflections = static_cast<uint32_t>(path.facets().size());
  uint32_t bits = 0, reflection = 0;
  for (size_t i = 0; i < path.interactions.size(); ++i) {
    if (path.interactions[i].type != InteractionType::reflection) continue;
    if (std::max(reflection, reflections - 1 - reflection) <= limits_.max_reflections_beside_diffraction)
      bits |= 1u << i;
    ++reflection;
  }
  return bits;
}

/// Sets GeometricPath::edge_sides of the paths of a link, in canonical order. Obstruction and the angles of
/// an edge are decided from the same facets, but within roundings, and within what a file's corners stand off
/// the planes of their facets, they may disagree about the side of a boundary. The paths that exist decide.
void PathSolver::find_edge_sides(std::vector<GeometricPath>& paths, const FacetWorld& world) const {
  constexpr double room_m = 2e-4;
  if (!model_->effects.diffraction || !model_->effects.line_of_sight || !model_->effects.reflection) return;
  GeometricPath other;
  const auto exists = [&] {
    const auto at = std::lower_bound(paths.begin(), paths.end(), other, less);
    return at != paths.end() && at->interactions == other.interactions ? 1 : -1;
  };
  const auto solid = [](const Interaction& i) { return i.type != InteractionType::transmission; };
  const auto keller_side = [&](const GeometricPath& path, size_t bend, const dvec3& before,
                               const dvec3& after, const scene::Wedge& wedge) {
    const auto place = corner_place(wedge, static_cast<Corner>(path.interactions[bend].patch), before, after);
    if (place && std::abs(place->inwards_m) > room_m) return KellerSide::by_place;
    other.interactions = path.interactions;
    other.interactions[bend].patch = 0;
    return exists() > 0 ? KellerSide::exists : KellerSide::does_not;
  };
  const auto sides_at = [&](GeometricPath& path, size_t bend) {
    size_t before = bend, after = bend + 2;  // vertices; walls on the way turn nothing
    while (before > 0 && !solid(path.interactions[before - 1])) --before;
    while (after <= path.interactions.size() && !solid(path.interactions[after - 1])) ++after;
    const uint32_t edge = path.interactions[bend].element;
    const scene::Wedge wedge = posed(model_->wedges[edge], world);
    if (path.interactions[bend].patch != 0) {
      path.keller_side = keller_side(path, bend, path.vertices[before], path.vertices[after], wedge);
      return EdgeSides{};  // the terms of an end are continuous across their boundaries
    }
    EdgeSides sides =
        near_boundaries(wedge, path.vertices[before], path.vertices[bend + 1], path.vertices[after], room_m);
    const auto instead = [&](uint32_t facet) {
      other.interactions = path.interactions;
      other.interactions[bend] = {InteractionType::reflection, facet};
      return static_cast<int8_t>(exists());
    };
    if (sides.incident != 0) {
      other.interactions = path.interactions;
      other.interactions.erase(other.interactions.begin() + static_cast<ptrdiff_t>(bend));
      sides.incident = static_cast<int8_t>(exists());
    }
    if (sides.reflected_0 != 0) sides.reflected_0 = instead(wedge.facet_0);
    if (sides.reflected_n != 0)
      sides.reflected_n = instead(wedge.facet_n == scene::no_facet ? wedge.facet_0 : wedge.facet_n);
    return sides;
  };
  for (GeometricPath& path : paths) {
    if (scatters(path)) continue;  // it was drawn without its neighbours, so that its angles decide
    size_t edge = 0;
    for (size_t i = 0; i < path.interactions.size(); ++i)
      if (path.interactions[i].type == InteractionType::diffraction)
        path.edge_sides[edge++] = sides_at(path, i);
  }
}

void PathSolver::add_segments(std::span<const GeometricPath> paths, const EndState& transmitter,
                              const EndState& receiver, std::vector<Segment>& segments) const {
  const auto body_or_none = [](uint32_t body) { return body == 0 ? shared::rf_none : body; };
  StraightToPatches straight;
  for (const GeometricPath& path : paths) {
    const size_t count = path.interactions.size(), first = segments.size();
    const uint32_t walls = walls_allowed(*model_, limits_, path.interactions.size());
    for (size_t i = 0; i <= count; ++i) {
      Segment segment{
          .a = traced_end(*model_, path, i), .b = traced_end(*model_, path, i + 1), .walls = walls};
      if (i > 0) {
        const Touched touched = touched_at(path.interactions[i - 1], model_->wedges);
        segment.facet_a = touched.first, segment.other_a = touched.second;
      }
      if (i < count) {
        const Touched touched = touched_at(path.interactions[i], model_->wedges);
        segment.facet_b = touched.first, segment.other_b = touched.second;
      }
      if (i == 0) segment.body_a = body_or_none(transmitter.body);
      if (i == count) segment.body_b = body_or_none(receiver.body);
      segments.push_back(segment);
    }
    if constexpr (all_effects_built) {
      if (has_two_bends_and_scatters(path))
        hang_on_last(path, first, segments, straight);
      else if (const std::optional<size_t> bend = bend_of(path))
        hang_on_one(path, *bend, first, segments, straight);
    }
  }
}

std::vector<Path> PathSolver::finish(std::span<const GeometricPath> paths,
                                     std::span<const Crossing> crossings, const EndState& transmitter,
                                     const EndState& receiver, const FacetWorld& world,
                                     uint32_t threads) const {
  FieldModel field = field_;
  field.world = &world;
  std::vector<GeometricPath> lit;
  size_t first = 0;
  for (const GeometricPath& path : paths) {
    const size_t count = path.interactions.size() + 1;
    GREATX_CHECK(first + count <= crossings.size(), "{} answers for {} segments and more", crossings.size(),
                 first + count);
    GeometricPath full;
    const bool clear = insert_walls(world, path, crossings.subspan(first, count), full);
    first += count;
    if (!clear || full.interactions.size() > limits_.max_depth) continue;
    if (full.interactions.size() - path.interactions.size() > limits_.max_transmissions) continue;
    if (model_->edge_gaps.passes_one(world, path, transmitter.body, receiver.body)) continue;
    full.edges_diffract = edges_diffract(full);
    lit.push_back(std::move(full));
  }
  GREATX_CHECK(first == crossings.size(), "{} segments, {} answers", first, crossings.size());
  std::sort(lit.begin(), lit.end(), less);
  find_edge_sides(lit, world);
  std::vector<Path> fields(lit.size());
  // Paths are taken in groups, because many fields take less time than a thread needs to start.
  const size_t groups = (lit.size() + paths_at_once - 1) / paths_at_once;
  parallel_for(groups, threads, [&](size_t group) {
    for (size_t i = group * paths_at_once; i < std::min(lit.size(), (group + 1) * paths_at_once); ++i)
      fields[i] = path_field(lit[i], field, transmitter.velocity, receiver.velocity);
  });
  return fields;
}

}  // namespace greatx::rf
