// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/echoes/echo_sender.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "rf/radar/echoes/mirrors.h"

namespace greatx::rf {

PhasePlane phase_plane(const PosedFacet& facet, const dvec3& source, const dvec3& receiver,
                       double wavenumber) {
  return {dvec3(facet.plane_coordinates(source), facet.distance(source)),
          dvec3(facet.plane_coordinates(receiver), facet.distance(receiver)), wavenumber};
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

void RawEchoes::append(const RawEchoes& more) {
  const uint32_t shift = static_cast<uint32_t>(chains.size());
  below_floor += more.below_floor;
  remembered += more.remembered;
  rough.append(more.rough);
  chains.insert(chains.end(), more.chains.begin(), more.chains.end());
  for (RawEcho echo : more.echoes) {
    echo.first_facet += shift;
    echoes.push_back(echo);
  }
}

void RawEchoes::join(std::span<RawEchoes> parts) {
  size_t held = echoes.size(), links = chains.size(), pieces = rough.parts.size(),
         corners = rough.corners.size();
  for (const RawEchoes& part : parts) {
    held += part.echoes.size(), links += part.chains.size();
    pieces += part.rough.parts.size(), corners += part.rough.corners.size();
  }
  echoes.reserve(held + 1), chains.reserve(links);
  rough.parts.reserve(pieces), rough.corners.reserve(corners);
  for (RawEchoes& part : parts) {
    append(part);
    part = {};
  }
}

EchoSender::EchoSender(const FacetWorld& world, const FacetTrees& trees, const EchoField& field,
                       const EchoOptions& options, bool monostatic)
    : world_(world),
      trees_(trees),
      field_(field),
      monostatic_(monostatic),
      home_(monostatic && options.max_bounces >= mirror_bounces) {
  // sigma = 4 pi |value|^2 / lambda^2
  limits_.floor = std::sqrt(options.border_floor_m2 * pi) / field.wavenumber();
  hidden_floor_ = std::sqrt(options.hidden_floor_m2 * pi) / field.wavenumber();
}

IntegralLimits EchoSender::limits_of(const PosedFacet& facet, const Polygon& piece, const dvec3& source,
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

Polygon EchoSender::lit_piece(const BeamWay& way, uint32_t last, const Polygon& part,
                              const dvec3& receiver) const {
  const PosedFacet& posed = world_.facet(way.chain[last]);
  const TubeBeam& beam = way.beams[last];
  // The receiver must be on the lit side: where the source was before the last surface turned the rays.
  if (posed.distance(beam.source) * posed.distance(receiver) <= 0.0) return {};
  return on_facet(posed, beam, part);
}

template <typename Look>
const BeamWay::Place& EchoSender::place_of(BeamWay& way, const dvec2& at, const Look& look) {
  // A corner comes back after a few contributions at most, or not at all.
  constexpr size_t looked_at = 16;
  const size_t count = way.places.size();
  for (size_t i = count; i > 0 && i + looked_at > count; --i)
    if (way.places[i - 1].at == at) return way.places[i - 1];
  BeamWay::Place& place = way.places.emplace_back();
  place.at = at;
  look(place);
  return place;
}

bool EchoSender::over_mirror(BeamWay& way, uint32_t bounce, const Polygon& part) const {
  const uint32_t facet = way.chain[bounce];
  if (!mirrors(world_, facet, way.chain[bounce - 1])) return false;
  // The previous surface has already sent this path back.
  if (bounce > 1 && home_ && facet == way.chain[0]) return true;
  send_over(way, bounce - 1, part, facet, Over::other, [](const Polygon&) { return 0u; });
  return true;
}

void EchoSender::send_piece_over(BeamWay& way, uint32_t last, const Polygon& piece, uint32_t mirror,
                                 Over way_home, uint32_t omitted) const {
  const PosedFacet &posed = world_.facet(way.chain[last]), &wall = world_.facet(mirror);
  const TubeBeam& beam = way.beams[last];
  const dvec3 image = field_.mirrored_receiver(mirror);
  way.contributions.clear(), way.places.clear();
  way.out->below_floor += integrate(phase_plane(posed, beam.source, image, field_.wavenumber()), piece,
                                    omitted, way.contributions, limits_of(posed, piece, beam.source, image));
  const auto look = [&](BeamWay::Place& place) {
    place.density = 0.0;
    place.point = point_of(posed, place.at);
    const dvec3 home = image - place.point;
    const double before = glm::distance(place.point, beam.source), after = glm::length(home);
    const double share = -wall.distance(place.point) / glm::dot(wall.normal, home);
    place.over = place.point + share * home;
    if (!(share > 0.0 && share < 1.0)) return;
    // A beam that came over the mirror directly to this surface returns over the mirror in the same way.
    if (!(way_home == Over::first && last == 1) && !trees_.contains(world_, mirror, place.over)) return;
    place.departure = glm::normalize(way.beams[0].along(beam.uv(place.point)));
    place.density =
        field_.density({place.departure, before, place.point, std::span(way.chain.data(), last + 1), mirror});
    place.arrival = glm::normalize(place.over - field_.receiver_at());
    place.length_m = before + after;
  };
  for (const Contribution& c : way.contributions) {
    const BeamWay::Place& place = place_of(way, c.at, look);
    const Complex amplitude = c.value * place.density;
    if (amplitude == 0.0) continue;
    const auto push = [&](const dvec3& out, const dvec3& in, const dvec3& at, bool reversed) {
      std::vector<uint32_t>& chains = way.out->chains;
      const uint32_t first = static_cast<uint32_t>(chains.size());
      chains.insert(chains.end(), way.chain.begin(), way.chain.begin() + last + 1);
      chains.push_back(mirror);
      if (reversed) std::reverse(chains.begin() + first, chains.end());
      way.out->echoes.push_back({amplitude, out, in, at, place.length_m, first, last + 2});
    };
    push(place.departure, place.arrival, place.over, false);
    if (way_home == Over::other && monostatic_ && last == 0)
      push(place.arrival, place.departure, place.point, true);
  }
}

void EchoSender::send_piece(BeamWay& way, uint32_t last, const Polygon& piece, uint32_t omitted) const {
  const PosedFacet& posed = world_.facet(way.chain[last]);
  const TubeBeam& beam = way.beams[last];
  way.contributions.clear(), way.places.clear();
  const PhasePlane plane = phase_plane(posed, beam.source, field_.receiver_at(), field_.wavenumber());
  way.out->below_floor += integrate(plane, piece, omitted, way.contributions,
                                    limits_of(posed, piece, beam.source, field_.receiver_at()));
  const std::span<const uint32_t> chain(way.chain.data(), last + 1);
  const auto look = [&](BeamWay::Place& place) {
    place.point = point_of(posed, place.at);
    const double before = glm::length(place.point - beam.source);
    place.departure = glm::normalize(way.beams[0].along(beam.uv(place.point)));
    place.density = field_.density({place.departure, before, place.point, chain});
    const dvec3 back = place.point - field_.receiver_at();
    const double after = glm::length(back);
    place.arrival = back / after;
    place.length_m = before + after;
  };
  for (const Contribution& c : way.contributions) {
    const BeamWay::Place& place = place_of(way, c.at, look);
    const Complex amplitude = c.value * place.density;
    if (amplitude == 0.0) continue;
    if (way.chain_at == ~0u) {
      way.chain_at = static_cast<uint32_t>(way.out->chains.size());
      way.out->chains.insert(way.out->chains.end(), chain.begin(), chain.end());
    }
    way.out->echoes.push_back(
        {amplitude, place.departure, place.arrival, place.point, place.length_m, way.chain_at, last + 1});
  }
}

}  // namespace greatx::rf
