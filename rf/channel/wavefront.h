// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes by how much the way between two elements of two arrays is shorter than that between their origins.
#pragma once

#include <limits>
#include <vector>

#include "rf/channel/frequency_response.h"
#include "rf/geometry/path.h"

namespace greatx::rf {

/// Describes the spheres in which a wave leaves one array and reaches the other, for Wavefront::curved (see
/// Leads).
struct WaveShape {
  /// The path has reflections and transmissions alone: the wave is a sphere about the transmitter's image.
  bool image = false;
  /// Otherwise the distances from each end to the first and to the last patch; infinity: a plane wave.
  double transmitter_radius_m = std::numeric_limits<double>::infinity();
  double receiver_radius_m = std::numeric_limits<double>::infinity();
  dmat3 mirror{1.0};  ///< M, for `image`
};
/// Returns the shape of a path with vertices.
WaveShape wave_shape(const Path& path);

/// Computes leads of one path after the other. With Wavefront::plane the lead is (r_R . d_u + r_T . d_s)/c,
/// with the directions of arrival and departure and the positions of the elements.
///
/// With Wavefront::curved, a path of reflections and transmissions has the length between elements that its
/// image sources give: |L r_R + M d_s - d_u|, where L is the length of the path and M mirrors the
/// transmitter at all reflecting planes. That is the exact length as long as the path stays on its facets.
/// A path with a scattering has a sphere about its first and about its last patch instead, which is exact,
/// too. A path with a diffraction keeps plane waves: behind an edge a wave has two radii of curvature.
class Leads {
 public:
  Leads(const ArrayPose& transmitter, const ArrayPose& receiver);
  size_t tx_elements() const { return sent_m_.size(); }
  size_t rx_elements() const { return received_m_.size(); }
  size_t pairs() const { return tx_elements() * rx_elements(); }
  bool curved() const { return curved_; }
  /// Sets out[rx element * tx_elements() + tx element] to the leads, seconds. For curved
  /// waves the path needs its vertices.
  void operator()(const Path& path, double* out);

 private:
  void of_image(const Path& path, double* out);
  void of_ends(const Path& path, const WaveShape& shape, double* out);

  bool curved_;
  std::vector<dvec3> sent_m_, received_m_;  ///< places of the elements, local axes
  std::vector<dvec3> mirrored_m_;           ///< M d_s of the path
};

}  // namespace greatx::rf
