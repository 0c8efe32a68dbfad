// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// How the channel is made, stage by stage (data flows one way):
//
//   facets ─► candidates (reflecting facets)  BeamSearch: the tree of image sources, nothing lost; or CandidateSearch: rays
//          ─► geometry (GeometricPath)        ImageTree, diffraction, scattering: exact, fp64, host
//          ─► crossings                       CrossingPass: every segment traced in the tick's command buffer: walls, foliage
//          ─► interactions merged             PathSolver: walls passed become interactions, dark paths go
//          ─► field (Path)                    path_field: every interaction, polarization, Doppler, fp64, host
//          ─► channel                         frequency_response: sum over paths, ports, subcarriers, complex64
#pragma once

#include <compare>
#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "rf/antenna/antenna.h"

namespace greatx::rf {

/// Values are stable, they go to disk.
enum class InteractionType : uint8_t {
  none = 0,
  reflection = 1,
  transmission = 2,
  diffraction = 3,
  scattering = 4
};
const char* name_of(InteractionType type);

/// What a path does at one of its vertices.
struct Interaction {
  InteractionType type = InteractionType::reflection;
  uint32_t element = 0;  ///< facet (index into Scene::facets); diffraction: wedge
  uint32_t patch = 0;    ///< scattering: number of the patch on the facet; else 0
  auto operator<=>(const Interaction&) const = default;
};

/// Facets (indices into Scene::facets) that a path is reflected at, in its order.
using FacetSequence = std::vector<uint32_t>;
FacetSequence reflecting_facets(std::span<const Interaction> interactions);

/// Canonical order of paths: fewer interactions first, then lexicographic.
bool interactions_less(std::span<const Interaction> a, std::span<const Interaction> b);

/// Identity of a path between two given ends: a function of its whole sequence of interactions and of nothing else, so
/// it lasts from tick to tick, through a resume and in any shard. 64 bits: two of a million paths share one with a
/// probability of 3e-8.
uint64_t path_id(std::span<const Interaction> interactions);

/// A path that exists geometrically, from the transmitter to the receiver.
struct GeometricPath {
  std::vector<Interaction> interactions;
  std::vector<dvec3>
      vertices;                ///< [interactions + 2], local coordinates: transmitter, interactions, receiver
  double length_m = 0.0;       ///< unfolded: from the images, not by adding segments up
  double foliage_m = 0.0;      ///< of it inside foliage
  double patch_area_m2 = 0.0;  ///< of the patch that it is scattered at; 0: it is not
  FacetSequence facets() const { return reflecting_facets(interactions); }
};

/// A path as seen from one transmitter and one receiver (their reference points).
struct Path {
  std::vector<Interaction> interactions;
  std::vector<dvec3> vertices;  ///< [interactions + 2], local coordinates
  double length_m = 0.0;
  double foliage_m = 0.0;
  double patch_area_m2 = 0.0;  ///< as GeometricPath's
  double delay_s = 0.0;        ///< length / c
  double doppler_hz =
      0.0;  ///< nu = (1/lambda)(v_tx . k_0 - v_rx . k_n + sum v_i . (k_i - k_{i-1})), approaching > 0
  dvec3 departure{0.0};  ///< unit, world axes, leaving the transmitter
  dvec3 arrival{0.0};    ///< unit, world axes, pointing from the receiver back along the path
  /// T: field at the receiver in (theta, phi) at `arrival` per field at the transmitter in (theta, phi) at `departure`,
  /// with the spreading but without the phase e^{-j 2 pi f tau}, which the channel adds in turns.
  /// Row-major [theta_rx theta_tx, theta_rx phi_tx, phi_rx theta_tx, phi_rx phi_tx], 1/m.
  Complex transfer[4]{};
  uint64_t id() const { return path_id(interactions); }
  FacetSequence facets() const { return reflecting_facets(interactions); }
};

}  // namespace greatx::rf
