// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/channel/frequency_response.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "rf/channel/pair_amplitudes.h"
#include "rf/channel/phase.h"
#include "rf/channel/row_sums.h"
#include "rf/channel/summing_order.h"

namespace greatx::rf {
namespace {

constexpr size_t term_chunk = 128;  // terms summed at a time: their phasors stay in the cache
constexpr size_t row_tile = 64;     // rows summed at a time: as their amplitudes and sums do
constexpr size_t lanes = sum_lanes;

void check_count(std::span<const Path> paths, std::span<const TransferSpectrum> spectra) {
  GREATX_CHECK(spectra.size() == paths.size(), "{} spectra of {} paths", spectra.size(), paths.size());
}

/// The phasors e^{-j 2 pi f tau} of a chunk of terms, in blocks of `lanes` subcarriers: [block][term][re,
/// im][lane].
class SubcarrierPhasors {
 public:
  SubcarrierPhasors(const ChannelGrid& grid, size_t terms)
      : grid_(grid),
        terms_(terms),
        blocks_((grid.subcarriers + lanes - 1) / lanes),
        values_(blocks_ * terms * 2 * lanes) {}
  size_t blocks() const { return blocks_; }
  const double* block(size_t index) const { return values_.data() + index * terms_ * 2 * lanes; }

  /// A block's subcarriers as (first of the block) x (place in the block): two phasors, each from exactly
  /// reduced turns, and one product; no recurrence whose error grows.
  void set(size_t term, double delay_s) {
    Complex place[lanes];
    for (size_t lane = 0; lane < lanes; ++lane)
      place[lane] = unit_phasor(-turns_of(static_cast<double>(lane), grid_.subcarrier_spacing_hz, delay_s));
    for (size_t index = 0; index < blocks_; ++index) {
      const double number = grid_.subcarrier_number(static_cast<uint32_t>(index * lanes));
      const Complex first = unit_phasor(-turns_of(number, grid_.subcarrier_spacing_hz, delay_s));
      double* out = values_.data() + (index * terms_ + term) * 2 * lanes;
      for (size_t lane = 0; lane < lanes; ++lane) {
        out[lane] = first.real() * place[lane].real() - first.imag() * place[lane].imag();
        out[lanes + lane] = first.real() * place[lane].imag() + first.imag() * place[lane].real();
      }
    }
  }
  /// Times an entry of the transfer at each subcarrier.
  void scale(size_t term, const TransferSpectrum& spectrum, size_t entry) {
    for (size_t k = 0; k < spectrum.size(); ++k) {
      double* out = values_.data() + (k / lanes * terms_ + term) * 2 * lanes + k % lanes;
      const Complex value = Complex(out[0], out[lanes]) * spectrum[k][entry];
      out[0] = value.real();
      out[lanes] = value.imag();
    }
  }

 private:
  ChannelGrid grid_;
  size_t terms_, blocks_;
  std::vector<double> values_;
};

/// The matrix product [rows, terms] x [terms, subcarriers], rows = (pair, time). A path is one term; with a spectrum it
/// is four, one for each entry of its transfer.
class Summation {
 public:
  /// `spectra`: [paths], or none.
  Summation(std::span<const Path> paths, std::span<const TransferSpectrum> spectra,
            const ArrayPose& transmitter, const ArrayPose& receiver, const ChannelGrid& grid)
      : paths_(paths),
        spectra_(spectra),
        grid_(grid),
        amplitudes_of_(transmitter, receiver, grid.carrier_hz),
        terms_(paths.size() * terms_per_path()),
        chunk_(std::min(term_chunk, terms_)),
        phasors_(grid, chunk_),
        rows_(size_t{amplitudes_of_.pairs()} * grid.time_samples) {
    check_link(paths, transmitter, receiver, grid.carrier_hz);
    check_spectra(spectra);
    amplitudes_.resize(rows_ * chunk_);
    pair_.resize(amplitudes_of_.pairs());
  }

