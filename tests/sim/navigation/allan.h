// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace greatx::test {

/// Returns the overlapping Allan deviation of samples `step_s` apart for an averaging time of `count` samples
/// (IEEE Std 952-1997, annex C, eq. C.3, with overlapping groups).
double allan_deviation(std::span<const double> samples, size_t count);

/// Returns the Allan deviation of a first-order Gauss-Markov process of standard deviation `sigma` and
/// correlation time T for the averaging time tau: sigma^2 (2 T / tau) (1 - (T / 2 tau) (3 - 4 exp(-tau / T) +
/// exp(-2 tau / T))) (IEEE Std 952-1997, annex C, section C.1.7, with q_c^2 = 2 sigma^2 / T).
double gauss_markov_allan(double sigma, double time_s, double tau_s);

}  // namespace greatx::test
