// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Contains the inner loops of beat.cpp, which compute the tone of each echo in one slot and its taps on the
// grids.
#pragma once

#include <complex>
#include <cstdint>
#include <vector>

#include "rf/config/radar_config.h"
#include "rf/radar/signal/tone_kernel.h"

namespace greatx::rf {

/// Number of echoes that are processed together, so that their data stays in the first-level cache.
inline constexpr uint32_t tone_block = 128;

/// Holds the delay of each echo of a block at the middle of a slot, and its derivatives.
struct BlockDelays {
  double delay_s[tone_block], rate[tone_block], curvature_per_s[tone_block];
};

/// Holds c0 .. c3 of DelayTrack and the time mid_s at which they apply, [echoes] padded to whole blocks.
struct TrackColumns {
  std::vector<double> c0, c1, c2, c3, mid_s;
};

/// Holds the values of a slot that all its tones share.
struct SlotScales {
  double carrier_hz, slope_hz_per_s;
  double sweeps;         ///< 1 if targets move while the samples are taken, or 0
  double square;         ///< 1 if the phase has the term S tau^2/2, or 0
  double cells_per_hz;   ///< grid frequencies per hertz, M/f_s
  double half_window_s;  ///< N/2 samples
  uint32_t grid;         ///< M
};

/// Holds the tones of a block in one slot, without the differences between virtual antennas.
struct BlockTones {
  float re[tone_block], im[tone_block];  ///< phasor of the phase at the middle of the slot
  int32_t cell[tone_block];              ///< grid frequency below the tone, in [0, M)
  float place[tone_block];               ///< from there towards the next grid frequency, in [0, 1]
  float drift[tone_block];  ///< phase, rad per cell by which a virtual antenna's lead shifts the tone
  float bend[tone_block];   ///< bend, rad (ToneKernel)
  float bessel[ToneKernel::orders][tone_block];
  int32_t orders[tone_block];  ///< number of kernels; 0: the echo is summed sample by sample
};

/// Holds the tones of one virtual antenna.
struct BlockTaps {
  int32_t start[tone_block];  ///< cell of the first tap on the grid, in [0, M)
  int32_t segment[tone_block];
  float u[tone_block];  ///< place within the segment, in [0, 1]
  float re[tone_block], im[tone_block];
};

/// Computes the delays of echoes [first, first + tone_block) at `time_s` from their polynomials.
void block_delays(const TrackColumns& columns, size_t first, double time_s, BlockDelays& delays);

/// Computes the tones of a block. `mid_delay_s` [tone_block] holds the delays for which the phases of the
/// virtual antennas were computed.
void block_tones(const SlotScales& scales, const BlockDelays& delays, const double* mid_delay_s,
                 BlockTones& tones);

/// Computes the taps of a virtual antenna, each array [tone_block]: `shift` is its shift in cells,
/// `phasor_re` and `phasor_im` are its amplitude and phase.
void block_taps(const SlotScales& scales, const BlockTones& tones, const float* shift, const float* phasor_re,
                const float* phasor_im, BlockTaps& taps);

/// Adds the first `count` tones, in their order, to the grid of each receiver. A grid has M + 8 cells; its
/// real and imaginary parts take `stride` floats each, and the grids of the receivers follow one another. The
/// grids of tone i begin at `grids` + offset[i]. `taps` is [receivers].
void spread(const ToneKernel& kernel, const BlockTones& tones, const BlockTaps* taps, uint32_t receivers,
            const uint32_t* offset, uint32_t count, uint32_t stride, float* grids);

}  // namespace greatx::rf
