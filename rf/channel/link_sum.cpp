// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/channel/link_sum.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "core/phase.h"
#include "rf/channel/summing_order.h"

namespace greatx::rf {
namespace {

constexpr size_t term_chunk = 128;  // terms summed at a time, so that their factors stay in the cache
// Bound of the factors of all columns. The number of terms at a time changes no bit of the result.
constexpr size_t most_factors = size_t{1} << 20;
constexpr size_t least_shared = size_t{1} << 19;  // products from which on more threads than one pay
constexpr size_t row_tile = 64;  // rows summed at a time, so that their amplitudes and sums stay in the cache

std::vector<uint32_t> selected_order(std::span<const Path> paths, std::span<const TransferSpectrum> spectra,
                                     PathSelection selection) {
  std::vector<uint32_t> order = summing_order(paths, spectra);
  std::erase_if(order, [&](uint32_t index) { return !is_selected(paths[index], selection); });
  return order;
}

/// Rounds the sums of a block and writes them to the columns of `row` from `first` on.
template <typename Part>
void store(const double* sums, size_t first, size_t columns, std::complex<Part>* row) {
  const size_t count = std::min(sum_lanes, columns - first);
  for (size_t lane = 0; lane < count; ++lane)
    row[first + lane] = {static_cast<Part>(sums[lane]), static_cast<Part>(sums[sum_lanes + lane])};
}

}  // namespace

LinkSum::LinkSum(std::span<const Path> paths, std::span<const TransferSpectrum> spectra,
                 const ArrayPose& transmitter, const ArrayPose& receiver, const RowTimes& times,
                 size_t columns, PathSelection selection, SetFactors set_factors)
    : paths_(paths),
      spectra_(spectra),
      times_(times),
      columns_(columns),
      set_factors_(std::move(set_factors)),
      squints_(transmitter.beam_squint),
      amplitudes_of_(transmitter, receiver, times.carrier_hz),
      order_(selected_order(paths, spectra, selection)),
      terms_(order_.size() * terms_per_path()),
      chunk_(
          std::min({term_chunk, terms_, std::max<size_t>(1, most_factors / std::max<size_t>(1, columns))})),
      factors_(1, ColumnFactors(columns, chunk_)),
      rows_(size_t{amplitudes_of_.pairs()} * times.samples) {
  check_link(paths, transmitter, receiver, times.carrier_hz);
  GREATX_CHECK(transmitter.beam_squint == receiver.beam_squint, "the ends of a link take waves differently");
  check_spectra();
  amplitudes_.resize(rows_ * chunk_);
  pair_.resize(amplitudes_of_.pairs());
  if (squints_) leads_s_.resize(chunk_ * amplitudes_of_.leads().pairs());
}

void LinkSum::check_spectra() const {
  for (const TransferSpectrum& spectrum : spectra_) {
    GREATX_CHECK(spectrum.size() == columns_, "a spectrum of {} subcarriers, {} in the grid", spectrum.size(),
                 columns_);
    for (const std::array<Complex, 4>& transfer : spectrum)
      for (const Complex& value : transfer)
        GREATX_CHECK(std::isfinite(value.real()) && std::isfinite(value.imag()), "a spectrum is not finite");
  }
}

template <typename Part>
void LinkSum::write(std::complex<Part>* out, uint32_t threads) {
  const size_t works = squints_ ? amplitudes_of_.leads().pairs() : rows_;
  const bool shared = chunk_ * rows_ * columns_ >= least_shared;
  workers_ = shared ? static_cast<uint32_t>(std::min<size_t>(std::max(1u, threads), works)) : 1;
  if (squints_) factors_.resize(workers_, factors_.front());
  if (terms_ == 0) std::fill_n(out, size(), std::complex<Part>{});
  // Sums must last from chunk to chunk only if there are several chunks.
  if (terms_ > chunk_) sums_.assign(factors_.front().blocks() * rows_ * 2 * sum_lanes, 0.0);
  size_t summed = 0;
  for (const uint32_t index : order_) {
    load(index);
    if (loaded_.size() < chunk_ && summed + loaded_.size() < terms_) continue;
    summed += loaded_.size();
    add(summed == terms_ ? out : nullptr);
  }
}
template void LinkSum::write(std::complex<float>*, uint32_t);
template void LinkSum::write(std::complex<double>*, uint32_t);

/// Puts the terms of a path into the next places of the chunk: one term, or with a spectrum one term for each
/// entry of the transfer.
void LinkSum::load(uint32_t index) {
  if (spectra_.empty()) return load({index, 0}, paths_[index].transfer);
  for (uint32_t entry = 0; entry < 4; ++entry) {
    Complex unit[4]{};
    unit[entry] = 1.0;
    load({index, entry}, unit);
  }
}

void LinkSum::load(Term term, const Complex* transfer) {
  const Path& path = paths_[term.path];
  const size_t place = loaded_.size();
  loaded_.push_back(term);
  if (squints_)
    amplitudes_of_.leads()(path, leads_s_.data() + place * amplitudes_of_.leads().pairs());
  else
    set_factors(place, path.delay_s, factors_.front());
  amplitudes_of_(path, transfer, pair_.data());
  const Complex carrier = unit_phasor(-turns_of(times_.carrier_hz, path.delay_s));
  const std::vector<double>* const uneven =
      path.echo && path.echo->turns.size() >= times_.samples ? &path.echo->turns : nullptr;
  for (uint32_t m = 0; m < times_.samples; ++m) {
    const double turns = uneven ? fraction_of_turn((*uneven)[m])
                                : turns_of(static_cast<double>(m), times_.spacing_s, path.doppler_hz);
    const Complex turned = carrier * unit_phasor(turns);
    for (size_t pair = 0; pair < pair_.size(); ++pair)
      amplitudes_[(pair * times_.samples + m) * chunk_ + place] = pair_[pair] * turned;
  }
}

void LinkSum::set_factors(size_t place, double delay_s, ColumnFactors& factors) {
  set_factors_(delay_s, place, factors);
  if (spectra_.empty()) return;
  const auto [path, entry] = loaded_[place];
  for (size_t column = 0; column < columns_; ++column) {
    double* factor = factors.at(column / sum_lanes, place) + column % sum_lanes;
    const Complex value = Complex(factor[0], factor[sum_lanes]) * spectra_[path][column][entry];
    factor[0] = value.real();
    factor[sum_lanes] = value.imag();
  }
}

/// Sets the factors of the chunk for the delays between two elements.
void LinkSum::set_factors_of_elements(size_t pair, ColumnFactors& factors) {
  const size_t pairs = amplitudes_of_.leads().pairs();
  for (size_t place = 0; place < loaded_.size(); ++place)
    set_factors(place, paths_[loaded_[place].path].delay_s - leads_s_[place * pairs + pair], factors);
}

/// Adds the chunk to the sums, and writes the sums to `out` unless it is null.
template <typename Part>
void LinkSum::add(std::complex<Part>* out) {
  const size_t works = squints_ ? amplitudes_of_.leads().pairs() : rows_;
  parallel_for(workers_, workers_, [&](size_t worker) {
    const size_t first = works * worker / workers_, end = works * (worker + 1) / workers_;
    if (!squints_) return add_rows_from(first, end, factors_.front(), out);
    for (size_t pair = first; pair < end; ++pair) add_elements(pair, factors_[worker], out);
  });
  loaded_.clear();
}

/// Adds the rows of all ports of a pair of elements. They share the factors of the pair.
template <typename Part>
void LinkSum::add_elements(size_t pair, ColumnFactors& factors, std::complex<Part>* out) {
  const size_t rx_ports = amplitudes_of_.rx().polarizations(), tx_ports = amplitudes_of_.tx().polarizations();
  const size_t tx_elements = amplitudes_of_.leads().tx_elements();
  const size_t u = pair / tx_elements, s = pair % tx_elements;
  set_factors_of_elements(pair, factors);
  for (size_t port = u * rx_ports; port < (u + 1) * rx_ports; ++port) {
    const size_t ports = port * amplitudes_of_.tx().count() + s * tx_ports;
    add_rows_from(ports * times_.samples, (ports + tx_ports) * times_.samples, factors, out);
  }
}

template <typename Part>
void LinkSum::add_rows_from(size_t begin, size_t end, const ColumnFactors& factors, std::complex<Part>* out) {
  const AddRows add_chunk = add_rows();
  double tile[row_tile * 2 * sum_lanes];
  for (size_t first = begin; first < end; first += row_tile)
    for (size_t block = 0; block < factors.blocks(); ++block) {
      const size_t count = std::min(row_tile, end - first);
      double* sums = sums_.empty() ? tile : sums_.data() + (block * rows_ + first) * 2 * sum_lanes;
      if (sums_.empty()) std::fill_n(tile, count * 2 * sum_lanes, 0.0);
      add_chunk(amplitudes_.data() + first * chunk_, chunk_, count, factors.block(block), loaded_.size(),
                sums);
      for (size_t row = 0; out != nullptr && row < count; ++row)
        store(sums + row * 2 * sum_lanes, block * sum_lanes, columns_, out + (first + row) * columns_);
    }
}

}  // namespace greatx::rf
