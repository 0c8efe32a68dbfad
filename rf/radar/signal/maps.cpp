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

constexpr uint32_t lanes = 8;
using Lane [[gnu::vector_size(32)]] = float;
using Stored [[gnu::vector_size(32), gnu::aligned(4), gnu::may_alias]] = float;

/// Computes sum x[i] conj(y[i]) over `count` values, a multiple of 8, in a fixed order.
GREATX_LANES void conjugate_product(const float* x_re, const float* x_im, const float* y_re,
                                    const float* y_im, uint32_t count, float& re, float& im) {
  Lane sum_re{}, sum_im{};
  for (uint32_t i = 0; i < count; i += lanes) {
    const Lane a = *reinterpret_cast<const Stored*>(x_re + i), b = *reinterpret_cast<const Stored*>(x_im + i);
    const Lane c = *reinterpret_cast<const Stored*>(y_re + i), d = *reinterpret_cast<const Stored*>(y_im + i);
    sum_re += a * c + b * d;
    sum_im += b * c - a * d;
  }
  re = ((sum_re[0] + sum_re[1]) + (sum_re[2] + sum_re[3])) +
       ((sum_re[4] + sum_re[5]) + (sum_re[6] + sum_re[7]));
  im = ((sum_im[0] + sum_im[1]) + (sum_im[2] + sum_im[3])) +
       ((sum_im[4] + sum_im[5]) + (sum_im[6] + sum_im[7]));
}

GREATX_LANES void add_scaled(float re, float im, const float* steering_re, const float* steering_im,
                             uint32_t count, float* out) {
  for (uint32_t i = 0; i < count; ++i) out[i] += re * steering_re[i] - im * steering_im[i];
}

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
  const uint32_t antennas = static_cast<uint32_t>(config.arrays.receive_m.size()) * transmitters;
  beams_ = config.bistatic ? transmitters : 1;
  for (uint32_t a = 0; a < antennas; ++a)
    for (uint32_t b = a + 1; b < antennas; ++b)
      if (!config.bistatic || a % transmitters == b % transmitters) pairs_.push_back({a, b});
  const size_t azimuths = axes_.azimuth.size();
  steering_.resize(pairs_.size() * 2 * azimuths);
  for (size_t i = 0; i < pairs_.size(); ++i)
    for (size_t k = 0; k < azimuths; ++k) {
      const dvec3 u(std::cos(axes_.azimuth[k]), std::sin(axes_.azimuth[k]), 0.0);
      const auto turns = [&](uint32_t v) {
        return steering_turns(config_, v / transmitters, v % transmitters, u);
      };
      const std::complex<double> phasor =
          unit_phasor(fraction_of_turn(turns(pairs_[i].b) - turns(pairs_[i].a)));
      steering_[2 * i * azimuths + k] = static_cast<float>(phasor.real());
      steering_[(2 * i + 1) * azimuths + k] = static_cast<float>(phasor.imag());
    }
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
  const uint32_t padded = (chirps + lanes - 1) / lanes * lanes;
  std::vector<std::complex<float>> compensation(size_t{transmitters} * chirps);
  for (uint32_t t = 0; t < transmitters; ++t)
    for (uint32_t k = 0; k < chirps; ++k)
      compensation[size_t{t} * chirps + k] = std::complex<float>(
          unit_phasor(-fraction_of_turn(tdm_turns(config_.waveform, t, doppler_turns(k, chirps)))));
  // The power of a beam is |sum of n antennas|^2/n^2. The map is the mean over the beams, divided by the
  // noise bandwidth of the window.
  const double each = double(antennas) / beams_;
  const float factor = static_cast<float>(1.0 / (each * each * beams_ * doppler_window_.noise_bandwidth()));
  std::vector<float> map(samples * azimuths);
  parallel_for(samples, threads, [&](size_t range) {
    std::vector<float> re(antennas * padded, 0.0f), im(antennas * padded, 0.0f);
    float sum = 0.0f, product_re, product_im;
    for (size_t v = 0; v < antennas; ++v) {
      const std::complex<float>* row = spectrum.data() + v * plane + range * chirps;
      const std::complex<float>* turn = compensation.data() + (v % transmitters) * chirps;
      for (uint32_t k = 0; k < chirps; ++k) {
        re[v * padded + k] = row[k].real() * turn[k].real() - row[k].imag() * turn[k].imag();
        im[v * padded + k] = row[k].real() * turn[k].imag() + row[k].imag() * turn[k].real();
      }
      conjugate_product(&re[v * padded], &im[v * padded], &re[v * padded], &im[v * padded], padded,
                        product_re, product_im);
      sum += product_re;
    }
    float* out = map.data() + range * azimuths;
    std::fill_n(out, azimuths, sum);
    for (size_t i = 0; i < pairs_.size(); ++i) {
      const auto [a, b] = pairs_[i];
      conjugate_product(&re[a * padded], &im[a * padded], &re[b * padded], &im[b * padded], padded,
                        product_re, product_im);
      // The term is conj(w_a) w_b x_a conj(x_b), where w is the steering. The pair (b, a) gives its
      // conjugate.
      add_scaled(2.0f * product_re, 2.0f * product_im, &steering_[2 * i * azimuths],
                 &steering_[(2 * i + 1) * azimuths], static_cast<uint32_t>(azimuths), out);
    }
    // Rounding errors may make the sum negative.
    for (size_t k = 0; k < azimuths; ++k) out[k] = std::max(out[k], 0.0f) * factor;
  });
  return map;
}

}  // namespace greatx::rf
