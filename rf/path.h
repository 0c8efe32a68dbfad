// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// How the channel is made, stage by stage (data flows one way):
//
//   facets ─► candidates (facet sequences)   CandidateSearch: rays on the GPU, duplicates removed by whole keys
//          ─► geometry (GeometricPath)       solve_paths: image method, fp64, host
//          ─► visibility                     VisibilityPass: the segments traced in the tick's command buffer
//          ─► field (Path)                   path_field: Fresnel TE/TM, polarization, Doppler, fp64, host
//          ─► channel                        frequency_response: sum over paths, ports, subcarriers, complex64
#pragma once

#include <complex>
#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "rf/antenna.h"

namespace greatx::rf {

/// A sequence of facets (indices into Scene::facets) from the transmitter to the receiver; empty: line of sight.
using FacetSequence = std::vector<uint32_t>;

/// A specular path that exists geometrically; whether anything stands in its way is not decided here.
struct GeometricPath {
  FacetSequence facets;
  std::vector<dvec3> vertices;  ///< [facets + 2], local coordinates: transmitter, reflections, receiver
  double length_m = 0.0;        ///< from the image, not by adding segments up
};

/// A path as seen from one transmitter and one receiver (their reference points).
struct Path {
  FacetSequence facets;
  std::vector<dvec3> vertices;  ///< local coordinates
  double length_m = 0.0;
  double delay_s = 0.0;  ///< length / c
  double doppler_hz =
      0.0;  ///< physics: nu = (1/lambda)(v_tx . k_0 - v_rx . k_n + sum v_i . (k_i - k_{i-1})), sign: approaching > 0
  dvec3 departure{0.0};  ///< unit, world axes, leaving the transmitter
  dvec3 arrival{0.0};    ///< unit, world axes, pointing from the receiver back along the path
  /// T: field at the receiver in (theta, phi) at `arrival` per field at the transmitter in (theta, phi) at `departure`,
  /// with the spreading 1/length but without the phase e^{-j 2 pi f tau}, which the channel adds in turns.
  /// Row-major [theta_rx theta_tx, theta_rx phi_tx, phi_rx theta_tx, phi_rx phi_tx], 1/m.
  Complex transfer[4]{};
};

}  // namespace greatx::rf
