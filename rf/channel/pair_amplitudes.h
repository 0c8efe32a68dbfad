// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the amplitude of a path at each pair of ports. Responses, taps, powers and received quantities
// share this factor.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rf/channel/frequency_response.h"
#include "rf/channel/wavefront.h"
#include "rf/geometry/path.h"

namespace greatx::rf {

/// Checks the contracts of all sums over paths: a carrier above 0 Hz, arrays with ports, finite paths.
void check_link(std::span<const Path> paths, const ArrayPose& transmitter, const ArrayPose& receiver,
                double carrier_hz);

/// Returns lambda/4 pi, metres.
double wavelength_factor(double carrier_hz);

/// Holds the ports of an array: the positions of the elements and the directions of the polarizations.
class Ports {
 public:
  Ports(const ArrayPose& end, double carrier_hz);
  uint32_t count() const { return count_; }
  /// Sets out[ports] to the field that each port radiates in a world direction, times the phase of the plane
  /// wave at the port. By reciprocity the port receives out^T E, where E is the field on theta-hat and
  /// phi-hat of the direction that the wave comes from. This is C_R^H E with C_R the conjugate of the
  /// radiated pattern.
  void respond(const dvec3& direction, std::vector<Jones>& out) const;
  /// Sets out[polarizations] to the radiated field of each polarization, without the phases.
  void fields(const dvec3& direction, std::vector<Jones>& out) const;
  /// Returns e^{j 2 pi direction . d/lambda} of the port at d.
  Complex phase(const dvec3& direction, uint32_t port) const;
  size_t polarizations() const { return element_.polarization_count(); }

 private:
  TurnedElement element_;
  uint32_t count_;
  std::vector<dvec3> positions_;  ///< [elements], in carrier wavelengths, along local axes
};

/// Computes (lambda/4 pi) C_R^H T C_T with the array phases for all pairs of ports of one path: out[rx *
/// tx_count + tx].
class PairAmplitudes {
 public:
  PairAmplitudes(const ArrayPose& transmitter, const ArrayPose& receiver, double carrier_hz);
  size_t pairs() const { return size_t{tx_.count()} * rx_.count(); }
  void operator()(const Path& path, Complex* out) { (*this)(path, path.transfer, out); }
  /// Uses t, [4], in place of the path's own transfer.
  void operator()(const Path& path, const Complex* t, Complex* out);
  /// Returns the mean of |out|^2 over all pairs. All elements of an array have the same patterns and the
  /// array phases have modulus 1, so that one element at each end gives the mean.
  double mean_power(const Path& path);
  const Ports& tx() const { return tx_; }
  const Ports& rx() const { return rx_; }
  Leads& leads() { return leads_; }

 private:
  void of_curved(const Path& path, const Complex* t, Complex* out);

  Ports tx_, rx_;
  Leads leads_;
  double carrier_hz_, scale_;
  std::vector<Jones> tx_response_, rx_response_;
  std::vector<double> leads_s_;
};

}  // namespace greatx::rf
