// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes the measurements of a GNSS receiver: ranges to satellites with the errors of orbits, atmosphere,
// multipath and receiver, and the position that follows from them.
//
//   constellation -> directions -> what stands in the way (Sky) -> ranges with errors, strengths ->
//   weights -> least squares, checked by their residuals
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/geodesy.h"
#include "sim/navigation/constellation.h"
#include "sim/navigation/positioning.h"
#include "sim/navigation/random_process.h"

namespace greatx::navigation {

/// Holds the errors of ranges, standard deviations in metres. A value of 0 leaves its term out.
struct GnssErrors {
  /// Receiver noise of the code: at elevation e it is code * sqrt(1 + 1 / sin(e)^2) (RTKLIB 2.4.2 manual,
  /// eq. E.6.24, with a = b), and below 1 degree as at 1 degree.
  double code_m = 0.3;
  double doppler = 0.05;  ///< of range rates at the zenith, m/s; below it grows like the code's noise
  /// Factor on 0.13 m + 0.53 m exp(-e / 10 degrees), the multipath of satellites in view (RTCA DO-229D,
  /// appendix J.2.4); about 1 in the open, several in streets.
  double multipath = 1.0;
  double multipath_time_s = 30.0;
  double orbit_m = 0.8;  ///< orbits and clocks of the satellites (the signal in space)
  double orbit_time_s = 3600.0;
  /// Of the zenith delay that remains after the broadcast model, times IS-GPS-200's obliquity.
  double ionosphere_m = 1.0;
  double ionosphere_time_s = 1800.0;
  double troposphere_m = 0.12;  ///< of the zenith delay, times DO-229D's mapping
  double troposphere_time_s = 1800.0;
  bool operator==(const GnssErrors&) const = default;
};

/// Returns the obliquity of the ionosphere's thin shell: 1 + 16 (0.53 - E)^3, E in half turns (IS-GPS-200,
/// fig. 20-4).
double ionosphere_obliquity(double elevation);
/// Returns the mapping of the zenith delay of the troposphere: 1.001 / sqrt(0.002001 + sin(e)^2) (RTCA
/// DO-229D, appendix A.4.2.4).
double troposphere_mapping(double elevation);

/// Says what happens to the signal of a satellite on its way to the receiver.
struct SignalPath {
  enum class State : uint8_t {
    below = 0,      ///< below the mask of the receiver
    direct = 1,     ///< in view
    reflected = 2,  ///< hidden, but received by one reflection
    blocked = 3,    ///< hidden
  } state = State::direct;
  double excess_m = 0.0;     ///< of a reflected path over the direct one
  double excess_rate = 0.0;  ///< its derivative, m/s
  double loss_db = 0.0;      ///< of strength against the signal in view
};

/// Returns the loss in dB of a GPS signal (L1, right-hand circular) by a reflection at a wall of concrete, at
/// an angle of incidence with this cosine, for an antenna that receives the other sense of rotation 6 dB
/// weaker: Fresnel's coefficients for ITU-R P.2040-4's concrete (5.24, 0.0462 f^0.7822 S/m), and powers of
/// both senses added. From 14 dB at right angles to none at grazing incidence.
double reflection_loss_db(double cosine);
/// Returns the carrier-to-noise density of a satellite in view, dB-Hz: 37 + 8 sin(e), for an ordinary
/// receiver with a patch antenna (our setting; Kaplan and Hegarty's budget, 2nd ed., section 6.2, gives 38 to
/// 45).
double nominal_cn0(double elevation);
/// Returns the factor by which a receiver multiplies the standard deviation of a signal that is `deficit_db`
/// weaker than nominal: 10^(a D / 20) with D = deficit - 2 dB where that is positive, and a = 2 (F. K.
/// Brunner, H. Hartinger and L. Troyer, GPS signal diffraction modelling: the stochastic SIGMA-D model, J.
/// Geodesy 73 (1999), for the form and a; 2 dB is twice the deviation of a measured strength).
double weakness_factor(double deficit_db);

/// Returns the extra length of the path over one plane mirror, and its derivative: 2 d (n . s) for a mirror
/// at the distance d with the normal n towards the receiver, and a satellite in the direction s, n . s > 0
/// (P. D. Groves, Principles of GNSS, ..., 2nd ed., section 9.4.1; the method of images). The loss is
/// reflection_loss_db(n . s).
SignalPath reflected_path(const dvec3& to_satellite, const dvec3& normal, double distance_m,
                          const dvec3& velocity);

/// Answers what the receiver at its present place has in a direction.
using Sky = std::function<SignalPath(const dvec3& direction)>;

/// One epoch of one satellite.
struct SatelliteView {
  double azimuth = 0.0, elevation = 0.0;  ///< rad, azimuth from x (east) towards y (north)
  SignalPath path;
  double range_error_m = 0.0, rate_error = 0.0;  ///< NaN: not tracked
  double cn0 = 0.0;                              ///< measured, dB-Hz; NaN: not tracked
  bool used = false;                             ///< for the fix
};

/// What a receiver can say about the agreement of its ranges.
enum class Integrity : uint8_t {
  unknown = 0,   ///< no fix, too few satellites, or no check
  agree = 1,     ///< those that are used do
  disagree = 2,  ///< but not which are wrong: the covariance is widened
};

struct GnssEpoch {
  std::array<SatelliteView, satellite_count> satellites;
  uint32_t used = 0;  ///< satellites of the fix, or that were there for one
  Integrity integrity = Integrity::unknown;
  std::optional<PositionFix> fix;  ///< none: fewer than 4 satellites, or a PDOP beyond the limit
};

/// Holds the settings of a receiver besides its errors.
struct GnssReceiver {
  GnssErrors errors;
  double mask = 0.0872664625997165;  ///< least elevation of satellites, rad (5 degrees)
  double most_pdop = 25.0;           ///< there is no fix above it
  /// Weights follow the strength of signals, and ranges that disagree are excluded. Otherwise the receiver
  /// believes every signal.
  bool integrity = true;
  double false_alarm = 1e-3;  ///< probability of the check's alarm for an epoch without reflections
};

/// Simulates a receiver in one sequence. The random numbers depend on (seed, name, sequence).
class Gnss {
 public:
  Gnss(const GnssReceiver& receiver, const LocalFrame& frame, uint64_t seed, const std::string& name,
       uint32_t sequence, double step_s);
  /// Returns the epoch of `sample`. Position (m) and velocity are those of the antenna in the frame.
  GnssEpoch measure(double unix_s, const dvec3& position_m, const dvec3& velocity, const Sky& sky,
                    int64_t sample);

 private:
  /// The processes of one satellite, each of variance 1.
  struct Processes {
    GaussMarkov orbit, ionosphere, troposphere, multipath;
  };
  void disturb(SatelliteView& view, RangeMeasurement& measurement, size_t satellite, int64_t sample);
  void weigh(const SatelliteView& view, double speed, RangeMeasurement& measurement) const;
  void solve(GnssEpoch& epoch, std::span<const RangeMeasurement> measurements,
             std::span<const size_t> tracked) const;

  GnssReceiver receiver_;
  LocalFrame frame_;
  dmat3 local_from_earth_{1.0};
  NormalStream code_, doppler_, strength_;
  std::vector<Processes> processes_;  ///< [satellite_count]
};

}  // namespace greatx::navigation
