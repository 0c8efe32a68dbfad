// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes what the currents on a part of a surface send to the receiver: the phase integral over the part,
// the fields of the way there, and the way to the receiver, directly or over one more surface that mirrors
// it. Tubes (TubeEchoes) and the beams of small facets (FacetEchoes) use it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "rf/radar/echoes/clutter_patches.h"
#include "rf/radar/echoes/echo_field.h"
#include "rf/radar/echoes/facet_trees.h"
#include "rf/radar/echoes/tube_beam.h"
#include "rf/radar/echoes/tube_integral.h"

namespace greatx::rf {

/// Holds the contribution of one place, before merging.
struct RawEcho {
  Complex amplitude;
  dvec3 departure{0.0}, arrival{0.0};  ///< as in Echo
  dvec3 point{0.0};
  double length_m = 0.0;     ///< unfolded length from the transmitter to the receiver
  uint32_t first_facet = 0;  ///< start of the echo's chain in RawEchoes::chains
  uint32_t bounces = 0;
};

struct RawEchoes {
  std::vector<RawEcho> echoes;
  std::vector<uint32_t> chains;
  uint64_t below_floor = 0;
  uint32_t remembered = 0;  ///< facets with beams whose echoes were kept from an earlier search
  ClutterParts rough;       ///< what the tubes see of surfaces that scatter, first or over a mirror
  std::span<const uint32_t> chain(const RawEcho& echo) const {
    return std::span(chains).subspan(echo.first_facet, echo.bounces);
  }
  /// Appends other echoes.
  void append(const RawEchoes& more);
  /// Appends all parts in their order. The parts lose their contents.
  void join(std::span<RawEchoes> parts);
};

/// Holds the way of a beam over the surfaces that it has met, and the working memory of its contributions.
struct BeamWay {
  /// Holds what the echo of a contribution takes from its place alone. Two sides of a piece contribute at the
  /// corner between them.
  struct Place {
    dvec2 at{0.0};
    Complex density;  ///< 0 if nothing comes back from there
    dvec3 point{0.0}, departure{0.0}, arrival{0.0};
    dvec3 over{0.0};  ///< point on the mirror that reflects the way to the receiver
    double length_m = 0.0;
  };
  std::array<TubeBeam, most_surfaces> beams;  ///< [number of bounces before]
  std::array<uint32_t, most_surfaces> chain{};
  uint32_t chain_at = ~0u;  ///< start of the present chain in out->chains; ~0: not stored yet
  RawEchoes* out = nullptr;
  std::vector<Contribution> contributions;
  std::vector<Place> places;  ///< of the contributions of one piece so far
};

/// Returns a part of a beam on a facet, in the plane coordinates of the facet. Returns an empty polygon if a
/// corner of the part does not fall on the plane.
Polygon on_facet(const PosedFacet& facet, const TubeBeam& beam, const Polygon& part);

/// Returns the points from which the phase on a facet is counted.
PhasePlane phase_plane(const PosedFacet& facet, const dvec3& source, const dvec3& receiver,
                       double wavenumber);

class EchoSender {
 public:
  EchoSender(const FacetWorld& world, const FacetTrees& trees, const EchoField& field,
             const EchoOptions& options, bool monostatic);

  /// Selects the mirror on the way to the receiver: the first surface of the beam, or the surface that it
  /// meets next.
  enum class Over : uint8_t { first, other };

  /// Adds the echoes of surface `bounce` of the way, on which `part` of the beam falls. If the surface is a
  /// mirror for the surface before, adds those of the surface before over this mirror. `omitted(piece)`
  /// returns the sides that integrate() omits.
  template <typename Omitted>
  void send_back(BeamWay& way, uint32_t bounce, const Polygon& part, const Omitted& omitted) const {
    if (bounce > 0 && over_mirror(way, bounce, part)) return;
    send_direct(way, bounce, part, omitted);
  }
  /// Adds the echoes of the currents on surface `last` of the way that reach the receiver directly.
  template <typename Omitted>
  void send_direct(BeamWay& way, uint32_t last, const Polygon& part, const Omitted& omitted) const {
    const Polygon piece = lit_piece(way, last, part, field_.receiver_at());
    if (!piece.empty()) send_piece(way, last, piece, omitted(piece));
  }
  /// Adds the echoes of the currents on surface `last` of the way that reach the receiver over `mirror`. If
  /// the opposite path is not searched for, it is added with this one.
  template <typename Omitted>
  void send_over(BeamWay& way, uint32_t last, const Polygon& part, uint32_t mirror, Over way_home,
                 const Omitted& omitted) const {
    const Polygon piece = lit_piece(way, last, part, field_.mirrored_receiver(mirror));
    if (!piece.empty()) send_piece_over(way, last, piece, mirror, way_home, omitted(piece));
  }
  /// Returns the limits of the phase integral over a piece, whose floor is that at the corner nearest to both
  /// ends.
  IntegralLimits limits_of(const PosedFacet& facet, const Polygon& piece, const dvec3& source,
                           const dvec3& receiver) const;
  /// Returns the value of a phase integral, m^2, below which nothing is kept, for a place at the distances
  /// `out` and `home` from both ends.
  double floor_at(double out, double home) const {
    return std::max(limits_.floor, hidden_floor_ * out * home);
  }
  /// Returns whether beams that came over mirrors send back over them.
  bool home() const { return home_; }

 private:
  /// Sends the currents of the surface before over surface `bounce`. Returns false if that is no mirror.
  bool over_mirror(BeamWay& way, uint32_t bounce, const Polygon& part) const;
  /// Returns the part on surface `last`, or an empty polygon if the receiver is on its dark side.
  Polygon lit_piece(const BeamWay& way, uint32_t last, const Polygon& part, const dvec3& receiver) const;
  void send_piece(BeamWay& way, uint32_t last, const Polygon& piece, uint32_t omitted) const;
  void send_piece_over(BeamWay& way, uint32_t last, const Polygon& piece, uint32_t mirror, Over way_home,
                       uint32_t omitted) const;
  /// Returns the place `at` of the present piece, which `look` completes if no contribution was there before.
  template <typename Look>
  static const BeamWay::Place& place_of(BeamWay& way, const dvec2& at, const Look& look);

  const FacetWorld& world_;
  const FacetTrees& trees_;
  const EchoField& field_;
  bool monostatic_, home_;
  IntegralLimits limits_;
  /// Floor of a border contribution 1 m from both ends, below which noise hides it, m^2.
  double hidden_floor_;
};

}  // namespace greatx::rf
