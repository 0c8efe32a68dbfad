// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/fit/links.h"

#include <algorithm>
#include <map>

#include "core/error.h"
#include "sim/channel/ends.h"
#include "sim/channel/link_ends.h"
#include "sim/plan/antennas.h"

namespace greatx::sim {
namespace {

/// The antenna at the positions of a set, with its orientation in the scenario and on its node.
struct FitReceiver {
  rf::AntennaArray array;
  dquat orientation{1.0, 0.0, 0.0, 0.0}, mount{1.0, 0.0, 0.0, 0.0};
};

FitReceiver receiver_of(const FitSet& set, const ChannelSnapshot& snapshot) {
  if (set.receiver.empty()) return {};
  const Experiment& experiment = snapshot.experiment();
  const ChannelEnd end = antenna_end(experiment, set.receiver);
  return {antenna_array(experiment.scenario, set.receiver,
                        experiment.scenario.channels[snapshot.channel()].carrier_hz),
          state_of(end, *experiment.world, snapshot.moment().context).orientation, end.mount.orientation};
}

/// Adds the parameters of a facet's material.
void add_parameters(uint32_t facet, const rf::FacetWorld& world, const FitMaterials& materials,
                    std::vector<uint32_t>& parameters) {
  if (facet == scene::no_facet) return;
  const std::vector<uint32_t>& of = materials.parameters_of()[world.facet(facet).material];
  parameters.insert(parameters.end(), of.begin(), of.end());
}

/// Returns the factor between two fields of which one is a multiple of the other.
rf::Complex factor_between(const rf::Complex (&of)[4], const rf::Complex (&with)[4]) {
  rf::Complex product = 0.0;
  double power = 0.0;
  for (size_t e = 0; e < 4; ++e) {
    product += std::conj(of[e]) * with[e];
    power += std::norm(of[e]);
  }
  return power > 0.0 ? product / power : rf::Complex(1.0);
}

}  // namespace

scene::Bounds bounds_of(std::span<const FitSet> sets) {
  scene::Bounds bounds;
  for (const FitSet& set : sets)
    for (const dvec3& point : set.points) bounds.add(point);
  return bounds;
}

void find_touched(FitLink& link, const FitMaterials& materials) {
  link.touched.clear();
  const rf::RadioModel& model = link.radio->model();
  for (uint32_t i = 0; i < link.paths.size(); ++i) {
    std::vector<uint32_t> parameters;
    for (const rf::Interaction& interaction : link.paths[i].interactions) {
      if (interaction.type != rf::InteractionType::diffraction) {
        add_parameters(interaction.element, *link.world, materials, parameters);
        continue;
      }
      const scene::Wedge& wedge = model.wedges[interaction.element];
      add_parameters(wedge.facet_0, *link.world, materials, parameters);
      add_parameters(wedge.facet_n, *link.world, materials, parameters);
    }
    std::ranges::sort(parameters);
    const auto repeated = std::ranges::unique(parameters);
    parameters.erase(repeated.begin(), repeated.end());
    if (!parameters.empty()) link.touched.push_back({i, std::move(parameters), 1.0});
  }
  if (link.fields.reflectors == nullptr) return;
  link.fields.reflectors = nullptr;
  link.fields.effects.finite_reflectors = false;
  for (FitLink::Touched& touched : link.touched) {
    const rf::Path& path = link.paths[touched.path];
    rf::Complex endless[4];
    rf::path_transfer(path, link.fields, endless);
    touched.weight = factor_between(endless, path.transfer);
  }
}

std::optional<std::vector<FitLink>> solve_links(gpu::Device& device, const Experiment& experiment,
                                                uint32_t channel, const FitProblem& problem,
                                                const FitMaterials& materials,
                                                const std::function<bool(size_t done)>& go_on) {
  const Scenario& scenario = experiment.scenario;
  const ChannelConfig& config = scenario.channels[channel];
  if (experiment.plan.dispersion.on)
    throw_user_error("effects.dispersion: expected off for a fit, which has the materials at the carrier");
  std::vector<FitLink> links;
  std::map<uint32_t, std::vector<uint32_t>> of_transmitter;
  for (uint32_t s = 0; s < problem.sets.size(); ++s) of_transmitter[problem.sets[s].transmitter].push_back(s);
  bool stopped = false;
  for (const auto& [transmitter, sets] : of_transmitter) {
    ChannelSnapshot snapshot(device, experiment, channel, {0, 0, transmitter});
    const rf::FieldModel fields = snapshot.model().field_model();
    const rf::AntennaArray sender =
        antenna_array(scenario, config.transmitters[transmitter], config.carrier_hz);
    for (const uint32_t s : sets) {
      const FitSet& set = problem.sets[s];
      const FitReceiver receiver = receiver_of(set, snapshot);
      const auto take = [&](ChannelSnapshot::Link solved) {
        const auto position = static_cast<uint32_t>(solved.receiver);
        FitLink link;
        link.set = s;
        link.position = position;
        link.place = set.points[position];
        solved.receiver_state.orientation =
            set.orientations.empty() ? receiver.orientation : set.orientations[position] * receiver.mount;
        LinkEnds ends = link_ends(scenario, config, sender, solved.transmitter_state, receiver.array,
                                  solved.receiver_state, 0.0);
        link.transmitter = std::move(ends.transmitter);
        link.receiver = std::move(ends.receiver);
        link.transmitter.beam_squint = link.receiver.beam_squint = false;
        link.paths = std::move(solved.paths);
        link.world = std::move(solved.world);
        link.radio = snapshot.radio();
        link.fields = fields;
        link.fields.world = link.world.get();
        find_touched(link, materials);
        links.push_back(std::move(link));
        stopped = !go_on(links.size());
        return !stopped;
      };
      snapshot.solve(set.points, 0, take);
      if (stopped) return std::nullopt;
    }
  }
  std::ranges::stable_sort(links, {}, &FitLink::set);
  return links;
}

}  // namespace greatx::sim
