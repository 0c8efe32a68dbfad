// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/signal/maps.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "core/phase.h"
#include "rf/radar/signal/demultiplex.h"
#include "rf/radar/signal/lanes.h"

namespace greatx::rf {
namespace {

GREATX_LANES void add_power(const std::complex<float>* values, size_t count, float* out) {
  const float* parts = reinterpret_cast<const float*>(values);
  for (size_t i = 0; i < count; ++i)
    out[i] += parts[2 * i] * parts[2 * i] + parts[2 * i + 1] * parts[2 * i + 1];
}

}  // namespace

double steering_turns(const RadarSignalConfig& config, uint32_t receiver, uint32_t transmitter,
                      const dvec3& direction) {
  const dvec3 element = config.arrays.receive_m[receiver] +
                        (config.bistatic ? dvec3(0.0) : config.arrays.transmit_m[transmitter]);
  return -glm::dot(direction, element) / config.waveform.wavelength_m();
}

RadarAxes radar_axes(const RadarSignalConfig& config) {
  const RadarWaveform& w = config.waveform;
  const RadarProcessing& p = config.processing;
  RadarAxes axes;
  for (uint32_t k = 0; k < w.samples; ++k) axes.range_m.push_back(k * w.range_bin_m());
  for (uint32_t k = 0; k < w.chirps(); ++k)
    axes.velocity_m_s.push_back(doppler_turns(k, w.chirps()) * w.velocity_bin_m_s());
  for (uint32_t k = 0; k < p.azimuths; ++k)
    axes.azimuth.push_back(p.azimuth_limit * (2.0 * k / (p.azimuths - 1) - 1.0));
  return axes;
}

RadarMaps::RadarMaps(const RadarSignalConfig& config)
    : config_(config),
      range_window_(config.processing.range_window, config.waveform.samples),
      doppler_window_(config.processing.doppler_window, config.waveform.chirps()),
      range_transform_(config.waveform.samples, Fft::Direction::forward,
                       config.waveform.coded() ? Fft::Others::chirp : Fft::Others::factors),
      doppler_transform_(config.waveform.chirps(), Fft::Direction::forward),
      axes_(radar_axes(config)) {
  if (!config.processing.range_azimuth) return;
  const uint32_t transmitters = config.waveform.transmitters;
  std::vector<BeamPlace> places;
  for (const dvec3& receive : config.arrays.receive_m)
    for (uint32_t t = 0; t < transmitters; ++t)
      places.push_back(config.bistatic ? BeamPlace{receive, t}
                                       : BeamPlace{receive + config.arrays.transmit_m[t], 0});
  beams_.emplace(places, config.waveform.wavelength_m(), axes_.azimuth);
}

std::vector<std::complex<float>> RadarMaps::spectrum(std::span<const std::complex<float>> cube,
                                                     uint32_t threads) const {
  const uint32_t samples = range_window_.size(), chirps = doppler_window_.size();
  const size_t plane = size_t{samples} * chirps, antennas = cube.size() / plane;
  GREATX_CHECK(antennas * plane == cube.size(), "{} samples in planes of {}", cube.size(), plane);
  const float range_factor = static_cast<float>(1.0 / (samples * range_window_.coherent_gain()));
  const float doppler_factor = static_cast<float>(1.0 / (chirps * doppler_window_.coherent_gain()));
  std::vector<std::complex<float>> result(cube.size());
  constexpr uint32_t together = Fft::lanes;
  // Transforms chirps, then ranges, four at a time. At the end some of them are transformed twice to fill the
  // lanes.
  parallel_for(antennas, threads, [&](size_t antenna) {
    const std::complex<float>* in = cube.data() + antenna * plane;
    std::complex<float>* out = result.data() + antenna * plane;
    std::vector<Fft::Value> values(std::max(samples, chirps)), line(values.size());
    std::vector<std::complex<float>> turned(plane);  // [range, chirp]
    for (uint32_t first = 0; first < chirps; first += together) {
      const std::complex<float>* rows[together];
      Four factor;
      for (uint32_t i = 0; i < together; ++i) {
        const uint32_t m = std::min(first + i, chirps - 1);
        rows[i] = in + size_t{m} * samples;
        factor.lane[i] = range_factor * doppler_window_.values()[m];
      }
      Fft::gather(rows, samples, values.data());
      for (uint32_t n = 0; n < samples; ++n) values[n] *= Four(range_window_.values()[n]);
      range_transform_.transform(values.data(), line.data());
      const uint32_t count = std::min(together, chirps - first);
      for (uint32_t k = 0; k < samples; ++k) {
        const Four re = line[k].real() * factor, im = line[k].imag() * factor;
        std::complex<float>* column = turned.data() + size_t{k} * chirps + first;
        for (uint32_t i = 0; i < count; ++i) column[i] = {re.lane[i], im.lane[i]};
      }
    }
    const uint32_t half = chirps / 2;
    for (uint32_t first = 0; first < samples; first += together) {
      const std::complex<float>* columns[together];
      std::complex<float>* above[together];  // output of the velocities from 0 up
      std::complex<float>* below[together];
      for (uint32_t i = 0; i < together; ++i) {
        const size_t k = std::min(first + i, samples - 1);
        columns[i] = turned.data() + k * chirps;
        above[i] = out + k * chirps + half, below[i] = out + k * chirps;
      }
      Fft::gather(columns, chirps, values.data());
      doppler_transform_.transform(values.data(), line.data());
      for (uint32_t k = 0; k < chirps; ++k) line[k] *= Four(doppler_factor);
      Fft::scatter(line.data(), chirps - half, above);
      Fft::scatter(line.data() + (chirps - half), half, below);
    }
  });
  if (config_.waveform.bands() > 1) return demultiplexed(config_.waveform, result, threads);
  return result;
}

std::vector<float> RadarMaps::range_doppler(std::span<const std::complex<float>> spectrum,
                                            uint32_t threads) const {
  const size_t chirps = doppler_window_.size(), samples = range_window_.size(), plane = samples * chirps;
  const size_t antennas = spectrum.size() / plane;
  std::vector<float> map(plane, 0.0f);
  parallel_for(samples, threads, [&](size_t range) {
    float* row = map.data() + range * chirps;
    for (size_t v = 0; v < antennas; ++v)
      add_power(spectrum.data() + v * plane + range * chirps, chirps, row);
    for (size_t k = 0; k < chirps; ++k) row[k] /= static_cast<float>(antennas);
  });
  return map;
}

std::vector<float> RadarMaps::range_azimuth(std::span<const std::complex<float>> spectrum,
                                            uint32_t threads) const {
  const uint32_t chirps = doppler_window_.size(), samples = range_window_.size();
  const uint32_t transmitters = config_.waveform.transmitters;
  const size_t plane = size_t{samples} * chirps, antennas = spectrum.size() / plane,
               azimuths = axes_.azimuth.size();
  GREATX_CHECK(beams_ && beams_->places() == antennas, "{} antennas", antennas);
  const uint32_t padded = (chirps + AzimuthBeams::lanes - 1) / AzimuthBeams::lanes * AzimuthBeams::lanes;
  std::vector<std::complex<float>> compensation(size_t{transmitters} * chirps);
  for (uint32_t t = 0; t < transmitters; ++t)
    for (uint32_t k = 0; k < chirps; ++k)
      compensation[size_t{t} * chirps + k] = std::complex<float>(
          unit_phasor(-fraction_of_turn(tdm_turns(config_.waveform, t, doppler_turns(k, chirps)))));
  // The power of a beam is |sum of n antennas|^2/n^2. The map is the mean over the beams, divided by the
  // noise bandwidth of the window.
  const double beams = config_.bistatic ? transmitters : 1, each = double(antennas) / beams;
  const float factor = static_cast<float>(1.0 / (each * each * beams * doppler_window_.noise_bandwidth()));
  std::vector<float> map(samples * azimuths);
  parallel_for(samples, threads, [&](size_t range) {
    std::vector<float> re(antennas * padded, 0.0f), im(antennas * padded, 0.0f);
    for (size_t v = 0; v < antennas; ++v) {
      const std::complex<float>* row = spectrum.data() + v * plane + range * chirps;
      const std::complex<float>* turn = compensation.data() + (v % transmitters) * chirps;
      for (uint32_t k = 0; k < chirps; ++k) {
        re[v * padded + k] = row[k].real() * turn[k].real() - row[k].imag() * turn[k].imag();
        im[v * padded + k] = row[k].real() * turn[k].imag() + row[k].imag() * turn[k].real();
      }
    }
    float* out = map.data() + range * azimuths;
    beams_->add_powers(re.data(), im.data(), padded, out);
    // Rounding errors may make the sum negative.
    for (size_t k = 0; k < azimuths; ++k) out[k] = std::max(out[k], 0.0f) * factor;
  });
  return map;
}

}  // namespace greatx::rf
