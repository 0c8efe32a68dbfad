// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Echoes of coded waveforms that arrive after the cyclic prefix (OFDM) or after the first repetition of the
// code (PMCW). Their first part within the samples of a slot belongs to the slot before, whose symbols are
// others: the symbols interfere with one another, and the lines of each symbol with one another. Such an echo
// has no response of its own over the lines. It is added to the signal in time, line by line and slot by
// slot.
#pragma once

#include <complex>
#include <cstdint>
#include <span>

#include "rf/config/radar_config.h"
#include "rf/radar/signal/beat.h"
#include "rf/radar/signal/echo.h"
#include "rf/radar/signal/symbols.h"

namespace greatx::rf {

/// Returns whether an echo of a list is late in the middle of the list.
bool is_late(const EchoList& list, const Echo& echo, const RadarWaveform& waveform);

/// Adds echoes to the signal of Symbols::send(), [receivers, loop, chirps, samples]. The echoes may be late
/// or not. The bytes do not depend on the number of threads.
void add_late_echoes(const RadarSignalConfig& config, const Symbols& symbols, const EchoList& list,
                     const RadarAttitude& attitude, const RadarSeeds& seeds, uint32_t threads,
                     std::span<std::complex<float>> signal);

}  // namespace greatx::rf
