// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/channel/beams.h"

#include <cmath>

#include "core/error.h"
#include "core/phase.h"
#include "rf/channel/pair_amplitudes.h"
#include "rf/channel/summing_order.h"

namespace greatx::rf {

std::vector<Complex> DftBeams::weights(uint64_t beam) const {
  GREATX_CHECK(beam < count(), "beam {} of {}", beam, count());
  const uint64_t row_beams = uint64_t{rows} * oversampling[0],
                 column_beams = uint64_t{columns} * oversampling[1];
  const uint64_t turned = beam % phases(), column_beam = beam / phases() % column_beams,
                 row_beam = beam / phases() / column_beams;
  const double scale = 1.0 / std::sqrt(static_cast<double>(ports()));
  std::vector<Complex> weights;
  weights.reserve(ports());
  for (uint64_t row = 0; row < rows; ++row)
    for (uint64_t column = 0; column < columns; ++column)
      for (uint64_t polarization = 0; polarization < polarizations; ++polarization) {
        const double turns =
            static_cast<double>(row_beam * row % row_beams) / static_cast<double>(row_beams) +
            static_cast<double>(column_beam * column % column_beams) / static_cast<double>(column_beams) +
            static_cast<double>(turned * polarization) / phases();
        weights.push_back(scale * unit_phasor(fraction_of_turn(turns)));
      }
  return weights;
}

DftBeams dft_beams(const AntennaArray& array, const std::array<uint32_t, 2>& oversampling) {
  GREATX_CHECK(array.positions_m.empty(), "DFT beams of {} free elements", array.positions_m.size());
  return {array.rows, array.columns, array.polarization_count(), oversampling};
}

std::vector<double> beam_gains(std::span<const Path> paths, const ArrayPose& transmitter,
                               const ArrayPose& receiver, double carrier_hz,
                               std::span<const Complex> weights) {
  check_link(paths, transmitter, receiver, carrier_hz);
  const size_t ports = transmitter.array.port_count(), rx_ports = receiver.array.port_count();
  GREATX_CHECK(weights.size() % ports == 0, "{} weights of {} ports", weights.size(), ports);
  std::vector<double> gains(weights.size() / ports);
  PairAmplitudes amplitudes(transmitter, receiver, carrier_hz);
  std::vector<Complex> a(amplitudes.pairs());
  for (const uint32_t path : summing_order(paths)) {
    amplitudes(paths[path], a.data());
    for (size_t beam = 0; beam < gains.size(); ++beam) {
      const Complex* const w = weights.data() + beam * ports;
      double power = 0.0;
      for (size_t rx = 0; rx < rx_ports; ++rx) {
        // Real arithmetic, since products of std::complex check for infinities.
        double real = 0.0, imaginary = 0.0;
        for (size_t n = 0; n < ports; ++n) {
          const Complex &x = a[rx * ports + n], &y = w[n];
          real += x.real() * y.real() - x.imag() * y.imag();
          imaginary += x.real() * y.imag() + x.imag() * y.real();
        }
        power += real * real + imaginary * imaginary;
      }
      gains[beam] += power / static_cast<double>(rx_ports);
    }
  }
  return gains;
}

}  // namespace greatx::rf
