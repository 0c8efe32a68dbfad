// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/echoes/facet_echoes.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/units.h"
#include "rf/radar/echoes/mirrors.h"
#include "rf/radar/echoes/visible_cells.h"

namespace greatx::rf {
namespace {

constexpr double narrow_tubes = 3.0;    ///< width in tubes up to which a facet has a beam
constexpr double widest_beam = 0.3;     ///< rad about the axis
constexpr double same_plane_m = 1e-6;   ///< distance behind a surface at which a facet does not lie behind it
constexpr double same_distance = 1e-6;  ///< relative, between two computations of a distance
constexpr double least_depth = 0.1;     ///< cosine to the axis down to which a view from the receiver reaches
constexpr double smallest_part = 1e-9;  ///< fraction of the area of a beam; smaller parts are dropped

}  // namespace

struct FacetEchoes::Job : BeamWay {
  /// Holds surfaces that a beam has met in turn.
  struct Surfaces {
    std::array<uint32_t, most_surfaces> chain{};
    uint32_t count = 0;
    bool operator==(const Surfaces& o) const {
      return count == o.count && std::equal(chain.begin(), chain.begin() + count, o.chain.begin());
    }
  };
  struct Lit {  ///< what a beam lights of the last surface
    Surfaces surfaces;
    Polygon part;
  };
  struct Shown {  ///< a mirror that some rays from the last surface meet
    Surfaces surfaces;
    uint32_t mirror = 0;
    bool operator==(const Shown& o) const = default;
  };
  Surfaces met(uint32_t count) const { return {chain, count}; }

  uint32_t limit = 0;     ///< number of surfaces that the beam may meet
  double smallest = 0.0;  ///< area in the (u, v) plane; smaller parts are dropped
  std::vector<FacetPiece> pieces;
  std::array<std::vector<VisibleCell>, most_surfaces> cells;
  std::vector<FacetPiece> hiding;            ///< what may hide a part from the receiver
  std::vector<VisibleCell> seen, on_mirror;  ///< of the way to the receiver
  std::vector<VisibleCell> behind;           ///< veils
  std::vector<Polygon> sending;              ///< what the receiver sees of a part
  std::vector<Lit> lit;                      ///< of the present beam
  std::vector<Shown> shown;                  ///< without repetition
  VisibleScratch scratch;
};

FacetEchoes::FacetEchoes(const FacetScene& scene, const RayGrid& grid, const EchoField& field,
                         const EchoOptions& options, const dvec3& source, bool monostatic, uint32_t own_body,
                         uint32_t receiver_body)
    : scene_(scene),
      grid_(grid),
      field_(field),
      options_(options),
      source_(source),
      monostatic_(monostatic),
      own_body_(own_body),
      sender_(scene.world, scene.trees, field, options, monostatic),
      beams_(scene.tracer.view(scene.world, own_body)),
      receiver_(scene.tracer.view(scene.world, own_body, receiver_body)),
      ends_{source, field.receiver_at(), own_body, receiver_body} {
  if (scene.veils != nullptr) veil_views_ = scene.veils->views(ends_);
}

bool FacetEchoes::chosen(uint32_t facet, const PosedFacet* mirror) const {
  const FacetWorld& world = scene_.world;
  const PosedFacet& posed = world.facet(facet);
  if (posed.body != 0 && own_body_ != 0 && posed.owner == own_body_) return false;
  // Distances are those of the images of places behind the mirror.
  const auto seen_at = [&](const dvec3& p) {
    return mirror == nullptr ? p : p - 2.0 * mirror->distance(p) * mirror->normal;
  };
  const double side = std::abs(posed.distance(seen_at(source_)));
  const dvec3 center = seen_at(posed.centroid), arm = center - source_;
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
      if (mirror != nullptr && !(mirror->distance(corner) * mirror->distance(source_) > 0.0)) return false;
      const dvec3 to = seen_at(corner) - source_;
      if (glm::dot(to, arm) < least * glm::length(to) * distance) return false;
      if (grid_.tube_at(to) == RayGrid::outside) return false;
    }
  return true;
}

BeamedFacets FacetEchoes::choose(std::span<const MirroredFacet> images) const {
  constexpr uint32_t at_once = 4096;
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
  for (const MirroredFacet& image : images)
    if (chosen(image.facet, &scene_.world.facet(image.mirror))) {
      found.images.push_back(image);
      found.mirrors[image.mirror] = 1;
    }
  return found;
}

