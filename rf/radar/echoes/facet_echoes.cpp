// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/echoes/facet_echoes.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/units.h"
#include "rf/radar/echoes/facet_beam_job.h"
#include "rf/radar/echoes/mirrors.h"
#include "rf/radar/echoes/visible_cells.h"

namespace greatx::rf {
namespace {

constexpr double narrow_tubes = 3.0;   ///< width in tubes up to which a facet has a beam
constexpr double widest_beam = 0.3;    ///< rad about the axis
constexpr double same_plane_m = 1e-6;  ///< distance behind a surface at which a facet does not lie behind it

}  // namespace

FacetEchoes::FacetEchoes(const FacetScene& scene, const RayGrid& grid, const EchoField& field,
                         const EchoOptions& options, const dvec3& source, bool monostatic, uint32_t own_body,
                         uint32_t receiver_body)
    : scene_(scene),
      grid_(grid),
      field_(field),
      options_(options),
      monostatic_(monostatic),
      ends_{source, field.receiver_at(), own_body, receiver_body},
      sender_(scene.world, scene.trees, field, options, monostatic),
      beams_(scene.tracer.view(scene.world, own_body)),
      receiver_(scene.tracer.view(scene.world, own_body, receiver_body)) {
  if (scene.veils != nullptr) veil_views_ = scene.veils->views(ends_);
}

bool FacetEchoes::chosen(uint32_t facet, const PosedFacet* mirror) const {
  const FacetWorld& world = scene_.world;
  const PosedFacet& posed = world.facet(facet);
  if (posed.body != 0 && ends_.own_body != 0 && posed.owner == ends_.own_body) return false;
  // Distances are those of the images of places behind the mirror.
  const auto seen_at = [&](const dvec3& p) { return mirror == nullptr ? p : mirrored(*mirror, p); };
  const double side = std::abs(posed.distance(seen_at(ends_.source)));
  const dvec3 center = seen_at(posed.centroid), arm = center - ends_.source;
  const double distance = glm::length(arm);
  const double extent = std::hypot(posed.max_u - posed.min_u, posed.max_v - posed.min_v);
  const double nearest = std::max(distance - extent, side);
  if (!(nearest > options_.antenna_radius_m)) return false;
  // No beam has a larger cross-section than the facet, and no flat surface changes it.
  const double area = (posed.max_u - posed.min_u) * (posed.max_v - posed.min_v);
  const double cosine = std::min(1.0, side / nearest);
  const double home = std::max(glm::distance(center, field_.receiver_at()) - extent, 0.0);
  if (area * cosine < sender_.floor_at(nearest, home)) return false;
  if (area > narrow_tubes * grid_.cell_rad() * distance * extent) return false;
  if (!field_.reflects(facet)) return false;
  const double least = std::cos(widest_beam);
  std::array<dvec3, FacetTrees::most_corners> room;
  for (const uint32_t piece : scene_.trees.pieces(facet))
    for (const dvec3& corner : scene_.trees.corners(world, facet, piece, room)) {
      if (mirror != nullptr && !(mirror->distance(corner) * mirror->distance(ends_.source) > 0.0))
        return false;
      const dvec3 to = seen_at(corner) - ends_.source;
      if (glm::dot(to, arm) < least * glm::length(to) * distance) return false;
      if (grid_.tube_at(to) == RayGrid::outside) return false;
    }
  return true;
}

BeamedFacets FacetEchoes::choose(std::span<const MirroredFacet> images) const {
  constexpr uint32_t at_once = 1024;
  const uint32_t facets = scene_.world.facet_count();
  BeamedFacets found;
  found.marks.assign(facets, 0), found.mirrors.assign(facets, 0);
  parallel_for((facets + at_once - 1) / at_once, options_.threads, [&](size_t part) {
    const uint32_t first = static_cast<uint32_t>(part) * at_once;
    for (uint32_t facet = first; facet < std::min(facets, first + at_once); ++facet)
      found.marks[facet] = chosen(facet, nullptr) ? 1 : 0;
  });
  for (uint32_t facet = 0; facet < facets; ++facet)
    if (found.marks[facet] != 0) found.facets.push_back(facet);
  std::vector<uint8_t> shown(images.size());
  parallel_for((images.size() + at_once - 1) / at_once, options_.threads, [&](size_t part) {
    for (size_t i = part * at_once; i < std::min(images.size(), (part + 1) * at_once); ++i)
      shown[i] = chosen(images[i].facet, &scene_.world.facet(images[i].mirror)) ? 1 : 0;
  });
  for (size_t i = 0; i < images.size(); ++i)
    if (shown[i] != 0) {
      found.images.push_back(images[i]);
      found.mirrors[images[i].mirror] = 1;
    }
  return found;
}

void FacetEchoes::find(const BeamedFacets& chosen, size_t part, RawEchoes& out, BeamMemory* memory) const {
  const size_t direct = chosen.facets.size(), count = direct + chosen.images.size();
  const bool remembers = memory != nullptr && memory->stands_still() && scene_.veils == nullptr;
  Job job;
  job.out = &out;
  for (size_t i = part * chunk; i < std::min(count, (part + 1) * chunk); ++i) {
    if (i >= direct)
      solve_over(chosen.images[i - direct], job);
    else if (remembers && scene_.world.facet(chosen.facets[i]).body == 0)
      solve_or_remember(chosen.facets[i], job, *memory);
    else
      solve(chosen.facets[i], job);
  }
}

void FacetEchoes::solve_or_remember(uint32_t facet, Job& job, BeamMemory& memory) const {
  RawEchoes& out = *job.out;
  // The receiver's view hides what this one hides, and perhaps more.
  if (const RawEchoes* known = memory.find(facet, scene_.tracer, beams_)) {
    out.append(*known);
    ++out.remembered;
    return;
  }
  RawEchoes sent;
  job.out = &sent;
  job.records = true;
  job.cones.clear();
  solve(facet, job);
  job.records = false;
  job.out = &out;
  memory.keep(facet, sent, job.cones, scene_.tracer, beams_);
  out.append(sent);
}

Polygon FacetEchoes::outline_of(uint32_t facet, uint32_t piece, const TubeBeam& beam,
                                double& farthest) const {
  std::array<dvec3, FacetTrees::most_corners> room;
  const std::span<const dvec3> corners = scene_.trees.corners(scene_.world, facet, piece, room);
  std::array<dvec2, FacetTrees::most_corners> points;
  farthest = 0.0;
  for (size_t i = 0; i < corners.size(); ++i) {
    points[i] = beam.uv(corners[i]);
    farthest = std::max(farthest, glm::dot(corners[i] - beam.source, beam.axis));
  }
  const Polygon outline(std::span<const dvec2>(points).first(corners.size()));
  return outline.area() > 0.0 ? outline : Polygon(std::span<const dvec2>{});
}

void FacetEchoes::solve(uint32_t facet, Job& job) const {
  const FacetWorld& world = scene_.world;
  const TubeBeam& beam = job.beams[0] =
      TubeBeam(ends_.source, glm::normalize(world.facet(facet).centroid - ends_.source));
  job.limit = options_.max_bounces;
  job.lit.clear(), job.shown.clear();
  for (const uint32_t piece : scene_.trees.pieces(facet)) {
    double farthest = 0.0;
    const Polygon outline = outline_of(facet, piece, beam, farthest);
    if (outline.empty()) continue;
    // Most facets that something hides are hidden by one piece of one other facet.
    const EchoTracer::Met met = first(job, ends_.source, glm::normalize(beam.along(outline.centroid())), ~0u);
    if (met.facet != facet && met.facet != ~0u && met.distance < farthest &&
        covers(world, scene_.trees, beam, {}, outline, met.facet, job.scratch, &world.facet(facet)))
      continue;
    job.smallest = smallest_beam_part * outline.area();
    gather(job, scene_.tracer, beams_, beam, {}, outline, farthest, job.pieces);
    std::vector<Polygon>& parts = job.parts[0];
    find_unhidden(world, scene_.trees, beam, {}, outline, facet, job.pieces, job.smallest, job.scratch,
                  parts);
    for (size_t i = 0; i < parts.size(); ++i)
      if (scene_.veils == nullptr) {
        keep_rough(facet, parts[i], job);
        bounce_off(job, 0, parts[i], facet);
      } else {
        solve_behind(facet, parts[i], farthest, job);
      }
  }
  if (scene_.veils == nullptr) send_over_shown(job);
}

void FacetEchoes::solve_behind(uint32_t facet, const Polygon& part, double farthest, Job& job) const {
  const TubeBeam& beam = job.beams[0];
  gather(job, scene_.veils->tracer(), veil_views_.out, beam, {}, part, farthest, job.hiding);
  std::vector<VisibleCell>& behind = job.behind;
  find_visible(scene_.world, scene_.trees, beam, {}, part, facet, job.hiding, job.smallest, job.scratch,
               behind);
  for (const VisibleCell& cell : behind) {
    if (cell.facet == facet) continue;  // no veil is before it
    const dvec3 at = beam.on(scene_.world.facet(facet), cell.part.centroid());
    const size_t first = job.out->echoes.size();
    job.lit.clear(), job.shown.clear();
    bounce_off(job, 0, cell.part, facet);
    send_over_shown(job);
    scene_.veils->weaken(*job.out, first, scene_.veils->leg(veil_views_.out, ends_.source, at), veil_views_,
                         ends_, monostatic_);
  }
}

void FacetEchoes::keep_rough(uint32_t facet, const Polygon& part, Job& job) const {
  const PosedFacet& posed = scene_.world.facet(facet);
  if (scene_.clutter == nullptr || !scene_.clutter->rough(facet)) return;
  if (posed.distance(ends_.source) * posed.distance(ends_.receiver) <= 0.0) return;
  job.chain[0] = facet;
  if (monostatic_)
    job.sending.assign(1, part);
  else
    find_seen(job, 0, part);
  for (const Polygon& seen : job.sending) {
    const Polygon piece = on_facet(posed, job.beams[0], seen);
    if (!piece.empty()) job.out->rough.add(ClutterParts::of_a_beam, facet, ClutterParts::no_mirror, piece);
  }
}

void FacetEchoes::solve_over(const MirroredFacet& image, Job& job) const {
  const FacetWorld& world = scene_.world;
  const PosedFacet& mirror = world.facet(image.mirror);
  const double side = mirror.distance(ends_.source);
  const dvec3 from = ends_.source - 2.0 * side * mirror.normal;
  const TubeBeam& beam = job.beams[1] =
      TubeBeam(from, glm::normalize(world.facet(image.facet).centroid - from));
  const TubeBeam& out = job.beams[0] = beam.mirrored(mirror);
  const BeamStart start{&mirror, image.mirror, side > 0.0 ? 1.0 : -1.0};
  job.limit = options_.max_bounces + 1;  // the mirror does not count
  job.lit.clear(), job.shown.clear();
  for (const uint32_t piece : scene_.trees.pieces(image.facet)) {
    double farthest = 0.0;
    const Polygon outline = outline_of(image.facet, piece, beam, farthest);
    if (outline.empty()) continue;
    job.smallest = smallest_beam_part * outline.area();
    double to = 0.0;  // the mirror is not farther away
    for (uint32_t i = 0; i < outline.size(); ++i) to = std::max(to, out.reach(mirror, out.along(outline[i])));
    std::vector<VisibleCell>& on_mirror = job.cells[0];
    std::vector<Polygon>& on_facet = job.parts[1];
    gather(job, scene_.tracer, beams_, out, {}, outline, to * (1.0 + same_beam_distance), job.pieces);
    find_visible(world, scene_.trees, out, {}, outline, VisibleCell::nothing, job.pieces, job.smallest,
                 job.scratch, on_mirror);
    for (size_t i = 0; i < on_mirror.size(); ++i) {
      if (on_mirror[i].facet != image.mirror) continue;
      const Polygon part = on_mirror[i].part;
      gather(job, scene_.tracer, beams_, beam, start, part, farthest, job.pieces);
      find_unhidden(world, scene_.trees, beam, start, part, image.facet, job.pieces, job.smallest,
                    job.scratch, on_facet);
      job.chain[0] = image.mirror;
      for (size_t k = 0; k < on_facet.size(); ++k) bounce_off(job, 1, on_facet[k], image.facet);
    }
  }
  send_over_shown(job);
}

void FacetEchoes::gather(Job& job, const EchoTracer& tracer, const EchoTracer::View& view,
                         const TubeBeam& beam, const BeamStart& start, const Polygon& part, double to,
                         std::vector<FacetPiece>& pieces) const {
  const PartBox box(part);
  const dvec2 middle = 0.5 * (box.low + box.high);
  EchoTracer::Cone cone{beam.source, beam.along(middle), 0.0, to, 0.5 * glm::length(box.high - box.low)};
  if (start.facet != nullptr) {
    double nearest = 1e30;
    for (uint32_t i = 0; i < part.size(); ++i)
      nearest = std::min(nearest, beam.reach(*start.facet, beam.along(part[i])));
    cone.from = std::max(0.0, nearest * (1.0 - 1e-9) - same_plane_m);
  }
  const BeamSpaces spaces(beam, start, box);
  cone.sides = spaces.used();
  if (job.records) job.cones.emplace_back(cone.origin, cone.direction, cone.to, cone.slope);
  pieces.clear();
  tracer.gather(view, cone, pieces);
}

EchoTracer::Met FacetEchoes::first(Job& job, const dvec3& origin, const dvec3& direction,
                                   uint32_t leaving) const {
  const EchoTracer::Met met = scene_.tracer.first(beams_, origin, direction, leaving);
  if (job.records) job.cones.emplace_back(origin, direction, met.distance, 0.0);
  return met;
}

void FacetEchoes::follow(Job& job, uint32_t bounce, const Polygon& part, const BeamStart& start) const {
  if (bounce + 1 == job.limit) return finish(job, bounce, part, start);
  std::vector<VisibleCell>& cells = job.cells[bounce];
  const TubeBeam& beam = job.beams[bounce];
  const uint32_t wall = gather_next(job, beam, start, part);
  find_visible(scene_.world, scene_.trees, beam, start, part, wall, job.pieces, job.smallest, job.scratch,
               cells);
  for (const VisibleCell& cell : cells) add_shown(job, bounce, cell.facet);
  for (size_t i = 0; i < cells.size(); ++i)
    if (cells[i].facet != VisibleCell::nothing) bounce_off(job, bounce, cells[i].part, cells[i].facet);
}

uint32_t FacetEchoes::gather_next(Job& job, const TubeBeam& beam, const BeamStart& start,
                                  const Polygon& part) const {
  const dvec3 direction = glm::normalize(beam.along(part.centroid()));
  const double reach = beam.reach(*start.facet, direction);
  const EchoTracer::Met met =
      first(job, EchoTracer::lifted(beam.source + reach * direction, start.side * start.facet->normal),
            direction, start.index);
  double to = 1e30;
  uint32_t wall = VisibleCell::nothing;
  if (met.facet != ~0u && covers(scene_.world, scene_.trees, beam, start, part, met.facet, job.scratch)) {
    wall = met.facet, to = 0.0;
    for (uint32_t i = 0; i < part.size(); ++i)
      to = std::max(to, beam.reach(scene_.world.facet(wall), beam.along(part[i])));
  }
  gather(job, scene_.tracer, beams_, beam, start, part, to, job.pieces);
  return wall;
}

void FacetEchoes::finish(Job& job, uint32_t bounce, const Polygon& part, const BeamStart& start) const {
  const FacetWorld& world = scene_.world;
  const TubeBeam& beam = job.beams[bounce];
  gather_next(job, beam, start, part);
  std::vector<VisibleCell>& senders = job.cells[bounce];
  std::vector<Polygon>& parts = job.parts[bounce + 1];
  senders.clear();
  const PartBox within(part);
  std::array<dvec3, FacetTrees::most_corners> room;
  for (const auto& [facet, piece] : job.pieces) {
    if (facet == start.index || !field_.reflects(facet)) continue;
    const Polygon outline = seen(scene_.trees.corners(world, facet, piece, room), beam, start, within);
    if (outline.empty()) continue;
    const Polygon on = overlap(part, outline);
    if (on.area() > job.smallest && (shows_before(job, bounce, facet) || may_send(job, bounce, on, facet)))
      senders.push_back({on, facet});
  }
  for (size_t i = 0; i < senders.size(); ++i) {
    const uint32_t facet = senders[i].facet;
    find_unhidden(world, scene_.trees, beam, start, senders[i].part, facet, job.pieces, job.smallest,
                  job.scratch, parts);
    for (const Polygon& part_seen : parts) {
      add_shown(job, bounce, facet);
      job.chain[bounce] = facet, job.chain_at = ~0u;
      if (may_send(job, bounce, part_seen, facet)) send(job, bounce, part_seen);
    }
  }
  job.chain_at = ~0u;
}

void FacetEchoes::bounce_off(Job& job, uint32_t bounce, const Polygon& part, uint32_t facet) const {
  const PosedFacet& posed = scene_.world.facet(facet);
  job.chain[bounce] = facet, job.chain_at = ~0u;
  if (!field_.reflects(facet)) return;
  const TubeBeam& beam = job.beams[bounce];
  // The cross-section of the beam, and a bound on what any surface that it meets may send back.
  const double length = std::abs(beam.reach(posed, beam.along(part.centroid())));
  const double home =
      std::max(1e-3, glm::distance(beam.source + length * beam.along(part.centroid()), field_.receiver_at()));
  if (part.area() * length * length < sender_.floor_at(length, home)) return;
  if (may_send(job, bounce, part, facet)) send(job, bounce, part);
  if (bounce + 1 == job.limit) return;
  job.lit.push_back({job.met(bounce + 1), part});
  job.beams[bounce + 1] = beam.mirrored(posed);
  follow(job, bounce + 1, part, {&posed, facet, posed.distance(beam.source) > 0.0 ? 1.0 : -1.0});
  job.chain_at = ~0u;
}

}  // namespace greatx::rf
