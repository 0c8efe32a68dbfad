// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What a LiDAR's receiver makes of the light that comes back: power, what is detected and how exactly. Numbers alone.
#pragma once

#include <cstdint>
#include <optional>

#include "core/vec.h"

namespace greatx::render {

/// Powers are relative to that transmitted.
struct Receiver {
  double aperture_diameter_m = 0.025;
  double system_efficiency = 1.0;
  double extinction_per_m = 0.0;  ///< of the air, one way

  /// Noise of the electronics at the decision: a return of power P is detected if P / noise_equivalent_power + n >
  /// threshold, n normal with variance 1; so with probability Phi(P / NEP - threshold).
  struct Detection {
    double noise_equivalent_power = 0.0;
    double threshold = 5.0;
  };
  std::optional<Detection> detection;  ///< none: everything is

  /// Of the range, normal: variance range_std_m^2 + (rise_m * NEP / P)^2, the jitter of a leading edge of length rise_m
  /// in noise (M.-C. Amann et al., "Laser ranging: a critical review of usual techniques for distance measurement", Opt.
  /// Eng. 40 (2001), pp. 10-19: slope of the pulse against the noise). rise_m needs `detection`.
  double range_std_m = 0.0, rise_m = 0.0;

  /// Volume backscattering of fog and rain, 1/(m sr). Needs `detection`: without a threshold the air would answer
  /// every shot.
  double backscatter_per_m_sr = 0.0;

  bool noisy() const { return detection.has_value() || range_std_m > 0.0; }
};

/// What the air leaves of the light there and back: exp(-2 alpha R), Beer and Lambert.
double air_transmittance(const Receiver& receiver, double range_m);

/// The range equation: P_r / P_t = intensity D^2 eta / (4 R^2) exp(-2 alpha R), for a surface of reflectance rho under
/// the angle theta with the intensity rho cos(theta).
double received_power(const Receiver& receiver, double range_m, double intensity);

/// The noise with which a surface of `reflectance`, seen along its normal through clear air at `range_m`, is detected with
/// `probability` in (0, 1): how data sheets rate a LiDAR. Throws ContractError if no noise gives that (probability
/// too small for the threshold).
Receiver::Detection rated(const Receiver& receiver, double range_m, double reflectance, double probability,
                          double threshold);

/// Extinction over backscattering of water drops large against the wavelength: 18.8 sr, E. J. O'Connor, A. J.
/// Illingworth, R. J. Hogan, "A technique for autocalibration of cloud lidar", J. Atmos. Oceanic Technol. 21 (2004), pp.
/// 777-786, at 905 nm, for droplets of 8 to 20 um across (the cloud's and a dense fog's); taken for rain and 1550 nm as
/// well, where it is an order of magnitude.
inline constexpr double lidar_ratio_sr = 18.8;

/// Standard normal distribution and its inverse, to the last bits.
double normal_cdf(double x);
double normal_quantile(double p);

/// Random numbers of a sweep: functions of (seed, sensor, sequence, tick, shot, purpose, index) alone.
class ShotNoise {
 public:
  enum class Purpose : uint32_t { detection, range, air_detection, air_range };
  ShotNoise() = default;
  /// `stream`: of the sensor.
  ShotNoise(uint64_t seed, uint32_t stream, uint32_t sequence, int64_t tick);
  double normal(uint32_t shot, Purpose purpose, uint32_t index) const;
  double uniform(uint32_t shot, Purpose purpose, uint32_t index) const;

 private:
  glm::uvec4 bits(uint32_t shot, Purpose purpose, uint32_t index) const;
  uvec2 key_{0u};
  uvec2 tick_{0u};
};

}  // namespace greatx::render
