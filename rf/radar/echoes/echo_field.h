// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The field that a tube carries, and what the currents that it excites on the last surface send to the
// receiver.
#pragma once

#include <cstdint>
#include <span>

#include "rf/antenna/element.h"
#include "rf/antenna/field_vector.h"
#include "rf/config/echo_options.h"
#include "rf/facets/facet_world.h"
#include "rf/surface/surfaces.h"

namespace greatx::rf {

/// One point of a path: transmitter, the facets that reflect, the last one with the point on it, receiver; or
/// from there over one more facet to the receiver.
struct EchoPoint {
  dvec3 departure{1, 0, 0};         ///< unit, at the transmitter
  double length_m = 0.0;            ///< from the transmitter to the point, unfolded
  dvec3 point{0.0};                 ///< on the last facet
  std::span<const uint32_t> chain;  ///< facets met, that of the point included
  static constexpr uint32_t none = ~0u;
  uint32_t mirror = none;  ///< facet that the way to the receiver is reflected at
};

/// Time convention e^{+j omega t}. Currents of physical optics on the lit side, J = n x (H_i + H_r) and
/// M = (E_i + E_r) x n with E_r by the material's Fresnel coefficients at the local angle of incidence (C. A.
/// Balanis, "Advanced Engineering Electromagnetics", 2nd ed., 7.10; for a perfect conductor J = 2 n x H_i, M
/// = 0), and what they radiate (ibid., 6.8): E_s = -jk/(4 pi r2) e^{-jk r2} integral of [eta J - r x M]
/// across r.
class EchoField {
 public:
  EchoField(const FacetWorld& world, const RadioSurfaces& surfaces, const EchoOptions& options,
            const TurnedElement& transmitter, const TurnedElement& receiver, const dvec3& receiver_at);

  /// Received over transmitted amplitude for 1 m^2 of the surface around the point, without the phase of the
  /// path; 0 where the receiver is behind the surface.
  Complex density(const EchoPoint& point) const;
  /// The same for a patch of `area_m2` that scatters diffusely (rf/surface/scattering.h), first surface only:
  /// the patch's phases are those of its place on the facet, so they go with the surface.
  Complex diffuse(const EchoPoint& point, double area_m2) const;
  /// Line of sight: lambda/(4 pi d) F_r . F_t.
  Complex direct(const dvec3& transmitter_at) const;

  const dvec3& receiver_at() const { return receiver_at_; }
  /// The receiver's image in a facet's plane.
  dvec3 mirrored_receiver(uint32_t facet) const;
  double wavenumber() const { return wavenumber_; }
  bool reflects(uint32_t facet) const {
    return !surfaces_.surface(world_.facet(facet).material).front.empty();
  }

 private:
  FieldVector radiated(const dvec3& departure) const;
  FieldVector incident(const EchoPoint& point, dvec3& direction) const;
  Complex received(const FieldVector& field, const dvec3& arrival) const;
  double coherent_share(uint32_t material, double cos_in, double cos_out) const;

  const FacetWorld& world_;
  const RadioSurfaces& surfaces_;
  const EchoOptions& options_;
  const TurnedElement& transmitter_;
  const TurnedElement& receiver_;
  dvec3 receiver_at_;
  double wavenumber_;
};

}  // namespace greatx::rf
