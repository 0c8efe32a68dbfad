// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A target whose scattering is known by samples that were measured or computed elsewhere.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rf/targets/target_model.h"

namespace greatx::rf {

/// Holds scattering matrices on a regular grid of directions. A monostatic table has one grid, that of the
/// direction to source and receiver. A bistatic table has two.
///
/// Each entry of S is interpolated linearly, as a complex amplitude, over all two or four angles. The error
/// is at most the sum over the angles of (step^2 max|d^2 S/d angle^2|)/8, as for rf::PatternTable. S of a
/// body of length L turns by up to 2 k L a radian (k = 2 pi/wavelength), so that amplitudes with phases need
/// steps well below wavelength/(2 L) rad; tables of cross-sections alone (without phases) need no such steps.
///
/// A monostatic table serves a bistatic aspect by the direction halfway between source and receiver (R. E.
/// Kell, "On the derivation of bistatic RCS from monostatic measurements", Proc. IEEE 53(8), 1965). This
/// holds for small bistatic angles of bodies without shadowing.
class RcsTable : public TargetModel {
 public:
  struct Grid {
    uint32_t zeniths = 0, azimuths = 0;  ///< zeniths from 0 to pi, both included; azimuths once around
    double first_azimuth = 0.0;          ///< rad
    size_t size() const { return size_t{zeniths} * azimuths; }
  };
  /// `samples`: [source zenith, source azimuth], for a monostatic table, or [source zenith, source azimuth,
  /// receiver zenith, receiver azimuth], in C order. `receiver` has no zeniths for a monostatic table.
  RcsTable(const Grid& source, const Grid& receiver, std::vector<ScatterMatrix> samples, std::string name,
           std::string sha256);

  ScatterMatrix scatter(const Aspect& aspect, const EchoKey& key) const override;
  bool bistatic() const { return receiver_.zeniths > 0; }
  const std::string& name() const { return name_; }
  const std::string& sha256() const { return sha256_; }

 private:
  Grid source_, receiver_;
  std::vector<ScatterMatrix> samples_;
  std::string name_, sha256_;
};

}  // namespace greatx::rf