  /// out[rows, subcarriers].
  template <typename Part>
  void write(std::complex<Part>* out) {
    if (terms_ == 0) std::fill_n(out, rows_ * grid_.subcarriers, std::complex<Part>{});
    // Sums live from chunk to chunk only where there are several.
    if (terms_ > chunk_) sums_.assign(phasors_.blocks() * rows_ * 2 * lanes, 0.0);
    size_t summed = 0;
    for (const uint32_t index : summing_order(paths_, spectra_)) {
      load(index);
      if (loaded_ < chunk_ && summed + loaded_ < terms_) continue;
      summed += loaded_;
      add(summed == terms_ ? out : nullptr);
    }
  }

 private:
  size_t terms_per_path() const { return spectra_.empty() ? 1 : 4; }

  void check_spectra(std::span<const TransferSpectrum> spectra) const {
    for (const TransferSpectrum& spectrum : spectra) {
      GREATX_CHECK(spectrum.size() == grid_.subcarriers, "a spectrum of {} subcarriers, {} in the grid",
                   spectrum.size(), grid_.subcarriers);
      for (const std::array<Complex, 4>& transfer : spectrum)
        for (const Complex& value : transfer)
          GREATX_CHECK(std::isfinite(value.real()) && std::isfinite(value.imag()),
                       "a spectrum is not finite");
    }
  }

  /// Puts a path's terms into the chunk's next places.
  void load(uint32_t index) {
    if (spectra_.empty()) return load(paths_[index], paths_[index].transfer);
    for (size_t entry = 0; entry < 4; ++entry) {
      Complex unit[4]{};
      unit[entry] = 1.0;
      load(paths_[index], unit);
      phasors_.scale(loaded_ - 1, spectra_[index], entry);
    }
  }
  void load(const Path& path, const Complex* transfer) {
    const size_t place = loaded_++;
    phasors_.set(place, path.delay_s);
    amplitudes_of_(path, transfer, pair_.data());
    const Complex carrier = unit_phasor(-turns_of(grid_.carrier_hz, path.delay_s));
    for (uint32_t m = 0; m < grid_.time_samples; ++m) {
      const Complex turned =
          carrier * unit_phasor(turns_of(static_cast<double>(m), grid_.time_spacing_s, path.doppler_hz));
      for (size_t pair = 0; pair < pair_.size(); ++pair)
        amplitudes_[(pair * grid_.time_samples + m) * chunk_ + place] = pair_[pair] * turned;
    }
  }

  /// Adds the chunk; `out`, unless null, takes the sums.
  template <typename Part>
  void add(std::complex<Part>* out) {
    double tile[row_tile * 2 * lanes];
    for (size_t first = 0; first < rows_; first += row_tile)
      for (size_t block = 0; block < phasors_.blocks(); ++block) {
        const size_t count = std::min(row_tile, rows_ - first);
        double* sums = sums_.empty() ? tile : sums_.data() + (block * rows_ + first) * 2 * lanes;
        if (sums_.empty()) std::fill_n(tile, count * 2 * lanes, 0.0);
        add_rows_(amplitudes_.data() + first * chunk_, chunk_, count, phasors_.block(block), loaded_, sums);
        for (size_t row = 0; out != nullptr && row < count; ++row)
          store(sums + row * 2 * lanes, block * lanes, out + (first + row) * grid_.subcarriers);
      }
    loaded_ = 0;
  }

  /// A block's sums, rounded, to the row's subcarriers from `first` on.
  template <typename Part>
  void store(const double* sums, size_t first, std::complex<Part>* row) const {
    const size_t count = std::min(lanes, grid_.subcarriers - first);
    for (size_t lane = 0; lane < count; ++lane)
      row[first + lane] = {static_cast<Part>(sums[lane]), static_cast<Part>(sums[lanes + lane])};
  }