RawEchoes FacetEchoes::find(const BeamedFacets& chosen) const {
  const size_t direct = chosen.facets.size(), count = direct + chosen.images.size();
  std::vector<RawEchoes> found((count + chunk - 1) / chunk);
  parallel_for(found.size(), options_.threads, [&](size_t part) {
    Job job;
    job.out = &found[part];
    for (size_t i = part * chunk; i < std::min(count, (part + 1) * chunk); ++i) {
      if (i < direct)
        solve(chosen.facets[i], job);
      else
        solve_over(chosen.images[i - direct], job);
    }
  });
  RawEchoes all;
  all.join(found);
  return all;
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
      TubeBeam(source_, glm::normalize(world.facet(facet).centroid - source_));
  job.limit = options_.max_bounces;
  job.lit.clear(), job.shown.clear();
  for (const uint32_t piece : scene_.trees.pieces(facet)) {
    double farthest = 0.0;
    const Polygon outline = outline_of(facet, piece, beam, farthest);
    if (outline.empty()) continue;
    // Most facets that something hides are hidden by one piece of one other facet.
    const EchoTracer::Met met =
        scene_.tracer.first(beams_, source_, glm::normalize(beam.along(outline.centroid())), ~0u);
    if (met.facet != facet && met.facet != ~0u && met.distance < farthest &&
        covers(world, scene_.trees, beam, {}, outline, met.facet, job.scratch, &world.facet(facet)))
      continue;
    job.smallest = smallest_part * outline.area();
    gather(scene_.tracer, beams_, beam, {}, outline, farthest, job.pieces);
    std::vector<VisibleCell>& cells = job.cells[0];
    find_visible(world, scene_.trees, beam, {}, outline, facet, job.pieces, job.smallest, job.scratch, cells);
    for (size_t i = 0; i < cells.size(); ++i)
      if (cells[i].facet == facet) {
        if (scene_.veils == nullptr)
          bounce_off(job, 0, cells[i].part, facet);
        else
          solve_behind(facet, Polygon(cells[i].part), farthest, job);
      }
  }
  if (scene_.veils == nullptr) send_over_shown(job);
}

void FacetEchoes::solve_behind(uint32_t facet, const Polygon& part, double farthest, Job& job) const {
  const TubeBeam& beam = job.beams[0];
  gather(scene_.veils->tracer(), veil_views_.out, beam, {}, part, farthest, job.hiding);
  std::vector<VisibleCell>& behind = job.behind;
  find_visible(scene_.world, scene_.trees, beam, {}, part, facet, job.hiding, job.smallest, job.scratch,
               behind);
  for (size_t i = 0; i < behind.size(); ++i) {
    const VisibleCell& cell = behind[i];
    if (cell.facet == facet) continue;  // no veil is before it
    const dvec3 along = beam.along(cell.part.centroid());
    const dvec3 at = beam.source + beam.reach(scene_.world.facet(facet), along) * along;
    const size_t first = job.out->echoes.size();
    job.lit.clear(), job.shown.clear();
    bounce_off(job, 0, cell.part, facet);
    send_over_shown(job);
    scene_.veils->weaken(*job.out, first, scene_.veils->leg(veil_views_.out, source_, at), veil_views_, ends_,
                         monostatic_);
  }
}

void FacetEchoes::solve_over(const MirroredFacet& image, Job& job) const {
  const FacetWorld& world = scene_.world;
  const PosedFacet& mirror = world.facet(image.mirror);
  const double side = mirror.distance(source_);
  const dvec3 from = source_ - 2.0 * side * mirror.normal;
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
    job.smallest = smallest_part * outline.area();
    double to = 0.0;  // the mirror is not farther away
    for (uint32_t i = 0; i < outline.size(); ++i) to = std::max(to, out.reach(mirror, out.along(outline[i])));
    std::vector<VisibleCell>&on_mirror = job.cells[0], &on_facet = job.cells[1];
    gather(scene_.tracer, beams_, out, {}, outline, to * (1.0 + same_distance), job.pieces);
    find_visible(world, scene_.trees, out, {}, outline, VisibleCell::nothing, job.pieces, job.smallest,
                 job.scratch, on_mirror);
    for (size_t i = 0; i < on_mirror.size(); ++i) {
      if (on_mirror[i].facet != image.mirror) continue;
      const Polygon part = on_mirror[i].part;
      gather(scene_.tracer, beams_, beam, start, part, farthest, job.pieces);
      find_visible(world, scene_.trees, beam, start, part, image.facet, job.pieces, job.smallest, job.scratch,
                   on_facet);
      job.chain[0] = image.mirror;
      for (size_t k = 0; k < on_facet.size(); ++k)
        if (on_facet[k].facet == image.facet) bounce_off(job, 1, on_facet[k].part, image.facet);
    }
  }
  send_over_shown(job);
}

