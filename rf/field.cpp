// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/field.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/units.h"
#include "rf/field_vector.h"

namespace greatx::rf {
namespace {

dvec3 mirrored(const dvec3& direction, const dvec3& normal) {
  return direction - 2.0 * glm::dot(direction, normal) * normal;
}

/// Unit vectors of the segments [facets + 1], from the transmitter on.
std::vector<dvec3> segment_directions(const GeometricPath& path, const FacetWorld& world) {
  const size_t count = path.interactions.size() + 1;
  std::vector<dvec3> directions(count);
  size_t longest = 0;
  double longest_m = 0.0;
  for (size_t i = 0; i < count; ++i) {
    const double length = glm::length(path.vertices[i + 1] - path.vertices[i]);
    if (length > longest_m) longest = i, longest_m = length;
  }
  directions[longest] = (path.vertices[longest + 1] - path.vertices[longest]) / longest_m;
  const auto normal = [&](size_t reflection) {
    return world.facet(path.interactions[reflection].element).normal;
  };
  for (size_t i = longest; i + 1 < count; ++i) directions[i + 1] = mirrored(directions[i], normal(i));
  for (size_t i = longest; i > 0; --i) directions[i - 1] = mirrored(directions[i], normal(i - 1));
  return directions;
}

/// Any unit vector perpendicular to k.
dvec3 any_perpendicular(const dvec3& k) {
  const dvec3 axis = std::abs(k.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
  return glm::normalize(glm::cross(k, axis));
}

void reflect(FieldVector (&columns)[2], const dvec3& in, const dvec3& out, const PosedFacet& facet,
             const RadioSurfaces& surfaces) {
  const double towards = glm::dot(in, facet.normal);
  const FresnelCoefficients fresnel =
      surfaces.reflect(facet.material, towards < 0.0, std::min(1.0, std::abs(towards)));
  // Within 1e-8 of the normal the plane of incidence is noise, and r_TE = -r_TM to 1e-16: any s gives the
  // same field.
  const dvec3 across = glm::cross(in, facet.normal);
  const double sine = glm::length(across);
  const dvec3 s = sine > 1e-8 ? across / sine : any_perpendicular(in);
  const dvec3 p_in = glm::cross(in, s), p_out = glm::cross(out, s);
  for (FieldVector& field : columns) {
    const Complex te = fresnel.r_te * field.along(s), tm = fresnel.r_tm * field.along(p_in);
    field = {};
    field.add(te, s);
    field.add(tm, p_out);
  }
}

}  // namespace

Path path_field(const GeometricPath& geometry, const FieldModel& model, const dvec3& transmitter_velocity,
                const dvec3& receiver_velocity) {
  const FacetWorld& world = *model.world;
  const RadioSurfaces& surfaces = *model.surfaces;
  GREATX_CHECK(geometry.vertices.size() == geometry.interactions.size() + 2 && geometry.length_m > 0.0,
               "path of {} facets, {} vertices, {} m", geometry.interactions.size(), geometry.vertices.size(),
               geometry.length_m);
  const std::vector<dvec3> directions = segment_directions(geometry, world);

  Path path;
  path.interactions = geometry.interactions;
  path.vertices = geometry.vertices;
  path.length_m = geometry.length_m;
  path.foliage_m = geometry.foliage_m;
  path.delay_s = geometry.length_m / speed_of_light;
  path.departure = directions.front();
  path.arrival = -directions.back();

  FieldVector columns[2];  // what unit fields along theta and phi at the transmitter have become
  columns[0].add(1.0, theta_hat(path.departure));
  columns[1].add(1.0, phi_hat(path.departure));
  // Rate at which the path shortens, m/s (physics: v_0 . k_0 - v_{n+1} . k_n + sum v_i . (k_i - k_{i-1})).
  double closing =
      glm::dot(transmitter_velocity, directions.front()) - glm::dot(receiver_velocity, directions.back());
  for (size_t i = 0; i < path.interactions.size(); ++i) {
    const uint32_t facet = path.interactions[i].element;
    reflect(columns, directions[i], directions[i + 1], world.facet(facet), surfaces);
    closing += glm::dot(world.velocity(facet, path.vertices[i + 1]), directions[i + 1] - directions[i]);
  }
  path.doppler_hz = closing / surfaces.wavelength_m();

  const dvec3 theta = theta_hat(path.arrival), phi = phi_hat(path.arrival);
  for (int column = 0; column < 2; ++column) {
    path.transfer[column] = columns[column].along(theta) / path.length_m;
    path.transfer[2 + column] = columns[column].along(phi) / path.length_m;
  }
  return path;
}

}  // namespace greatx::rf
