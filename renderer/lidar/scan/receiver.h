// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Models a LiDAR's receiver: the power of the light that comes back, the detection, and the error of the
// range. The code is plain arithmetic.
#pragma once

#include <cstdint>
#include <optional>

#include "core/vec.h"

namespace greatx::render {

/// Describes a receiver. Powers are relative to the transmitted one.
struct Receiver {
  double aperture_diameter_m = 0.025;
  double system_efficiency = 1.0;
  double extinction_per_m = 0.0;  ///< extinction of the air, one way

  /// Describes the noise of the electronics at the decision. A return of power P is detected if P /
  /// noise_equivalent_power + n > threshold, with n normal of variance 1. Its probability is therefore Phi(P
  /// / NEP - threshold).
  struct Detection {
    double noise_equivalent_power = 0.0;
    double threshold = 5.0;
  };
  std::optional<Detection> detection;  ///< none: every return is detected

  /// The noise of the range is normal with the variance range_std_m^2 + (rise_m * NEP / P)^2. The second term
  /// is the jitter of a leading edge of length rise_m in noise (M.-C. Amann et al., "Laser ranging: a
  /// critical review of usual techniques for distance measurement", Opt. Eng. 40 (2001), pp. 10-19: slope of
  /// the pulse against the noise). rise_m needs `detection`.
  double range_std_m = 0.0, rise_m = 0.0;

  /// The volume backscattering of fog and rain, 1/(m sr). It needs `detection`: without a threshold the air
  /// would answer every shot.
  double backscatter_per_m_sr = 0.0;

  bool noisy() const { return detection.has_value() || range_std_m > 0.0; }
};

/// Returns the share of light that passes the air there and back: exp(-2 alpha R), Beer and Lambert.
double air_transmittance(const Receiver& receiver, double range_m);

/// Returns the power by the range equation: P_r / P_t = intensity D^2 eta / (4 R^2) exp(-2 alpha R). A
/// surface of reflectance rho under the angle theta has the intensity rho cos(theta).
double received_power(const Receiver& receiver, double range_m, double intensity);

/// Returns the noise with which a surface of `reflectance`, seen along its normal through clear air at
/// `range_m`, is detected with `probability` in (0, 1). Data sheets rate a LiDAR in this way. Throws
/// ContractError if no noise gives that (the probability is too small for the threshold).
Receiver::Detection rated(const Receiver& receiver, double range_m, double reflectance, double probability,
                          double threshold);

/// The extinction over the backscattering of water drops that are large against the wavelength: 18.8 sr, E.
/// J. O'Connor, A. J. Illingworth, R. J. Hogan, "A technique for autocalibration of cloud lidar", J. Atmos.
/// Oceanic Technol. 21 (2004), pp. 777-786, at 905 nm, for droplets of 8 to 20 um across (the cloud's and a
/// dense fog's). It is also taken for rain and 1550 nm, where it is only an order of magnitude.
inline constexpr double lidar_ratio_sr = 18.8;

/// Return the standard normal distribution and its inverse, to the last bits.
double normal_cdf(double x);
double normal_quantile(double p);

/// Represents the random numbers of a sweep. They are functions of (seed, sensor, sequence, tick, shot,
/// purpose, index) only.
class ShotNoise {
 public:
  enum class Purpose : uint32_t { detection, range, air_detection, air_range };
  ShotNoise() = default;
  /// `stream` identifies the sensor.
  ShotNoise(uint64_t seed, uint32_t stream, uint32_t sequence, int64_t tick);
  double normal(uint32_t shot, Purpose purpose, uint32_t index) const;
  double uniform(uint32_t shot, Purpose purpose, uint32_t index) const;

 private:
  glm::uvec4 bits(uint32_t shot, Purpose purpose, uint32_t index) const;
  uvec2 key_{0u};
  uvec2 tick_{0u};
};

}  // namespace greatx::render
