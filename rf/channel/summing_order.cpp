// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/channel/summing_order.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace greatx::rf {
namespace {

/// Returns all properties of a path that enter a sum.
std::array<double, 16> sum_key(const Path& path) {
  std::array<double, 16> key{path.delay_s,     path.doppler_hz, path.departure.x, path.departure.y,
                             path.departure.z, path.arrival.x,  path.arrival.y,   path.arrival.z};
  for (size_t i = 0; i < 4; ++i) {
    key[8 + 2 * i] = path.transfer[i].real();
    key[9 + 2 * i] = path.transfer[i].imag();
  }
  return key;
}

bool spectrum_less(const TransferSpectrum& a, const TransferSpectrum& b) {
  const auto parts = [](const std::array<Complex, 4>& t) {
    return std::array<double, 8>{t[0].real(), t[0].imag(), t[1].real(), t[1].imag(),
                                 t[2].real(), t[2].imag(), t[3].real(), t[3].imag()};
  };
  return std::lexicographical_compare(
      a.begin(), a.end(), b.begin(), b.end(),
      [&](const auto& left, const auto& right) { return parts(left) < parts(right); });
}

}  // namespace

std::vector<uint32_t> summing_order(std::span<const Path> paths, std::span<const TransferSpectrum> spectra) {
  std::vector<uint32_t> order(paths.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    if (paths[a].delay_s != paths[b].delay_s) return paths[a].delay_s < paths[b].delay_s;
    const auto key_a = sum_key(paths[a]), key_b = sum_key(paths[b]);
    if (key_a != key_b || spectra.empty()) return key_a < key_b;
    return spectrum_less(spectra[a], spectra[b]);
  });
  return order;
}

}  // namespace greatx::rf
