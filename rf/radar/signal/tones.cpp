// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/signal/tones.h"

#include "core/units.h"
#include "rf/radar/signal/lanes.h"

namespace greatx::rf {

GREATX_LANES void block_delays(const TrackColumns& columns, size_t first, double time_s,
                               BlockDelays& delays) {
  const double *c0 = columns.c0.data() + first, *c1 = columns.c1.data() + first,
               *c2 = columns.c2.data() + first, *c3 = columns.c3.data() + first,
               *mid = columns.mid_s.data() + first;
  for (uint32_t i = 0; i < tone_block; ++i) {
    const double d = time_s - mid[i];
    delays.delay_s[i] = c0[i] + d * (c1[i] + d * (c2[i] + d * c3[i]));
    delays.rate[i] = c1[i] + d * (2.0 * c2[i] + d * 3.0 * c3[i]);
    delays.curvature_per_s[i] = 2.0 * c2[i] + d * 6.0 * c3[i];
  }
}

GREATX_LANES void block_tones(const SlotScales& scales, const BlockDelays& delays, const double* mid_delay_s,
                              BlockTones& tones) {
  const double f = scales.carrier_hz, s = scales.slope_hz_per_s, half = scales.half_window_s;
  const double sweeps = scales.sweeps, square = scales.square;
  const double grid = scales.grid, by_grid = 1.0 / grid, cells_per_hz = scales.cells_per_hz;
  double turns[tone_block], cells[tone_block];
  for (uint32_t i = 0; i < tone_block; ++i) {
    // f_c tau + S tau u - square S tau^2/2 with tau = tau_0 + rate u + curvature u^2/2, by powers of u.
    const double tau = delays.delay_s[i], rate = delays.rate[i], curvature = delays.curvature_per_s[i];
    const double bend = half * half * sweeps *
                        (0.5 * f * curvature + s * rate - 0.5 * s * square * (rate * rate + tau * curvature));
    const double at_middle = (f - 0.5 * s * square * tau) * tau + 0.5 * bend;
    turns[i] = at_middle - nearest(at_middle);
    const double tone = (f * rate * sweeps + s * tau * (1.0 - square * rate)) * cells_per_hz;
    cells[i] = tone - grid * nearest(tone * by_grid);  // [-M/2, M/2]
    tones.bend[i] = static_cast<float>(2.0 * pi * bend);
    tones.drift[i] = static_cast<float>(-2.0 * pi / cells_per_hz * square * (tau - mid_delay_s[i]));
  }
  for (uint32_t i = 0; i < tone_block; ++i) {
    // Truncation of a value above 0 gives the grid frequency below.
    const int32_t below = static_cast<int32_t>(cells[i] + grid) - static_cast<int32_t>(scales.grid);
    tones.place[i] = static_cast<float>(cells[i] - below);
    tones.cell[i] = below + (static_cast<int32_t>(scales.grid) & (below >> 31));
  }
  for (uint32_t i = 0; i < tone_block; ++i)
    cos_sin_of_turns(static_cast<float>(turns[i]), tones.re[i], tones.im[i]);
  for (uint32_t i = 0; i < tone_block; ++i) {
    const auto bessel = ToneKernel::bessel(tones.bend[i]);
    for (int k = 0; k < ToneKernel::orders; ++k) tones.bessel[k][i] = bessel[k];
    tones.orders[i] = ToneKernel::orders_for(tones.bend[i]);
  }
}

GREATX_LANES void block_taps(const SlotScales& scales, const BlockTones& tones, const float* shift,
                             const float* phasor_re, const float* phasor_im, BlockTaps& taps) {
  const int32_t grid = static_cast<int32_t>(scales.grid);
  for (uint32_t i = 0; i < tone_block; ++i) {
    const float place = tones.place[i] + shift[i];
    const int32_t below = static_cast<int32_t>(place + 1024.0f) - 1024;
    const float u = (place - static_cast<float>(below)) * ToneKernel::segments;
    const int32_t segment = static_cast<int32_t>(u);
    const int32_t last = segment - (segment >> 6);  // the value 64, due to rounding, is the end of segment 63
    taps.segment[i] = last;
    taps.u[i] = u - static_cast<float>(last);
    int32_t start = tones.cell[i] + below + ToneKernel::first_tap;
    start += grid & (start >> 31);
    start -= grid & ~((start - grid) >> 31);
    taps.start[i] = start;
  }
  for (uint32_t i = 0; i < tone_block; ++i) {
    const float re = tones.re[i] * phasor_re[i] - tones.im[i] * phasor_im[i];
    const float im = tones.re[i] * phasor_im[i] + tones.im[i] * phasor_re[i];
    const float turn = tones.drift[i] * shift[i];
    taps.re[i] = re - turn * im;
    taps.im[i] = im + turn * re;
  }
}

namespace {

using Taps [[gnu::vector_size(32)]] = float;
using Stored [[gnu::vector_size(32), gnu::aligned(4), gnu::may_alias]] = float;
static_assert(ToneKernel::taps * sizeof(float) == sizeof(Taps));

}  // namespace

/// The taps of kernel k at `u`, from the row `rows` of its table, times its Bessel factor.
#define GREATX_TAPS(k)                                                           \
  (((*reinterpret_cast<const Stored*>(tables[k] + rows) * u +                    \
     *reinterpret_cast<const Stored*>(tables[k] + rows + ToneKernel::taps)) *    \
        u +                                                                      \
    *reinterpret_cast<const Stored*>(tables[k] + rows + 2 * ToneKernel::taps)) * \
   bessel[k])

GREATX_LANES void spread(const ToneKernel& kernel, const BlockTones& tones, const BlockTaps* taps,
                         uint32_t receivers, const uint32_t* offset, uint32_t count, uint32_t stride,
                         float* grids) {
  constexpr int row = 3 * ToneKernel::taps;
  const float* const tables[ToneKernel::orders] = {kernel.table(0), kernel.table(1), kernel.table(2),
                                                   kernel.table(3)};
  for (uint32_t i = 0; i < count; ++i) {
    const int32_t orders = tones.orders[i];
    if (orders == 0) continue;
    // As far as the compiler knows, the stores below might change these numbers: they are read before.
    const float bessel[ToneKernel::orders] = {tones.bessel[0][i], tones.bessel[1][i], tones.bessel[2][i],
                                              tones.bessel[3][i]};
    float* grid = grids + offset[i];
    // The receivers are in the inner loop, because successive tones have similar delays and add to the same
    // cells: each addition would wait for the previous store.
    for (const BlockTaps *at = taps, *const end = taps + receivers; at != end; ++at, grid += 2 * stride) {
      const float u = at->u[i], re = at->re[i], im = at->im[i];
      const int32_t rows = at->segment[i] * row;
      float* const out = grid + at->start[i];
      Stored& out_re = *reinterpret_cast<Stored*>(out);
      Stored& out_im = *reinterpret_cast<Stored*>(out + stride);
      Taps real = GREATX_TAPS(0);
      if (orders == 1) {
        out_re += real * re;
        out_im += real * im;
        continue;
      }
      Taps imaginary = GREATX_TAPS(1);
      if (orders > 2) [[unlikely]] {
        real -= GREATX_TAPS(2);
        if (orders > 3) imaginary -= GREATX_TAPS(3);
      }
      out_re += real * re - imaginary * im;
      out_im += real * im + imaginary * re;
    }
  }
}

#undef GREATX_TAPS

}  // namespace greatx::rf
