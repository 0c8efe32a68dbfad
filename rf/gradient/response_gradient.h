// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Differentiates the frequency response of a link (rf/channel/frequency_response.h) in both directions:
//
//   push_forward: slopes of paths and ends ─► dH (Jacobian-vector products, the Jacobian's columns)
//   pull_back:    G = dL/d Re H + j dL/d Im H ─► dL by what the sum takes from each path and end
//
// Both differentiate
//
//   H_us = (lambda/4 pi) sum_i g_u g_s [F_R,u^T T_i F_T,s] e^{j 2 pi f_c (l_us/c - tau_i)} e^{j 2 pi nu_i t}
//          e^{-j 2 pi f (tau_i - [squint] l_us/c)},
//
// with complex gains g of the ports (1 in a simulation) and the lead l_us in metres of a pair of elements
// (rf/channel/wavefront.h). The phase of the carrier at a path of tau turns by 2 pi f_c per second: this term
// makes gradients by positions large and periodic with the wavelength.
//
// pull_back costs about two forward sums, whatever the number of parameters. It goes first to
// paths, and only there to parameters: dL/dp = sum over paths of <cotangent of the path, its slope by p>.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "rf/channel/frequency_response.h"
#include "rf/gradient/path_slopes.h"

namespace greatx::rf {

/// Describes a link whose response is differentiated. No path may lead over a target.
struct ResponseLink {
  std::span<const Path> paths;
  ArrayPose transmitter, receiver;
  /// Complex amplitude gain of each port, [ports]; empty: 1 at every port.
  std::vector<Complex> transmitter_gains = {}, receiver_gains = {};
  /// Slant of each polarization, rad, [polarizations]; empty: those of the array.
  std::vector<double> transmitter_slants = {}, receiver_slants = {};
};

/// The derivatives of a path by one parameter, or a direction in which a path changes.
struct PathTangent {
  PathSlope slope;
  /// Of the distances from each end to the last source of a spherical wave; for Wavefront::curved on paths
  /// with a scattering only, where the source is a patch. Otherwise without meaning.
  double transmitter_radius_m = 0.0, receiver_radius_m = 0.0;
};

struct EndTangent {
  dvec3 attitude{0.0};              ///< a turn after the orientation, rad, world axes
  std::array<double, 2> slants{};   ///< [polarizations], rad
  std::vector<Complex> gains = {};  ///< [ports]; empty: 0
};

struct LinkTangent {
  std::vector<PathTangent> paths;  ///< [paths]
  EndTangent transmitter, receiver;
  /// Of the carrier where the sum takes it: lambda/4 pi and the phases. What a path has by its carrier is in
  /// its slope. The elements keep their places in metres.
  double carrier_hz = 0.0;
};

/// The derivatives of a real loss L by the components of a path. A change of the path changes the loss by
/// Re(sum of transfer[i] d transfer[i]) + length_m d length_m + ...
struct PathCotangent {
  Complex transfer[4]{};
  double length_m = 0.0, doppler_hz = 0.0;  ///< length: with the delay
  dvec3 departure{0.0}, arrival{0.0};
  double transmitter_radius_m = 0.0, receiver_radius_m = 0.0;
  /// Returns the change of the loss along a tangent.
  double along(const PathTangent& tangent) const;
};

struct EndCotangent {
  dvec3 attitude{0.0};
  std::array<double, 2> slants{};
  /// [ports] c with dL = Re(c dg), so that PyTorch's gradient is conj(c).
  std::vector<Complex> gains;
};

struct LinkCotangent {
  std::vector<PathCotangent> paths;
  EndCotangent transmitter, receiver;
  double carrier_hz = 0.0;
  /// Returns the change of the loss along a tangent of the whole link.
  double along(const LinkTangent& tangent) const;
};

class ResponseGradient {
 public:
  /// The paths of `link` must outlive this object. Throws ContractError for paths that are not finite or lead
  /// over a target. Selected paths alone are summed, in the order of `link.paths`.
  ResponseGradient(ResponseLink link, const ChannelGrid& grid, PathSelection selection = PathSelection::all);

  size_t size() const;  ///< response_size()
  /// Returns H [rx_ant, tx_ant, time, subcarrier]: frequency_response_fp64() with the gains.
  std::vector<Complex> response() const;
  /// Adds dH along each tangent to out [tangents, response_size()].
  void push_forward(std::span<const LinkTangent> tangents, std::span<Complex> out) const;
  /// Returns the derivatives of a loss with G = dL/d Re H + j dL/d Im H, [response_size()].
  LinkCotangent pull_back(std::span<const Complex> cotangent) const;

 private:
  std::vector<Complex> response_by_gains() const;

  ResponseLink link_;
  ChannelGrid grid_;
  PathSelection selection_;
};

/// The powers and delays of the paths of a link, and their derivatives along tangents. The power of a path is
/// the mean of |a|^2 over all pairs of ports (path_powers()), with the gains of the ports.
struct PowerSlopes {
  std::vector<double> powers;  ///< [paths]
  std::vector<double> slopes;  ///< [paths, tangents]
};
PowerSlopes power_slopes(const ResponseLink& link, double carrier_hz, std::span<const LinkTangent> tangents);

/// The path gain, the mean delay and the rms delay spread of a link (LinkStatistics) along one tangent.
struct DelaySlopes {
  double path_gain = 0.0, mean_delay_s = 0.0, delay_spread_s = 0.0;
};
/// `powers`, `power_slopes`, `delays_s` and `delay_slopes_s` are [paths]. Without power the slopes of delays
/// are NaN; so is that of a spread of 0, which has a corner there.
DelaySlopes delay_slopes(std::span<const double> powers, std::span<const double> power_slopes,
                         std::span<const double> delays_s, std::span<const double> delay_slopes_s);

}  // namespace greatx::rf
