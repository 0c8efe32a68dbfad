// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What a path contributes at each pair of ports: the factor that responses, taps, powers and received
// quantities share.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rf/channel/frequency_response.h"
#include "rf/geometry/path.h"

namespace greatx::rf {

/// Contracts of everything that sums paths: a carrier above 0 Hz, arrays with ports, finite paths.
void check_link(std::span<const Path> paths, const ArrayPose& transmitter, const ArrayPose& receiver,
                double carrier_hz);

/// lambda/4 pi, metres.
double wavelength_factor(double carrier_hz);

/// An array's ports, worked out once: where the elements are and which way the polarizations point.
class Ports {
 public:
  Ports(const ArrayPose& end, double carrier_hz);
  uint32_t count() const { return count_; }
  /// The field that each port radiates in a world direction, times the plane wave's phase there: out[ports].
  /// It is also what the port takes up from there, out^T E, with E the field on theta-hat and phi-hat of the
  /// direction that the wave comes from (reciprocity): C_R^H E with C_R the conjugate of the radiated
  /// pattern.
  void respond(const dvec3& direction, std::vector<Jones>& out) const;
  /// The same of each polarization, without the phases: out[polarizations].
  void fields(const dvec3& direction, std::vector<Jones>& out) const;
  /// e^{j 2 pi direction . d/lambda} of a port at d.
  Complex phase(const dvec3& direction, uint32_t port) const;

 private:
  TurnedElement element_;
  uint32_t count_;
  std::vector<dvec3> positions_;  ///< [elements], carrier wavelengths, local axes
};

/// (lambda/4 pi) C_R^H T C_T with the array phases, for all pairs of ports of one path: out[rx * tx_count +
/// tx].
class PairAmplitudes {
 public:
  PairAmplitudes(const ArrayPose& transmitter, const ArrayPose& receiver, double carrier_hz);
  size_t pairs() const { return size_t{tx_.count()} * rx_.count(); }
  void operator()(const Path& path, Complex* out) { (*this)(path, path.transfer, out); }
  /// With t, [4], in place of the path's own transfer.
  void operator()(const Path& path, const Complex* t, Complex* out);
  /// Mean over all pairs of |out|^2. All elements of an array have the same patterns, so it is that of one
  /// element at each end: the array phases have modulus 1.
  double mean_power(const Path& path);

 private:
  Ports tx_, rx_;
  double scale_;
  std::vector<Jones> tx_response_, rx_response_;
};

}  // namespace greatx::rf
