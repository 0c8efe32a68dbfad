// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The channels of points, made by hand, for the tests of OFDM sensing.
#pragma once

#include <cmath>
#include <complex>
#include <span>
#include <vector>

#include "core/phase.h"
#include "core/units.h"
#include "rf/sensing/ofdm_sensing.h"

namespace greatx::rf::test {

inline const SensingWaveform waveform{28e9, 120e3, 384, 125e-6, 64};
inline constexpr RadarSeeds seeds{7, 21, 4};

inline SensingConfig quiet() {
  SensingConfig config;
  config.power_w = 2.0;
  return config;
}

struct Point {
  double range_m, velocity_m_s, gain;
  uint32_t instance = 1;
  dvec3 direction{1.0, 0.0, 0.0};  ///< in the frame of the array
  double delay_s() const { return 2.0 * range_m / speed_of_light; }
  double doppler_hz() const { return -2.0 * velocity_m_s / waveform.wavelength_m(); }
  SensingTone tone() const { return {instance, delay_s(), doppler_hz(), gain}; }
};

/// Returns H of points, [rx, tx, symbol, subcarrier], element by element.
inline std::vector<std::complex<float>> response_of(const SensingArrays& arrays,
                                                    std::span<const Point> points) {
  std::vector<std::complex<float>> h;
  for (size_t r = 0; r < arrays.receive_ports(); ++r)
    for (size_t t = 0; t < arrays.transmit_ports(); ++t)
      for (uint32_t m = 0; m < waveform.symbols; ++m)
        for (uint32_t k = 0; k < waveform.subcarriers; ++k) {
          std::complex<double> sum = 0.0;
          for (const Point& p : points) {
            const dvec3 places = arrays.receive_m[r / arrays.receive_polarizations] +
                                 arrays.transmit_m[t / arrays.transmit_polarizations];
            const double offset_hz = (double(k) - double(waveform.subcarriers / 2)) * waveform.spacing_hz;
            sum += std::sqrt(p.gain) *
                   unit_phasor(p.doppler_hz() * m * waveform.interval_s - offset_hz * p.delay_s() -
                               fraction_of_turn(turns_of(waveform.carrier_hz, p.delay_s())) +
                               glm::dot(p.direction, places) / waveform.wavelength_m());
          }
          h.emplace_back(sum);
        }
  return h;
}

inline SensingFrame frame_of(const OfdmSensing& sensing, const SensingArrays& arrays,
                             std::span<const Point> points, uint32_t threads = 0) {
  const std::vector<std::complex<float>> h = response_of(arrays, points);
  std::vector<SensingTone> tones;
  for (const Point& p : points) tones.push_back(p.tone());
  return sensing.process({h, tones, seeds, {1.0, 0.0, 0.0, 0.0}, dvec3(0.0)}, threads);
}

/// A quiet map has no noise to compare with, so that CFAR needs a little of it.
inline SensingConfig noisy(double figure_db = 7.0) {
  SensingConfig config = quiet();
  config.noise_figure_db = figure_db;
  return config;
}

}  // namespace greatx::rf::test
