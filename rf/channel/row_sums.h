// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The hot loop of the frequency response: amplitudes of rows (pairs of ports at time samples) times phasors
// of subcarriers, summed over paths.
#pragma once

#include <complex>
#include <cstddef>

namespace greatx::rf {

/// Subcarriers that are summed at a time.
inline constexpr size_t sum_lanes = 8;

/// sums[row][re, im][lane] += sum over terms of amplitudes[row * stride + term] * phasors[term][re,
/// im][lane], term after term. Every product and sum is rounded on its own (no fused multiply-add), so that
/// all versions give the same bits.
using AddRows = void (*)(const std::complex<double>* amplitudes, size_t stride, size_t rows,
                         const double* phasors, size_t terms, double* sums);

void add_rows_generic(const std::complex<double>* amplitudes, size_t stride, size_t rows,
                      const double* phasors, size_t terms, double* sums);
/// With AVX2; null on processors without it.
AddRows add_rows_avx2();
/// The fastest that this processor has.
AddRows add_rows();

}  // namespace greatx::rf
