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

PhasePlane phase_plane(const PosedFacet& facet, const dvec3& source, const dvec3& receiver,
                       double wavenumber) {
  return {dvec3(facet.plane_coordinates(source), facet.distance(source)),
          dvec3(facet.plane_coordinates(receiver), facet.distance(receiver)), wavenumber};
}

}  // namespace

std::array<dvec2, 4> tube_corners(const std::array<dvec3, 4>& corners, const TubeBeam& beam) {
  std::array<dvec2, 4> points;
  for (int i = 0; i < 4; ++i) points[i] = beam.uv(beam.source + corners[i]);
  return points;
}

Polygon tube_part(const std::array<dvec3, 4>& corners, const TubeBeam& beam) {
  return Polygon(tube_corners(corners, beam));
}

Polygon on_facet(const PosedFacet& facet, const TubeBeam& beam, const Polygon& part) {
  std::array<dvec2, Polygon::capacity> points;
  for (uint32_t i = 0; i < part.size(); ++i) {
    const dvec3 direction = beam.along(part[i]);
    const double reach = beam.reach(facet, direction);
    if (!(reach > 0.0 && reach < 1e12)) return {};
    points[i] = facet.plane_coordinates(beam.source + reach * direction);
  }
  return Polygon(std::span(points.data(), part.size()));
}

/// Holds what the echo of a contribution takes from its place alone. Two sides of a piece contribute at the
/// corner between them.
struct TubeEchoes::Place {
  dvec2 at{0.0};
  Complex density;  ///< 0 if nothing comes back from there
  dvec3 point{0.0}, departure{0.0}, arrival{0.0};
  dvec3 over{0.0};  ///< point on the mirror that reflects the way to the receiver
  double length_m = 0.0;
};

/// Holds the state of a tube while it is processed.
struct TubeEchoes::Job {
  uint32_t tube = 0;
  std::array<uint32_t, 8> ring{};
  std::array<dvec2, 4> corners{};             ///< corners of the whole tube in its own coordinates
  std::array<TubeBeam, most_surfaces> beams;  ///< [number of bounces before]
  std::array<uint32_t, most_surfaces> chain{};
  Polygon part;  ///< quadrilateral of the whole tube
  RawEchoes* out = nullptr;
  std::vector<Contribution> contributions;
  std::vector<Place> places;  ///< of the contributions of one piece so far
  std::vector<uint32_t> facets;
  std::array<std::vector<VisibleCell>, most_surfaces> cells;
  VisibleScratch scratch;
  uint32_t chain_at = ~0u;  ///< start of the present chain in out->chains; ~0: not stored yet
};

TubeEchoes::TubeEchoes(const RayGrid& grid, const RayHits& hits, const FacetWorld& world,
                       const FacetTrees& trees, const EchoField& field, const scene::Scene& scene,
                       const dvec3& source, bool monostatic, const EchoOptions& options,
                       const ClutterPatches* clutter)
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
      bounces_(hits.bounces()),
      home_(monostatic && options.max_bounces >= mirror_bounces) {
  // sigma = 4 pi |value|^2 / lambda^2
  limits_.floor = std::sqrt(options.border_floor_m2 * pi) / field.wavenumber();
  hidden_floor_ = std::sqrt(options.hidden_floor_m2 * pi) / field.wavenumber();
  GREATX_CHECK(bounces_ < most_surfaces, "{} bounces", bounces_);
  whole_.assign(size_t{grid.size()} * bounces_, Whole::no);
  parallel_for((grid.size() + chunk - 1) / chunk, options.threads, [&](size_t part) {
    const uint32_t first = static_cast<uint32_t>(part) * chunk, last = std::min(grid.size(), first + chunk);
    for (uint32_t tube = first; tube < last; ++tube) classify(tube);
  });
}

