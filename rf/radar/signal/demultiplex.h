// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tells the transmitters of Doppler-division multiplexing apart.
//
// Transmitter t turns its phase by t/K from slot to slot, K = transmitters + empty bands, so that a target in
// Doppler bin k is in bin k + t M/K of the spectrum as well. The bins k_0, k_0 + M/K, ... are a group of K
// cells. In a group with one target, `transmitters` cells that follow one another on the circle hold its
// echoes and the others hold noise. The processor takes the place where these cells have the most power. The
// target is thereby placed in the whole Doppler band; the other places of the group are empty.
#pragma once

#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include "rf/config/radar_waveform.h"
#include "rf/radar/signal/cfar.h"

namespace greatx::rf {

/// Returns the spectrum [rx, tx, range, velocity] of the spectrum [rx, range, velocity]. In each group all
/// velocities but one are 0.
std::vector<std::complex<float>> demultiplexed(const RadarWaveform& waveform,
                                               std::span<const std::complex<float>> spectrum,
                                               uint32_t threads);

/// Returns the map [range, velocity modulo M/K] of the velocities that were taken.
std::vector<float> folded_map(const RadarWaveform& waveform, std::span<const float> map);

/// Returns the mean of a folded map's cells where there is noise alone, relative to the mean power of the
/// noise: the largest of several sums is above their mean. To half a per cent, by random draws that are
/// always the same.
double noise_rise(const RadarWaveform& waveform, size_t receivers);

/// Moves the peaks of a folded map to their velocities in `map`.
void unfold(const RadarWaveform& waveform, std::span<const float> map, std::vector<CfarPeak>& peaks);

}  // namespace greatx::rf
