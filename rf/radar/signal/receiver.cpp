// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/signal/receiver.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "rf/radar/signal/lanes.h"

namespace greatx::rf {
namespace {

constexpr double boltzmann_j_k = 1.380649e-23;    ///< exact, SI
constexpr double standard_temperature_k = 290.0;  ///< T_0 of a noise figure, as IEEE defines it
constexpr uint32_t draws = 64;                    ///< number of counters side by side
constexpr size_t samples_per_task = 16384;

/// Holds philox4x32 (shaders/shared/random.h) of the `draws` counters (first + i, y, z, w).
struct Words {
  uint32_t x[draws], y[draws], z[draws], w[draws];
};

GREATX_LANES void philox(uint32_t first, uint32_t y, uint32_t z, uint32_t w, uint64_t seed, Words& words) {
  for (uint32_t i = 0; i < draws; ++i) {
    words.x[i] = first + i;
    words.y[i] = y;
    words.z[i] = z;
    words.w[i] = w;
  }
  uint32_t key_x = static_cast<uint32_t>(seed), key_y = static_cast<uint32_t>(seed >> 32);
  for (int round = 0; round < 10; ++round) {
    for (uint32_t i = 0; i < draws; ++i) {
      const uint64_t p0 = uint64_t{0xD2511F53u} * words.x[i], p1 = uint64_t{0xCD9E8D57u} * words.z[i];
      words.x[i] = static_cast<uint32_t>(p1 >> 32) ^ words.y[i] ^ key_x;
      words.y[i] = static_cast<uint32_t>(p1);
      words.z[i] = static_cast<uint32_t>(p0 >> 32) ^ words.w[i] ^ key_y;
      words.w[i] = static_cast<uint32_t>(p0);
    }
    key_x += 0x9E3779B9u;
    key_y += 0xBB67AE85u;
  }
}

/// Computes a complex normal number from each pair of words.
GREATX_LANES void box_muller(const uint32_t* radius_bits, const uint32_t* angle_bits, float* re, float* im) {
  for (uint32_t i = 0; i < draws; ++i) {
    const float uniform =
        (static_cast<float>(static_cast<int32_t>(radius_bits[i] >> 8)) + 0.5f) * 0x1p-24f;  // (0, 1)
    complex_normal(uniform, static_cast<float>(static_cast<int32_t>(angle_bits[i] >> 8)) * 0x1p-24f, re[i],
                   im[i]);
  }
}

}  // namespace

void complex_normals(const RadarSeeds& seeds, RadarDraw purpose, uint32_t part, uint32_t first,
                     std::span<std::complex<float>> out) {
  GREATX_CHECK(first % 2 == 0, "draws from {}", first);
  Words words;
  float re[2][draws], im[2][draws];
  for (size_t done = 0; done < out.size(); done += 2 * draws) {
    philox(first / 2 + static_cast<uint32_t>(done / 2), seeds.stream, seeds.sequence,
           static_cast<uint32_t>(purpose) + part, seeds.seed, words);
    box_muller(words.x, words.y, re[0], im[0]);
    box_muller(words.z, words.w, re[1], im[1]);
    if (out.size() - done >= 2 * draws) {
      for (size_t i = 0; i < draws; ++i) {
        out[done + 2 * i] = {re[0][i], im[0][i]};
        out[done + 2 * i + 1] = {re[1][i], im[1][i]};
      }
      continue;
    }
    for (size_t i = 0; i < out.size() - done; ++i) out[done + i] = {re[i % 2][i / 2], im[i % 2][i / 2]};
  }
}

double noise_power_w(double bandwidth_hz, double noise_figure_db) {
  return boltzmann_j_k * standard_temperature_k * bandwidth_hz * from_decibels(noise_figure_db);
}

double hidden_ratio(const RadarSignalConfig& config) {
  if (!config.receiver.noise_figure_db) return 0.0;
  constexpr double share = 0.01;
  const RadarWaveform& w = config.waveform;
  const double added =
      double(w.samples) * w.chirps() * w.transmitters * double(config.arrays.receive_m.size());
  return share * noise_power_w(w.noise_bandwidth_hz(), *config.receiver.noise_figure_db) /
         (added * config.transmit_power_w);
}

double hidden_section_m2(const RadarSignalConfig& config, double transmit_gain, double receive_gain) {
  const double lambda = config.waveform.wavelength_m(), four_pi = 4.0 * pi;
  return hidden_ratio(config) * four_pi * four_pi * four_pi /
         (transmit_gain * receive_gain * lambda * lambda);
}

void add_noise(const RadarSeeds& seeds, double power_w, uint32_t threads,
               std::span<std::complex<float>> cube) {
  GREATX_CHECK(cube.size() / 2 <= UINT32_MAX, "{} samples", cube.size());
  const float amplitude = static_cast<float>(std::sqrt(power_w));
  parallel_for((cube.size() + samples_per_task - 1) / samples_per_task, threads, [&](size_t task) {
    const size_t first = task * samples_per_task, count = std::min(samples_per_task, cube.size() - first);
    std::vector<std::complex<float>> noise(count);
    // The four words of a counter serve two samples; the counter is the number of the pair.
    complex_normals(seeds, RadarDraw::thermal, static_cast<uint32_t>(first >> 32),
                    static_cast<uint32_t>(first), noise);
    for (size_t i = 0; i < count; ++i) cube[first + i] += amplitude * noise[i];
  });
}

uint64_t digitize(const AnalogToDigital& adc, uint32_t threads, std::span<std::complex<float>> cube) {
  const double full_scale = std::sqrt(from_decibels(adc.full_scale_dbm - 30.0));
  const double levels = std::exp2(adc.bits - 1.0);  // on each side of zero
  const double step = full_scale / levels;
  const auto convert = [&](float value, bool& beyond) {
    const double level = std::floor(value / step), held = std::clamp(level, -levels, levels - 1.0);
    beyond |= level != held;
    return static_cast<float>((held + 0.5) * step);
  };
  std::vector<uint64_t> beyond((cube.size() + samples_per_task - 1) / samples_per_task, 0);
  parallel_for(beyond.size(), threads, [&](size_t task) {
    const size_t first = task * samples_per_task, last = std::min(cube.size(), first + samples_per_task);
    for (size_t i = first; i < last; ++i) {
      bool out = false;
      const float re = convert(cube[i].real(), out), im = convert(cube[i].imag(), out);
      cube[i] = {re, im};
      beyond[task] += out;
    }
  });
  uint64_t sum = 0;
  for (const uint64_t count : beyond) sum += count;
  return sum;
}

namespace {

constexpr double first_node_s = 1e-10;
constexpr double node_ratio = 1.25;

}  // namespace

PhaseWalk::PhaseWalk(const PhaseNoise& noise, const RadarWaveform& waveform, const RadarSeeds& seeds)
    : seeds_(seeds),
      deviation_(std::sqrt(pi * noise.pole_hz * from_decibels(noise.level_dbc_hz))),
      pole_rad_s_(2.0 * pi * noise.pole_hz),
      sample_s_(1.0 / waveform.sample_rate_hz),
      samples_(waveform.samples) {}

uint32_t PhaseWalk::node_of(double delay_s) {
  return static_cast<uint32_t>(
      std::max(0.0, std::nearbyint(std::log(delay_s / first_node_s) / std::log(node_ratio))));
}

double PhaseWalk::node_delay_s(uint32_t node) { return first_node_s * std::pow(node_ratio, node); }

void PhaseWalk::Ramp::extend(size_t count) {
  if (count <= backwards_.size()) return;
  // A stationary Gaussian process with one pole has the same statistics when it is read backwards.
  std::vector<std::complex<float>> draws_of(count);
  complex_normals(walk_.seeds_, RadarDraw::walk, slot_, 0, draws_of);
  const double kept = std::exp(-walk_.pole_rad_s_ * walk_.sample_s_);
  const float keep = static_cast<float>(kept),
              fresh = static_cast<float>(std::sqrt(2.0 * (1.0 - kept * kept)));
  for (size_t i = backwards_.size(); i < count; ++i)
    backwards_.push_back(i == 0 ? std::sqrt(2.0f) * draws_of[0].real()
                                : keep * backwards_[i - 1] + fresh * draws_of[i].real());
}

void PhaseWalk::Ramp::differences(uint32_t node, std::span<float> turns) {
  GREATX_CHECK(turns.size() == walk_.samples_ && node < 128, "{} samples, node {}", turns.size(), node);
  const double in_samples = node_delay_s(node) / walk_.sample_s_;
  const size_t whole = static_cast<size_t>(in_samples);
  const double later = in_samples - double(whole), rate = walk_.pole_rad_s_ * walk_.sample_s_;
  extend(walk_.samples_ + whole + 1);
  std::vector<std::complex<float>> bridge(walk_.samples_);
  complex_normals(walk_.seeds_, RadarDraw::bridge, slot_, node << 24, bridge);
  // The phase between two samples, conditioned on both. D. T. Gillespie, Phys. Rev. E 54, 2084 (1996), gives
  // the process; here it is also conditioned on the far end.
  const double both = std::sinh(rate);
  const float near = static_cast<float>(std::sinh(rate * (1.0 - later)) / both);
  const float far = static_cast<float>(std::sinh(rate * later) / both);
  const float between = static_cast<float>(
      std::sqrt(2.0 * 2.0 * std::sinh(rate * later) * std::sinh(rate * (1.0 - later)) / both));
  const float scale = static_cast<float>(walk_.deviation_ / (2.0 * pi));
  for (uint32_t n = 0; n < walk_.samples_; ++n) {
    const size_t now = walk_.samples_ - 1 - n;
    const float before =
        near * backwards_[now + whole] + far * backwards_[now + whole + 1] + between * bridge[n].real();
    turns[n] = scale * (backwards_[now] - before);
  }
}

}  // namespace greatx::rf
