// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Evaluates what the two arrays of a link make of one path: fields, amplitudes and leads, and how these
// change with the path and the ends.
#pragma once

#include <array>
#include <vector>

#include "rf/channel/wavefront.h"
#include "rf/gradient/element_slopes.h"
#include "rf/gradient/response_gradient.h"

namespace greatx::rf {

/// The places of an array's elements about its origin, metres, local axes.
std::vector<dvec3> element_places(const ArrayPose& end);
/// Returns the derivatives of the field of each polarization at one end. `slants`: as in ResponseLink.
ElementSlopes element_slopes_of(const ArrayPose& end, const std::vector<double>& slants);
/// Returns the gain of a port; `gains` may be empty.
inline Complex gain_of(const std::vector<Complex>& gains, size_t port) {
  return gains.empty() ? Complex(1.0) : gains[port];
}

/// Holds the fields of the polarizations at both ends of one path, which all elements share.
class PathAmplitudes {
 public:
  PathAmplitudes(const ResponseLink& link, double carrier_hz);
  void load(const Path& path);

  size_t tx_polarizations() const { return sender_.polarization_count(); }
  size_t rx_polarizations() const { return receiver_.polarization_count(); }
  const FieldSlopes& sent(size_t polarization) const { return sent_[polarization]; }
  const FieldSlopes& received(size_t polarization) const { return received_[polarization]; }
  double scale() const { return scale_; }
  /// Returns (lambda/4 pi) F_R^T T F_T.
  Complex amplitude(size_t rx_polarization, size_t tx_polarization) const;
  /// Returns its change along a tangent.
  Complex slope(size_t rx_polarization, size_t tx_polarization, const PathSlope& path,
                const LinkTangent& link) const;

 private:
  ElementSlopes sender_, receiver_;
  double scale_, carrier_hz_;
  std::array<FieldSlopes, 2> sent_, received_;
  const Path* path_ = nullptr;
};

/// Computes the leads of one path, metres, and differentiates them in both directions.
class PathLeads {
 public:
  PathLeads(const ArrayPose& transmitter, const ArrayPose& receiver);
  void load(const Path& path);

  size_t tx_elements() const { return sent_m_.size(); }
  size_t rx_elements() const { return received_m_.size(); }
  size_t pairs() const { return tx_elements() * rx_elements(); }
  /// [rx element, tx element]
  double lead_m(size_t rx, size_t tx) const;
  /// Returns the change of the lead along a tangent.
  double slope_m(size_t rx, size_t tx, const PathTangent& path, const LinkTangent& link) const;
  /// Adds to the cotangents the share of this lead, whose own cotangent is `weight` per metre.
  void pull_back(size_t rx, size_t tx, double weight, PathCotangent& path, LinkCotangent& link) const;

 private:
  const bool curved_;
  std::vector<dvec3> sent_m_, received_m_;
  WaveShape shape_;
  const Path* path_ = nullptr;
};

}  // namespace greatx::rf
