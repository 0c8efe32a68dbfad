// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the bandwidth and the time over which a channel stays correlated.
#pragma once

#include <cstdint>
#include <span>

#include "rf/channel/statistics.h"
#include "rf/geometry/path.h"

namespace greatx::rf {

/// Returns the smallest frequency offset df at which the correlation |sum p_i e^{-j 2 pi df tau_i}| / sum p_i
/// falls to `level`, to 1e-9 of the level. The correlation is the Fourier transform of the power delay
/// profile, for uncorrelated scattering (P. A. Bello, IEEE Trans. Commun. Syst. 11(4), 1963; Rec. ITU-R
/// P.1407).
/// `level` lies in (0, 1). `powers` is [paths]; any order of the paths gives the same bits. Returns +inf if
/// the correlation does not fall to `level` within 10/(rms delay spread), for example if there is one path or
/// a line of sight with more than (1 + level)/2 of the power. Returns NaN if no path has power. Thread-safe.
double coherence_bandwidth_hz(std::span<const Path> paths, std::span<const double> powers, double level);

/// Returns the coherence time in the same way from the Doppler shifts nu_i: the correlation is |sum p_i e^{j
/// 2 pi nu_i dt}| / sum p_i. Returns +inf if the correlation does not fall to `level` within 10/(rms Doppler
/// spread), for example if nothing moves.
double coherence_time_s(std::span<const Path> paths, std::span<const double> powers, double level);

/// Returns 1/(5 x rms delay spread), the rule of thumb for a correlation of 0.5 (T. S. Rappaport, Wireless
/// Communications, 2nd ed., 5.4.2). Returns +inf if the delays have no spread.
double coherence_bandwidth_rule_hz(const LinkStatistics& link);
/// Returns 9/(16 pi f_m), the rule of thumb for a correlation of 0.5 (Rappaport, 5.4.3), where f_m is the
/// greatest |Doppler shift| of a path that has power. Returns +inf if nothing moves, and NaN if no path has
/// power.
double coherence_time_rule_s(std::span<const Path> paths, std::span<const double> powers);

}  // namespace greatx::rf