void FacetEchoes::gather(const EchoTracer& tracer, const EchoTracer::View& view, const TubeBeam& beam,
                         const BeamStart& start, const Polygon& part, double to,
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
  pieces.clear();
  tracer.gather(view, cone, pieces);
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
  const EchoTracer::Met met = scene_.tracer.first(
      beams_, EchoTracer::lifted(beam.source + reach * direction, start.side * start.facet->normal),
      direction, start.index);
  double to = 1e30;
  uint32_t wall = VisibleCell::nothing;
  if (met.facet != ~0u && covers(scene_.world, scene_.trees, beam, start, part, met.facet, job.scratch)) {
    wall = met.facet, to = 0.0;
    for (uint32_t i = 0; i < part.size(); ++i)
      to = std::max(to, beam.reach(scene_.world.facet(wall), beam.along(part[i])));
  }
  gather(scene_.tracer, beams_, beam, start, part, to, job.pieces);
  return wall;
}

void FacetEchoes::finish(Job& job, uint32_t bounce, const Polygon& part, const BeamStart& start) const {
  const FacetWorld& world = scene_.world;
  const TubeBeam& beam = job.beams[bounce];
  gather_next(job, beam, start, part);
  std::vector<VisibleCell>&senders = job.cells[bounce], &cells = job.cells[bounce + 1];
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
    find_visible(world, scene_.trees, beam, start, senders[i].part, facet, job.pieces, job.smallest,
                 job.scratch, cells);
    for (const VisibleCell& cell : cells) {
      if (cell.facet != facet) continue;
      add_shown(job, bounce, facet);
      job.chain[bounce] = facet, job.chain_at = ~0u;
      if (may_send(job, bounce, cell.part, facet)) send(job, bounce, cell.part);
    }
  }
  job.chain_at = ~0u;
}

bool FacetEchoes::shows_before(const Job& job, uint32_t bounce, uint32_t facet) const {
  return bounce < options_.max_bounces && mirrors(scene_.world, facet, job.chain[bounce - 1]) &&
         !(bounce > 1 && sender_.home() && facet == job.chain[0]);  // the surface before has sent it
}

void FacetEchoes::add_shown(Job& job, uint32_t bounce, uint32_t mirror) const {
  if (mirror == VisibleCell::nothing || !field_.reflects(mirror) || !shows_before(job, bounce, mirror))
    return;
  const Job::Shown shown{job.met(bounce), mirror};
  if (std::find(job.shown.begin(), job.shown.end(), shown) == job.shown.end()) job.shown.push_back(shown);
}

void FacetEchoes::send_over_shown(Job& job) const {
  for (const Job::Shown& shown : job.shown) {
    const uint32_t last = shown.surfaces.count - 1;
    job.chain = shown.surfaces.chain;
    for (uint32_t i = 0; i < last; ++i)
      job.beams[i + 1] = job.beams[i].mirrored(scene_.world.facet(job.chain[i]));
    for (const Job::Lit& lit : job.lit) {
      if (!(lit.surfaces == shown.surfaces) ||
          !may_send_from(job, last, lit.part, field_.mirrored_receiver(shown.mirror)))
        continue;
      find_seen_over(job, last, lit.part, shown.mirror);
      for (const Polygon& sending : job.sending)
        sender_.send_over(job, last, sending, shown.mirror, EchoSender::Over::other,
                          [](const Polygon&) { return 0u; });
    }
  }
  job.chain_at = ~0u;
}

bool FacetEchoes::may_send_from(const Job& job, uint32_t last, const Polygon& part,
                                const dvec3& receiver) const {
  const PosedFacet& posed = scene_.world.facet(job.chain[last]);
  const TubeBeam& beam = job.beams[last];
  if (posed.distance(beam.source) * posed.distance(receiver) <= 0.0) return false;
  const Polygon piece = on_facet(posed, beam, part);
  if (piece.empty()) return false;
  const PhasePlane plane = phase_plane(posed, beam.source, receiver, field_.wavenumber());
  const dvec2 middle = piece.centroid();
  const double out = glm::length(dvec3(middle, 0.0) - plane.source),
               home = glm::length(dvec3(middle, 0.0) - plane.receiver);
  return most_of(plane, piece) >= sender_.floor_at(out, home);
}

