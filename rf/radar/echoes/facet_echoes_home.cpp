// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Sends back from what the beams of facet_echoes.cpp light: the way home to the receiver, directly or over a
// mirror, is clipped as exactly as the way out.
#include <algorithm>
#include <cmath>

#include "rf/radar/echoes/facet_beam_job.h"
#include "rf/radar/echoes/mirrors.h"

namespace greatx::rf {
namespace {

constexpr double least_depth = 0.1;  ///< cosine to the axis down to which a view from the receiver reaches

}  // namespace

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
          !may_send_from(job.chain[last], job.beams[last], lit.part, field_.mirrored_receiver(shown.mirror)))
        continue;
      find_seen_over(job, last, lit.part, shown.mirror);
      for (const Polygon& sending : job.sending)
        sender_.send_over(job, last, sending, shown.mirror, EchoSender::Over::other,
                          [](const Polygon&) { return 0u; });
    }
  }
  job.chain_at = ~0u;
}

bool FacetEchoes::may_send_from(uint32_t facet, const TubeBeam& beam, const Polygon& part,
                                const dvec3& receiver) const {
  const PosedFacet& posed = scene_.world.facet(facet);
  if (posed.distance(beam.source) * posed.distance(receiver) <= 0.0) return false;
  const Polygon piece = on_facet(posed, beam, part);
  if (piece.empty()) return false;
  const PhasePlane plane = phase_plane(posed, beam.source, receiver, field_.wavenumber());
  const dvec2 middle = piece.centroid();
  const double out = glm::length(dvec3(middle, 0.0) - plane.source),
               home = glm::length(dvec3(middle, 0.0) - plane.receiver);
  return most_of(plane, piece) >= sender_.floor_at(out, home);
}

bool FacetEchoes::may_send(const Job& job, uint32_t bounce, const Polygon& part, uint32_t facet) const {
  const TubeBeam& beam = job.beams[bounce];
  if (bounce > 0 && mirrors(scene_.world, job.chain[0], facet) &&
      may_send_from(facet, beam, part, field_.mirrored_receiver(job.chain[0])))
    return true;
  if (bounce >= options_.max_bounces) return false;
  if (bounce > 0 && mirrors(scene_.world, facet, job.chain[bounce - 1])) return false;  // add_shown()
  return may_send_from(facet, beam, part, field_.receiver_at());
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
  view.beam = TubeBeam(from, glm::normalize(beam.on(posed, part.centroid()) - from));
  view.farthest = 0.0;
  std::array<dvec2, Polygon::capacity> points;
  for (uint32_t i = 0; i < part.size(); ++i) {
    const dvec3 corner = beam.on(posed, part[i]);
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
  for (const Polygon& part : job.seen) {
    for (uint32_t i = 0; i < part.size(); ++i) points[i] = job.beams[last].uv(back.on(posed, part[i]));
    job.sending.emplace_back(std::span<const dvec2>(points).first(part.size()));
  }
}

void FacetEchoes::find_seen(Job& job, uint32_t last, const Polygon& part) const {
  job.sending.clear();
  BackView view;
  if (!view_back(job, last, part, field_.receiver_at(), view)) return;
  gather(job, scene_.tracer, receiver_, view.beam, {}, view.outline, view.farthest, job.hiding);
  find_unhidden(scene_.world, scene_.trees, view.beam, {}, view.outline, job.chain[last], job.hiding,
                smallest_beam_part * view.outline.area(), job.scratch, job.seen);
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
  const double smallest = smallest_beam_part * view.outline.area();
  gather(job, scene_.tracer, receiver_, out, {}, view.outline, to * (1.0 + same_beam_distance), job.hiding);
  find_visible(world, scene_.trees, out, {}, view.outline, VisibleCell::nothing, job.hiding, smallest,
               job.scratch, job.on_mirror);
  const BeamStart start{&wall, mirror, side > 0.0 ? 1.0 : -1.0};
  for (const VisibleCell& cell : job.on_mirror) {
    if (cell.facet != mirror) continue;
    gather(job, scene_.tracer, receiver_, view.beam, start, cell.part, view.farthest, job.hiding);
    find_unhidden(world, scene_.trees, view.beam, start, cell.part, job.chain[last], job.hiding, smallest,
                  job.scratch, job.seen);
    keep_seen(job, last, view.beam);
  }
}

}  // namespace greatx::rf
