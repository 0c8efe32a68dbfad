// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <complex>
#include <span>

#include "rf/radar/signal/beat.h"

namespace greatx::rf::testing {

/// Adds the reference for BeatSynthesizer to `cube`, [receivers, transmitters, chirps, samples], without
/// phase noise. Each sample's phase is computed on its own in fp64, with the delay at the time of that
/// sample.
void beat_direct(const RadarSignalConfig& config, const EchoList& list, const RadarAttitude& attitude,
                 uint32_t threads, std::span<std::complex<double>> cube);

}  // namespace greatx::rf::testing
