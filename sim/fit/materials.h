// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Gives the materials of a scene the values of a fit.
#pragma once

#include <span>
#include <vector>

#include "rf/surface/surfaces.h"
#include "scene/description/scene.h"
#include "sim/fit/problem.h"

namespace greatx::sim {

/// The parameters of a fit, bound to the materials of a scene at a carrier. `scene` outlives this.
class FitMaterials {
 public:
  /// Throws UserError, at the parameter, if no material of the scene has the name or the layer, if materials
  /// that share a value start from different ones and none is given, if the start is not within the bounds,
  /// if a thickness is that of a half-space, or if a scattering coefficient starts from 0 (no path scatters
  /// then).
  FitMaterials(const scene::Scene& scene, double carrier_hz, std::span<const FitParameter> parameters);

  /// Returns the value of each parameter before the fit.
  const std::vector<double>& start() const { return start_; }
  /// Returns the indices of the scene's materials that have parameter `parameter`.
  const std::vector<uint32_t>& materials(size_t parameter) const { return materials_[parameter]; }
  /// Returns, for each material of the scene, the parameters that it has.
  const std::vector<std::vector<uint32_t>>& parameters_of() const { return parameters_of_; }

  /// Returns the surfaces of the scene with `values`, [parameters].
  rf::RadioSurfaces surfaces(std::span<const double> values) const;
  /// Returns the radio side of a material with `values`. Where a parameter is electric, the layer's medium
  /// keeps the exponents and the range of the row that holds at the carrier: eta' = a f^b and sigma = c f^d
  /// have the fitted values at the carrier.
  scene::RadioMaterial material(uint32_t index, std::span<const double> values) const;

 private:
  const scene::Scene& scene_;
  double carrier_hz_;
  std::vector<FitParameter> parameters_;
  std::vector<std::vector<uint32_t>> materials_;      ///< [parameters]
  std::vector<std::vector<uint32_t>> parameters_of_;  ///< [materials of the scene]
  std::vector<double> start_;
  std::vector<rf::RadioSurface> surfaces_;  ///< of the scene as it is
};

}  // namespace greatx::sim
