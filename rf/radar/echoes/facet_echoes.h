// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the echoes of facets that are too small for the tubes of the grid. A ray of the grid may pass beside
// such a facet. Each facet whose echo may stand above the noise therefore has a beam of its own, which is as
// wide as the facet is seen from the transmitter. The beam is divided exactly at each bounce: EchoTracer
// gathers all facets that it may meet, and find_visible clips them to it. No reflector is missed for its
// size.
//
// The facets with beams are divided from the others by the first surface of an echo: TubeEchoes leaves out
// tubes that fall on them first. What a beam sees of a rough facet is kept for ClutterPatches.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "rf/radar/echoes/beam_memory.h"
#include "rf/radar/echoes/echo_sender.h"
#include "rf/radar/echoes/echo_tracer.h"
#include "rf/radar/echoes/mirrors.h"
#include "rf/radar/echoes/ray_grid.h"
#include "rf/radar/echoes/veils.h"
#include "rf/radar/echoes/visible_cells.h"

namespace greatx::rf {

/// Holds the facets that have beams of their own.
struct BeamedFacets {
  std::vector<uint8_t> marks;         ///< [facets] 1: it has a beam from the transmitter
  std::vector<uint8_t> mirrors;       ///< [facets] 1: a beam goes over it first
  std::vector<uint32_t> facets;       ///< facets with beams from the transmitter, ascending
  std::vector<MirroredFacet> images;  ///< facets with beams over mirrors, ascending

  /// Returns whether the echoes that begin with the first surfaces of a chain are those of a beam.
  bool hold(std::span<const uint32_t> chain) const {
    if (chain.size() == 1) return marks[chain[0]] != 0;
    return chain.size() == 2 && mirrors[chain[0]] != 0 &&
           std::binary_search(images.begin(), images.end(), MirroredFacet{chain[0], chain[1]});
  }
};

/// Holds what a search for the echoes of facets works on. All references outlive it.
struct FacetScene {
  const FacetWorld& world;
  const FacetTrees& trees;
  const EchoTracer& tracer;
  /// Null, or the veils through which `tracer` sees: only echoes of what is behind them are found then.
  const Veils* veils = nullptr;
  const ClutterPatches* clutter = nullptr;  ///< null: rough surfaces are not asked for
};

class FacetEchoes {
 public:
  /// `transmitter` and `receiver` are the ends; their bodies are not seen.
  FacetEchoes(const FacetScene& scene, const RayGrid& grid, const EchoField& field,
              const EchoOptions& options, const dvec3& source, bool monostatic, uint32_t own_body,
              uint32_t receiver_body);

  /// Returns the facets of which the grid may miss a part: those narrower than a few tubes, entirely in the
  /// field of view, whose echo may stand above the floor. `images` are those that are seen over mirrors.
  BeamedFacets choose(std::span<const MirroredFacet> images) const;
  /// The raw echoes of all parts, in their order, are those of the chosen facets. Parts do not depend on each
  /// other.
  static size_t parts(const BeamedFacets& chosen) {
    return (chosen.facets.size() + chosen.images.size() + chunk - 1) / chunk;
  }
  /// `memory` keeps the echoes of facets at rest; null: nothing is kept.
  void find(const BeamedFacets& chosen, size_t part, RawEchoes& out, BeamMemory* memory) const;

