// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Paths and arrays written down by hand or drawn by lot, for tests of what is made from paths.
#pragma once

#include <cmath>
#include <complex>
#include <cstdint>
#include <vector>

#include "core/phase.h"
#include "core/random.h"
#include "core/units.h"
#include "rf/channel/frequency_response.h"

namespace greatx::rf::testing {

using Wide = std::complex<long double>;
inline constexpr long double wide_pi = 3.14159265358979323846264338327950288L;

/// e^{-j 2 pi f tau} with 64 bits of mantissa and the whole turns taken off exactly enough: f tau < 2^23
/// turns leaves 2^-41 turns of it, so the product is split first.
inline Wide wide_phasor(double frequency_hz, double delay_s) {
  const ExactProduct product = exact_product(frequency_hz, delay_s);
  const long double whole = std::nearbyint(product.value);
  const long double turns = (static_cast<long double>(product.value) - whole) + product.error;
  return std::polar(1.0L, -2.0L * wide_pi * turns);
}

inline std::vector<Path> random_paths(size_t count, double longest_s, uint32_t stream) {
  RandomStream random(20, stream);
  const auto direction = [&] {
    return glm::normalize(dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
  };
  std::vector<Path> paths(count);
  for (Path& path : paths) {
    path.delay_s = random.uniform(0.0, longest_s);
    path.length_m = path.delay_s * speed_of_light;
    path.doppler_hz = random.uniform(-400, 400);
    path.departure = direction();
    path.arrival = direction();
    for (Complex& value : path.transfer) value = {random.uniform(-1, 1), random.uniform(-1, 1)};
  }
  return paths;
}

/// A path along +x (departure +x, arrival -x for the direction of arrival that points back) with T =
/// amplitude * I.
inline Path plain_path(double delay_s, Complex amplitude = 1.0, bool line_of_sight = true) {
  Path path;
  path.delay_s = delay_s;
  path.length_m = delay_s * speed_of_light;
  path.departure = {1.0, 0.0, 0.0};
  path.arrival = {-1.0, 0.0, 0.0};
  path.transfer[0] = path.transfer[3] = amplitude;
  if (!line_of_sight) path.interactions.push_back({});
  return path;
}

inline dvec3 direction_at(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// Every path into a place drawn by lot.
template <typename Value>
void shuffle(std::vector<Value>& values, uint32_t stream) {
  RandomStream random(43, stream);
  for (size_t i = values.size() - 1; i > 0; --i)
    std::swap(values[i], values[random.below(static_cast<uint32_t>(i + 1))]);
}

inline ArrayPose antenna(Pattern pattern = Pattern::isotropic, Polarization polarization = Polarization::v) {
  ArrayPose end;
  end.array.pattern = pattern;
  end.array.polarization = polarization;
  return end;
}

}  // namespace greatx::rf::testing
