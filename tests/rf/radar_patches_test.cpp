// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Compares the two-dimensional transform of patches with the sum of their echoes, one by one.
#include <cstring>

#include <gtest/gtest.h>

#include "core/random.h"
#include "rf/radar/signal/patch_kernel.h"
#include "tests/rf/radar_support.h"

namespace greatx::rf {
namespace {

using testing::direct_cube;
using testing::point_echo;
using testing::small_radar;
using testing::whole_frame;

/// Stated in rf/radar/signal/patches.h; 9e-4 is the largest that is met here.
constexpr double transform_error = 1.5e-3;

/// Returns echoes at random places that all have constant rates.
std::vector<Echo> steady_echoes(const RadarSignalConfig& config, int count, double fastest, uint64_t seed) {
  RandomStream random(seed, 7);
  std::vector<Echo> echoes;
  for (int i = 0; i < count; ++i) {
    Echo echo = testing::random_echo(config, fastest, random);
    echo.instance = 1 + i % 3;
    echoes.push_back(echo);
  }
  return echoes;
}

/// Returns the same echoes as patches in `blocks` blocks.
PatchList patches_of(const RadarSignalConfig& config, const std::vector<Echo>& echoes, uint32_t blocks) {
  PatchList list;
  list.blocks = blocks;
  for (const Echo& echo : echoes) {
    list.re.push_back(static_cast<float>(echo.amplitude.real()));
    list.im.push_back(static_cast<float>(echo.amplitude.imag()));
    list.departure.push_back(vec3(echo.departure));
    list.instance.push_back(echo.instance);
  }
  for (uint32_t block = 0; block < blocks; ++block)
    for (const Echo& echo : echoes) {
      const double middle_s = patch_block(config.waveform, 0, config.waveform.slots, blocks, block).middle_s;
      list.delay_s.push_back(echo.delay.coefficients[0] +
                             echo.delay.coefficients[1] * (middle_s - echo.delay.mid_s));
      list.rate.push_back(echo.delay.coefficients[1]);
    }
  return list;
}

RadarCube patch_cube(const RadarSignalConfig& config, const PatchList& list, uint32_t threads = 0) {
  RadarCube cube(config.arrays.receive_m.size() * config.waveform.slots * config.waveform.samples);
  PatchSynthesizer(config).add(list, 0, config.waveform.slots, {}, nullptr, threads, cube);
  return cube;
}

double amplitude_sum(const RadarSignalConfig& config, const std::vector<Echo>& echoes) {
  double sum = 0.0;
  for (const Echo& echo : echoes) sum += std::abs(echo.amplitude) * std::sqrt(config.transmit_power_w);
  return sum;
}

/// Returns the largest difference of a sample, relative to the sum of all amplitudes.
double patch_fault(const RadarSignalConfig& config, const std::vector<Echo>& echoes, uint32_t blocks) {
  const RadarCube fast = patch_cube(config, patches_of(config, echoes, blocks));
  const auto slow = direct_cube(config, whole_frame(config, echoes));
  double largest = 0.0;
  for (size_t i = 0; i < fast.size(); ++i)
    largest = std::max(largest, std::abs(std::complex<double>(fast[i]) - slow[i]));
  return largest / amplitude_sum(config, echoes);
}

TEST(RadarPatches, PatchesAtRestAreTheSumOfTheirEchoes) {
  // One antenna: the range that its place adds is not left out then.
  for (const uint32_t samples : {16u, 37u, 64u, 250u}) {
    RadarSignalConfig config = small_radar();
    testing::set_row(config, 1, 1);
    config.waveform.samples = samples;
    config.waveform.sample_rate_hz = samples / 42e-6;
    config.waveform.slots = 48;
    for (const uint32_t blocks : {1u, 5u, 48u})
      for (const uint64_t seed : {1u, 2u})
        EXPECT_LT(patch_fault(config, steady_echoes(config, 30, 0.0, seed), blocks), transform_error)
            << samples << " samples, " << blocks << " blocks";
  }
}

TEST(RadarPatches, WhatIsLeftOutOfAMovingPatchStaysBelowItsBound) {
  // The phase that is left out is at most largest_patch_phase in the corners of a block.
  RadarSignalConfig config = small_radar();
  testing::set_row(config, 1, 1);
  for (const double fastest : {1.0, 10.0, 60.0}) {
    const uint32_t blocks =
        patch_blocks(config.waveform, config.waveform.slots, 2.0 * fastest / speed_of_light, 0.0);
    EXPECT_LT(patch_fault(config, steady_echoes(config, 30, fastest, 3), blocks), largest_patch_phase)
        << fastest << " m/s in " << blocks << " blocks";
    // A single echo at the bound reaches most of it, so that fewer blocks would break it.
    if (blocks < 2) continue;
    std::vector<Echo> one{point_echo(config, 20.0, fastest)};
    EXPECT_GT(patch_fault(config, one, blocks / 2), largest_patch_phase);
    EXPECT_LT(patch_fault(config, one, blocks), largest_patch_phase + transform_error);
  }
}

TEST(RadarPatches, TheArrayBendsRangesOnlyByItsLength) {
  const RadarSignalConfig config = small_radar();
  // The arrays are 4 half wavelengths long: at most 2 pi S (lead) (window/2) of phase is left out.
  const double lead_s = 3.0 * 0.5 * config.waveform.wavelength_m() / speed_of_light;
  const double bound = pi * config.waveform.bandwidth_hz() * lead_s;
  const double fault = patch_fault(config, steady_echoes(config, 30, 0.0, 5), 1);
  EXPECT_LT(fault, bound + transform_error);
  EXPECT_LT(bound, 0.02);
}

TEST(RadarPatches, BlocksFollowFromRangeAndRate) {
  RadarWaveform w = small_radar().waveform;
  const double frame_s = w.slots * w.interval_s;
  EXPECT_EQ(patch_blocks(w, w.slots, 0.0, 0.0), 1u);
  // A rate at which a patch crosses half a range cell in a frame: pi/2 x 2 x 0.5 = 1.57 rad, 7 blocks.
  EXPECT_EQ(patch_blocks(w, w.slots, 1.0 / (w.bandwidth_hz() * frame_s), 0.0), 7u);
  // Half a wavelength of bend between the middle and the ends of the frame: pi f_c c (T/2)^2.
  const double curvature = 4.0 * 0.5 / (w.carrier_hz * frame_s * frame_s);
  EXPECT_EQ(patch_blocks(w, w.slots, 0.0, curvature), 3u);
  EXPECT_EQ(patch_blocks(w, w.slots, 1e-3, 0.0), w.chirps());
  uint32_t next = 0;
  for (uint32_t block = 0; block < 5; ++block) {
    const PatchBlock at = patch_block(w, 0, w.slots, 5, block);
    EXPECT_EQ(at.first, next);
    next = at.last;
  }
  EXPECT_EQ(next, w.chirps());
}

TEST(RadarPatches, BytesDoNotDependOnThreads) {
  const RadarSignalConfig config = small_radar();
  const PatchList list = patches_of(config, steady_echoes(config, 2000, 5.0, 9), 3);
  const RadarCube one = patch_cube(config, list, 1), three = patch_cube(config, list, 3);
  EXPECT_EQ(std::memcmp(one.data(), three.data(), one.size() * sizeof one[0]), 0);
}

TEST(RadarPatches, PhaseNoiseIsThatOfEchoes) {
  RadarSignalConfig config = small_radar();
  testing::set_row(config, 1, 1);
  config.receiver.phase_noise = PhaseNoise{-80.0, 1e6};
  const std::vector<Echo> echoes = steady_echoes(config, 10, 0.0, 4);
  const PhaseWalk walk(*config.receiver.phase_noise, config.waveform, {1, 2, 3});
  RadarCube patches(config.waveform.slots * config.waveform.samples), tones(patches.size());
  PatchSynthesizer(config).add(patches_of(config, echoes, 1), 0, config.waveform.slots, {}, &walk, 0,
                               patches);
  BeatSynthesizer(config).add(whole_frame(config, echoes), {}, &walk, 0, tones);
  double largest = 0.0, differs = 0.0;
  const RadarCube clean = patch_cube(config, patches_of(config, echoes, 1));
  for (size_t i = 0; i < tones.size(); ++i) {
    largest = std::max<double>(largest, std::abs(patches[i] - tones[i]));
    differs = std::max<double>(differs, std::abs(patches[i] - clean[i]));
  }
  EXPECT_LT(largest, transform_error * amplitude_sum(config, echoes));
  EXPECT_GT(differs, 1e-2 * amplitude_sum(config, echoes));
}

TEST(PatchKernel, GridsAreSmoothAndLargeEnough) {
  for (const uint32_t count : {1u, 2u, 7u, 128u, 250u, 1021u}) {
    const uint32_t grid = PatchKernel::grid_for(count);
    EXPECT_GE(grid, std::max<double>(1.5 * count, 2.0 * PatchKernel::taps));
    uint32_t left = grid;
    for (const uint32_t factor : {2u, 3u, 5u})
      while (left % factor == 0) left /= factor;
    EXPECT_EQ(left, 1u) << grid;
  }
}

}  // namespace
}  // namespace greatx::rf