bool TubeEchoes::ring_agrees(uint32_t tube, const std::array<uint32_t, 8>& ring, uint32_t bounce) const {
  const uint32_t own = hits_.word(tube, bounce);
  return RayHits::met(own) && std::all_of(ring.begin(), ring.end(), [&](uint32_t other) {
           return other == RayGrid::outside || hits_.word(other, bounce) == own;
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

RawEchoes TubeEchoes::find() const {
  const size_t chunks = (grid_.size() + chunk - 1) / chunk;
  std::vector<RawEchoes> found(chunks);
  parallel_for(chunks, options_.threads, [&](size_t part) {
    const uint32_t first = static_cast<uint32_t>(part) * chunk, last = std::min(grid_.size(), first + chunk);
    Job job;
    job.out = &found[part];
    for (uint32_t tube = first; tube < last; ++tube) solve(tube, job);
  });
  RawEchoes all;
  size_t echoes = 0, chains = 0, rough = 0, corners = 0;
  for (const RawEchoes& part : found) {
    echoes += part.echoes.size(), chains += part.chains.size();
    rough += part.rough.parts.size(), corners += part.rough.corners.size();
  }
  all.echoes.reserve(echoes + 1), all.chains.reserve(chains);
  all.rough.parts.reserve(rough), all.rough.corners.reserve(corners);
  for (RawEchoes& part : found) {
    const uint32_t shift = static_cast<uint32_t>(all.chains.size());
    all.below_floor += part.below_floor;
    all.rough.append(part.rough);
    all.chains.insert(all.chains.end(), part.chains.begin(), part.chains.end());
    for (RawEcho& echo : part.echoes) {
      echo.first_facet += shift;
      all.echoes.push_back(echo);
    }
  }
  return all;
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
    if (tube == RayGrid::outside) return;
    const uint32_t facet = RayHits::facet(hits_.word(tube, bounce));
    const bool counts = facet != VisibleCell::nothing && same_chain(job, tube, bounce);
    if (!counts) {
      one_instance = false;
      return;
    }
    job.facets.push_back(facet);
    sends = sends || may_send(tube, bounce);
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
  if (clutter_ != nullptr && bounce == 0 && RayHits::sees_receiver(word) && clutter_->rough(posed.material))
    keep_rough(job, part, facet);
  if (!field_.reflects(facet)) return;
  if (RayHits::sees_receiver(word) && bounce < options_.max_bounces)
    send_back(job, bounce, part, facet, whole);
  if (RayHits::sees_over(word)) send_over(job, bounce, part, job.chain[0], Over::first, whole && bounce == 1);
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
    const bool cancels = border && other != RayGrid::outside && grid_.same_level(job.tube, other) &&
                         whole_[size_t{other} * bounces_ + bounce] == Whole::border;
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

/// Returns the limits with the floor at the corner of the piece that is nearest to both ends.
IntegralLimits TubeEchoes::limits_of(const PosedFacet& facet, const Polygon& piece, const dvec3& source,
                                     const dvec3& receiver) const {
  IntegralLimits limits = limits_;
  if (hidden_floor_ == 0.0) return limits;
  double nearest = 1e300;
  for (uint32_t i = 0; i < piece.size(); ++i) {
    const dvec3 corner = point_of(facet, piece[i]);
    const dvec3 out = corner - source, home = corner - receiver;
    nearest = std::min(nearest, glm::dot(out, out) * glm::dot(home, home));
  }
  limits.floor = std::max(limits.floor, hidden_floor_ * std::sqrt(nearest));
  return limits;
}

template <typename Look>
const TubeEchoes::Place& TubeEchoes::place_of(Job& job, const dvec2& at, const Look& look) {
  // A corner comes back after a few contributions at most, or not at all.
  constexpr size_t looked_at = 16;
  const size_t count = job.places.size();
  for (size_t i = count; i > 0 && i + looked_at > count; --i)
    if (job.places[i - 1].at == at) return job.places[i - 1];
  Place& place = job.places.emplace_back();
  place.at = at;
  look(place);
  return place;
}

void TubeEchoes::send_over(Job& job, uint32_t last, const Polygon& part, uint32_t mirror, Over way_home,
                           bool whole) const {
  const PosedFacet &posed = world_.facet(job.chain[last]), &wall = world_.facet(mirror);
  const TubeBeam& beam = job.beams[last];
  const dvec3 image = field_.mirrored_receiver(mirror);
  if (posed.distance(beam.source) * posed.distance(image) <= 0.0) return;
  const Polygon piece = on_facet(posed, beam, part);
  if (piece.empty()) return;
  job.contributions.clear(), job.places.clear();
  const uint32_t omitted = way_home == Over::other ? 0 : omitted_sides(job, last, posed, piece, whole);
  job.out->below_floor += integrate(phase_plane(posed, beam.source, image, field_.wavenumber()), piece,
                                    omitted, job.contributions, limits_of(posed, piece, beam.source, image));
  const auto look = [&](Place& place) {
    place.density = 0.0;
    place.point = point_of(posed, place.at);
    const dvec3 way = image - place.point;
    const double before = glm::distance(place.point, beam.source), after = glm::length(way);
    const double share = -wall.distance(place.point) / glm::dot(wall.normal, way);
    place.over = place.point + share * way;
    if (!(share > 0.0 && share < 1.0)) return;
    // A tube that came over the mirror directly to this surface returns over the mirror in the same way.
    if (!(way_home == Over::first && last == 1) && !trees_.contains(world_, mirror, place.over)) return;
    place.departure = glm::normalize(job.beams[0].along(beam.uv(place.point)));
    place.density =
        field_.density({place.departure, before, place.point, std::span(job.chain.data(), last + 1), mirror});
    place.arrival = glm::normalize(place.over - field_.receiver_at());
    place.length_m = before + after;
  };
  for (const Contribution& c : job.contributions) {
    const Place& place = place_of(job, c.at, look);
    const Complex amplitude = c.value * place.density;
    if (amplitude == 0.0) continue;
    const auto push = [&](const dvec3& out, const dvec3& in, const dvec3& at, bool reversed) {
      std::vector<uint32_t>& chains = job.out->chains;
      const uint32_t first = static_cast<uint32_t>(chains.size());
      chains.insert(chains.end(), job.chain.begin(), job.chain.begin() + last + 1);
      chains.push_back(mirror);
      if (reversed) std::reverse(chains.begin() + first, chains.end());
      job.out->echoes.push_back({amplitude, out, in, at, place.length_m, first, last + 2});
    };
    push(place.departure, place.arrival, place.over, false);
    if (way_home == Over::other && monostatic_ && last == 0)
      push(place.arrival, place.departure, place.point, true);
  }
}

void TubeEchoes::send_back(Job& job, uint32_t bounce, const Polygon& part, uint32_t facet, bool whole) const {
  if (bounce > 0 && mirrors(world_, facet, job.chain[bounce - 1])) {
    // The previous surface has already sent this path back.
    if (bounce > 1 && home_ && facet == job.chain[0]) return;
    return send_over(job, bounce - 1, part, facet, Over::other, false);
  }
  const PosedFacet& posed = world_.facet(facet);
  const TubeBeam& beam = job.beams[bounce];
  // The receiver must be on the lit side: where the source was before the last surface turned the rays.
  if (posed.distance(beam.source) * posed.distance(field_.receiver_at()) <= 0.0) return;
  const Polygon piece = on_facet(posed, beam, part);
  if (piece.empty()) return;
  job.contributions.clear(), job.places.clear();
  const PhasePlane plane = phase_plane(posed, beam.source, field_.receiver_at(), field_.wavenumber());
  const uint32_t omitted = omitted_sides(job, bounce, posed, piece, whole);
  job.out->below_floor += integrate(plane, piece, omitted, job.contributions,
                                    limits_of(posed, piece, beam.source, field_.receiver_at()));
  const std::span<const uint32_t> chain(job.chain.data(), bounce + 1);
  const auto look = [&](Place& place) {
    place.point = point_of(posed, place.at);
    const double before = glm::length(place.point - beam.source);
    place.departure = glm::normalize(job.beams[0].along(beam.uv(place.point)));
    place.density = field_.density({place.departure, before, place.point, chain});
    const dvec3 back = place.point - field_.receiver_at();
    const double after = glm::length(back);
    place.arrival = back / after;
    place.length_m = before + after;
  };
  for (const Contribution& c : job.contributions) {
    const Place& place = place_of(job, c.at, look);
    const Complex amplitude = c.value * place.density;
    if (amplitude == 0.0) continue;
    if (job.chain_at == ~0u) {
      job.chain_at = static_cast<uint32_t>(job.out->chains.size());
      job.out->chains.insert(job.out->chains.end(), chain.begin(), chain.end());
    }
    job.out->echoes.push_back(
        {amplitude, place.departure, place.arrival, place.point, place.length_m, job.chain_at, bounce + 1});
  }
}

void TubeEchoes::keep_rough(Job& job, const Polygon& part, uint32_t facet) const {
  const PosedFacet& posed = world_.facet(facet);
  if (posed.distance(source_) * posed.distance(field_.receiver_at()) <= 0.0) return;
  const Polygon piece = on_facet(posed, job.beams[0], part);
  if (!piece.empty()) job.out->rough.add(job.tube, facet, piece);
}

}  // namespace greatx::rf
