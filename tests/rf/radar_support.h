// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Provides radars and point targets for tests.
#pragma once

#include <cmath>
#include <complex>
#include <vector>

#include "core/random.h"
#include "rf/radar/signal/radar_processor.h"
#include "tests/rf/beat_direct.h"

namespace greatx::rf::testing {

inline double dbm_of(double power_w) { return decibels(power_w) + 30.0; }
inline double isotropic(const dvec3&) { return 1.0; }

/// Sets a row of transmitters * receivers virtual antennas along y, half a wavelength apart. The receivers
/// have that spacing; the transmitters are one row of receivers apart.
inline void set_row(RadarSignalConfig& config, uint32_t transmitters, uint32_t receivers) {
  const double half = 0.5 * config.waveform.wavelength_m();
  config.waveform.transmitters = transmitters;
  config.arrays.transmit_m.clear();
  config.arrays.receive_m.clear();
  for (uint32_t t = 0; t < transmitters; ++t)
    config.arrays.transmit_m.push_back({0, half * receivers * t, 0});
  for (uint32_t r = 0; r < receivers; ++r) config.arrays.receive_m.push_back({0, half * r, 0});
}

/// Returns a radar at 77 GHz with 213 MHz over 64 samples (0.70 m per bin, 45 m in all), 32 chirps of each of
/// two transmitters (velocities up to 8.1 m/s) and two receivers.
inline RadarSignalConfig small_radar() {
  RadarSignalConfig config;
  config.waveform.slope_hz_per_s = 5e12;
  config.waveform.samples = 64;
  config.waveform.sample_rate_hz = 1.5e6;
  config.waveform.slots = 64;
  set_row(config, 2, 2);
  config.processing.cfar.train_doppler = 3;
  return config;
}

/// Returns the echo of a point at `range_m` in the middle of the frame, which recedes at `velocity_m_s`, in
/// the given direction. Its amplitude follows from the radar equation for elements of gain `gain`.
inline Echo point_echo(const RadarSignalConfig& config, double range_m, double velocity_m_s,
                       double azimuth = 0.0, double elevation = 0.0, double rcs_m2 = 1.0, double gain = 1.0) {
  Echo echo;
  const double lambda = config.waveform.wavelength_m();
  echo.amplitude = gain * lambda * std::sqrt(rcs_m2 / std::pow(4 * pi, 3)) / (range_m * range_m);
  echo.departure = echo.arrival = Direction{azimuth, elevation, 0.0}.unit();
  echo.delay.mid_s = config.waveform.frame_middle_s();
  echo.delay.coefficients = {2 * range_m / speed_of_light, 2 * velocity_m_s / speed_of_light, 0.0, 0.0};
  echo.instance = 1;
  return echo;
}

/// Returns an echo at a random place, of a random amplitude and a constant rate of at most `fastest` m/s.
inline Echo random_echo(const RadarSignalConfig& config, double fastest, RandomStream& random) {
  Echo echo = point_echo(config, random.uniform(1.0, 150.0), random.uniform(-fastest, fastest),
                         random.uniform(-1.5, 1.5), random.uniform(-0.5, 0.5));
  echo.amplitude = std::polar(random.uniform(0.1, 1.0), random.uniform(-pi, pi));
  return echo;
}

inline EchoList whole_frame(const RadarSignalConfig& config, std::vector<Echo> echoes) {
  return {0, config.waveform.slots, std::move(echoes), {}};
}

inline RadarCube cube_of(const RadarSignalConfig& config, const EchoList& list, uint32_t threads = 0) {
  RadarCube cube(config.arrays.receive_m.size() * config.waveform.slots * config.waveform.samples);
  BeatSynthesizer(config).add(list, {}, nullptr, threads, cube);
  return cube;
}

inline std::vector<std::complex<double>> direct_cube(const RadarSignalConfig& config, const EchoList& list) {
  std::vector<std::complex<double>> cube(config.arrays.receive_m.size() * config.waveform.slots *
                                         config.waveform.samples);
  beat_direct(config, list, {}, 0, cube);
  return cube;
}

inline RadarFrame frame_of(const RadarSignalConfig& config, const std::vector<EchoList>& lists,
                           RadarSeeds seeds = {1, 2, 3}, double gain = 1.0) {
  const std::vector<RadarAttitude> attitudes(1);
  const auto gains = [gain](const dvec3&) { return gain; };
  return RadarProcessor("front", config, gains, gains).process({lists, attitudes, {}, seeds});
}

/// Returns the index of the largest value.
inline size_t peak_of(const std::vector<float>& map) {
  return std::max_element(map.begin(), map.end()) - map.begin();
}

}  // namespace greatx::rf::testing
