// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/channel/frequency_response.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "rf/channel/pair_amplitudes.h"
#include "rf/channel/phase.h"
#include "rf/channel/summing_order.h"

namespace greatx::rf {
namespace {

constexpr size_t term_chunk = 128;  // terms summed at a time: their phasors stay in the cache
constexpr size_t lanes = 8;         // subcarriers per block of the inner product

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

/// sum[lane] += sum over terms of amplitude * phasor, in the order of the terms.
inline void add_block(const Complex* amplitudes, const double* phasors, size_t terms, double* sum_re,
                      double* sum_im) {
  double re[lanes], im[lanes];
  for (size_t lane = 0; lane < lanes; ++lane) re[lane] = sum_re[lane], im[lane] = sum_im[lane];
  for (size_t term = 0; term < terms; ++term) {
    const double a = amplitudes[term].real(), b = amplitudes[term].imag();
    const double* p = phasors + term * 2 * lanes;
    for (size_t lane = 0; lane < lanes; ++lane) {
      re[lane] += a * p[lane] - b * p[lanes + lane];
      im[lane] += a * p[lanes + lane] + b * p[lane];
    }
  }
  for (size_t lane = 0; lane < lanes; ++lane) sum_re[lane] = re[lane], sum_im[lane] = im[lane];
}

/// The matrix product [rows, terms] x [terms, subcarriers], rows = (pair, time). A path is one term; with a spectrum it
/// is four, one for each entry of its transfer. `sums` holds real and imaginary parts in blocks: [row][block][re,
/// im][lane].
class Summation {
 public:
  /// `spectra`: [paths], or none.
  Summation(std::span<const Path> paths, std::span<const TransferSpectrum> spectra,
            const ArrayPose& transmitter, const ArrayPose& receiver, const ChannelGrid& grid)
      : grid_(grid),
        amplitudes_of_(transmitter, receiver, grid.carrier_hz),
        chunk_(std::min(term_chunk, paths.size() * (spectra.empty() ? 1 : 4))),
        phasors_(grid, chunk_) {
    check_link(paths, transmitter, receiver, grid.carrier_hz);
    check_spectra(spectra);
    rows_ = size_t{amplitudes_of_.pairs()} * grid.time_samples;
    sums_.assign(rows_ * phasors_.blocks() * 2 * lanes, 0.0);
    amplitudes_.resize(rows_ * chunk_);
    pair_.resize(amplitudes_of_.pairs());
    for (const uint32_t index : summing_order(paths, spectra)) {
      if (spectra.empty()) load(paths[index], paths[index].transfer);
      for (size_t entry = 0; entry < (spectra.empty() ? 0 : 4); ++entry) {
        Complex unit[4]{};
        unit[entry] = 1.0;
        load(paths[index], unit);
        phasors_.scale(loaded_ - 1, spectra[index], entry);
      }
      if (loaded_ == chunk_) add();
    }
    add();
  }

  template <typename Value>
  std::vector<Value> values() const {
    std::vector<Value> out;
    out.reserve(rows_ * grid_.subcarriers);
    using Part = typename Value::value_type;
    for (size_t row = 0; row < rows_; ++row)
      for (size_t k = 0; k < grid_.subcarriers; ++k) {
        const double* sum = sums_.data() + (row * phasors_.blocks() + k / lanes) * 2 * lanes + k % lanes;
        out.emplace_back(static_cast<Part>(sum[0]), static_cast<Part>(sum[lanes]));
      }
    return out;
  }

 private:
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

  /// Puts a term into the chunk's next place.
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

  void add() {
    for (size_t block = 0; block < phasors_.blocks(); ++block)
      for (size_t row = 0; row < rows_; ++row) {
        double* sum = sums_.data() + (row * phasors_.blocks() + block) * 2 * lanes;
        add_block(amplitudes_.data() + row * chunk_, phasors_.block(block), loaded_, sum, sum + lanes);
      }
    loaded_ = 0;
  }

  ChannelGrid grid_;
  PairAmplitudes amplitudes_of_;
  size_t chunk_;  ///< terms at a time
  SubcarrierPhasors phasors_;
  size_t rows_ = 0, loaded_ = 0;
  std::vector<double> sums_;
  std::vector<Complex> amplitudes_, pair_;  ///< [rows, chunk]; [pairs]
};

}  // namespace

std::vector<std::complex<float>> frequency_response(std::span<const Path> paths, const ArrayPose& transmitter,
                                                    const ArrayPose& receiver, const ChannelGrid& grid) {
  return Summation(paths, {}, transmitter, receiver, grid).values<std::complex<float>>();
}

std::vector<Complex> frequency_response_fp64(std::span<const Path> paths, const ArrayPose& transmitter,
                                             const ArrayPose& receiver, const ChannelGrid& grid) {
  return Summation(paths, {}, transmitter, receiver, grid).values<Complex>();
}

std::vector<std::complex<float>> frequency_response(std::span<const Path> paths,
                                                    std::span<const TransferSpectrum> spectra,
                                                    const ArrayPose& transmitter, const ArrayPose& receiver,
                                                    const ChannelGrid& grid) {
  check_count(paths, spectra);
  return Summation(paths, spectra, transmitter, receiver, grid).values<std::complex<float>>();
}

std::vector<Complex> frequency_response_fp64(std::span<const Path> paths,
                                             std::span<const TransferSpectrum> spectra,
                                             const ArrayPose& transmitter, const ArrayPose& receiver,
                                             const ChannelGrid& grid) {
  check_count(paths, spectra);
  return Summation(paths, spectra, transmitter, receiver, grid).values<Complex>();
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
