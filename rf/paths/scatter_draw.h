// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Chooses the scatterings of a link that are traced, if there are too many for all of them. They are put into
// strata: first by the delay of the path, in bins of 10 ns, and in each bin by place, so that the strata of a
// bin have about the same power. One scattering is drawn from each stratum, with the probability of its share
// of the power that the stratum would send if nothing were in the way of the target, and gets the power of
// the whole stratum. Hence the expected power of every bin is that of all scatterings, and the crossings
// decide what is hidden (stratified sampling with probability proportional to size: W. G. Cochran, Sampling
// Techniques, 3rd ed., 1977, chapters 5A and 9A).
//
// Reflections behind a scattering are views of the target (ReflectedTarget), and each view has the whole tree
// to draw from. Most patches of a view do not reach the target. A patch that is drawn and does not stands for
// nothing, and the others stand for more.
//
// The draw of a stratum is a race of exponential clocks, which belong to patch and way. If the target moves a
// little, the strata change a little, and most scatterings that are drawn stay the same.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/vec.h"
#include "rf/paths/reflected_target.h"
#include "rf/paths/scatter_tree.h"

namespace greatx::rf {

/// Describes a scattering that is no patch of a tree, or whose way to the target is not straight.
struct SingleScattering {
  double power = 0.0;     ///< as ScatterTree::to() gives it; 0 or less: it is never drawn
  double length_m = 0.0;  ///< from the source to the target
  double clock = 0.0;     ///< as LitPatch::clock
};

/// Describes a scattering that is traced.
struct ScatterDraw {
  /// Index into ScatterTree::patches(), or the number of these plus an index of the single scatterings.
  uint32_t index = 0;
  double factor = 1.0;    ///< by which the patch's area grows, so that its power is that of the stratum
  uint32_t stratum = 0;   ///< from 1 on; 0: the scattering stands for itself alone
  uint32_t view = 0;      ///< 0: the way to the target is straight; else 1 + the view of a ReflectedTarget
  double variance = 0.0;  ///< of what it stands for, before the strata, relative to its square
};

/// Width of the bins of delay, as a length: 10 ns of light.
inline constexpr double delay_bin_m = 2.99792458;

/// Returns the share of the power that passes what never moves between a patch and the target, 0 to 1, on the
/// way of a ScatterDraw::view; 1 if the patch does not reach the target in this way.
using Sight = std::function<double(const LitPatch& patch, uint32_t view)>;

/// Returns at most `budget` draws from the patches of the tree, which send straight to a target, and from
/// `singles`, in the order of the strata. If there are not more of both, all are returned. `budget` must be
/// greater than 0. `sight` is asked for some patches of the tree. Where they are hidden, the patches around
/// them are drawn more rarely, and each stands for more. The answer depends on the arguments alone.
std::vector<ScatterDraw> draw_scatterings(const ScatterTree& tree, const dvec3& target,
                                          std::span<const SingleScattering> singles, uint32_t budget,
                                          const Sight& sight);

/// Does the same for patches that send to a target straight and over reflections. There must be more of them
/// than `budget`.
std::vector<ScatterDraw> draw_scatterings(const ScatterTree& tree, const dvec3& target,
                                          const ReflectedTarget& views, uint32_t budget, const Sight& sight);

}  // namespace greatx::rf
