// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "draw/paths/facts.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "core/phase.h"
#include "core/units.h"
#include "rf/channel/statistics.h"

namespace greatx::apps {

namespace {

/// Returns lambda / 4 pi.
double reference(double carrier_hz) { return speed_of_light / carrier_hz / (4.0 * pi); }

}  // namespace

PathLink path_link(sim::ChannelSnapshot::Link solved, const dvec3& origin) {
  PathLink link;
  link.index = static_cast<uint32_t>(solved.receiver);
  link.name = std::move(solved.receiver_name);
  link.transmitter_m = solved.transmitter_state.position + origin;
  link.receiver_m = solved.receiver_state.position + origin;
  link.distance_m = solved.distance_m;
  link.paths = std::move(solved.paths);
  sort_by_delay(link.paths);
  return link;
}

void sort_by_delay(std::vector<rf::Path>& paths) {
  std::sort(paths.begin(), paths.end(), [](const rf::Path& a, const rf::Path& b) {
    if (a.delay_s != b.delay_s) return a.delay_s < b.delay_s;
    return rf::interactions_less(a.interactions, b.interactions);
  });
}

double path_gain(const rf::Path& path, double carrier_hz) {
  double square = 0.0;
  for (const rf::Complex& t : path.transfer) square += std::norm(t);
  const double amplitude = reference(carrier_hz);
  return 0.5 * amplitude * amplitude * square;
}

rf::Complex vertical_amplitude(const rf::Path& path, double carrier_hz) {
  return reference(carrier_hz) * path.transfer[0] * rf::unit_phasor(-rf::turns_of(carrier_hz, path.delay_s));
}

double gain_db(double gain) { return decibels(gain); }

char letter_of(rf::InteractionType type) {
  switch (type) {
    case rf::InteractionType::none:
      break;
    case rf::InteractionType::reflection:
      return 'R';
    case rf::InteractionType::transmission:
      return 'T';
    case rf::InteractionType::diffraction:
      return 'D';
    case rf::InteractionType::scattering:
      return 'S';
    case rf::InteractionType::target:
      return 'E';
  }
  throw ContractError(fmt::format("interaction {} has no letter", static_cast<int>(type)));
}

std::string chain_of(const rf::Path& path) {
  if (path.interactions.empty()) return "LoS";
  std::string chain;
  for (const rf::Interaction& interaction : path.interactions) chain += letter_of(interaction.type);
  return chain;
}

rf::InteractionType kind_of(const rf::Path& path) {
  // The values of InteractionType ascend from none to target.
  auto kind = rf::InteractionType::none;
  for (const rf::Interaction& interaction : path.interactions) kind = std::max(kind, interaction.type);
  return kind;
}

const char* kind_name(rf::InteractionType kind) {
  return kind == rf::InteractionType::none ? "line of sight" : rf::name_of(kind);
}

Touched touched(const rf::Interaction& interaction, const PathScene& scene) {
  Touched result;
  if (interaction.type == rf::InteractionType::target) {
    GREATX_CHECK(interaction.element < scene.scene->instances.size(), "instance {} of {}",
                 interaction.element, scene.scene->instances.size());
    result.objects.push_back(scene.scene->instances[interaction.element].name);
    result.materials.emplace_back("target");
    return result;
  }
  if (interaction.type == rf::InteractionType::diffraction) {
    GREATX_CHECK(interaction.element < scene.wedges.size(), "wedge {} of {}", interaction.element,
                 scene.wedges.size());
    const scene::Wedge& wedge = scene.wedges[interaction.element];
    result.facets.push_back(wedge.facet_0);
    if (wedge.facet_n != scene::no_facet && wedge.facet_n != wedge.facet_0)
      result.facets.push_back(wedge.facet_n);
  } else {
    result.facets.push_back(interaction.element);
  }
  for (const uint32_t index : result.facets) {
    GREATX_CHECK(index < scene.scene->facets.size(), "facet {} of {}", index, scene.scene->facets.size());
    const scene::Facet& facet = scene.scene->facets[index];
    result.objects.push_back(scene.scene->instances[facet.instance].name);
    result.materials.push_back(scene.scene->materials[facet.material].name);
  }
  return result;
}

std::string describe_interactions(const rf::Path& path, const PathScene& scene) {
  if (path.interactions.empty()) return "line of sight";
  std::vector<std::string> parts;
  for (const rf::Interaction& interaction : path.interactions) {
    Touched names = touched(interaction, scene);
    // Both faces of most edges belong to the same object, which is named once.
    for (std::vector<std::string>* list : {&names.objects, &names.materials})
      list->erase(std::unique(list->begin(), list->end()), list->end());
    const bool end = interaction.type == rf::InteractionType::diffraction && interaction.patch != 0;
    parts.push_back(fmt::format("{}{} {} ({})", letter_of(interaction.type), end ? " end," : "",
                                fmt::join(names.objects, " | "), fmt::join(names.materials, " | ")));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

LinkFigures figures_of(const PathLink& link, double carrier_hz) {
  LinkFigures figures;
  std::vector<double> gains;
  for (const rf::Path& path : link.paths) {
    gains.push_back(path_gain(path, carrier_hz));
    figures.first_delay_s = std::min(figures.first_delay_s.value_or(path.delay_s), path.delay_s);
    ++figures.kinds[static_cast<size_t>(kind_of(path))];
  }
  const rf::LinkStatistics statistics = rf::link_statistics(link.paths, gains);
  figures.paths = statistics.paths;
  figures.line_of_sight = statistics.line_of_sight;
  figures.gain = statistics.path_gain;
  figures.gain_deviation = statistics.path_gain_deviation;
  if (statistics.path_gain > 0.0) figures.delay_spread_s = statistics.delay_spread_s;
  return figures;
}

std::vector<PathLink> strong_paths(std::span<const PathLink> links, double carrier_hz, double range_db) {
  double strongest = 0.0;
  for (const PathLink& link : links)
    for (const rf::Path& path : link.paths) strongest = std::max(strongest, path_gain(path, carrier_hz));
  const double least = strongest * from_decibels(-range_db);
  std::vector<PathLink> strong(links.begin(), links.end());
  for (PathLink& link : strong)
    std::erase_if(link.paths, [&](const rf::Path& path) { return path_gain(path, carrier_hz) < least; });
  return strong;
}

std::string id_text(uint64_t id) { return fmt::format("{:016x}", id); }

}  // namespace greatx::apps
