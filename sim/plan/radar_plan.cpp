// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/plan/radar_plan.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "rf/atmosphere/fog.h"
#include "rf/atmosphere/gas.h"
#include "rf/atmosphere/path_attenuation.h"
#include "rf/surface/roughness.h"
#include "sim/plan/radio_plan.h"

namespace greatx::sim {

namespace {

/// Summarizes the requests of all radars of the scenario.
struct RadarAsks {
  size_t radars = 0;
  double shortest_wavelength_m = 1e9;
  bool noise = false, phase_noise = false, adc = false;
  double most_air_db = 0.0;  ///< out to the range span and back
};

RadarAsks radar_asks(const Scenario& scenario) {
  RadarAsks asks;
  for (const NodeConfig& node : scenario.nodes) {
    for (const SensorConfig& sensor : node.sensors) {
      const auto* radar = std::get_if<RadarConfig>(&sensor.config);
      if (radar == nullptr) continue;
      ++asks.radars;
      const rf::RadarWaveform& waveform = radar->signal.waveform;
      asks.most_air_db =
          std::max(asks.most_air_db, radar_air_db_per_km(scenario.environment, waveform.carrier_hz) * 2e-3 *
                                         waveform.range_span_m());
      asks.shortest_wavelength_m =
          std::min(asks.shortest_wavelength_m, radar->signal.waveform.wavelength_m());
      const rf::RadarReceiver& receiver = radar->signal.receiver;
      asks.noise |= receiver.noise_figure_db.has_value();
      asks.phase_noise |= receiver.phase_noise.has_value();
      asks.adc |= receiver.adc.has_value();
    }
  }
  return asks;
}

/// Summarizes the properties of surfaces that matter to radars.
struct RadarOffers {
  double roughness_m = 0.0;  ///< the largest of all materials
  std::string roughest;
  bool scattering = false;
  std::string clutter;  ///< a material with a model of its clutter; empty: none
};

RadarOffers radar_offers(const scene::Scene& scene) {
  RadarOffers offers;
  for (const scene::Primitive& primitive : scene.primitives) {
    const scene::Material& material = scene.materials[primitive.material];
    if (!material.radio) continue;
    offers.scattering |= material.radio->scattering_coefficient > 0.0;
    if (offers.clutter.empty() && material.radio->clutter) offers.clutter = material.name;
    if (material.radio->roughness_m <= offers.roughness_m) continue;
    offers.roughness_m = material.radio->roughness_m;
    offers.roughest = material.name;
  }
  return offers;
}

}  // namespace

double radar_air_db_per_km(const Environment& environment, double carrier_hz) {
  const rf::PathAttenuation air =
      rf::path_attenuation(weather_of(environment), carrier_hz,
                           {rf::gas_model_covers(carrier_hz), rf::rain_model_covers(carrier_hz),
                            rf::fog_model_covers(carrier_hz)});
  return air.isotropic() + 0.5 * (air.rain_h + air.rain_v);
}

void plan_radar(EffectPlan& plan, const Planner& planner, const Scenario& scenario,
                const scene::Scene& scene) {
  const RadarAsks asks = radar_asks(scenario);
  const RadarOffers offers = radar_offers(scene);
  const bool radar = asks.radars > 0;
  const auto decide = [&](Effect& effect, bool needed, const std::string& yes, const std::string& no,
                          const std::string& bound = "") {
    planner.decide(effect, radar && needed, !radar ? "no radar" : needed ? yes : no, bound);
  };
  planner.decide(plan.radar, radar, radar ? fmt::format("{} of them", asks.radars) : "no radar");
  // Ament's factor for both fields at normal incidence is the upper bound.
  const double most_db =
      offers.roughness_m > 0.0 ? rf::most_roughness_db(offers.roughness_m, asks.shortest_wavelength_m) : 0.0;
  decide(plan.radar_roughness, most_db > scenario.tolerance_db,
         fmt::format("surfaces are rough: {} has {:g} mm rms", offers.roughest, 1e3 * offers.roughness_m),
         offers.roughness_m > 0.0 ? "rough surfaces are smooth at these wavelengths" : "no material is rough",
         radar && offers.roughness_m > 0.0 ? fmt::format("at most {:.3g} dB an echo", most_db) : "");
  decide(plan.radar_clutter, !offers.clutter.empty(),
         fmt::format("surfaces have models of their clutter: {} is one", offers.clutter),
         offers.scattering
             ? "no material has a model of its clutter (effects: {radar_clutter: on} to have what "
               "scattering coefficients send back)"
             : "no material has a model of its clutter");
  const bool air = asks.most_air_db > scenario.tolerance_db;
  decide(plan.radar_air, air, "more than the tolerance", "within the tolerance",
         radar ? fmt::format("at most {:.3g} dB out to the range span and back", asks.most_air_db) : "");
  decide(plan.radar_noise, asks.noise, "a receiver has a noise figure", "no receiver has one");
  decide(plan.radar_phase_noise, asks.phase_noise, "an oscillator has phase noise", "no oscillator has any");
  decide(plan.radar_quantisation, asks.adc, "a converter has steps", "no converter is described");
}

}  // namespace greatx::sim
