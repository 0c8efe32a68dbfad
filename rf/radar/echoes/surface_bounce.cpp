// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/echoes/surface_bounce.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "rf/surface/incidence.h"
#include "rf/surface/roughness.h"

namespace greatx::rf {

SurfaceBounce bounce_of(const RadioSurfaces& surfaces, const PosedFacet& facet, const FieldVector& field,
                        const dvec3& in) {
  SurfaceBounce b;
  const double towards = glm::dot(in, facet.normal);
  b.normal = towards < 0.0 ? facet.normal : -facet.normal;
  b.cosine = std::min(1.0, std::abs(towards));
  b.out = in - 2.0 * towards * facet.normal;
  const ReflectionCoefficients fresnel = surfaces.reflect(facet.material, towards < 0.0, b.cosine);
  const dvec3 s = s_axis(in, b.normal);
  b.reflected.add(fresnel.r_te * field.along(s), s);
  b.reflected.add(fresnel.r_tm * field.along(glm::cross(in, s)), glm::cross(b.out, s));
  return b;
}

double coherent_share(const RadioSurfaces& surfaces, const EchoOptions& options, uint32_t material,
                      double cosine) {
  return specular_share(surfaces.surface(material), std::min(1.0, cosine), surfaces.wavelength_m(),
                        options.roughness ? std::optional(RoughnessModel::ament) : std::nullopt,
                        options.diffuse);
}

}  // namespace greatx::rf
