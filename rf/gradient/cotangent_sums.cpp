// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/gradient/cotangent_sums.h"

#include <algorithm>

#include "core/phase.h"

namespace greatx::rf {
namespace {

struct PairOfDoubles {
  using Vec [[gnu::vector_size(16)]] = double;
  using Stored [[gnu::vector_size(16), gnu::aligned(8), gnu::may_alias]] = double;
};
#if defined(__x86_64__)
struct QuadOfDoubles {
  using Vec [[gnu::vector_size(32)]] = double;
  using Stored [[gnu::vector_size(32), gnu::aligned(8), gnu::may_alias]] = double;
};
#endif

double sum_of_lanes(const double* lanes) {
  double total = 0.0;
  for (size_t lane = 0; lane < sum_lanes; ++lane) total += lanes[lane];
  return total;
}

template <typename Width>
[[gnu::always_inline]] inline CotangentSums sum_blocks(const double* cotangent, const double* phasors,
                                                       const double* frequencies, size_t blocks) {
  using Vec = typename Width::Vec;
  using Stored = typename Width::Stored;
  constexpr size_t parts = sum_lanes * sizeof(double) / sizeof(Vec);
  double lanes[4][sum_lanes] = {};
  // One part of the lanes after the other, so that its four sums stay in registers over all blocks.
  for (size_t part = 0; part < parts; ++part) {
    Vec re{}, im{}, re_f{}, im_f{};
    for (size_t block = 0; block < blocks; ++block) {
      const Stored* const g = reinterpret_cast<const Stored*>(cotangent + block * 2 * sum_lanes) + part;
      const Stored* const p = reinterpret_cast<const Stored*>(phasors + block * 2 * sum_lanes) + part;
      const Vec f = reinterpret_cast<const Stored*>(frequencies + block * sum_lanes)[part];
      const Vec product_re = g[0] * p[0] + g[parts] * p[parts];
      const Vec product_im = g[0] * p[parts] - g[parts] * p[0];
      re += product_re;
      im += product_im;
      re_f += f * product_re;
      im_f += f * product_im;
    }
    const auto keep = [&](size_t which, const Vec& value) {
      reinterpret_cast<Stored*>(lanes[which])[part] = value;
    };
    keep(0, re), keep(1, im), keep(2, re_f), keep(3, im_f);
  }
  return {{sum_of_lanes(lanes[0]), sum_of_lanes(lanes[1])}, {sum_of_lanes(lanes[2]), sum_of_lanes(lanes[3])}};
}

#if defined(__x86_64__)
[[gnu::target("avx2")]] CotangentSums sum_blocks_with_avx2(const double* cotangent, const double* phasors,
                                                           const double* frequencies, size_t blocks) {
  return sum_blocks<QuadOfDoubles>(cotangent, phasors, frequencies, blocks);
}
#endif

}  // namespace

void set_path_phasors(const ChannelGrid& grid, double delay_s, BlockedRow& phasors) {
  static_assert(sum_lanes == 8);
  constexpr size_t blocks_between = 8;  // those whose turns are reduced
  Complex places[sum_lanes] = {1.0, unit_phasor(-turns_of(grid.subcarrier_spacing_hz, delay_s))};
  for (size_t power = 2; power < sum_lanes; power *= 2) {
    places[power] = plain_product(places[power / 2], places[power / 2]);
    for (size_t i = 1; i < power; ++i) places[power + i] = plain_product(places[power], places[i]);
  }
  const Complex step = unit_phasor(-turns_of(sum_lanes, grid.subcarrier_spacing_hz, delay_s));
  Complex start;
  for (size_t block = 0; block < phasors.blocks(); ++block) {
    const auto first = static_cast<uint32_t>(block * sum_lanes);
    start = block % blocks_between == 0
                ? unit_phasor(-turns_of(grid.subcarrier_number(first), grid.subcarrier_spacing_hz, delay_s))
                : plain_product(start, step);
    const size_t count = std::min<size_t>(sum_lanes, grid.subcarriers - first);
    double* const to = phasors.block(block);
    for (size_t lane = 0; lane < count; ++lane) {
      const Complex phasor = plain_product(start, places[lane]);
      to[lane] = phasor.real();
      to[sum_lanes + lane] = phasor.imag();
    }
  }
}

CotangentSums cotangent_sums_generic(const double* cotangent, const double* phasors,
                                     const double* frequencies, size_t blocks) {
  return sum_blocks<PairOfDoubles>(cotangent, phasors, frequencies, blocks);
}

CotangentSum cotangent_sums_avx2() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") ? sum_blocks_with_avx2 : nullptr;
#else
  return nullptr;
#endif
}

CotangentSum cotangent_sums() {
  static const CotangentSum best = cotangent_sums_avx2() ? cotangent_sums_avx2() : cotangent_sums_generic;
  return best;
}

std::vector<double> offsets_hz(const ChannelGrid& grid) {
  std::vector<double> offsets((grid.subcarriers + sum_lanes - 1) / sum_lanes * sum_lanes);
  for (uint32_t k = 0; k < grid.subcarriers; ++k)
    offsets[k] = grid.subcarrier_number(k) * grid.subcarrier_spacing_hz;
  return offsets;
}

}  // namespace greatx::rf
