// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the bandwidth and the time over which a channel stays correlated.
#pragma once

#include <span>

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

}  // namespace greatx::rf
