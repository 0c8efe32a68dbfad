// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/signal/direction_finder.h"

#include <algorithm>
#include <cmath>

#include "core/phase.h"
#include "rf/radar/signal/maps.h"

namespace greatx::rf {
namespace {

constexpr double finest_step = radians(0.05);

/// Returns angles from -90 to 90 degrees, a fifth of the beam lambda/extent apart, or the single angle 0 if
/// there is no extent.
std::vector<double> angles(double extent) {
  if (extent < least_extent_wavelengths) return {0.0};
  const double step = std::max(finest_step, 0.2 / std::max(extent, 1.0));
  const int half = static_cast<int>(std::ceil(0.5 * pi / step));
  std::vector<double> result;
  for (int i = -half; i <= half; ++i) result.push_back(0.5 * pi * i / half);
  return result;
}

}  // namespace

double extent_wavelengths(const RadarSignalConfig& config, const dvec3& axis) {
  double lowest = 0.0, highest = 0.0;
  bool first = true;
  for (uint32_t r = 0; r < config.arrays.receive_m.size(); ++r)
    for (uint32_t t = 0; t < config.waveform.transmitters; ++t) {
      const double place = -steering_turns(config, r, t, axis);
      lowest = first ? place : std::min(lowest, place);
      highest = first ? place : std::max(highest, place);
      first = false;
    }
  return highest - lowest;
}

DirectionFinder::DirectionFinder(const RadarSignalConfig& config)
    : config_(config),
      azimuths_(angles(extent_wavelengths(config, dvec3(0, 1, 0)))),
      elevations_(angles(extent_wavelengths(config, dvec3(0, 0, 1)))) {
  for (const double azimuth : azimuths_)
    for (const double elevation : elevations_)
      for (uint32_t r = 0; r < config.arrays.receive_m.size(); ++r)
        for (uint32_t t = 0; t < config.waveform.transmitters; ++t)
          steering_.push_back(std::complex<float>(unit_phasor(
              -fraction_of_turn(steering_turns(config, r, t, Direction{azimuth, elevation, 0.0}.unit())))));
}

double DirectionFinder::power(std::span<const std::complex<double>> snapshot, double azimuth,
                              double elevation, std::vector<std::complex<double>>& phasors) const {
  const dvec3 unit = Direction{azimuth, elevation, 0.0}.unit();
  const uint32_t transmitters = config_.waveform.transmitters;
  const size_t receivers = config_.arrays.receive_m.size();
  const auto phasor = [&](const dvec3& element) {
    return unit_phasor(fraction_of_turn(glm::dot(unit, element) / config_.waveform.wavelength_m()));
  };
  phasors.clear();
  if (config_.bistatic) {
    for (const dvec3& element : config_.arrays.receive_m) phasors.push_back(phasor(element));
    double powers = 0.0;
    for (uint32_t t = 0; t < transmitters; ++t) {
      std::complex<double> sum = 0.0;
      for (size_t r = 0; r < receivers; ++r) sum += plain_product(snapshot[r * transmitters + t], phasors[r]);
      powers += std::norm(sum / double(receivers));
    }
    return powers / transmitters;
  }
  // The phase of a pair is the sum of those of its elements.
  for (const dvec3& element : config_.arrays.transmit_m) phasors.push_back(phasor(element));
  std::complex<double> beam = 0.0;
  for (size_t r = 0; r < receivers; ++r) {
    std::complex<double> sum = 0.0;
    for (uint32_t t = 0; t < transmitters; ++t)
      sum += plain_product(snapshot[r * transmitters + t], phasors[t]);
    beam += plain_product(sum, phasor(config_.arrays.receive_m[r]));
  }
  return std::norm(beam / double(snapshot.size()));
}

Direction DirectionFinder::find(std::span<const std::complex<double>> snapshot) const {
  const uint32_t transmitters = config_.waveform.transmitters;
  const size_t antennas = snapshot.size();
  double largest = 0.0;  // scaling by this keeps squares within the range of fp32
  for (const auto& value : snapshot) largest = std::max(largest, std::abs(value));
  if (!(largest > 0.0)) return {};
  std::vector<std::complex<float>> rounded;
  for (const auto& value : snapshot) rounded.emplace_back(value / largest);
  Direction best;
  float highest = -1.0f;
  const std::complex<float>* steering = steering_.data();
  for (const double azimuth : azimuths_)
    for (const double elevation : elevations_) {
      float power_here = 0.0f;
      const size_t groups = config_.bistatic ? transmitters : 1;
      for (size_t g = 0; g < groups; ++g) {
        float re = 0.0f, im = 0.0f;
        for (size_t v = g; v < antennas; v += groups) {
          re += rounded[v].real() * steering[v].real() - rounded[v].imag() * steering[v].imag();
          im += rounded[v].real() * steering[v].imag() + rounded[v].imag() * steering[v].real();
        }
        power_here += re * re + im * im;
      }
      steering += antennas;
      if (power_here > highest) {
        highest = power_here;
        best = {azimuth, elevation, 0.0};
      }
    }
  std::vector<std::complex<double>> phasors;
  best.power_w = power(snapshot, best.azimuth, best.elevation, phasors);
  // Climbs in ever smaller steps along either angle.
  double azimuth_step = azimuths_.size() > 1 ? azimuths_[1] - azimuths_[0] : 0.0;
  double elevation_step = elevations_.size() > 1 ? elevations_[1] - elevations_[0] : 0.0;
  while (std::max(azimuth_step, elevation_step) > 1e-8) {
    bool higher = false;
    for (const auto& [da, de] : {std::pair{azimuth_step, 0.0},
                                 {-azimuth_step, 0.0},
                                 {0.0, elevation_step},
                                 {0.0, -elevation_step}}) {
      if (da == 0.0 && de == 0.0) continue;
      const double azimuth = std::clamp(best.azimuth + da, -0.5 * pi, 0.5 * pi);
      const double elevation = std::clamp(best.elevation + de, -0.5 * pi, 0.5 * pi);
      const double value = power(snapshot, azimuth, elevation, phasors);
      if (value <= best.power_w) continue;
      best = {azimuth, elevation, value};
      higher = true;
    }
    if (higher) continue;
    azimuth_step *= 0.5;
    elevation_step *= 0.5;
  }
  return best;
}

}  // namespace greatx::rf
