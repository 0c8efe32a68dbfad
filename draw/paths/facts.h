// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Derives facts about paths that rf::Path does not hold: gains, phases, names of the objects at interactions,
// figures of a whole link. All code that prints, draws or exports paths takes its numbers from here.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "rf/geometry/path.h"
#include "scene/description/scene.h"
#include "scene/description/wedges.h"
#include "sim/channel/channel_snapshot.h"

namespace greatx::apps {

/// Holds one receiver and its paths at a tick.
struct PathLink {
  uint32_t index = 0;                         ///< index in the channel, or in the list of positions
  std::string name;                           ///< "node/sensor", or "point 17"
  dvec3 transmitter_m{0.0}, receiver_m{0.0};  ///< positions in the world
  double distance_m = 0.0;
  std::vector<rf::Path> paths;  ///< in the order of sort_by_delay()
};

/// Converts a link that a snapshot has solved; its paths are sorted by delay. `origin` is that of the scene.
PathLink path_link(sim::ChannelSnapshot::Link solved, const dvec3& origin);

/// Holds the data that gives names and world coordinates to paths.
struct PathScene {
  const scene::Scene* scene = nullptr;
  std::span<const scene::Wedge> wedges;  ///< the wedges to which interactions refer
  double carrier_hz = 0.0;
};

/// Sorts by delay; paths with equal delays by rf::interactions_less().
void sort_by_delay(std::vector<rf::Path>& paths);

/// Returns (lambda / 4 pi)^2 ||T||_F^2 / 2: the power that an isotropic antenna of unit gain receives from
/// the path in both polarizations, divided by the power that another one transmits, averaged over the
/// transmitted polarization. For a line of sight this is Friis, (lambda / 4 pi d)^2.
double path_gain(const rf::Path& path, double carrier_hz);
/// Returns a = (lambda / 4 pi) T_theta_theta e^{-j 2 pi f tau}: the amplitude between two isotropic antennas
/// with vertical polarization at the carrier.
rf::Complex vertical_amplitude(const rf::Path& path, double carrier_hz);
/// Returns 10 log10(gain); -infinity for zero.
double gain_db(double gain);

/// Returns the letters of the interactions in their order (R, T, D, S, E for the echo of a
/// target), or "LoS" if there is none.
std::string chain_of(const rf::Path& path);
char letter_of(rf::InteractionType type);

/// Returns the kind of a path: the first of target, scattering, diffraction, transmission and reflection that
/// occurs in its interactions, or none for the line of sight.
rf::InteractionType kind_of(const rf::Path& path);
inline constexpr std::array<rf::InteractionType, 6> path_kinds = {
    rf::InteractionType::none,        rf::InteractionType::reflection, rf::InteractionType::transmission,
    rf::InteractionType::diffraction, rf::InteractionType::scattering, rf::InteractionType::target};
/// Returns "line of sight", "reflection", ...
const char* kind_name(rf::InteractionType kind);

/// Describes the surfaces at an interaction: one facet, or the one or two faces of a wedge. A target has an
/// object and no facet.
struct Touched {
  std::vector<uint32_t> facets;
  std::vector<std::string> objects, materials;  ///< [facets]
};
Touched touched(const rf::Interaction& interaction, const PathScene& scene);
/// Returns a text such as "R tower (itu_glass), D tower | roof (itu_concrete)", or "line of sight" if there
/// is no interaction.
std::string describe_interactions(const rf::Path& path, const PathScene& scene);

/// Holds the figures of a whole link.
struct LinkFigures {
  size_t paths = 0;
  bool line_of_sight = false;
  double gain = 0.0;                     ///< sum of path_gain(): powers are added, not fields
  double gain_deviation = 0.0;           ///< of the draws of scatterings
  std::optional<double> first_delay_s;   ///< empty if there is no path
  std::optional<double> delay_spread_s;  ///< rms, weighted by path_gain(); empty if there is no power
  std::array<size_t, path_kinds.size()> kinds{};  ///< number of paths by kind_of()
};
LinkFigures figures_of(const PathLink& link, double carrier_hz);

/// Returns the links without the paths that are more than `range_db` weaker than the strongest path of all
/// links.
std::vector<PathLink> strong_paths(std::span<const PathLink> links, double carrier_hz, double range_db);

/// Returns 16 hexadecimal digits.
std::string id_text(uint64_t id);

}  // namespace greatx::apps
