// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the field that a tube carries to its last surface, and the field that the currents on this surface
// send to the receiver.
#pragma once

#include <cstdint>
#include <span>

#include "rf/antenna/element.h"
#include "rf/antenna/field_vector.h"
#include "rf/config/echo_options.h"
#include "rf/facets/facet_world.h"
#include "rf/radar/echoes/fringe.h"
#include "rf/surface/surfaces.h"

namespace greatx::rf {

/// Describes a path from the transmitter over the facets that reflect to a point on the last facet, and from
/// there to the receiver, either directly or over one more facet.
struct EchoPoint {
  dvec3 departure{1, 0, 0};         ///< unit vector at the transmitter
  double length_m = 0.0;            ///< unfolded length from the transmitter to the point
  dvec3 point{0.0};                 ///< point on the last facet
  std::span<const uint32_t> chain;  ///< facets met, including that of the point
  static constexpr uint32_t none = ~0u;
  uint32_t mirror = none;  ///< facet that reflects the way to the receiver
};

/// Describes a point of an edge.
struct EdgePoint {
  dvec3 departure{1, 0, 0};  ///< unit vector at the transmitter
  double length_m = 0.0;     ///< from the transmitter to the point
  dvec3 point{0.0};
  dvec3 along{1, 0, 0};  ///< unit vector along the edge
  uint32_t facet = 0;    ///< one of its faces
};

/// Computes fields by physical optics, with the time convention e^{+j omega t}. The currents on the lit side
/// are J = n x (H_i + H_r) and M = (E_i + E_r) x n, where E_r follows from the Fresnel coefficients of the
/// material at the local angle of incidence (C. A. Balanis, "Advanced Engineering Electromagnetics", 2nd ed.,
/// 7.10; a perfect conductor has J = 2 n x H_i, M = 0). The radiated field is the part transverse to r of
///   E_s = -jk/(4 pi r2) e^{-jk r2} integral of [eta J - r x M]   (ibid., 6.8).
class EchoField {
 public:
  EchoField(const FacetWorld& world, const RadioSurfaces& surfaces, const EchoOptions& options,
            const TurnedElement& transmitter, const TurnedElement& receiver, const dvec3& receiver_at);

  /// Returns the ratio of received to transmitted amplitude for 1 m^2 of the surface around the point,
  /// without the phase of the path. Returns 0 if the receiver is behind the surface.
  Complex density(const EchoPoint& point) const;
  /// Returns the ratio for 1 m of an edge around the point, by its fringe currents. The coefficients are
  /// those of a conductor; for another material they are multiplied by the mean of the magnitudes of both
  /// Fresnel coefficients, an approximation.
  Complex edge_density(const EdgePoint& point, const Fringe& strength) const;
  /// Returns the ratio for the line of sight: lambda/(4 pi d) F_r . F_t.
  Complex direct(const dvec3& transmitter_at) const;

  const dvec3& receiver_at() const { return receiver_at_; }
  /// Returns the image of the receiver in the plane of a facet.
  dvec3 mirrored_receiver(uint32_t facet) const;
  double wavenumber() const { return wavenumber_; }
  bool reflects(uint32_t facet) const {
    return !surfaces_.surface(world_.facet(facet).material).front.empty();
  }

 private:
  FieldVector incident(const EchoPoint& point, dvec3& direction) const;
  Complex received(const FieldVector& field, const dvec3& arrival) const;

  const FacetWorld& world_;
  const RadioSurfaces& surfaces_;
  const EchoOptions& options_;
  const TurnedElement& transmitter_;
  const TurnedElement& receiver_;
  dvec3 receiver_at_;
  double wavenumber_;
};

}  // namespace greatx::rf