bool FacetEchoes::may_send(Job& job, uint32_t bounce, const Polygon& part, uint32_t facet) const {
  job.chain[bounce] = facet;
  if (bounce > 0 && mirrors(scene_.world, job.chain[0], facet) &&
      may_send_from(job, bounce, part, field_.mirrored_receiver(job.chain[0])))
    return true;
  if (bounce >= options_.max_bounces) return false;
  if (bounce > 0 && mirrors(scene_.world, facet, job.chain[bounce - 1])) return false;  // add_shown()
  return may_send_from(job, bounce, part, field_.receiver_at());
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

void FacetEchoes::send(Job& job, uint32_t bounce, const Polygon& part) const {
  const auto none = [](const Polygon&) { return 0u; };
  const FacetWorld& world = scene_.world;
  const uint32_t facet = job.chain[bounce];
  const bool over_first = bounce > 0 && mirrors(world, job.chain[0], facet);
  if (over_first && sender_.home()) {
    // A beam that came over the mirror directly to this surface returns in the same way.
    if (bounce > 1)
      find_seen_over(job, bounce, part, job.chain[0]);
    else
      job.sending.assign(1, part);
    for (const Polygon& sending : job.sending)
      sender_.send_over(job, bounce, sending, job.chain[0], EchoSender::Over::first, none);
  }
  // The opposite path of the second case is that of the smaller facet.
  if (bounce >= options_.max_bounces || (over_first && bounce == 1)) return;
  if (bounce > 0 && mirrors(world, facet, job.chain[bounce - 1])) return;  // add_shown()
  if (bounce == 0 && monostatic_)
    job.sending.assign(1, part);
  else
    find_seen(job, bounce, part);
  for (const Polygon& sending : job.sending) sender_.send_direct(job, bounce, sending, none);
}

bool FacetEchoes::view_back(const Job& job, uint32_t last, const Polygon& part, const dvec3& from,
                            BackView& view) const {
  const PosedFacet& posed = scene_.world.facet(job.chain[last]);
  const TubeBeam& beam = job.beams[last];
  const auto at = [&](const dvec2& uv) {
    const dvec3 along = beam.along(uv);
    return beam.source + beam.reach(posed, along) * along;
  };
  view.beam = TubeBeam(from, glm::normalize(at(part.centroid()) - from));
  view.farthest = 0.0;
  std::array<dvec2, Polygon::capacity> points;
  for (uint32_t i = 0; i < part.size(); ++i) {
    const dvec3 corner = at(part[i]);
    const double depth = glm::dot(corner - from, view.beam.axis);
    if (!(depth > least_depth * glm::distance(corner, from))) return false;
    points[i] = view.beam.uv(corner);
    view.farthest = std::max(view.farthest, depth);
  }
  view.outline = Polygon(std::span<const dvec2>(points).first(part.size()));
  return view.outline.area() > 0.0;
}

void FacetEchoes::keep_seen(Job& job, uint32_t last, const TubeBeam& back) const {
  const PosedFacet& posed = scene_.world.facet(job.chain[last]);
  std::array<dvec2, Polygon::capacity> points;
  for (const VisibleCell& cell : job.seen) {
    if (cell.facet != job.chain[last]) continue;
    for (uint32_t i = 0; i < cell.part.size(); ++i) {
      const dvec3 along = back.along(cell.part[i]);
      points[i] = job.beams[last].uv(back.source + back.reach(posed, along) * along);
    }
    job.sending.emplace_back(std::span<const dvec2>(points).first(cell.part.size()));
  }
}

void FacetEchoes::find_seen(Job& job, uint32_t last, const Polygon& part) const {
  job.sending.clear();
  BackView view;
  if (!view_back(job, last, part, field_.receiver_at(), view)) return;
  gather(scene_.tracer, receiver_, view.beam, {}, view.outline, view.farthest, job.hiding);
  find_visible(scene_.world, scene_.trees, view.beam, {}, view.outline, job.chain[last], job.hiding,
               smallest_part * view.outline.area(), job.scratch, job.seen);
  keep_seen(job, last, view.beam);
}

void FacetEchoes::find_seen_over(Job& job, uint32_t last, const Polygon& part, uint32_t mirror) const {
  const FacetWorld& world = scene_.world;
  const PosedFacet& wall = world.facet(mirror);
  const double side = wall.distance(field_.receiver_at());
  job.sending.clear();
  BackView view;
  if (!view_back(job, last, part, field_.mirrored_receiver(mirror), view)) return;
  const TubeBeam out = view.beam.mirrored(wall);
  double to = 0.0;  // the mirror is not farther away
  for (uint32_t i = 0; i < view.outline.size(); ++i)
    to = std::max(to, out.reach(wall, out.along(view.outline[i])));
  const double smallest = smallest_part * view.outline.area();
  gather(scene_.tracer, receiver_, out, {}, view.outline, to * (1.0 + same_distance), job.hiding);
  find_visible(world, scene_.trees, out, {}, view.outline, VisibleCell::nothing, job.hiding, smallest,
               job.scratch, job.on_mirror);
  const BeamStart start{&wall, mirror, side > 0.0 ? 1.0 : -1.0};
  for (const VisibleCell& cell : job.on_mirror) {
    if (cell.facet != mirror) continue;
    gather(scene_.tracer, receiver_, view.beam, start, cell.part, view.farthest, job.hiding);
    find_visible(world, scene_.trees, view.beam, start, cell.part, job.chain[last], job.hiding, smallest,
                 job.scratch, job.seen);
    keep_seen(job, last, view.beam);
  }
}

}  // namespace greatx::rf
