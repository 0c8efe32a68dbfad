// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What the echoes of a radar are asked for (docs/radar_echoes.md). Plain data.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/vec.h"
#include "rf/antenna/element.h"

namespace greatx::rf {

/// The directions that tubes leave the transmitter in: a sector about boresight (+x) of its frame.
struct FieldOfView {
  double azimuth_min = -1.0471975511965976, azimuth_max = 1.0471975511965976;        ///< rad, towards +y
  double elevation_min = -0.26179938779914946, elevation_max = 0.26179938779914946;  ///< rad, towards +z
};

/// Who traces the rays. Both meet the same facets but where a ray passes within roundings of an edge.
enum class EchoTracing : uint8_t {
  automatic,  ///< the device, if it is no CPU
  device,     ///< EchoPass
  host        ///< EchoTracer
};

struct EchoOptions {
  FieldOfView field_of_view;
  uint32_t tubes = 6000;  ///< of the field of view, before subdivision
  /// Surfaces that a tube meets, 1 to most_bounces. From 3 on a monostatic radar sees targets over mirrors,
  /// out and back over the same one, with so many bounces on the target itself: the mirror does not count.
  uint32_t max_bounces = 3;
  /// Tubes on bodies that move, and on instances named in `targets`, are subdivided to this width at their
  /// distance, metres.
  double target_tube_m = 0.03;
  /// Tubes that subdivision may add; if it is not enough the width grows (EchoStatistics::target_tube_m says
  /// to what).
  uint32_t target_budget = 4096;
  /// The same for where a monostatic radar sees targets over mirrors: tubes that it may add there on top. 0:
  /// the images of targets are seen by the tubes that happen to be there.
  uint32_t mirror_budget = 2048;
  bool moving_targets = true;
  std::vector<uint32_t> targets;  ///< indices into Scene::instances

  /// A surface nearer than this to an end is inside its antenna: an error that names it. Metres.
  double antenna_radius_m = 0.02;

  /// What edges and corners of surfaces send back is left out, and counted, where it is below that of a body
  /// of this radar cross-section even for a perfect conductor, m^2. 0: nothing is.
  double border_floor_m2 = 1e-5;
  /// The same for what the receiver's noise hides (hidden_section_m2()): that of a body 1 m away from both
  /// ends; it grows with the square of the distance of each. 0: nothing is hidden. m^2.
  double hidden_floor_m2 = 0.0;

  bool roughness = false;  ///< coherent fields fall by Ament's factor of the materials' rms heights
  bool diffuse =
      false;  ///< rough surfaces scatter what their materials say, with phases fixed to the surface
  double diffuse_patch_m = 0.25;  ///< side of the patches whose phases are drawn together
  uint64_t seed = 1;              ///< of those phases

  /// Tubes become one echo if they fall into one cell of delay, delay rate and direction at both ends, by
  /// `merge_share` of what an output can tell apart: 1/bandwidth, wavelength/frame, `beam_rad`. 0: nothing is
  /// merged.
  double merge_share = 0.125;
  double bandwidth_hz = 1e9;
  double beam_rad = 0.1;
  uint32_t max_echoes = 1u << 16;  ///< the strongest are kept; the rest is counted

  EchoTracing tracing = EchoTracing::automatic;
  uint32_t threads = 0;  ///< 0: as many as there are cores; the echoes do not depend on it
};

inline constexpr uint32_t most_bounces = 6;
/// The least max_bounces with ghosts by a mirror both ways.
inline constexpr uint32_t mirror_bounces = 3;
/// Surfaces on an echo's way: most_bounces on the target, the mirror twice.
inline constexpr uint32_t most_surfaces = most_bounces + 2;

/// One end of a radar: an element at the origin of its frame, which looks along +x.
struct EchoEnd {
  ElementPattern pattern;
  double slant = 0.0;          ///< rad
  uint32_t own_body = 0;       ///< rays do not see the body that carries it, nor its parts; 0: none does
  std::string name = "radar";  ///< for messages
};

}  // namespace greatx::rf
