// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/channel/frequency_response.h"

#include <algorithm>

#include "core/error.h"
#include "core/phase.h"
#include "rf/channel/link_sum.h"
#include "rf/channel/pair_amplitudes.h"

namespace greatx::rf {
namespace {

void check_count(std::span<const Path> paths, std::span<const TransferSpectrum> spectra) {
  GREATX_CHECK(spectra.size() == paths.size(), "{} spectra of {} paths", spectra.size(), paths.size());
}

constexpr size_t group = 8;            ///< blocks that share a phasor
constexpr size_t groups_in_a_row = 8;  ///< groups whose phasors follow from the first one's

/// Sets out[i] = e^{-j 2 pi i step delay} for i below 8, as products of the phasor at 1.
void set_eight(double step_hz, double delay_s, Complex* out) {
  out[0] = 1.0;
  out[1] = unit_phasor(-turns_of(step_hz, delay_s));
  for (size_t power = 2; power < 8; power *= 2) {
    out[power] = plain_product(out[power / 2], out[power / 2]);
    for (size_t i = 1; i < power; ++i) out[power + i] = plain_product(out[power], out[i]);
  }
}

/// Sets e^{-j 2 pi f tau} at all subcarriers. The phasor of a subcarrier is the product of three: of the
/// first subcarrier of its group of blocks, of its block in the group, of its place in the block. The first
/// comes from exactly reduced turns at every eighth group. The others come from those of one step, so that a
/// phasor has the roundings of at most 7 + 7 + 7 steps, below 1e-14, wherever it is in the band.
void set_phasors(const ChannelGrid& grid, double delay_s, size_t term, ColumnFactors& factors) {
  static_assert(sum_lanes == 8 && group == 8);
  constexpr size_t group_columns = group * sum_lanes;
  Complex places[sum_lanes], steps[group], firsts[group], start;
  set_eight(grid.subcarrier_spacing_hz, delay_s, places);
  set_eight(sum_lanes * grid.subcarrier_spacing_hz, delay_s, steps);
  const Complex next_group = factors.blocks() > group
                                 ? unit_phasor(-turns_of(group_columns * grid.subcarrier_spacing_hz, delay_s))
                                 : Complex(1.0);
  const SetProducts set = set_products();
  for (size_t block = 0; block < factors.blocks(); block += group) {
    if (block % (group * groups_in_a_row) == 0) {
      const double number = grid.subcarrier_number(static_cast<uint32_t>(block * sum_lanes));
      start = unit_phasor(-turns_of(number, grid.subcarrier_spacing_hz, delay_s));
    } else {
      start = plain_product(start, next_group);
    }
    const size_t blocks = std::min(group, factors.blocks() - block);
    for (size_t i = 0; i < blocks; ++i) firsts[i] = plain_product(start, steps[i]);
    set(firsts, blocks, places, factors.at(block, term), factors.stride());
  }
}

LinkSum response_sum(std::span<const Path> paths, std::span<const TransferSpectrum> spectra,
                     const ArrayPose& transmitter, const ArrayPose& receiver, const ChannelGrid& grid,
                     PathSelection selection) {
  return {paths,
          spectra,
          transmitter,
          receiver,
          {grid.carrier_hz, grid.time_samples, grid.time_spacing_s},
          grid.subcarriers,
          selection,
          [grid](double delay_s, size_t term, ColumnFactors& factors) {
            set_phasors(grid, delay_s, term, factors);
          }};
}

template <typename Part>
std::vector<std::complex<Part>> response(std::span<const Path> paths,
                                         std::span<const TransferSpectrum> spectra,
                                         const ArrayPose& transmitter, const ArrayPose& receiver,
                                         const ChannelGrid& grid) {
  LinkSum sum = response_sum(paths, spectra, transmitter, receiver, grid, PathSelection::all);
  std::vector<std::complex<Part>> values(sum.size());
  sum.write(values.data());
  return values;
}

}  // namespace

bool is_selected(const Path& path, PathSelection selection) {
  return selection == PathSelection::all ||
         path.interactions.empty() == (selection == PathSelection::line_of_sight);
}

size_t response_size(const ArrayPose& transmitter, const ArrayPose& receiver, const ChannelGrid& grid) {
  return size_t{receiver.array.port_count()} * transmitter.array.port_count() * grid.size_per_pair();
}

void frequency_response_into(std::span<const Path> paths, std::span<const TransferSpectrum> spectra,
                             const ArrayPose& transmitter, const ArrayPose& receiver, const ChannelGrid& grid,
                             std::span<std::complex<float>> out, PathSelection selection, uint32_t threads) {
  if (!spectra.empty()) check_count(paths, spectra);
  LinkSum sum = response_sum(paths, spectra, transmitter, receiver, grid, selection);
  GREATX_CHECK(out.size() == sum.size(), "room for {} values, {} needed", out.size(), sum.size());
  sum.write(out.data(), threads);
}

std::vector<std::complex<float>> frequency_response(std::span<const Path> paths, const ArrayPose& transmitter,
                                                    const ArrayPose& receiver, const ChannelGrid& grid) {
  return response<float>(paths, {}, transmitter, receiver, grid);
}

std::vector<Complex> frequency_response_fp64(std::span<const Path> paths, const ArrayPose& transmitter,
                                             const ArrayPose& receiver, const ChannelGrid& grid) {
  return response<double>(paths, {}, transmitter, receiver, grid);
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
