// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the scattering matrix of a target in its far field, for tables of scattering (docs/targets.md).
#pragma once

#include "gpu/tick_ring.h"
#include "rf/targets/target_model.h"
#include "rf/targets/tubes/tube_targets.h"

namespace greatx::rf {

/// Describes where a target is: its bodies' poses, and the point that its phases refer to, in local
/// coordinates.
struct PosedTarget {
  std::vector<Pose> bodies;
  dvec3 centre{0.0};
  double size_m = 1.0;  ///< diameter of a ball around the centre that holds the target
};

/// Returns a distance at which waves are plane over the target: the error of the phase at its edge is pi/400
/// at the wavelength.
double far_distance_m(const PosedTarget& target, double wavelength_m);

/// Returns the echoes for directions in world axes, which point away from the target. Times the square of
/// far_distance_m(), their transfers are entries of scattering matrices.
std::vector<TubeEcho> far_echoes(TubeTargets& tubes, scene::GpuScene& scene, gpu::TickRing& ring,
                                 const PosedTarget& target, const Aspect& aspect, double carrier_hz);

/// Returns the matrix for directions in world axes, on the bases (theta, phi) of the world at these
/// directions, which point away from the target.
ScatterMatrix far_field(TubeTargets& tubes, scene::GpuScene& scene, gpu::TickRing& ring,
                        const PosedTarget& target, const Aspect& aspect, double carrier_hz);

}  // namespace greatx::rf
