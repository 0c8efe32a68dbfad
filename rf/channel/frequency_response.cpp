// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/channel/frequency_response.h"

#include "core/error.h"
#include "core/phase.h"
#include "rf/channel/link_sum.h"
#include "rf/channel/pair_amplitudes.h"

namespace greatx::rf {
namespace {

void check_count(std::span<const Path> paths, std::span<const TransferSpectrum> spectra) {
  GREATX_CHECK(spectra.size() == paths.size(), "{} spectra of {} paths", spectra.size(), paths.size());
}

/// Sets e^{-j 2 pi f tau} at all subcarriers. The phasor of a subcarrier is the product of the phasor of its
/// block's first subcarrier and of its place in the block. Both come from exactly reduced turns, so that no
/// recurrence accumulates error.
void set_phasors(const ChannelGrid& grid, double delay_s, size_t term, ColumnFactors& factors) {
  Complex place[sum_lanes];
  for (size_t lane = 0; lane < sum_lanes; ++lane)
    place[lane] = unit_phasor(-turns_of(static_cast<double>(lane), grid.subcarrier_spacing_hz, delay_s));
  for (size_t block = 0; block < factors.blocks(); ++block) {
    const double number = grid.subcarrier_number(static_cast<uint32_t>(block * sum_lanes));
    const Complex first = unit_phasor(-turns_of(number, grid.subcarrier_spacing_hz, delay_s));
    double* out = factors.at(block, term);
    for (size_t lane = 0; lane < sum_lanes; ++lane) {
      out[lane] = first.real() * place[lane].real() - first.imag() * place[lane].imag();
      out[sum_lanes + lane] = first.real() * place[lane].imag() + first.imag() * place[lane].real();
    }
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
          [grid](const Path& path, size_t term, ColumnFactors& factors) {
            set_phasors(grid, path.delay_s, term, factors);
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
                             std::span<std::complex<float>> out, PathSelection selection) {
  if (!spectra.empty()) check_count(paths, spectra);
  LinkSum sum = response_sum(paths, spectra, transmitter, receiver, grid, selection);
  GREATX_CHECK(out.size() == sum.size(), "room for {} values, {} needed", out.size(), sum.size());
  sum.write(out.data());
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
