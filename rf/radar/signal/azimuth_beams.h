// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Sums the powers of beams at elevation 0 over azimuths: the kernel of range-azimuth maps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/vec.h"

namespace greatx::rf {

/// Describes a place of an antenna: metres in the frame of the array, and the coherent group that it is in.
struct BeamPlace {
  dvec3 at_m{0.0};
  uint32_t beam = 0;
};

/// A beam is the sum of its places, each turned back by the phase of the direction. The sum over many values
/// (velocities) follows from the covariance of the places, or, where its table would be large, from the sums
/// themselves.
class AzimuthBeams {
 public:
  /// The largest table of pairs of places, in entries [pair, azimuth] of two fp32.
  static constexpr size_t most_entries = size_t{1} << 23;
  /// Rows of values are multiples of this long, filled up with zeros.
  static constexpr uint32_t lanes = 8;

  AzimuthBeams(const std::vector<BeamPlace>& places, double wavelength_m,
               const std::vector<double>& azimuths);

  size_t places() const { return places_.size(); }
  size_t azimuths() const { return azimuths_; }
  size_t table_bytes() const { return steering_.size() * sizeof(float); }
  /// Adds to out[k] the power of all beams at azimuth k, summed over `count` values of each place (a multiple
  /// of `lanes`). `re`, `im`: [places, count]. Rounding errors may leave a sum slightly below 0.
  void add_powers(const float* re, const float* im, uint32_t count, float* out) const;

 private:
  struct Pair {
    uint32_t a, b;
  };
  void add_by_pairs(const float* re, const float* im, uint32_t count, float* out) const;
  void add_by_sums(const float* re, const float* im, uint32_t count, float* out) const;

  std::vector<BeamPlace> places_;
  size_t azimuths_;
  std::vector<Pair> pairs_;      ///< places a < b of one beam; none if the sums are computed themselves
  std::vector<float> steering_;  ///< [pairs or places, re | im, azimuths]
  uint32_t beams_ = 0;
};

}  // namespace greatx::rf
