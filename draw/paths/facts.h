// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What `greatx paths` says of paths beyond what rf::Path holds: gains, phases, names of what they touch,
// figures of a whole link. Everything that prints, draws or exports paths takes its numbers from here.
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

/// One receiver and its paths at the tick.
struct PathLink {
  uint32_t index = 0;                         ///< in the channel, or in the list of positions
  std::string name;                           ///< "node/sensor", or "point 17"
  dvec3 transmitter_m{0.0}, receiver_m{0.0};  ///< world
  double distance_m = 0.0;
  std::vector<rf::Path> paths;  ///< by delay; what arrives together in canonical order
};

/// What a snapshot has solved, with its paths sorted by delay. `origin`: of the scene.
PathLink path_link(sim::ChannelSnapshot::Link solved, const dvec3& origin);

/// What names and world coordinates need.
struct PathScene {
  const scene::Scene* scene = nullptr;
  std::span<const scene::Wedge> wedges;  ///< that interactions refer to
  double carrier_hz = 0.0;
};

/// By delay, then rf::interactions_less.
void sort_by_delay(std::vector<rf::Path>& paths);

/// (lambda / 4 pi)^2 ||T||_F^2 / 2: the power that isotropic antennas of unit gain take from the path in both
/// polarizations, over the power sent, mean over the polarization sent. A line of sight: Friis, (lambda / 4
/// pi d)^2.
double path_gain(const rf::Path& path, double carrier_hz);
/// a = (lambda / 4 pi) T_theta_theta e^{-j 2 pi f tau}: what two vertical isotropic antennas see at the
/// carrier.
rf::Complex vertical_amplitude(const rf::Path& path, double carrier_hz);
/// 10 log10; of zero: -infinity.
double gain_db(double gain);

/// The letters of the interactions in their order: R, T, D, S; "LoS" if there is none.
std::string chain_of(const rf::Path& path);
char letter_of(rf::InteractionType type);

/// The kind that a path counts as: that of its rarest interaction, scattering before diffraction before
/// transmission before reflection; none: line of sight.
rf::InteractionType kind_of(const rf::Path& path);
inline constexpr std::array<rf::InteractionType, 5> path_kinds = {
    rf::InteractionType::none, rf::InteractionType::reflection, rf::InteractionType::transmission,
    rf::InteractionType::diffraction, rf::InteractionType::scattering};
const char* kind_name(rf::InteractionType kind);  ///< "line of sight", "reflection", ...

/// What an interaction touches: one facet, or the one or two faces of a wedge.
struct Touched {
  std::vector<uint32_t> facets;
  std::vector<std::string> objects, materials;  ///< [facets]
};
Touched touched(const rf::Interaction& interaction, const PathScene& scene);
/// "R tower (itu_glass), D tower | roof (itu_concrete)"; "line of sight" if there is none.
std::string describe_interactions(const rf::Path& path, const PathScene& scene);

/// A whole link.
struct LinkFigures {
  size_t paths = 0;
  bool line_of_sight = false;
  double gain = 0.0;                              ///< sum of path_gain: powers, not fields
  std::optional<double> first_delay_s;            ///< none: no path
  std::optional<double> delay_spread_s;           ///< rms, weighted by path_gain; none: no power
  std::array<size_t, path_kinds.size()> kinds{};  ///< paths by kind_of
};
LinkFigures figures_of(const PathLink& link, double carrier_hz);

/// Without the paths that are more than `range_db` weaker than the strongest of all links.
std::vector<PathLink> strong_paths(std::span<const PathLink> links, double carrier_hz, double range_db);

/// 16 hexadecimal digits.
std::string id_text(uint64_t id);

}  // namespace greatx::apps
