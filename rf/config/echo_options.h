// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Describes the options and the ends of a radar's echo search (docs/radar_echoes.md). Plain data.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/vec.h"
#include "rf/antenna/element.h"
#include "rf/config/radar_config.h"

namespace greatx::rf {

/// Describes the directions in which tubes leave the transmitter: a sector about boresight (+x) of its frame.
struct FieldOfView {
  double azimuth_min = -1.0471975511965976, azimuth_max = 1.0471975511965976;        ///< rad, towards +y
  double elevation_min = -0.26179938779914946, elevation_max = 0.26179938779914946;  ///< rad, towards +z
};

/// Selects where rays are traced. Both tracers meet the same facets, except where a ray passes within a
/// rounding error of an edge.
enum class EchoTracing : uint8_t {
  automatic,  ///< the device, unless the device is a CPU
  device,     ///< EchoPass
  host        ///< EchoTracer
};

/// Describes what the drops in a cubic metre of air send back, and how they move.
struct RainEchoes {
  double reflectivity_per_m = 0.0;  ///< eta: radar cross-section of a cubic metre, m^2/m^3; 0: no rain
  double fall_m_s = 0.0;            ///< mean, weighted with the cross-sections
  double fall_spread_m_s = 0.0;     ///< standard deviation
  double turbulence_m_s = 0.0;      ///< standard deviation of the velocity along any direction
};

struct EchoOptions {
  FieldOfView field_of_view;
  uint32_t tubes = 6000;  ///< number of tubes over the field of view
  /// Number of surfaces that a tube meets, 1 to most_bounces. With 3 or more, a monostatic radar also sees
  /// targets over mirrors, out and back over the same mirror. The target itself may then have max_bounces
  /// bounces: the mirror does not count.
  uint32_t max_bounces = 3;
  /// A monostatic radar sees moving bodies, and the instances in `targets`, over mirrors as well.
  bool moving_targets = true;
  std::vector<uint32_t> targets;  ///< indices into Scene::instances

  /// Radius of the antennas, metres. A surface nearer than this to an end causes an error that names the
  /// surface.
  double antenna_radius_m = 0.02;

  /// Radar cross-section, m^2. Edges and corners of surfaces are left out, and counted, if their echo would
  /// be below that of a body with this cross-section even for a perfect conductor. 0: nothing is left out.
  double border_floor_m2 = 1e-7;
  /// Radar cross-section, m^2, below which the receiver's noise hides edges and corners
  /// (hidden_section_m2()), for a body 1 m away from both ends. It grows with the square of the distance to
  /// each end. 0: nothing is hidden.
  double hidden_floor_m2 = 0.0;

  /// Ratio of received to transmitted power below which the receiver's noise hides an echo (hidden_ratio()).
  /// Echoes below it are left out after merging, and counted. 0: nothing is hidden.
  double hidden_ratio = 0.0;

  /// Attenuation by the air over the whole way of an echo, dB/km.
  double air_db_per_km = 0.0;
  /// Edges send back the fields of their fringe currents (rf/radar/echoes/fringe.h).
  bool edges = false;
  /// Targets are seen through foliage and thin panes (rf/radar/echoes/veils.h).
  bool transmission = false;
  /// Coherent fields fall by Ament's factor of the materials' rms heights.
  bool roughness = false;
  /// Rough surfaces send back what their materials scatter (docs/clutter.md).
  bool diffuse = false;
  /// Side of the squares with one scatterer each, metres. 0: half a range cell of `waveform`.
  double diffuse_patch_m = 0.0;
  /// The instances that scatter, if there are any here; indices into Scene::instances. Empty: all.
  std::vector<uint32_t> diffuse_instances;
  /// Scatterers are echoes of their own, which merge as others do, instead of patches. They take the field of
  /// the element itself, whatever the field of view is.
  bool scatterer_echoes = false;
  /// What raindrops send back. Only monostatic radars have it.
  RainEchoes rain;
  uint64_t seed = 1;       ///< seed of the scatterers
  RadarWaveform waveform;  ///< of the radar, if `diffuse` or in rain

  /// Tubes merge into one echo if they fall into one cell of delay, delay rate and direction at both ends.
  /// The size of a cell is `merge_share` times the resolution of an output: 1/bandwidth, wavelength/frame,
  /// `beam_rad`. 0: nothing is merged.
  double merge_share = 0.125;
  double bandwidth_hz = 1e9;
  double beam_rad = 0.1;
  uint32_t max_echoes = 1u << 16;  ///< the strongest echoes are kept; the others are counted

  EchoTracing tracing = EchoTracing::automatic;
  uint32_t threads = 0;  ///< 0: one per core; the echoes do not depend on the number of threads
};

inline constexpr uint32_t most_bounces = 6;
/// Least max_bounces for which echoes go over a mirror on both ways.
inline constexpr uint32_t mirror_bounces = 3;
/// Largest number of surfaces on the way of an echo: most_bounces on the target, and the mirror twice.
inline constexpr uint32_t most_surfaces = most_bounces + 2;

/// Describes one end of a radar: an element at the origin of its frame, facing +x.
struct EchoEnd {
  ElementPattern pattern;
  double slant = 0.0;          ///< rad
  uint32_t own_body = 0;       ///< body that carries the end; rays do not see it or its parts; 0: none
  std::string name = "radar";  ///< name in messages
};

}  // namespace greatx::rf
