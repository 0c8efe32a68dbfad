// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes paths and arrays, by hand or at random, for tests of the results that are computed from paths.
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

/// Returns e^{-j 2 pi f tau} with a mantissa of 64 bits. A rounded product f tau close to 2^23 turns would
/// only resolve 2^-41 turns; so the function splits the product and removes the whole turns first.
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

/// Returns a path along +x with the transfer matrix T = amplitude * I. The departure is +x; the arrival is -x
/// because it points back along the path.
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

/// Permutes the values at random.
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
