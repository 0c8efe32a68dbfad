// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <complex>
#include <span>

#include "rf/radar/signal/beat.h"

namespace greatx::rf::testing {

/// The sum of BeatSynthesizer in fp64, every sample's phase on its own, with the delay at that sample's time:
/// the reference, without phase noise. cube: [receivers, transmitters, chirps, samples], added to.
void beat_direct(const RadarSignalConfig& config, const EchoList& list, const RadarAttitude& attitude,
                 uint32_t threads, std::span<std::complex<double>> cube);

}  // namespace greatx::rf::testing
