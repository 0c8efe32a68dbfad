// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Decides which radio effects a scenario calls for, each with a bound on the change that it causes.
#include "sim/plan/radio_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/units.h"
#include "rf/atmosphere/bounds.h"
#include "rf/atmosphere/fog.h"
#include "rf/atmosphere/gas.h"
#include "rf/atmosphere/rain.h"
#include "rf/field/finite_reflectors.h"
#include "rf/paths/radio_model.h"
#include "rf/surface/roughness.h"
#include "scene/material/lossless.h"
#include "sim/plan/antennas.h"
#include "sim/plan/array_plan.h"
#include "sim/plan/effect_planner.h"
#include "sim/plan/trajectory_bounds.h"

namespace greatx::sim {

namespace {

/// Summarizes the requests of all channels, with the extremes of their numbers.
struct RadioAsks {
  size_t channels = 0;
  uint32_t max_depth = 0, walls = 0, time_samples = 1;
  bool every_tick = false, beams = false, rays = false;
  size_t targets = 0;  ///< of all channels
  size_t sensing = 0;  ///< channels that sense
  bool sensing_noise = false, sensing_adc = false, leakage = false;
  uint32_t segments = 1;            ///< the most segments of a path, echoes of targets included
  std::vector<double> carriers_hz;  ///< [channels]
  double longest_record_s = 0.0, highest_hz = 0.0, lowest_hz = std::numeric_limits<double>::infinity();
};

/// Summarizes the properties of surfaces that matter to radio.
struct RadioSurfacesSeen {
  bool triangles = false, moving = false, foliage = false, scattering = false, edges = false;
  size_t walls = 0;            ///< materials that let waves pass (rf::dark_wall_db)
  double least_loss_db = 0.0;  ///< the least loss of these, at normal incidence and the lowest carrier
  std::string clearest;        ///< the material with the least loss
  double roughness_m = 0.0;
};

RadioAsks radio_asks_of(const Scenario& scenario) {
  RadioAsks asks;
  for (const ChannelConfig& channel : scenario.channels) {
    ++asks.channels;
    asks.max_depth = std::max(asks.max_depth, channel.limits.max_depth);
    asks.targets += channel.targets.size();
    if (channel.sensing) {
      ++asks.sensing;
      asks.sensing_noise |= channel.sensing->noise_figure_db.has_value();
      asks.sensing_adc |= channel.sensing->adc.has_value();
      asks.leakage |= channel.sensing->leakage_db.has_value();
    }
    asks.segments = std::max(asks.segments, channel.limits.max_depth + 1);
    if (!channel.targets.empty()) {
      asks.segments = std::max(asks.segments, 2 * (channel.legs.max_depth + 1));
      asks.max_depth = std::max(asks.max_depth, channel.legs.max_depth);
      asks.walls = std::max(asks.walls, std::min(channel.legs.max_transmissions, channel.legs.max_depth));
    }
    asks.walls = std::max(asks.walls, channel.walls());
    asks.time_samples = std::max(asks.time_samples, channel.time_samples);
    asks.longest_record_s =
        std::max(asks.longest_record_s, (channel.time_samples - 1) * channel.time_spacing_s);
    asks.carriers_hz.push_back(channel.carrier_hz);
    asks.highest_hz = std::max(asks.highest_hz, channel.carrier_hz);
    asks.lowest_hz = std::min(asks.lowest_hz, channel.carrier_hz);
    asks.every_tick |= channel.search == ChannelConfig::Search::every_tick;
    (channel.candidates == ChannelConfig::Candidates::rays ? asks.rays : asks.beams) = true;
  }
  return asks;
}

RadioSurfacesSeen radio_surfaces_of(const scene::Scene& scene, const RadioAsks& asks) {
  RadioSurfacesSeen surfaces;
  std::vector<bool> seen(scene.materials.size(), false);
  for (const scene::Facet& facet : scene.facets) {
    surfaces.triangles = true;
    surfaces.moving |= facet.body != 0;
    const scene::Material& material = scene.materials[facet.material];
    if (asks.channels == 0 || seen[facet.material] || !material.radio) continue;
    seen[facet.material] = true;
    if (material.radio->foliage) {
      surfaces.foliage |= !scene::is_lossless(material);
      continue;
    }
    surfaces.edges = true;
    surfaces.scattering |= material.radio->scattering_coefficient > 0.0;
    surfaces.roughness_m = std::max(surfaces.roughness_m, material.radio->roughness_m);
    if (!rf::penetrable(*material.radio)) continue;
    const double loss = rf::wall_loss_db(material, asks.lowest_hz);
    if (loss >= rf::dark_wall_db) continue;
    if (surfaces.walls++ == 0 || loss < surfaces.least_loss_db) {
      surfaces.least_loss_db = loss;
      surfaces.clearest = material.name;
    }
  }
  return surfaces;
}

scene::Bounds widened(const scene::Bounds& bounds, double by_m) {
  return bounds.empty() ? bounds : scene::Bounds{bounds.min - by_m, bounds.max + by_m};
}

/// Adds a box that the elements of a channel's arrays never leave. The mounts, and the positions of the
/// elements in the array, turn with the node.
void add_elements(const Scenario& scenario, const ChannelConfig& channel, scene::Bounds& bounds) {
  for (const auto* names : {&channel.transmitters, &channel.receivers})
    for (const std::string& name : *names) {
      const auto [node, sensor] = sensor_place(scenario, name);
      const rf::AntennaArray array = antenna_array(scenario, name, channel.carrier_hz);
      double reach_m = 0.0;
      for (uint32_t element = 0; element < array.element_count(); ++element)
        reach_m =
            std::max(reach_m, glm::length(array.element_position(element * array.polarization_count())));
      reach_m += glm::length(scenario.nodes[node].sensors[sensor].mount.position_m);
      scene::Bounds course;
      add_trajectory(scenario, scenario.nodes[node].trajectory, course);
      bounds.add(widened(course, reach_m));
    }
}

/// Returns the largest distance by which a moving mesh extends beyond the course of its node, in any
/// attitude.
double largest_body_m(const scene::Scene& scene) {
  double largest = 0.0;
  for (uint32_t body = 1; body < scene.bodies.size(); ++body) {
    if (scene.bodies[body].joint) continue;  // included in the reach of its owner
    const scene::Bounds& reach = scene.reach_of(body);
    if (!reach.empty())
      largest = std::max(largest, glm::length(glm::max(glm::abs(reach.min), glm::abs(reach.max))));
  }
  return largest;
}

/// Returns an upper bound of the length of a path. Each segment of a path lies in the box around the scene,
/// the trajectories, all antenna elements, the moving reflectors, and the points given from outside.
double longest_path_m(const Scenario& scenario, const scene::Scene& scene, uint32_t segments,
                      bool moving_reflectors, const scene::Bounds& points) {
  scene::Bounds courses;
  for (const NodeConfig& node : scenario.nodes) add_trajectory(scenario, node.trajectory, courses);
  scene::Bounds bounds = moving_reflectors ? widened(courses, largest_body_m(scene)) : courses;
  if (!scene.bounds.empty()) {
    bounds.add(scene.bounds.min + scene.origin);
    bounds.add(scene.bounds.max + scene.origin);
  }
  for (const ChannelConfig& channel : scenario.channels) add_elements(scenario, channel, bounds);
  bounds.add(points);
  return segments * glm::length(bounds.size());
}

/// Holds the inputs that all functions below need.
struct Radio {
  const Planner& planner;
  const RadioAsks& asks;
  const RadioSurfacesSeen& surfaces;
  bool on() const { return asks.channels > 0; }
  /// Returns `reason`, or "no channel" if there is none.
  std::string why(const std::string& reason) const { return on() ? reason : "no channel"; }
};

void plan_reflection(EffectPlan& plan, const Radio& radio) {
  const RadioAsks& asks = radio.asks;
  radio.planner.decide(plan.channel, radio.on(), radio.why(fmt::format("{} of them", asks.channels)));
  radio.planner.decide(plan.line_of_sight, radio.on(), radio.why("transmitters and receivers"));
  const bool reflect = radio.on() && asks.max_depth > 0 && radio.surfaces.triangles;
  radio.planner.decide(
      plan.reflection, reflect,
      radio.why(asks.max_depth == 0         ? "max_depth is 0"
                : !radio.surfaces.triangles ? "the scene has no surface"
                                            : fmt::format("surfaces, up to {} reflections", asks.max_depth)),
      !reflect    ? ""
      : asks.rays ? "candidates from rays: what is narrower than their spacing may be missed"
                  : "candidates from beams: none is missed");
  radio.planner.decide(
      plan.moving_reflectors, plan.reflection.on && radio.surfaces.moving && asks.every_tick,
      radio.why(!plan.reflection.on      ? "no reflection"
                : !radio.surfaces.moving ? "no mesh moves"
                : asks.every_tick        ? "candidates are searched at every tick"
                                  : "candidates of the static world are searched once; moving meshes block "
                                    "paths but do not reflect "
                                    "them (effects: {moving_reflectors: on} to have that)"));
}

void plan_transmission(EffectPlan& plan, const Radio& radio) {
  const RadioSurfacesSeen& surfaces = radio.surfaces;
  const bool walls = radio.on() && radio.asks.walls > 0 && surfaces.walls > 0;
  radio.planner.decide(
      plan.transmission, walls,
      radio.why(
          radio.asks.walls == 0 ? "max_transmissions or max_depth is 0"
          : surfaces.walls == 0
              ? fmt::format("no material lets waves pass: all are half-spaces (no thickness given) without "
                            "windows, or take {:.0f} dB or more",
                            rf::dark_wall_db)
              : fmt::format("{} materials let waves pass, up to {} walls", surfaces.walls, radio.asks.walls)),
      walls ? fmt::format(
                  "the clearest, {}, takes {:.2f} dB at normal incidence and {:.4g} GHz; dark from {:.0f} dB",
                  surfaces.clearest, surfaces.least_loss_db, radio.asks.lowest_hz * 1e-9, rf::dark_wall_db)
            : "");
}

/// Switches off an effect that is asked for but has nothing to act on.
void deny(Effect& effect) {
  effect.on = false;
  effect.reason = "asked for, but nothing to act on" + effect.reason.substr(effect.reason.find(" ("));
}

/// Decides the effects that cost a search or thousands of paths. They are on only if a scenario asks for them
/// by name.
void plan_on_request(EffectPlan& plan, const Radio& radio) {
  const bool deep = radio.on() && radio.asks.max_depth > 0;
  const bool edges = deep && radio.surfaces.edges;
  radio.planner.decide(
      plan.diffraction, false,
      radio.why(edges ? "not asked for (effects: {diffraction: on}; accuracy: decides by measurement)"
                      : (deep ? "the scene has no edge" : "max_depth is 0")),
      edges ? "in shadow nothing else may be left; beside a lit path at most 6 dB, at its shadow boundary"
            : "");
  if (plan.diffraction.on && !edges) deny(plan.diffraction);
  radio.planner.decide(
      plan.diffraction_lit_region, plan.diffraction.on,
      plan.diffraction.on ? "keeps the field continuous where a path begins or ends" : "diffraction is off");
  radio.planner.decide(
      plan.corner_diffraction, plan.diffraction.on,
      plan.diffraction.on ? "keeps the field continuous where Keller's point runs off an edge"
                          : "diffraction is off",
      plan.diffraction.on ? "without it, a diffracted field steps by 6 dB and more at the end of its edge"
                          : "");
  radio.planner.decide(plan.free_edges, false, "edges of one facet alone bound drawings, seldom plates");
  const bool rough = deep && radio.surfaces.scattering;
  radio.planner.decide(
      plan.scattering, false,
      radio.why(rough ? "not asked for (effects: {scattering: on}; accuracy: decides by measurement)"
                      : "no material has a scattering coefficient"));
  if (plan.scattering.on && !rough) deny(plan.scattering);
  radio.planner.decide(
      plan.dispersion, false,
      radio.why(
          "not asked for (effects: {dispersion: on}; accuracy: decides by measurement): materials as at the "
          "carrier"));
}

/// Describes the largest attenuation by the air on any path of any channel.
struct Most {
  double db = 0.0, carrier_hz = 0.0;  ///< the attenuation, and the carrier where it is largest
  double outside_hz = 0.0;            ///< a carrier outside the recommendation; 0: none
};
using AirBound = double (*)(const rf::Weather&, double frequency_hz, double distance_m);

Most most_of(const RadioAsks& asks, const rf::Weather& weather, double distance_m, bool (*covers)(double),
             AirBound bound) {
  Most most;
  for (const double carrier : asks.carriers_hz) {
    if (!covers(carrier)) {
      most.outside_hz = carrier;
      continue;
    }
    // Gases have absorption lines, so the highest carrier need not have the largest attenuation.
    const double db = bound(weather, carrier, distance_m);
    if (most.carrier_hz == 0.0 || db > most.db) most.db = db, most.carrier_hz = carrier;
  }
  return most;
}

/// Decides one of gas, rain and fog. Outside the frequency range of its recommendation an effect has no
/// bound. It then stays off, and its reason says so.
void plan_air(Effect& effect, const Radio& radio, const Most& most, double longest_m, double tolerance,
              const std::string& none, const char* source) {
  const bool needed = radio.on() && most.db > tolerance;
  const bool no_bound = !radio.on() || most.db == 0.0;
  const std::string but = most.outside_hz > 0.0 ? fmt::format("; not at {:.4g} GHz, which {} does not cover",
                                                              most.outside_hz * 1e-9, source)
                                                : std::string();
  radio.planner.decide(
      effect, needed,
      radio.why(needed ? "more than the tolerance" + but
                : most.outside_hz > 0.0
                    ? fmt::format("{} does not cover {:.4g} GHz", source, most.outside_hz * 1e-9)
                : most.db == 0.0 ? none
                                 : "within the tolerance"),
      no_bound ? ""
               : fmt::format("at most {:.3g} dB over {:.0f} m at {:.4g} GHz, tolerance {:.3g} dB", most.db,
                             longest_m, most.carrier_hz * 1e-9, tolerance));
  if (effect.on && most.outside_hz > 0.0 && most.carrier_hz == 0.0)
    throw_user_error("effects: {}: expected auto or off, since {} does not cover {:.4g} GHz; found on",
                     effect.name, source, most.outside_hz * 1e-9);
}

/// Decides the effects that are on if their bound exceeds the tolerance.
void plan_attenuation(EffectPlan& plan, const Radio& radio, const Scenario& scenario, double longest_m) {
  const double tolerance = scenario.tolerance_db;
  const rf::Weather weather = weather_of(scenario.environment);
  const RadioAsks& asks = radio.asks;
  const Most gas = most_of(asks, weather, longest_m, rf::gas_model_covers, rf::most_gas_db);
  plan_air(plan.gas, radio, gas, longest_m, tolerance, "no air", "P.676-13");
  Most rain, fog;
  if (weather.rain_mm_h > 0.0)
    rain = most_of(asks, weather, longest_m, rf::rain_model_covers, rf::most_rain_db);
  plan_air(plan.rain, radio, rain, longest_m, tolerance, "no rain", "P.838-3");
  if (weather.fog_g_m3 > 0.0) fog = most_of(asks, weather, longest_m, rf::fog_model_covers, rf::most_fog_db);
  plan_air(plan.fog, radio, fog, longest_m, tolerance, "no fog", "P.840");
  const bool leaves = radio.on() && radio.surfaces.foliage;
  radio.planner.decide(plan.foliage, leaves,
                       radio.why(leaves ? "crowns take from what passes them" : "the scene has none"));
  const double rough_db =
      asks.max_depth *
      rf::most_roughness_db(radio.surfaces.roughness_m, speed_of_light / std::max(asks.highest_hz, 1.0));
  const bool rough = plan.reflection.on && rough_db > tolerance;
  radio.planner.decide(plan.roughness, rough,
                       radio.why(radio.surfaces.roughness_m == 0.0 ? "no material has one"
                                 : rough                           ? "more than the tolerance"
                                                                   : "within the tolerance"),
                       radio.surfaces.roughness_m == 0.0 || !radio.on()
                           ? ""
                           : fmt::format("at most {:.3g} dB over {} reflections, tolerance {:.3g} dB",
                                         rough_db, asks.max_depth, tolerance));
}

/// Decides the weights of reflections, for the lowest carrier and the longest path, where Fresnel zones are
/// largest.
void plan_finite_reflectors(EffectPlan& plan, const Radio& radio, const Scenario& scenario,
                            const scene::Scene& scene, double longest_m) {
  rf::FiniteReflectorBound bound;
  const double lowest_hz = radio.asks.lowest_hz;
  const auto wish = scenario.effects.find(plan.finite_reflectors.name);
  const bool switched = wish != scenario.effects.end() && wish->second != Switch::automatic;
  if (plan.reflection.on)
    bound = rf::finite_reflector_bound(scene, speed_of_light / lowest_hz, longest_m, !switched);
  // On an edge a weight is 1/2.
  const double most_db = bound.edges ? std::max(bound.most_db, 20.0 * std::log10(2.0)) : 0.0;
  const bool needed = most_db > scenario.tolerance_db;
  radio.planner.decide(
      plan.finite_reflectors, needed,
      radio.why(!plan.reflection.on ? "no reflection"
                : !bound.edges      ? "no reflecting surface ends or bends outwards"
                : needed            ? "more than the tolerance"
                                    : "within the tolerance"),
      !bound.edges
          ? ""
          : fmt::format("at most {:.3g} dB, in the middle of a facet of {:.2g} m^2 of '{}', {:.0f} m "
                        "and {:.4g} GHz; 6.02 dB on an edge; {} of {} facets are smaller than a "
                        "Fresnel zone can be; tolerance {:.3g} dB",
                        most_db, bound.area_m2,
                        scene.instances.empty() ? scene.name
                                                : scene.instances[scene.facets[bound.facet].instance].name,
                        longest_m, lowest_hz * 1e-9, bound.below_a_zone, bound.facets,
                        scenario.tolerance_db));
}

/// Decides the Doppler effect. Speeds are not known before the run, so the bound is given per m/s.
void plan_doppler(EffectPlan& plan, const Radio& radio) {
  const bool doppler = radio.on() && radio.asks.time_samples > 1;
  radio.planner.decide(
      plan.doppler, doppler,
      radio.why(doppler ? fmt::format("{} time samples a record", radio.asks.time_samples)
                        : "one time sample a record: shifts are reported with the paths, phases do not turn"),
      doppler ? fmt::format("{:.3g} turns per m/s within a record",
                            radio.asks.longest_record_s * radio.asks.highest_hz / speed_of_light)
              : "");
}

/// Decides the echoes of targets. They have no bound that is known before the run.
void plan_targets(EffectPlan& plan, const Radio& radio) {
  const size_t targets = radio.asks.targets;
  radio.planner.decide(
      plan.target_echoes, targets > 0,
      radio.why(targets > 0 ? fmt::format("{} target{} of channels", targets, targets == 1 ? "" : "s")
                            : "no channel has targets"),
      targets > 0 ? "paths that a target's surfaces reflect are left to its echoes" : "");
  if (targets == 0) plan.target_echoes.on = false;
}

void plan_sensing(EffectPlan& plan, const Radio& radio) {
  const RadioAsks& asks = radio.asks;
  const bool senses = asks.sensing > 0;
  radio.planner.decide(
      plan.sensing, senses,
      radio.why(senses ? fmt::format("{} channel{}", asks.sensing, asks.sensing == 1 ? "" : "s")
                       : "no channel senses"));
  const auto decide = [&](Effect& effect, bool needed, const char* yes, const char* no) {
    radio.planner.decide(effect, needed, radio.why(!senses ? "no channel senses" : needed ? yes : no));
    if (!needed) effect.on = false;
  };
  decide(plan.sensing_noise, asks.sensing_noise, "a receiver has a noise figure", "no receiver has one");
  decide(plan.sensing_quantisation, asks.sensing_adc, "a converter has steps", "no converter is described");
  decide(plan.sensing_leakage, asks.leakage, "a channel has a level of leakage", "no channel has one");
}

/// Throws UserError if a channel cannot find what its effects ask for.
void check_candidates(const EffectPlan& plan, const Scenario& scenario) {
  for (const ChannelConfig& channel : scenario.channels)
    if (plan.diffraction.on && channel.candidates == ChannelConfig::Candidates::rays)
      throw_user_error_at(
          channel.where,
          "channel '{}': candidates: expected beams, since diffraction is on and rays meet no "
          "edges; found rays",
          channel.name);
}

}  // namespace

rf::Weather weather_of(const Environment& environment) {
  rf::Weather weather;
  weather.temperature_k = environment.temperature_k;
  weather.dry_pressure_hpa = environment.pressure_hpa;
  weather.water_vapour_g_m3 = environment.water_vapour_g_m3;
  weather.rain_mm_h = environment.rain_mm_h;
  weather.fog_g_m3 = environment.fog_g_m3;
  return weather;
}

void plan_radio(EffectPlan& plan, const Planner& planner, const Scenario& scenario, const scene::Scene& scene,
                const scene::Bounds& points) {
  const RadioAsks asks = radio_asks_of(scenario);
  const RadioSurfacesSeen surfaces = radio_surfaces_of(scene, asks);
  const Radio radio{planner, asks, surfaces};
  plan_reflection(plan, radio);
  plan_transmission(plan, radio);
  plan_on_request(plan, radio);
  check_candidates(plan, scenario);
  const double longest_m = longest_path_m(scenario, scene, asks.segments, plan.moving_reflectors.on, points);
  plan_attenuation(plan, radio, scenario, longest_m);
  plan_finite_reflectors(plan, radio, scenario, scene, longest_m);
  plan_doppler(plan, radio);
  plan_targets(plan, radio);
  plan_sensing(plan, radio);
  plan_arrays(plan, planner, scenario);
}

}  // namespace greatx::sim
