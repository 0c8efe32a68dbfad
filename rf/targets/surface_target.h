// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A target that is a panel of phase-shifting elements (docs/surfaces.md).
#pragma once

#include <cstdint>
#include <vector>

#include "rf/targets/target_model.h"

namespace greatx::rf {

/// Describes the elements of a panel. They lie in the plane x = 0 of the panel's frame about its origin, in
/// rows along +z and columns along +y, and face +x. Element = row * columns + column, the lowest row first.
struct SurfaceLayout {
  uint32_t rows = 1, columns = 1;
  double row_spacing_m = 0.0, column_spacing_m = 0.0;  ///< at most half a wavelength, for the power balance
  double wavelength_m = 0.0;

  size_t elements() const { return size_t{rows} * columns; }
  double element_area_m2() const { return row_spacing_m * column_spacing_m; }
  dvec3 element(size_t index) const;
};

/// Describes where a wave comes from or goes to, in the panel's frame.
struct SurfaceAim {
  dvec3 direction{1.0, 0.0, 0.0};  ///< unit vector away from the panel
  double distance_m = far_away;    ///< to the point that the wave is a sphere about; infinite: a plane wave
};

/// Returns the phases, rad, [elements], with which a wave from one aim arrives at the other in step.
std::vector<double> steered_phases(const SurfaceLayout& layout, const SurfaceAim& from, const SurfaceAim& to);
/// Rounds phases to the nearest of 2^bits steps of a turn.
void round_phases(std::vector<double>& phases, uint32_t bits);

/// Scatters by the sum over the elements of S_n = j (A/lambda) sqrt(cos theta_s cos theta_r) Gamma_n, with
/// the distances of each element if Aspect has finite ones. Nothing is scattered from behind or to behind.
/// The polarization is kept by Ludwig's third definition (IEEE Trans. Antennas Propag. 21(1), 1973) about +x.
/// Reciprocal: exchanged ends have the transposed matrix. For spacings up to half a wavelength the scattered
/// power is at most max|Gamma|^2 of the power that falls on the elements.
class SurfaceTarget : public TargetModel {
 public:
  /// `phases`: rad, [elements]. `amplitude`: |Gamma|, 0 to 1.
  SurfaceTarget(const SurfaceLayout& layout, const std::vector<double>& phases, double amplitude);
  ScatterMatrix scatter(const Aspect& aspect, const EchoKey& key) const override;

 private:
  SurfaceLayout layout_;
  std::vector<Complex> reflections_;  ///< [elements]
};

}  // namespace greatx::rf
