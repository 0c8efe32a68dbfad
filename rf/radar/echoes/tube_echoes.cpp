// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/echoes/tube_echoes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "core/units.h"
#include "rf/radar/echoes/mirrors.h"

namespace greatx::rf {
namespace {

constexpr double smallest_share = 1e-9;  ///< fraction of a tube's area; smaller parts are dropped

}  // namespace

std::array<dvec2, 4> tube_corners(const std::array<dvec3, 4>& corners, const TubeBeam& beam) {
  std::array<dvec2, 4> points;
  for (int i = 0; i < 4; ++i) points[i] = beam.uv(beam.source + corners[i]);
  return points;
}

Polygon tube_part(const std::array<dvec3, 4>& corners, const TubeBeam& beam) {
  return Polygon(tube_corners(corners, beam));
}

/// Holds the state of a tube while it is processed.
struct TubeEchoes::Job : BeamWay {
  uint32_t tube = 0;
  std::array<uint32_t, 8> ring{};
  std::array<dvec2, 4> corners{};  ///< corners of the whole tube in its own coordinates
  Polygon part;                    ///< quadrilateral of the whole tube
  std::vector<uint32_t> facets;
  std::array<std::vector<VisibleCell>, most_surfaces> cells;
  VisibleScratch scratch;
};

TubeEchoes::TubeEchoes(const RayGrid& grid, const RayHits& hits, const FacetWorld& world,
                       const FacetTrees& trees, const EchoField& field, const scene::Scene& scene,
                       const dvec3& source, bool monostatic, const EchoOptions& options,
                       const ClutterPatches* clutter, const BeamedFacets& beamed)
    : grid_(grid),
      hits_(hits),
      world_(world),
      trees_(trees),
      field_(field),
      scene_(scene),
      source_(source),
      monostatic_(monostatic),
      options_(options),
      clutter_(clutter),
      beamed_(beamed),
      sender_(world, trees, field, options, monostatic),
      bounces_(hits.bounces()) {
  GREATX_CHECK(bounces_ < most_surfaces, "{} bounces", bounces_);
  whole_.assign(size_t{grid.size()} * bounces_, Whole::no);
  parallel_for(parts(), options.threads, [&](size_t part) {
    const uint32_t first = static_cast<uint32_t>(part) * chunk, last = std::min(grid.size(), first + chunk);
    for (uint32_t tube = first; tube < last; ++tube) classify(tube);
  });
}

bool TubeEchoes::ring_agrees(uint32_t tube, const std::array<uint32_t, 8>& ring, uint32_t bounce) const {
  const uint32_t own = hits_.word(tube, bounce);
  return RayHits::met(own) && std::all_of(ring.begin(), ring.end(), [&](uint32_t other) {
           return other != RayGrid::outside && hits_.word(other, bounce) == own;
         });
}

void TubeEchoes::classify(uint32_t tube) {
  if (!RayHits::met(hits_.word(tube, 0))) return;
  const std::array<uint32_t, 8> ring = grid_.neighbours(tube);
  TubeBeam beam(source_, grid_.axis(tube));
  const Polygon part = tube_part(grid_.corners(tube), beam);
  for (uint32_t bounce = 0; bounce < bounces_ && ring_agrees(tube, ring, bounce); ++bounce) {
    const uint32_t word = hits_.word(tube, bounce);
    const PosedFacet& facet = world_.facet(RayHits::facet(word));
    const Polygon piece = on_facet(facet, beam, part);
    if (piece.empty()) return;
    Whole& whole = whole_[size_t{tube} * bounces_ + bounce];
    if (!field_.reflects(RayHits::facet(word))) {
      whole = Whole::silent;
      return;
    }
    whole = Whole::silent;
    // From the second surface the receiver is seen either directly or over the first surface, never both
    // ways.
    const bool over = bounce == 1 && RayHits::sees_over(word);
    if (over || RayHits::sees_receiver(word)) {
      const dvec3 receiver =
          over ? field_.mirrored_receiver(RayHits::facet(hits_.word(tube, 0))) : field_.receiver_at();
      const PhasePlane plane = phase_plane(facet, beam.source, receiver, field_.wavenumber());
      whole = integral_form(plane, piece) == IntegralForm::border ? Whole::border : Whole::other;
    }
    beam = beam.mirrored(facet);
  }
}

void TubeEchoes::find(size_t part, RawEchoes& out) const {
  const uint32_t first = static_cast<uint32_t>(part) * chunk, last = std::min(grid_.size(), first + chunk);
  Job job;
  job.out = &out;
  for (uint32_t tube = first; tube < last; ++tube) solve(tube, job);
}

void TubeEchoes::solve(uint32_t tube, Job& job) const {
  job.tube = tube;
  job.ring = grid_.neighbours(tube);
  const auto empty = [&](uint32_t other) {
    return other == RayGrid::outside || !RayHits::met(hits_.word(other, 0));
  };
  if (empty(tube) && std::all_of(job.ring.begin(), job.ring.end(), empty)) return;
  job.beams[0] = TubeBeam(source_, grid_.axis(tube));
  job.corners = tube_corners(grid_.corners(tube), job.beams[0]);
  job.part = Polygon(job.corners);
  follow(job, 0, job.part, {}, true);
}

bool TubeEchoes::same_chain(const Job& job, uint32_t tube, uint32_t length) const {
  for (uint32_t i = 0; i < length; ++i)
    if (RayHits::facet(hits_.word(tube, i)) != job.chain[i]) return false;
  return true;
}

void TubeEchoes::follow(Job& job, uint32_t bounce, const Polygon& part, const BeamStart& start,
                        bool whole) const {
  if (bounce == bounces_) return;
  if (whole && whole_[size_t{job.tube} * bounces_ + bounce] != Whole::no)
    return bounce_off(job, bounce, part, RayHits::facet(hits_.word(job.tube, bounce)), true);
  std::vector<VisibleCell>& cells = job.cells[bounce];
  divide(job, bounce, part, start, cells);
  for (size_t i = 0; i < cells.size(); ++i)
    if (cells[i].facet != VisibleCell::nothing) bounce_off(job, bounce, cells[i].part, cells[i].facet, false);
}

void TubeEchoes::divide(Job& job, uint32_t bounce, const Polygon& part, const BeamStart& start,
                        std::vector<VisibleCell>& cells) const {
  job.facets.clear();
  bool one_instance = same_chain(job, job.tube, bounce) && RayHits::met(hits_.word(job.tube, bounce));
  const uint32_t own = one_instance ? RayHits::facet(hits_.word(job.tube, bounce)) : VisibleCell::nothing;
  bool sends = false;
  const auto look = [&](uint32_t tube) {
    const uint32_t facet =
        tube == RayGrid::outside ? VisibleCell::nothing : RayHits::facet(hits_.word(tube, bounce));
    const bool counts = facet != VisibleCell::nothing && same_chain(job, tube, bounce);
    if (!counts) {
      one_instance = false;
      return;
    }
    job.facets.push_back(facet);
    sends = sends || may_send(tube, bounce) || (bounce == 1 && scatters(bounce, facet));
    one_instance = one_instance && scene_.facets[facet].instance == scene_.facets[own].instance;
  };
  look(job.tube);
  for (const uint32_t other : job.ring) look(other);
  std::sort(job.facets.begin(), job.facets.end());
  job.facets.erase(std::unique(job.facets.begin(), job.facets.end()), job.facets.end());
  cells.clear();
  if (!sends) return;
  find_visible(world_, trees_, job.beams[bounce], start, part, job.facets, smallest_share * job.part.area(),
               job.scratch, cells);
  if (!one_instance) return;
  for (VisibleCell& cell : cells)
    if (cell.facet == VisibleCell::nothing && cell.part.area() > 1e-6 * job.part.area()) cell.facet = own;
}

bool TubeEchoes::may_send(uint32_t tube, uint32_t bounce) const {
  for (uint32_t b = bounce; b < bounces_ && RayHits::met(hits_.word(tube, b)); ++b) {
    const uint32_t word = hits_.word(tube, b);
    if ((RayHits::sees_receiver(word) && b < options_.max_bounces) || RayHits::sees_over(word)) return true;
  }
  return false;
}

uint32_t TubeEchoes::word_of(const Job& job, uint32_t bounce, uint32_t facet) const {
  const auto asks = [&](uint32_t tube) {
    return tube != RayGrid::outside && RayHits::facet(hits_.word(tube, bounce)) == facet &&
           same_chain(job, tube, bounce);
  };
  if (asks(job.tube)) return hits_.word(job.tube, bounce);
  for (const uint32_t other : job.ring)
    if (asks(other)) return hits_.word(other, bounce);
  return RayHits::nothing;
}

void TubeEchoes::bounce_off(Job& job, uint32_t bounce, const Polygon& part, uint32_t facet,
                            bool whole) const {
  const PosedFacet& posed = world_.facet(facet);
  job.chain[bounce] = facet;
  job.chain_at = ~0u;
  const uint32_t word = whole ? hits_.word(job.tube, bounce) : word_of(job, bounce, facet);
  if (scatters(bounce, facet) && (bounce == 1 || (RayHits::sees_receiver(word) && beamed_.marks[facet] == 0)))
    keep_rough(job, bounce, part, facet);
  if (!field_.reflects(facet) || beamed_.hold(std::span(job.chain.data(), bounce + 1))) return;
  const auto omitted = [&](bool unbroken) {
    return [&, unbroken](const Polygon& piece) { return omitted_sides(job, bounce, posed, piece, unbroken); };
  };
  if (RayHits::sees_receiver(word) && bounce < options_.max_bounces)
    sender_.send_back(job, bounce, part, omitted(whole));
  if (RayHits::sees_over(word))
    sender_.send_over(job, bounce, part, job.chain[0], EchoSender::Over::first,
                      omitted(whole && bounce == 1));
  if (bounce + 1 == bounces_) return;
  // Beyond max_bounces only tubes that came over a mirror have hits.
  if (bounce + 1 == options_.max_bounces && !mirrors(world_, job.chain[0], job.chain[1])) return;
  const TubeBeam& beam = job.beams[bounce];
  job.beams[bounce + 1] = beam.mirrored(posed);
  // The rays continue on the side from which they came, where the source before the reflection is.
  const BeamStart start{&posed, facet, posed.distance(beam.source) > 0.0 ? 1.0 : -1.0};
  follow(job, bounce + 1, part, start, whole);
  job.chain_at = ~0u;
}

uint32_t TubeEchoes::omitted_sides(const Job& job, uint32_t bounce, const PosedFacet& facet,
                                   const Polygon& piece, bool whole) const {
  const bool border = whole && whole_[size_t{job.tube} * bounces_ + bounce] == Whole::border;
  std::array<dvec2, Polygon::capacity> points;  // corners of the piece in the coordinates of the beam
  uint32_t marks = 0;
  bool placed = false;
  for (int side = 0; side < 4; ++side) {
    const uint32_t other = job.ring[side];
    const bool cancels =
        border && other != RayGrid::outside && whole_[size_t{other} * bounces_ + bounce] == Whole::border;
    if (other != RayGrid::outside && !cancels) continue;
    const dvec2 a = job.corners[side], along = job.corners[(side + 1) % 4] - a;
    const double length = glm::length(along);
    if (length == 0.0) continue;
    if (!std::exchange(placed, true))
      for (uint32_t i = 0; i < piece.size(); ++i) points[i] = job.beams[bounce].uv(point_of(facet, piece[i]));
    uint32_t on = 0;  // corners that lie on the side
    for (uint32_t i = 0; i < piece.size(); ++i) {
      const dvec2 arm = points[i] - a;
      if (std::abs(along.x * arm.y - along.y * arm.x) < 1e-6 * length * length) on |= 1u << i;
    }
    for (uint32_t i = 0; i < piece.size(); ++i) {
      const uint32_t next = i + 1 < piece.size() ? i + 1 : 0;
      marks |= (on >> i & on >> next & 1u) << i;
    }
  }
  return marks;
}

bool TubeEchoes::scatters(uint32_t bounce, uint32_t facet) const {
  if (clutter_ == nullptr || !clutter_->rough(facet)) return false;
  return bounce == 0 || (bounce == 1 && monostatic_ && options_.max_bounces > 1);
}

void TubeEchoes::keep_rough(Job& job, uint32_t bounce, const Polygon& part, uint32_t facet) const {
  const PosedFacet& posed = world_.facet(facet);
  if (bounce == 0 && posed.distance(source_) * posed.distance(field_.receiver_at()) <= 0.0) return;
  const Polygon piece = on_facet(posed, job.beams[bounce], part);
  if (!piece.empty())
    job.out->rough.add(job.tube, facet, bounce == 0 ? ClutterParts::no_mirror : job.chain[0], piece);
}

}  // namespace greatx::rf
