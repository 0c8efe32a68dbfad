// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// From what the rays have met to what every tube sends back: geometry and fields, fp64, tube by tube.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rf/radar/echoes/echo_field.h"
#include "rf/radar/echoes/ray_grid.h"
#include "rf/radar/echoes/ray_hits.h"
#include "rf/radar/echoes/tube_integral.h"
#include "rf/radar/echoes/visible_cells.h"

namespace greatx::rf {

/// A place that sends something back, before merging.
struct RawEcho {
  Complex amplitude;
  dvec3 departure{0.0}, arrival{0.0};  ///< as Echo's
  dvec3 point{0.0};
  double length_m = 0.0;     ///< transmitter to receiver, unfolded
  uint32_t first_facet = 0;  ///< of its chain, into RawEchoes::chains
  uint32_t bounces = 0;
};

struct RawEchoes {
  std::vector<RawEcho> echoes;
  std::vector<uint32_t> chains;
  uint64_t below_floor = 0;
  std::span<const uint32_t> chain(const RawEcho& echo) const {
    return std::span(chains).subspan(echo.first_facet, echo.bounces);
  }
};

/// A tube is *whole* up to a bounce if its ray and the eight around it have met the same facets so far and
/// agree on seeing the receiver: then all of it falls on that facet. Else it is divided by find_visible among
/// the facets that those nine have met after the same facets before, if anything sends from there: any of the
/// nine sees the receiver then or later. Each part goes on as a beam of its own.
///
/// Where a small surface is followed by a large one (target, wall), the currents are taken on the small one
/// and the large one is a mirror on the way to the receiver: on the large one the wave of a small surface has
/// no parallel rays, and currents there would be stronger than they are (by 10 dB in the test). The same path
/// backwards, out over the mirror, is its reciprocal for a monostatic radar: it is added with it, and not
/// looked for on its own where the small surface is seen directly.
///
/// A tube that came by a mirror sends back over it, too (wall, target, wall), from all surfaces from which
/// the radar is seen there, wherever their own reflections go: what the wall shows is an image of the radar,
/// and it sees the target as the radar itself would from there.
///
/// Errors: a surface that none of the nine rays meets is not there; where all nine meet one instance (a fine
/// mesh) what is left uncovered counts as the middle ray's facet.
class TubeEchoes {
 public:
  TubeEchoes(const RayGrid& grid, const RayHits& hits, const FacetWorld& world, const FacetTrees& trees,
             const EchoField& field, const scene::Scene& scene, const dvec3& source, bool monostatic,
             const EchoOptions& options);

  /// All tubes, in their order, on options.threads threads.
  RawEchoes find() const;

 private:
  struct Job;
  static constexpr uint32_t chunk = 128;
  /// How a whole tube's integral goes at each bounce, so that neighbours know what cancels.
  enum class Whole : uint8_t { no, silent, border, other };
  void classify(uint32_t tube);
  bool ring_agrees(uint32_t tube, const std::array<uint32_t, 8>& ring, uint32_t bounce) const;
  void solve(uint32_t tube, Job& job) const;
  void follow(Job& job, uint32_t bounce, const Polygon& part, const BeamStart& start, bool whole) const;
  void divide(Job& job, uint32_t bounce, const Polygon& part, const BeamStart& start,
              std::vector<VisibleCell>& cells) const;
  void bounce_off(Job& job, uint32_t bounce, const Polygon& part, uint32_t facet, bool whole) const;
  void send_back(Job& job, uint32_t bounce, const Polygon& part, uint32_t facet, bool whole) const;
  /// Which mirror the way to the receiver goes over: the tube's first surface, or another one that its ray
  /// meets next.
  enum class Over : uint8_t { first, other };
  /// Currents on surface `last` of the chain, and what they send over `mirror`; with the same path backwards
  /// where only this one is looked for.
  void send_over(Job& job, uint32_t last, const Polygon& part, uint32_t mirror, Over way_home,
                 bool whole) const;
  void scatter(Job& job, const Polygon& part, uint32_t facet) const;
  /// Whether the ray of a tube, from that bounce on, met anything that sends something to the receiver.
  bool may_send(uint32_t tube, uint32_t bounce) const;
  /// Of the ray, this one's or one's around it, that met the facet after the same ones.
  uint32_t word_of(const Job& job, uint32_t bounce, uint32_t facet) const;
  bool same_chain(const Job& job, uint32_t tube, uint32_t length) const;
  uint32_t omitted_sides(const Job& job, uint32_t bounce, const PosedFacet& facet, const Polygon& piece,
                         bool whole) const;
  IntegralLimits limits_of(const PosedFacet& facet, const Polygon& piece, const dvec3& source,
                           const dvec3& receiver) const;
  void add(Job& job, uint32_t bounce, const PosedFacet& facet, const dvec2& at, Complex value) const;

  const RayGrid& grid_;
  const RayHits& hits_;
  const FacetWorld& world_;
  const FacetTrees& trees_;
  const EchoField& field_;
  const scene::Scene& scene_;
  dvec3 source_;
  bool monostatic_;
  const EchoOptions& options_;
  uint32_t bounces_;  ///< traced
  bool home_;         ///< tubes that come by mirrors send back over them
  IntegralLimits limits_;
  double hidden_floor_;       ///< of a border's contribution 1 m from both ends, m^2
  std::vector<Whole> whole_;  ///< [tubes * bounces]
};

/// The tube's quadrilateral in its own coordinates.
Polygon tube_part(const std::array<dvec3, 4>& corners, const TubeBeam& beam);
/// A part of a beam on a facet, in the facet's plane coordinates; empty where it does not fall on the plane.
Polygon on_facet(const PosedFacet& facet, const TubeBeam& beam, const Polygon& part);

}  // namespace greatx::rf
