// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/channel/row_sums.h"

namespace greatx::rf {
namespace {

/// Vectors of doubles with the width of the processor's registers: `Vec` in registers, `Stored` in memory,
/// aligned like a double. The operators round each lane as they round a double.
struct TwoDoubles {
  using Vec [[gnu::vector_size(16)]] = double;
  using Stored [[gnu::vector_size(16), gnu::aligned(8), gnu::may_alias]] = double;
};
#if defined(__x86_64__)
struct FourDoubles {
  using Vec [[gnu::vector_size(32)]] = double;
  using Stored [[gnu::vector_size(32), gnu::aligned(8), gnu::may_alias]] = double;
};
#endif

/// Adds all terms to a block of `rows_at_once` rows. The sums of these rows stay in registers over all terms.
template <typename Width, size_t rows_at_once>
[[gnu::always_inline]] inline void add_some_rows(const std::complex<double>* amplitudes, size_t stride,
                                                 const double* phasors, size_t terms, double* sums) {
  using Vec = typename Width::Vec;
  using Stored = typename Width::Stored;
  constexpr size_t parts = sum_lanes * sizeof(double) / sizeof(Vec);
  Vec re[rows_at_once][parts], im[rows_at_once][parts];
  Stored* const out = reinterpret_cast<Stored*>(sums);
#pragma GCC unroll 8
  for (size_t row = 0; row < rows_at_once; ++row)
#pragma GCC unroll 8
    for (size_t part = 0; part < parts; ++part) {
      re[row][part] = out[row * 2 * parts + part];
      im[row][part] = out[row * 2 * parts + parts + part];
    }
  for (size_t term = 0; term < terms; ++term) {
    const Stored* const p = reinterpret_cast<const Stored*>(phasors + term * 2 * sum_lanes);
#pragma GCC unroll 8
    for (size_t row = 0; row < rows_at_once; ++row) {
      const double a = amplitudes[row * stride + term].real(), b = amplitudes[row * stride + term].imag();
#pragma GCC unroll 8
      for (size_t part = 0; part < parts; ++part) {
        re[row][part] += a * p[part] - b * p[parts + part];
        im[row][part] += a * p[parts + part] + b * p[part];
      }
    }
  }
#pragma GCC unroll 8
  for (size_t row = 0; row < rows_at_once; ++row)
#pragma GCC unroll 8
    for (size_t part = 0; part < parts; ++part) {
      out[row * 2 * parts + part] = re[row][part];
      out[row * 2 * parts + parts + part] = im[row][part];
    }
}

template <typename Width, size_t rows_at_once>
[[gnu::always_inline]] inline void add_all_rows(const std::complex<double>* amplitudes, size_t stride,
                                                size_t rows, const double* phasors, size_t terms,
                                                double* sums) {
  size_t row = 0;
  for (; row + rows_at_once <= rows; row += rows_at_once)
    add_some_rows<Width, rows_at_once>(amplitudes + row * stride, stride, phasors, terms,
                                       sums + row * 2 * sum_lanes);
  for (; row < rows; ++row)
    add_some_rows<Width, 1>(amplitudes + row * stride, stride, phasors, terms, sums + row * 2 * sum_lanes);
}

template <typename Width>
[[gnu::always_inline]] inline void set_all_products(const std::complex<double>* firsts, size_t blocks,
                                                    const std::complex<double>* places, double* out,
                                                    size_t stride) {
  using Vec = typename Width::Vec;
  using Stored = typename Width::Stored;
  constexpr size_t parts = sum_lanes * sizeof(double) / sizeof(Vec);
  double parts_of_places[2 * sum_lanes];
  for (size_t lane = 0; lane < sum_lanes; ++lane)
    parts_of_places[lane] = places[lane].real(), parts_of_places[sum_lanes + lane] = places[lane].imag();
  const Stored* const p = reinterpret_cast<const Stored*>(parts_of_places);
  for (size_t block = 0; block < blocks; ++block) {
    const double a = firsts[block].real(), b = firsts[block].imag();
    Stored* const to = reinterpret_cast<Stored*>(out + block * stride);
#pragma GCC unroll 8
    for (size_t part = 0; part < parts; ++part) {
      to[part] = a * p[part] - b * p[parts + part];
      to[parts + part] = a * p[parts + part] + b * p[part];
    }
  }
}

#if defined(__x86_64__)
[[gnu::target("avx2")]] void set_products_with_avx2(const std::complex<double>* firsts, size_t blocks,
                                                    const std::complex<double>* places, double* out,
                                                    size_t stride) {
  set_all_products<FourDoubles>(firsts, blocks, places, out, stride);
}

[[gnu::target("avx2")]] void add_rows_with_avx2(const std::complex<double>* amplitudes, size_t stride,
                                                size_t rows, const double* phasors, size_t terms,
                                                double* sums) {
  add_all_rows<FourDoubles, 2>(amplitudes, stride, rows, phasors, terms, sums);
}
#endif

}  // namespace

void add_rows_generic(const std::complex<double>* amplitudes, size_t stride, size_t rows,
                      const double* phasors, size_t terms, double* sums) {
  add_all_rows<TwoDoubles, 1>(amplitudes, stride, rows, phasors, terms, sums);
}

AddRows add_rows_avx2() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") ? add_rows_with_avx2 : nullptr;
#else
  return nullptr;
#endif
}

AddRows add_rows() {
  static const AddRows best = add_rows_avx2() ? add_rows_avx2() : add_rows_generic;
  return best;
}

void set_products_generic(const std::complex<double>* firsts, size_t blocks,
                          const std::complex<double>* places, double* out, size_t stride) {
  set_all_products<TwoDoubles>(firsts, blocks, places, out, stride);
}

SetProducts set_products_avx2() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") ? set_products_with_avx2 : nullptr;
#else
  return nullptr;
#endif
}

SetProducts set_products() {
  static const SetProducts best = set_products_avx2() ? set_products_avx2() : set_products_generic;
  return best;
}

}  // namespace greatx::rf
