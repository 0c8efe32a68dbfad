// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the reflection of a plane wave by one surface of a radar's scene.
#pragma once

#include <cstdint>

#include "rf/antenna/field_vector.h"
#include "rf/config/echo_options.h"
#include "rf/facets/facet_world.h"
#include "rf/surface/surfaces.h"

namespace greatx::rf {

/// Holds the reflection of a wave by a surface: the lit side and the wave that leaves.
struct SurfaceBounce {
  dvec3 normal{0.0}, out{0.0};  ///< the normal points to the lit side
  double cosine = 0.0;          ///< of the angle of incidence
  FieldVector reflected;        ///< by a smooth surface
};

/// `in` is the unit vector of the wave that meets the facet.
SurfaceBounce bounce_of(const RadioSurfaces& surfaces, const PosedFacet& facet, const FieldVector& field,
                        const dvec3& in);

/// Returns the share of the amplitude that roughness and diffuse scattering leave to the specular wave.
double coherent_share(const RadioSurfaces& surfaces, const EchoOptions& options, uint32_t material,
                      double cosine);

}  // namespace greatx::rf
