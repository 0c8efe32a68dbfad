// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/signal/demultiplex.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/random.h"

namespace greatx::rf {
namespace {

/// Returns the first of the `taken` cells that follow one another on a circle and have the largest sum.
uint32_t strongest_run(std::span<const double> powers, uint32_t taken) {
  const uint32_t count = static_cast<uint32_t>(powers.size());
  uint32_t best = 0;
  double largest = -1.0;
  for (uint32_t first = 0; first < count; ++first) {
    double sum = 0.0;
    for (uint32_t i = 0; i < taken; ++i) sum += powers[(first + i) % count];
    if (sum <= largest) continue;
    largest = sum;
    best = first;
  }
  return best;
}

}  // namespace

std::vector<std::complex<float>> demultiplexed(const RadarWaveform& w,
                                               std::span<const std::complex<float>> spectrum,
                                               uint32_t threads) {
  const uint32_t bins = w.chirps(), bands = w.bands(), width = bins / bands;
  const size_t plane = size_t{w.samples} * bins, receivers = spectrum.size() / plane;
  std::vector<std::complex<float>> result(spectrum.size() * w.transmitters);
  parallel_for(w.samples, threads, [&](size_t range) {
    std::vector<double> powers(bands);
    for (uint32_t at = 0; at < width; ++at) {
      for (uint32_t band = 0; band < bands; ++band) {
        powers[band] = 0.0;
        for (size_t r = 0; r < receivers; ++r)
          powers[band] += std::norm(spectrum[r * plane + range * bins + at + size_t{band} * width]);
      }
      const uint32_t first = strongest_run(powers, w.transmitters);
      for (size_t r = 0; r < receivers; ++r)
        for (uint32_t t = 0; t < w.transmitters; ++t)
          result[(r * w.transmitters + t) * plane + range * bins + at + size_t{first} * width] =
              spectrum[r * plane + range * bins + at + size_t{(first + t) % bands} * width];
    }
  });
  return result;
}

std::vector<float> folded_map(const RadarWaveform& w, std::span<const float> map) {
  const uint32_t bins = w.chirps(), width = bins / w.bands();
  std::vector<float> folded(map.size() / w.bands(), 0.0f);
  for (size_t range = 0; range < w.samples; ++range)
    for (uint32_t k = 0; k < bins; ++k) {
      float& cell = folded[range * width + k % width];
      cell = std::max(cell, map[range * bins + k]);
    }
  return folded;
}

double noise_rise(const RadarWaveform& w, size_t receivers) {
  constexpr int draws = 8192;
  RandomStream random(1, 2);
  std::vector<double> powers(w.bands());
  double sum = 0.0;
  for (int draw = 0; draw < draws; ++draw) {
    for (double& power : powers) {
      power = 0.0;
      for (size_t r = 0; r < receivers; ++r) power -= std::log(1.0 - random.uniform());
    }
    const uint32_t first = strongest_run(powers, w.transmitters);
    for (uint32_t t = 0; t < w.transmitters; ++t) sum += powers[(first + t) % w.bands()];
  }
  return sum / (double(draws) * w.transmitters * double(receivers));
}

void unfold(const RadarWaveform& w, std::span<const float> map, std::vector<CfarPeak>& peaks) {
  const uint32_t bins = w.chirps(), width = bins / w.bands();
  for (CfarPeak& peak : peaks) {
    uint32_t best = peak.velocity;
    for (uint32_t k = peak.velocity; k < bins; k += width)
      if (map[size_t{peak.range} * bins + k] > map[size_t{peak.range} * bins + best]) best = k;
    peak.velocity = best;
  }
}

}  // namespace greatx::rf
