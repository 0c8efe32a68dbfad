// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Sums a link's paths for the frequency response and the taps. The sum is a matrix product: rows hold the
// contributions of paths at pairs of ports and times, and columns hold the factors of paths at subcarriers or
// taps.
#pragma once

#include <complex>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "rf/channel/frequency_response.h"
#include "rf/channel/pair_amplitudes.h"
#include "rf/channel/row_sums.h"

namespace greatx::rf {

/// Holds the factors of a chunk of terms at each column, in blocks of sum_lanes columns: [block][term][re,
/// im][lane].
class ColumnFactors {
 public:
  ColumnFactors(size_t columns, size_t terms)
      : terms_(terms),
        blocks_((columns + sum_lanes - 1) / sum_lanes),
        values_(blocks_ * terms * 2 * sum_lanes) {}
  size_t blocks() const { return blocks_; }
  const double* block(size_t index) const { return values_.data() + index * terms_ * 2 * sum_lanes; }
  /// Returns the real parts of a term in a block; its imaginary parts follow. Lanes beyond the last column
  /// may hold any finite value.
  double* at(size_t block, size_t term) { return values_.data() + (block * terms_ + term) * 2 * sum_lanes; }
  /// Returns the distance between the factors of a term in one block and in the next.
  size_t stride() const { return terms_ * 2 * sum_lanes; }

 private:
  size_t terms_, blocks_;
  std::vector<double> values_;
};

/// Holds the times of the rows; a row is a pair of ports at one time.
struct RowTimes {
  double carrier_hz = 0.0;
  uint32_t samples = 1;
  double spacing_s = 0.0;
};

/// Computes the sum over paths of (pair amplitude) e^{-j 2 pi f_c tau} e^{j 2 pi nu t_m} (factor at the
/// column), in fp64 and in summing_order(). Each link has its own object, so that threads share nothing.
class LinkSum {
 public:
  /// Writes the factors of a delay at all columns into the place of the term.
  using SetFactors = std::function<void(double delay_s, size_t term, ColumnFactors& factors)>;

  /// `spectra`: [paths], each with one transfer per column, or empty for the paths' own transfers. The paths
  /// and spectra must outlive this object.
  LinkSum(std::span<const Path> paths, std::span<const TransferSpectrum> spectra,
          const ArrayPose& transmitter, const ArrayPose& receiver, const RowTimes& times, size_t columns,
          PathSelection selection, SetFactors set_factors);

  size_t size() const { return rows_ * columns_; }
  /// Writes out[rx_ant, tx_ant, time, column], size() values; float or double. The rows are divided among
  /// `threads` threads; that changes no bit.
  template <typename Part>
  void write(std::complex<Part>* out, uint32_t threads = 1);

 private:
  size_t terms_per_path() const { return spectra_.empty() ? 1 : 4; }
  void check_spectra() const;
  /// A path, or with spectra one entry of a path's transfer.
  struct Term {
    uint32_t path, entry;
  };
  void load(uint32_t index);
  void load(Term term, const Complex* transfer);
  void set_factors(size_t place, double delay_s, ColumnFactors& factors);
  void set_factors_of_elements(size_t pair, ColumnFactors& factors);
  template <typename Part>
  void add(std::complex<Part>* out);
  template <typename Part>
  void add_elements(size_t pair, ColumnFactors& factors, std::complex<Part>* out);
  template <typename Part>
  void add_rows_from(size_t first, size_t end, const ColumnFactors& factors, std::complex<Part>* out);

  std::span<const Path> paths_;
  std::span<const TransferSpectrum> spectra_;
  RowTimes times_;
  size_t columns_;
  SetFactors set_factors_;
  bool squints_;  ///< the factors of a path depend on the pair of elements
  PairAmplitudes amplitudes_of_;
  std::vector<uint32_t> order_;  ///< indices of the paths that are summed
  /// Number of all terms, and of terms per chunk, which is a multiple of terms_per_path().
  size_t terms_, chunk_;
  std::vector<ColumnFactors> factors_;  ///< one; with squint one a worker
  uint32_t workers_ = 1;                ///< threads that divide the rows
  size_t rows_;
  std::vector<Term> loaded_;                ///< of the chunk
  std::vector<double> leads_s_;             ///< [chunk, pairs of elements]; empty without squint
  std::vector<Complex> amplitudes_, pair_;  ///< [rows, chunk]; [pairs]
  std::vector<double> sums_;  ///< [blocks, rows, (re, im), lanes]; empty if one chunk holds all terms
};

}  // namespace greatx::rf
