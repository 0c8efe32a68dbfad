// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the errors of three orthogonal axes of a sensor: of accelerometers, gyroscopes, magnetometers.
//
//   truth -> (I + M) truth + bias + noise -> limited to +-range -> rounded to the resolution
//
// The terms are those of IEEE Std 952-1997, annex C, and of N. El-Sheimy, H. Hou, X. Niu, "Analysis and
// Modeling of Inertial Sensors Using Allan Variance", IEEE Trans. Instrum. Meas. 57 (2008), 140-149.
#pragma once

#include <string>
#include <vector>

#include "sim/navigation/random_process.h"

namespace greatx::navigation {

/// Holds the errors of a triad. `unit` is m/s^2 for accelerometers, rad/s for gyroscopes, T for
/// magnetometers. A value of 0 leaves its term out.
struct TriadErrors {
  double noise_density = 0.0;     ///< white noise N, unit/sqrt(Hz): angle or velocity random walk
  double bias_std = 0.0;          ///< constant bias of a sequence, unit; drawn for each axis
  double bias_instability = 0.0;  ///< the least Allan deviation of the bias's Gauss-Markov process, unit
  double bias_time_s = 100.0;     ///< correlation time of that process
  double bias_walk = 0.0;         ///< rate random walk K, unit/s/sqrt(Hz)
  double scale_std = 0.0;         ///< scale factor error, 1; drawn for each axis
  double misalignment_std = 0.0;  ///< rad; drawn for each of the six elements beside the diagonal
  double resolution = 0.0;        ///< quantum of the output, unit
  double range = 0.0;             ///< the output is within +-range, unit; 0: it has no limit
  bool operator==(const TriadErrors&) const = default;
};

/// The greatest Allan deviation of a first-order Gauss-Markov process of standard deviation 1. It is that of
/// averages over 1.893 correlation times (IEEE Std 952-1997, annex C).
inline constexpr double most_gauss_markov_allan = 0.617364;

/// One measurement.
struct TriadSample {
  dvec3 measured{0.0};
  dvec3 bias{0.0};  ///< the sum of the constant, the Gauss-Markov and the random-walk part
};

/// Measures with the errors of one triad in one sequence.
class Triad {
 public:
  /// The random numbers depend on (seed, name, sequence). Samples are `step_s` apart; white noise has the
  /// bandwidth of the samples, so that its standard deviation is noise_density / sqrt(step_s).
  Triad(const TriadErrors& errors, uint64_t seed, const std::string& name, uint32_t sequence, double step_s);
  /// Returns sample `sample`, which depends on the arguments and the constructor's alone.
  TriadSample measure(const dvec3& truth, int64_t sample);
  /// Returns I + M: scale factors on the diagonal, misalignments beside it.
  const dmat3& scale() const { return scale_; }

 private:
  TriadErrors errors_;
  dmat3 scale_{1.0};
  dvec3 constant_{0.0};
  double noise_ = 0.0;
  NormalStream white_;
  std::vector<GaussMarkov> drift_;  ///< [3]
  std::vector<RandomWalk> walk_;    ///< [3]
};

}  // namespace greatx::navigation
