// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Aligns a modelled frequency response with a measured one: clock and phase.
#pragma once

#include <span>

#include "rf/surface/fresnel.h"
#include "sim/fit/problem.h"

namespace greatx::sim {

/// Returns e^{-j 2 pi f t} at the subcarriers, f counted from the carrier.
std::vector<rf::Complex> clock_turn(const FitBand& band, double clock_s);
/// The most steps of a search for the clock of a position.
inline constexpr double most_clock_steps = 65536.0;
/// Returns the number of steps of best_clock() over a range.
double clock_steps(const FitBand& band, double low_s, double high_s);
/// Returns the clock from `low_s` to `high_s` by which `modelled` must be delayed so that its correlation
/// with `measured` has the largest magnitude: the largest at steps of a quarter of 1/bandwidth, then refined
/// by golden sections to 1e-6 of that step.
double best_clock(const FitBand& band, std::span<const rf::Complex> modelled,
                  std::span<const rf::Complex> measured, double low_s, double high_s);

}  // namespace greatx::sim
