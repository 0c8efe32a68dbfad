// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Describes paths. The channel is computed in these stages; data flows one way:
// - Candidates, sequences of reflecting facets: BeamSearch follows the tree of image sources and loses
//   nothing, or CandidateSearch traces rays.
// - Geometry (GeometricPath): ImageTree, diffraction and scattering compute exact paths in fp64 on the host.
// - Crossings: CrossingPass traces every segment in the tick's command buffer and finds walls and foliage.
// - Merged interactions: PathSolver turns passed walls into interactions and drops blocked paths.
// - Field (Path): path_field applies every interaction, polarization and Doppler shift in fp64 on the host.
// - Channel: frequency_response sums over paths for all ports and subcarriers, in complex64.
#pragma once

#include <array>
#include <compare>
#include <complex>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/vec.h"
#include "rf/antenna/antenna.h"

namespace greatx::rf {

/// Types of interactions. The values are stable, because data sets store them.
enum class InteractionType : uint8_t {
  none = 0,
  reflection = 1,
  transmission = 2,
  diffraction = 3,
  scattering = 4,
  target = 5  ///< the echo of a target (rf/targets); the element is an instance
};
const char* name_of(InteractionType type);

/// Describes the interaction of a path at one of its vertices.
struct Interaction {
  InteractionType type = InteractionType::reflection;
  /// Facet (index into Scene::facets); for diffraction the wedge, for a target the instance.
  uint32_t element = 0;
  /// Number of the scattering patch on the facet; for a diffraction 0, or the end of the edge (rf/edges/
  /// corners.h: 1 for a, 2 for b); 0 for other types.
  uint32_t patch = 0;
  auto operator<=>(const Interaction&) const = default;
};

/// Facets (indices into Scene::facets) that reflect a path, in the order of the path.
using FacetSequence = std::vector<uint32_t>;
FacetSequence reflecting_facets(std::span<const Interaction> interactions);

/// Tells whether a comes before b in the canonical order: fewer interactions first, then lexicographic.
bool interactions_less(std::span<const Interaction> a, std::span<const Interaction> b);

/// Returns the identity of a path between two given ends. It depends only on the whole sequence of
/// interactions, so that it persists from tick to tick, through a resume and in any shard. It has 64 bits:
/// the probability that two of a million paths share an identity is 3e-8.
uint64_t path_id(std::span<const Interaction> interactions);

/// Tells on which sides of the boundaries of an edge a path ends that is too near to them for its angles to
/// tell: whether the wave without the edge, or its reflection in face 0 or face n instead of it, is a path of
/// its own (+1) or not (-1). 0: the angles tell.
struct EdgeSides {
  int8_t incident = 0, reflected_0 = 0, reflected_n = 0;
};

/// Tells whether Keller's point exists beside an end that is too near to it for roundings to tell.
enum class KellerSide : int8_t { by_place = 0, exists = 1, does_not = -1 };

/// Holds a path that exists geometrically, from the transmitter to the receiver.
struct GeometricPath {
  std::vector<Interaction> interactions;
  /// [interactions + 2], local coordinates: transmitter, interactions, receiver.
  std::vector<dvec3> vertices;
  double length_m = 0.0;   ///< unfolded length, from the images and not as a sum of segments
  double foliage_m = 0.0;  ///< length inside foliage
  /// Area of the scattering patch; 0 if the path is not scattered. A patch that stands for others (stratum)
  /// has the area that gives it their power.
  double patch_area_m2 = 0.0;
  /// Bit i: the diffraction at the edges of the facet of interaction i, a reflection, is in other paths.
  uint32_t edges_diffract = 0;
  std::array<EdgeSides, 2> edge_sides = {};       ///< of its diffractions, in the order of the path
  KellerSide keller_side = KellerSide::by_place;  ///< of its diffraction at the end of an edge
  /// The field is computed as if the receiver sent. A diffraction at a lossy wedge and a scattering have
  /// other fields from each side, so both directions of a link compute theirs from the same end.
  bool from_receiver = false;
  /// Number, from 1 on, of the stratum of scatterings of this link for which this one was drawn; 0: it stands
  /// for itself alone (rf/paths/scatter_draw.h).
  uint32_t stratum = 0;
  /// Area of the second patch as the wave meets them, which starts at the receiver if from_receiver; 0: there
  /// is none. patch_area_m2 is that of the first one.
  double second_patch_area_m2 = 0.0;
  /// Variance that the draw of what lights the last patch adds to the power of this path, relative to its
  /// square (rf/paths/indirect_light.h). It may be negative, but the sum over the paths of a link is not on
  /// average.
  double draw_variance = 0.0;
  FacetSequence facets() const { return reflecting_facets(interactions); }
  /// Makes this an empty path that keeps its memory.
  void clear() {
    interactions.clear();
    vertices.clear();
    length_m = foliage_m = patch_area_m2 = 0.0;
    edges_diffract = 0;
    edge_sides = {};
    keller_side = KellerSide::by_place;
    from_receiver = false;
    stratum = 0;
    second_patch_area_m2 = 0.0;
    draw_variance = 0.0;
  }
};

struct TargetEcho;

/// Holds a path as seen from one transmitter and one receiver (their reference points).
struct Path : GeometricPath {
  double delay_s = 0.0;  ///< length / c
  /// nu = (1/lambda)(v_tx . k_0 - v_rx . k_n + sum v_i . (k_i - k_{i-1})); approaching ends give nu > 0.
  double doppler_hz = 0.0;
  dvec3 departure{0.0};  ///< unit, world axes, leaving the transmitter
  dvec3 arrival{0.0};    ///< unit, world axes, pointing from the receiver back along the path
  /// T: field at the receiver in (theta, phi) at `arrival` per field at the transmitter in (theta, phi) at
  /// `departure`, 1/m. It includes the spreading but not the phase e^{-j 2 pi f tau}, which the channel adds
  /// in turns. Row-major [theta_rx theta_tx, theta_rx phi_tx, phi_rx theta_tx, phi_rx phi_tx].
  Complex transfer[4]{};
  std::shared_ptr<const TargetEcho> echo;  ///< set if and only if the path leads over a target
  uint64_t id() const { return path_id(interactions); }
};

/// Holds the parts of a path over a target.
struct TargetEcho {
  Path out;   ///< from the transmitter to the target
  Path home;  ///< from the target to the receiver
  /// Scattering matrix of the target, m, as Path::transfer: field in (theta, phi) at the departure of `home`
  /// times the distance, per field in (theta, phi) at the arrival of `out`. 4 pi |S|^2 is a cross-section.
  Complex scatter[4]{};
  /// [time samples] phase since the first sample, turns, where it does not turn evenly (rotors); empty: it
  /// turns with the Doppler shift of the path. An echo of surfaces has no legs, and all its transfer in the
  /// path.
  std::vector<double> turns;
  bool has_legs() const { return !out.vertices.empty(); }
};

}  // namespace greatx::rf
