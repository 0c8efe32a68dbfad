// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Inner loops of beat.cpp: what each echo's tone is in one slot, and its taps on the grids.
#pragma once

#include <complex>
#include <cstdint>
#include <vector>

#include "rf/config/radar_config.h"
#include "rf/radar/signal/tone_kernel.h"

namespace greatx::rf {

/// Echoes that are worked on together: what is known of them stays in the first cache.
inline constexpr uint32_t tone_block = 128;

/// Delay of each echo of a block at a slot's middle and its derivatives.
struct BlockDelays {
  double delay_s[tone_block], rate[tone_block], curvature_per_s[tone_block];
};

/// c0 .. c3 of DelayTrack at the list's own mid, and the delay there, [echoes] padded to whole blocks.
struct TrackColumns {
  std::vector<double> c0, c1, c2, c3, mid_s;
};

/// Numbers of one slot that all its tones share.
struct SlotScales {
  double carrier_hz, slope_hz_per_s;
  double cells_per_hz;   ///< grid frequencies by hertz, M/f_s
  double half_window_s;  ///< N/2 samples
  uint32_t grid;         ///< M
};

/// The tones of a block in one slot, but for what tells one virtual antenna from another.
struct BlockTones {
  float re[tone_block], im[tone_block];  ///< phase at the slot's middle
  int32_t cell[tone_block];              ///< grid frequency below the tone, in [0, M)
  float place[tone_block];               ///< from there to the next one, in [0, 1]
  float drift[tone_block];               ///< rad by cell that a virtual antenna's lead shifts the tone
  float bend[tone_block];                ///< rad, ToneKernel
  float bessel[ToneKernel::orders][tone_block];
  int32_t orders[tone_block];  ///< 0: the echo is summed otherwise, or is padding
};

/// The tones of one virtual antenna.
struct BlockTaps {
  int32_t start[tone_block];  ///< first tap's cell on the grid, in [0, M)
  int32_t segment[tone_block];
  float u[tone_block];  ///< place within the segment
  float re[tone_block], im[tone_block];
};

/// Of echoes [first, first + tone_block) at `time_s`, by their polynomials.
void block_delays(const TrackColumns& columns, size_t first, double time_s, BlockDelays& delays);

/// `mid_delay_s`: [tone_block], the delays with which the virtual antennas' phases were worked out.
void block_tones(const SlotScales& scales, const BlockDelays& delays, const double* mid_delay_s,
                 BlockTones& tones);

/// `shift`: cells, `phasor_re`, `phasor_im`: amplitude and phase of this virtual antenna, each [tone_block].
void block_taps(const SlotScales& scales, const BlockTones& tones, const float* shift, const float* phasor_re,
                const float* phasor_im, BlockTaps& taps);

/// Adds the first `count` tones, in their order, to each receiver's grid of M + 8 cells, re and im, `stride`
/// floats each, one receiver's after the other's: those of tone i begin at `grids` + offset[i]. taps:
/// [receivers].
void spread(const ToneKernel& kernel, const BlockTones& tones, const BlockTaps* taps, uint32_t receivers,
            const uint32_t* offset, uint32_t count, uint32_t stride, float* grids);

}  // namespace greatx::rf
