// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <complex>
#include <span>
#include <vector>

#include "rf/radar/signal/beat.h"
#include "rf/radar/signal/receiver.h"

namespace greatx::rf::testing {

/// Adds the reference for BeatSynthesizer to `cube`, [receivers, loop, chirps, samples], without phase noise.
/// Each sample's phase is computed on its own in fp64, with the delay at the time of that sample. For
/// waveforms that sweep.
void beat_direct(const RadarSignalConfig& config, const EchoList& list, const RadarAttitude& attitude,
                 uint32_t threads, std::span<std::complex<double>> cube);

/// Returns the reference for coded waveforms, [receivers, loop, chirps, samples], without noise. Each sample
/// in time is the sum of all lines of all echoes in fp64, with the delay at the time of that sample and the
/// symbol that was on its way then; the lines follow by a direct transform.
std::vector<std::complex<double>> coded_direct(const RadarSignalConfig& config, const EchoList& list,
                                               const RadarSeeds& seeds);

}  // namespace greatx::rf::testing
