// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Over which bandwidth and for how long a channel stays what it is.
#pragma once

#include <cstdint>
#include <span>

#include "rf/channel/statistics.h"
#include "rf/geometry/path.h"

namespace greatx::rf {

/// The smallest frequency offset at which the correlation |sum p_i e^{-j 2 pi df tau_i}| / sum p_i (the
/// Fourier transform of the power delay profile: uncorrelated scattering, P. A. Bello, IEEE Trans. Commun.
/// Syst. 11(4), 1963; Rec. ITU-R P.1407) falls to `level`, in (0, 1); to 1e-9 of the level. +inf: never
/// within 10/(rms delay spread), as for one path or a line of sight of more than (1 + level)/2 of the power.
/// NaN: no path has power. `powers` [paths]; any order of the paths gives the same bits. Thread-safe.
double coherence_bandwidth_hz(std::span<const Path> paths, std::span<const double> powers, double level);

/// The same over time for the Doppler shifts: |sum p_i e^{j 2 pi nu_i dt}| / sum p_i. +inf: never within
/// 10/(rms Doppler spread); nothing moves.
double coherence_time_s(std::span<const Path> paths, std::span<const double> powers, double level);

/// 1/(5 x rms delay spread), the rule of thumb for a correlation of 0.5 (T. S. Rappaport, Wireless
/// Communications, 2nd ed., 5.4.2). +inf: no spread.
double coherence_bandwidth_rule_hz(const LinkStatistics& link);
/// 9/(16 pi f_m), the rule of thumb for a correlation of 0.5 (Rappaport, 5.4.3), f_m the greatest |Doppler
/// shift| of a path that has power. +inf: nothing moves.
double coherence_time_rule_s(std::span<const Path> paths, std::span<const double> powers);

}  // namespace greatx::rf