 private:
  struct Job;
  static constexpr uint32_t chunk = 32;
  bool chosen(uint32_t facet, const PosedFacet* mirror) const;
  /// Returns the outline of a piece in the coordinates of `beam`, and the largest distance of its corners
  /// along the axis. Returns an empty polygon if the piece is seen edge on.
  Polygon outline_of(uint32_t facet, uint32_t piece, const TubeBeam& beam, double& farthest) const;
  void solve(uint32_t facet, Job& job) const;
  void solve_or_remember(uint32_t facet, Job& job, BeamMemory& memory) const;
  void solve_over(const MirroredFacet& image, Job& job) const;
  /// Keeps what both ends see of a part of the first facet, if it is rough.
  void keep_rough(uint32_t facet, const Polygon& part, Job& job) const;
  /// Sends back from what is behind veils of a part that the source sees of a facet.
  void solve_behind(uint32_t facet, const Polygon& part, double farthest, Job& job) const;
  /// Replaces `pieces` by those that a part of a beam may meet nearer than `to`.
  void gather(Job& job, const EchoTracer& tracer, const EchoTracer::View& view, const TubeBeam& beam,
              const BeamStart& start, const Polygon& part, double to, std::vector<FacetPiece>& pieces) const;
  /// Returns the first facet that a ray of the transmitter's beams meets.
  EchoTracer::Met first(Job& job, const dvec3& origin, const dvec3& direction, uint32_t leaving) const;
  void follow(Job& job, uint32_t bounce, const Polygon& part, const BeamStart& start) const;
  /// Gathers what a part of a beam that leaves a surface may meet. Returns a facet that covers all of the
  /// part, so that nothing behind it is seen, or VisibleCell::nothing.
  uint32_t gather_next(Job& job, const TubeBeam& beam, const BeamStart& start, const Polygon& part) const;
  /// Sends back from the last surfaces that a beam may meet. Only facets that send more than the floor are
  /// looked at. An edge that another facet's shadow makes does not count for this.
  void finish(Job& job, uint32_t bounce, const Polygon& part, const BeamStart& start) const;
  /// Returns whether `part` of the beam on `facet` as its surface `bounce` may stand above the floor.
  bool may_send(const Job& job, uint32_t bounce, const Polygon& part, uint32_t facet) const;
  /// The same for the currents of a beam on a facet, and a receiver or its image.
  bool may_send_from(uint32_t facet, const TubeBeam& beam, const Polygon& part, const dvec3& receiver) const;
  /// Returns whether the facet is a mirror for the currents on the surface before.
  bool shows_before(const Job& job, uint32_t bounce, uint32_t facet) const;
  /// Notes that some rays of the beam meet a mirror next.
  void add_shown(Job& job, uint32_t bounce, uint32_t mirror) const;
  /// Sends over each such mirror what the beam lights of the surface before and the receiver sees over the
  /// mirror, wherever the specular rays of that part go.
  void send_over_shown(Job& job) const;
  void bounce_off(Job& job, uint32_t bounce, const Polygon& part, uint32_t facet) const;
  /// Sends back from what the receiver sees of surface `bounce`.
  void send(Job& job, uint32_t bounce, const Polygon& part) const;
  /// Puts what the receiver sees of `part` of the beam on surface `last`, directly or over `mirror`, into
  /// job.sending. Parts that are too wide for one view are not seen.
  void find_seen(Job& job, uint32_t last, const Polygon& part) const;
  void find_seen_over(Job& job, uint32_t last, const Polygon& part, uint32_t mirror) const;
  /// Holds the view of a part from the receiver or from its image.
  struct BackView {
    TubeBeam beam;
    Polygon outline;        ///< of the part, in the coordinates of `beam`
    double farthest = 0.0;  ///< distance of its corners along the axis
  };
  /// Returns false if the part is too wide for one view, or seen edge on.
  bool view_back(const Job& job, uint32_t last, const Polygon& part, const dvec3& from, BackView& view) const;
  /// Adds the parts in job.seen on surface `last`, in the coordinates of the beam, to job.sending.
  void keep_seen(Job& job, uint32_t last, const TubeBeam& back) const;

  const FacetScene& scene_;
  const RayGrid& grid_;
  const EchoField& field_;
  const EchoOptions& options_;
  bool monostatic_;
  Veils::Ends ends_;
  EchoSender sender_;
  EchoTracer::View beams_, receiver_;
  Veils::Views veil_views_;  ///< empty without veils
};

}  // namespace greatx::rf
