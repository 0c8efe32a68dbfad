// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/echoes/echo_field.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/units.h"
#include "rf/radar/echoes/surface_bounce.h"
#include "rf/radar/echoes/tube_beam.h"

namespace greatx::rf {
namespace {

constexpr Complex j{0.0, 1.0};

FieldVector crossed(const dvec3& a, const FieldVector& b) {
  return {glm::cross(a, b.re), glm::cross(a, b.im)};
}

FieldVector sum(const FieldVector& a, const FieldVector& b) { return {a.re + b.re, a.im + b.im}; }

void scale(FieldVector& field, double by) { field.re *= by, field.im *= by; }

}  // namespace

EchoField::EchoField(const FacetWorld& world, const RadioSurfaces& surfaces, const EchoOptions& options,
                     const TurnedElement& transmitter, const TurnedElement& receiver,
                     const dvec3& receiver_at)
    : world_(world),
      surfaces_(surfaces),
      options_(options),
      transmitter_(transmitter),
      receiver_(receiver),
      receiver_at_(receiver_at),
      wavenumber_(2.0 * pi / surfaces.wavelength_m()) {}

Complex EchoField::received(const FieldVector& field, const dvec3& arrival) const {
  Jones jones[1];
  const Angles at = angles_of(arrival);
  receiver_.respond(arrival, jones);
  return jones[0].theta * field.along(at.theta_hat()) + jones[0].phi * field.along(at.phi_hat());
}

FieldVector EchoField::incident(const EchoPoint& point, dvec3& direction) const {
  direction = point.departure;
  FieldVector field = field_towards(transmitter_, direction);
  for (size_t i = 0; i + 1 < point.chain.size(); ++i) {
    const PosedFacet& facet = world_.facet(point.chain[i]);
    SurfaceBounce at = bounce_of(surfaces_, facet, field, direction);
    field = at.reflected;
    scale(field, coherent_share(surfaces_, options_, facet.material, at.cosine));
    direction = at.out;
  }
  return field;
}

dvec3 EchoField::mirrored_receiver(uint32_t facet) const {
  return mirrored(world_.facet(facet), receiver_at_);
}

Complex EchoField::density(const EchoPoint& point) const {
  dvec3 in;
  const FieldVector field = incident(point, in);
  const PosedFacet& facet = world_.facet(point.chain.back());
  dvec3 receiver = receiver_at_;
  if (point.mirror != EchoPoint::none) receiver = mirrored_receiver(point.mirror);
  const dvec3 arm = receiver - point.point;
  const double distance = glm::length(arm);
  const dvec3 out = arm / distance;
  const SurfaceBounce at = bounce_of(surfaces_, facet, field, in);
  const double cos_out = glm::dot(out, at.normal);
  if (cos_out <= 0.0 || at.cosine <= 0.0) return 0.0;
  const FieldVector electric = sum(field, at.reflected);
  const FieldVector magnetic = sum(crossed(in, field), crossed(at.out, at.reflected));  // eta H
  // eta J - r x M with J = n x H and M = -n x E. The axes of `received` are transverse to r, so that it drops
  // the part along r.
  const FieldVector source = sum(crossed(at.normal, magnetic), crossed(out, crossed(at.normal, electric)));
  const double kept = coherent_share(surfaces_, options_, facet.material, 0.5 * (at.cosine + cos_out));
  const double wavelength = surfaces_.wavelength_m();
  const Complex scale_by =
      -j * (wavelength / (4.0 * pi)) * (wavenumber_ / (4.0 * pi)) * kept / (point.length_m * distance);
  if (point.mirror == EchoPoint::none) return scale_by * received(source, -out);
  const PosedFacet& mirror = world_.facet(point.mirror);
  const SurfaceBounce over = bounce_of(surfaces_, mirror, source, out);
  return scale_by * coherent_share(surfaces_, options_, mirror.material, over.cosine) *
         received(over.reflected, -over.out);
}

Complex EchoField::edge_density(const EdgePoint& point, const Fringe& strength) const {
  const dvec3& in = point.departure;
  const dvec3 arm = receiver_at_ - point.point;
  const double distance = glm::length(arm);
  const dvec3 out = arm / distance;
  const double sine_in = glm::length(glm::cross(in, point.along)),
               sine_out = glm::length(glm::cross(out, point.along));
  const FieldVector field = field_towards(transmitter_, in);
  const Complex electric = field.along(point.along), magnetic = crossed(in, field).along(point.along);
  FieldVector sent;
  const double share = 1.0 / (sine_in * sine_out * sine_out);
  sent.add(strength.soft * share * electric, point.along - glm::dot(point.along, out) * out);
  sent.add(strength.hard * share * magnetic, glm::cross(point.along, out));
  const PosedFacet& facet = world_.facet(point.facet);
  const double towards = glm::dot(in, facet.normal);
  const ReflectionCoefficients fresnel =
      surfaces_.reflect(facet.material, towards < 0.0, std::clamp(std::abs(towards), 1e-3, 1.0));
  const double reflects = 0.5 * (std::abs(fresnel.r_te) + std::abs(fresnel.r_tm));
  return reflects * surfaces_.wavelength_m() / (8.0 * pi * pi * point.length_m * distance) *
         received(sent, -out);
}

Complex EchoField::direct(const dvec3& transmitter_at) const {
  const dvec3 arm = receiver_at_ - transmitter_at;
  const double distance = glm::length(arm);
  GREATX_CHECK(distance > 0.0, "transmitter and receiver in one place");
  return surfaces_.wavelength_m() / (4.0 * pi * distance) *
         received(field_towards(transmitter_, arm / distance), -arm / distance);
}

}  // namespace greatx::rf
