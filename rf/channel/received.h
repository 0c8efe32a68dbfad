// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Converts amplitudes to the quantities that instruments show: volts, volts per metre, watts. Fields and
// voltages are rms phasors about e^{+j omega t}; the peak value is sqrt(2) times the rms value.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/units.h"
#include "rf/antenna/field_vector.h"
#include "rf/channel/frequency_response.h"
#include "rf/geometry/path.h"

namespace greatx::rf {

/// Wave impedance of vacuum, 1/(epsilon_0 c) = 376.730 ohm.
inline constexpr double vacuum_impedance_ohm = 1.0 / (vacuum_permittivity * speed_of_light);

/// Describes a link in which one port sends and one port receives.
struct RadioLink {
  double carrier_hz = 3.5e9;
  /// Power into the transmitting port, not negative. The port radiates all of it except the loss of its
  /// pattern.
  double transmit_power_w = 1.0;
  double resistance_ohm = 50.0;  ///< R, real part of the receiving port's impedance; above 0
  uint32_t transmit_port = 0, receive_port = 0;
};

/// Holds the received quantities of one path.
struct ReceivedPath {
  /// a, as in ImpulseResponse, in fp64: a = (lambda/4 pi) C_R^H T C_T e^{-j 2 pi f_c tau}.
  Complex amplitude{0.0};
  /// E = sqrt(eta_0 P_t/4 pi) T C_T e^{-j 2 pi f_c tau}, V/m rms along theta-hat and phi-hat (world axes) of
  /// the direction of arrival, which points back along the path. For a line of sight |E| = sqrt(eta_0 P_t
  /// G_t/4 pi)/d, which Rec. ITU-R P.525-4, eq. 1 rounds to sqrt(30 P_t G_t)/d (0.003 dB more). This is the
  /// field in the air, before the receiving antenna; only the position of the receiving port enters.
  Jones field_v_per_m;
  /// Power at a matched load: P_r = P_t |a|^2 (Friis; Balanis, "Antenna Theory", 4th ed., eq. 2-118).
  double power_w = 0.0;
  /// V_oc = sqrt(4 R P_t) a, V rms: the Thevenin voltage whose available power |V_oc|^2/4R is P_r (in peak
  /// values sqrt(8 R P_r), Balanis, 2.13). Up to a constant phase of the antenna V_oc is h^H E, with the
  /// vector effective length h = lambda sqrt(R/(pi eta_0)) C_R (Balanis, 2.15; lambda/pi for a half-wave
  /// dipole, whose R is 73.08 ohm).
  Complex open_circuit_v{0.0};
};

/// Holds the received quantities of a link's paths and their sums.
struct Received {
  std::vector<ReceivedPath> paths;  ///< in the order of the paths
  /// The sums add the phasors at the carrier: they hold at this very place. power_w is P_t |sum a|^2.
  Complex amplitude{0.0};
  FieldVector field_v_per_m;  ///< along world axes, because paths arrive from all directions
  double power_w = 0.0;
  Complex open_circuit_v{0.0};
  /// Sum of the paths' powers: the mean power over a neighbourhood of several wavelengths.
  double mean_power_w = 0.0;
};

/// Computes the received quantities. Sums are in summing_order(): any order of the paths gives the same bits.
/// Thread-safe.
Received received(std::span<const Path> paths, const ArrayPose& transmitter, const ArrayPose& receiver,
                  const RadioLink& link);

/// Sets out[paths, tx_ant, 2] to the field of every path and transmit port before the receiver, V/m rms on
/// theta-hat and phi-hat of the arrival, with the phase at the receiver's origin. `power_w` goes into each
/// port. Thread-safe.
void arriving_fields(std::span<const Path> paths, const ArrayPose& transmitter, double carrier_hz,
                     double power_w, std::span<std::complex<float>> out);

/// Returns 10 log10(P / 1 mW); -inf for 0.
double dbm(double power_w);
double watts(double dbm);

}  // namespace greatx::rf
