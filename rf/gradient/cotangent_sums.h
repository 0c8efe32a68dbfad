// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs the hot loop of the gradient: it multiplies the cotangents of a response by the phasors of a path and
// sums over subcarriers.
#pragma once

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

#include "rf/channel/frequency_response.h"
#include "rf/channel/row_sums.h"

namespace greatx::rf {

/// Holds values at all subcarriers in blocks of sum_lanes: [block][re, im][lane]. Lanes beyond the last
/// subcarrier are 0.
class BlockedRow {
 public:
  explicit BlockedRow(size_t subcarriers)
      : blocks_((subcarriers + sum_lanes - 1) / sum_lanes), values_(blocks_ * 2 * sum_lanes) {}
  size_t blocks() const { return blocks_; }
  const double* data() const { return values_.data(); }
  /// Returns the real parts of a block; its imaginary parts follow.
  double* block(size_t index) { return values_.data() + index * 2 * sum_lanes; }

 private:
  size_t blocks_;
  std::vector<double> values_;
};

/// Sets the phasors e^{-j 2 pi f tau} of a delay at all subcarriers, to about 1e-15: the product of the
/// phasor of a block and that of a place in the block. The turns of every eighth block are reduced exactly;
/// the others follow by products.
void set_path_phasors(const ChannelGrid& grid, double delay_s, BlockedRow& phasors);

/// Holds the sums over subcarriers of conj(G) P and of f conj(G) P, with f counted from the carrier, Hz.
struct CotangentSums {
  Complex plain{0.0}, by_frequency{0.0};
};

/// Computes both sums of a row of cotangents G with phasors P. The lanes are summed each for itself and then
/// in order, so that every version gives the same bits.
using CotangentSum = CotangentSums (*)(const double* cotangent, const double* phasors,
                                       const double* frequencies, size_t blocks);
CotangentSums cotangent_sums_generic(const double* cotangent, const double* phasors,
                                     const double* frequencies, size_t blocks);
/// Returns the version for AVX2; null on processors without AVX2.
CotangentSum cotangent_sums_avx2();
/// Returns the fastest version for this processor.
CotangentSum cotangent_sums();

/// Returns the frequencies of the subcarriers from the carrier, Hz, [blocks * sum_lanes]; 0 beyond the last.
std::vector<double> offsets_hz(const ChannelGrid& grid);

}  // namespace greatx::rf