  std::span<const Path> paths_;
  std::span<const TransferSpectrum> spectra_;
  ChannelGrid grid_;
  PairAmplitudes amplitudes_of_;
  size_t terms_, chunk_;  ///< in all; at a time, a multiple of terms_per_path()
  SubcarrierPhasors phasors_;
  size_t rows_, loaded_ = 0;
  AddRows add_rows_ = add_rows();
  std::vector<Complex> amplitudes_, pair_;  ///< [rows, chunk]; [pairs]
  std::vector<double> sums_;  ///< [blocks, rows, (re, im), lanes]; empty: one chunk holds all terms
};

template <typename Part>
std::vector<std::complex<Part>> response(std::span<const Path> paths,
                                         std::span<const TransferSpectrum> spectra,
                                         const ArrayPose& transmitter, const ArrayPose& receiver,
                                         const ChannelGrid& grid) {
  Summation summation(paths, spectra, transmitter, receiver, grid);
  std::vector<std::complex<Part>> values(response_size(transmitter, receiver, grid));
  summation.write(values.data());
  return values;
}

}  // namespace

size_t response_size(const ArrayPose& transmitter, const ArrayPose& receiver, const ChannelGrid& grid) {
  return size_t{receiver.array.port_count()} * transmitter.array.port_count() * grid.size_per_pair();
}

void frequency_response_into(std::span<const Path> paths, std::span<const TransferSpectrum> spectra,
                             const ArrayPose& transmitter, const ArrayPose& receiver, const ChannelGrid& grid,
                             std::span<std::complex<float>> out) {
  if (!spectra.empty()) check_count(paths, spectra);
  GREATX_CHECK(out.size() == response_size(transmitter, receiver, grid), "room for {} values, {} needed",
               out.size(), response_size(transmitter, receiver, grid));
  Summation(paths, spectra, transmitter, receiver, grid).write(out.data());
}

std::vector<std::complex<float>> frequency_response(std::span<const Path> paths, const ArrayPose& transmitter,
                                                    const ArrayPose& receiver, const ChannelGrid& grid) {
  return response<float>(paths, {}, transmitter, receiver, grid);
}

std::vector<Complex> frequency_response_fp64(std::span<const Path> paths, const ArrayPose& transmitter,
                                             const ArrayPose& receiver, const ChannelGrid& grid) {
  return response<double>(paths, {}, transmitter, receiver, grid);
}

std::vector<std::complex<float>> frequency_response(std::span<const Path> paths,
                                                    std::span<const TransferSpectrum> spectra,
                                                    const ArrayPose& transmitter, const ArrayPose& receiver,
                                                    const ChannelGrid& grid) {
  check_count(paths, spectra);
  return response<float>(paths, spectra, transmitter, receiver, grid);
}

std::vector<Complex> frequency_response_fp64(std::span<const Path> paths,
                                             std::span<const TransferSpectrum> spectra,
                                             const ArrayPose& transmitter, const ArrayPose& receiver,
                                             const ChannelGrid& grid) {
  check_count(paths, spectra);
  return response<double>(paths, spectra, transmitter, receiver, grid);
}

ImpulseResponse impulse_response(std::span<const Path> paths, const ArrayPose& transmitter,
                                 const ArrayPose& receiver, double carrier_hz) {
  check_link(paths, transmitter, receiver, carrier_hz);
  PairAmplitudes amplitudes_of(transmitter, receiver, carrier_hz);
  std::vector<Complex> pair(amplitudes_of.pairs());
  ImpulseResponse response;
  response.amplitude.reserve(paths.size() * pair.size());
  for (const Path& path : paths) {
    amplitudes_of(path, pair.data());
    const Complex carrier = unit_phasor(-turns_of(carrier_hz, path.delay_s));
    for (const Complex& value : pair) response.amplitude.emplace_back(value * carrier);
    response.delay_s.push_back(path.delay_s);
    response.doppler_hz.push_back(path.doppler_hz);
  }
  return response;
}

}  // namespace greatx::rf
