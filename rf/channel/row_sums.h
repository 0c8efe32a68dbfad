// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs the hot loop of the frequency response: it multiplies amplitudes of rows (pairs of ports at time
// samples) by phasors of subcarriers and sums over paths. It also makes the phasors.
#pragma once

#include <complex>
#include <cstddef>

namespace greatx::rf {

/// Number of subcarriers that are summed together.
inline constexpr size_t sum_lanes = 8;

/// Adds to sums[row][re, im][lane] the sum over terms of amplitudes[row * stride + term] * phasors[term][re,
/// im][lane], term after term. Every product and sum is rounded on its own (no fused multiply-add), so that
/// all versions give the same bits.
using AddRows = void (*)(const std::complex<double>* amplitudes, size_t stride, size_t rows,
                         const double* phasors, size_t terms, double* sums);

void add_rows_generic(const std::complex<double>* amplitudes, size_t stride, size_t rows,
                      const double* phasors, size_t terms, double* sums);
/// Returns the version for AVX2; null on processors without AVX2.
AddRows add_rows_avx2();
/// Returns the fastest version for this processor.
AddRows add_rows();

/// Sets out[block * stride][re, im][lane] = firsts[block] * places[lane] for all blocks. Every product and
/// sum is rounded on its own, as above.
using SetProducts = void (*)(const std::complex<double>* firsts, size_t blocks,
                             const std::complex<double>* places, double* out, size_t stride);

void set_products_generic(const std::complex<double>* firsts, size_t blocks,
                          const std::complex<double>* places, double* out, size_t stride);
/// Returns the version for AVX2; null on processors without AVX2.
SetProducts set_products_avx2();
/// Returns the fastest version for this processor.
SetProducts set_products();

}  // namespace greatx::rf
