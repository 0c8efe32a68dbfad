// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/plan/radar_plan.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "rf/atmosphere/fog.h"
#include "rf/atmosphere/gas.h"
#include "rf/atmosphere/path_attenuation.h"
#include "rf/atmosphere/rain_backscatter.h"
#include "rf/paths/radio_model.h"
#include "rf/surface/roughness.h"
#include "scene/material/lossless.h"
#include "sim/plan/radio_plan.h"

namespace greatx::sim {

namespace {

/// Summarizes the requests of all radars of the scenario.
struct RadarAsks {
  size_t radars = 0;
  double shortest_wavelength_m = 1e9;
  size_t disturbed = 0;  ///< radars that others disturb
  size_t rained_on = 0;  ///< monostatic radars in rain whose model covers their carrier
  bool noise = false, phase_noise = false, adc = false, leakage = false;
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
      asks.leakage |= receiver.leakage.has_value();
      asks.disturbed += radar->interferers.empty() ? 0 : 1;
      asks.rained_on += scenario.environment.rain_mm_h > 0.0 && !radar->signal.bistatic &&
                                rf::rain_backscatter_covers(waveform.carrier_hz)
                            ? 1
                            : 0;
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
  std::string veil;     ///< foliage, or a material that waves can pass; empty: none
};

RadarOffers radar_offers(const scene::Scene& scene) {
  RadarOffers offers;
  for (const scene::Primitive& primitive : scene.primitives) {
    const scene::Material& material = scene.materials[primitive.material];
    if (!material.radio || scene::is_lossless(material)) continue;
    offers.scattering |= material.radio->scattering_coefficient > 0.0;
    if (offers.clutter.empty() && material.radio->clutter) offers.clutter = material.name;
    if (offers.veil.empty() && (material.radio->foliage || rf::penetrable(*material.radio)))
      offers.veil = material.name;
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

rf::RainEchoes radar_rain(const Environment& environment, double carrier_hz) {
  if (!(environment.rain_mm_h > 0.0) || !rf::rain_backscatter_covers(carrier_hz)) return {};
  const rf::RainBackscatter rain =
      rf::rain_backscatter(carrier_hz, weather_of(environment).temperature_k, environment.rain_mm_h);
  // Small cells near the ground: an assumption (docs/radar_rain.md).
  constexpr double turbulence_m_s = 0.5;
  return {rain.reflectivity_per_m, rain.fall_m_s, rain.fall_spread_m_s, turbulence_m_s};
}

namespace {

/// Describes the reflectivity of the rain at the first monostatic radar that has it.
std::string rain_bound(const Scenario& scenario) {
  for (const NodeConfig& node : scenario.nodes)
    for (const SensorConfig& sensor : node.sensors)
      if (const auto* radar = std::get_if<RadarConfig>(&sensor.config); radar && !radar->signal.bistatic)
        if (const double eta =
                radar_rain(scenario.environment, radar->signal.waveform.carrier_hz).reflectivity_per_m;
            eta > 0.0)
          return fmt::format("{:.3g} dBsm/m^3 at {:g} GHz", 10.0 * std::log10(eta),
                             1e-9 * radar->signal.waveform.carrier_hz);
  return "";
}

}  // namespace

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
  decide(plan.radar_transmission, !offers.veil.empty(),
         fmt::format("waves pass through materials: {} is one", offers.veil),
         "waves pass through no material");
  decide(plan.radar_edges, true, "edges send back more than physical optics has", "");
  decide(plan.radar_noise, asks.noise, "a receiver has a noise figure", "no receiver has one");
  decide(plan.radar_phase_noise, asks.phase_noise, "an oscillator has phase noise", "no oscillator has any");
  decide(plan.radar_quantisation, asks.adc, "a converter has steps", "no converter is described");
  decide(plan.radar_leakage, asks.leakage, "a receiver has a level of leakage", "no receiver has one");
  decide(plan.radar_interference, asks.disturbed > 0,
         fmt::format("{} of the radars asks for the ramps of others", asks.disturbed),
         "no radar asks for those of others");
  decide(plan.radar_rain, asks.rained_on > 0, "it rains on a monostatic radar",
         scenario.environment.rain_mm_h > 0.0 ? "no monostatic radar has a carrier from 1 to 300 GHz"
                                              : "it does not rain",
         asks.rained_on > 0 ? rain_bound(scenario) : "");
}

}  // namespace greatx::sim
