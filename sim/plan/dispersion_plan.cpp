// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/plan/dispersion_plan.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/units.h"
#include "rf/atmosphere/bounds.h"
#include "rf/atmosphere/fog.h"
#include "rf/atmosphere/gas.h"
#include "rf/atmosphere/rain.h"
#include "rf/paths/radio_model.h"
#include "rf/surface/band_change.h"
#include "sim/plan/radio_plan.h"

namespace greatx::sim {

namespace {

double gained_db(double change) { return 20.0 * std::log10(1.0 + change); }

/// Holds the parts of a channel's bound, dB.
struct ChannelChange {
  const ChannelConfig* channel = nullptr;
  double surfaces_db = 0.0, air_db = 0.0;
  std::string material;  ///< the one that changes most

  double db() const { return surfaces_db + air_db; }
  /// Returns the largest change of the phase of a field that nothing weakens, degrees.
  double degrees() const { return std::asin(std::min(1.0, std::pow(10.0, db() / 20.0) - 1.0)) * 180.0 / pi; }
};

class BandBounds {
 public:
  BandBounds(const EffectPlan& plan, const Scenario& scenario, const scene::Scene& scene, double longest_m)
      : plan_(plan), scenario_(scenario), scene_(scene), longest_m_(longest_m) {
    for (const scene::Facet& facet : scene.facets) {
      const scene::Material& material = scene.materials[facet.material];
      if (material.radio && !material.radio->foliage) materials_.insert(facet.material);
    }
    lowest_hz_ = scenario.channels[0].carrier_hz;
    for (const ChannelConfig& channel : scenario.channels)
      lowest_hz_ = std::min(lowest_hz_, channel.carrier_hz);
  }

  ChannelChange of(const ChannelConfig& channel) const {
    const Band band = band_of(channel);
    ChannelChange change{.channel = &channel};
    if (band.width_hz() == 0.0) return change;
    if (band.lowest_hz <= 0.0) throw_user_error("a subcarrier is at {} Hz", band.lowest_hz);
    for (const uint32_t material : materials_) {
      const double db = surface_db(channel, band, scene_.materials[material]);
      if (db > change.surfaces_db) change.surfaces_db = db, change.material = scene_.materials[material].name;
    }
    const rf::WeatherEffects air{plan_.gas.on && rf::gas_model_covers(band.carrier_hz),
                                 plan_.rain.on && rf::rain_model_covers(band.carrier_hz),
                                 plan_.fog.on && rf::fog_model_covers(band.carrier_hz)};
    change.air_db = rf::most_air_change_db(weather_of(scenario_.environment), air, band, longest_m_);
    return change;
  }

 private:
  /// Returns the bound of a channel whose every interaction is with this material.
  double surface_db(const ChannelConfig& channel, const Band& band, const scene::Material& material) const {
    const bool reflects = plan_.reflection.on || plan_.scattering.on;
    const bool wall = plan_.transmission.on && rf::penetrable(*material.radio) &&
                      rf::wall_loss_db(material, lowest_hz_) < rf::dark_wall_db;
    const uint32_t depth = channel.limits.max_depth, walls = wall ? channel.walls() : 0;
    if (depth == 0 || !(reflects || walls > 0)) return 0.0;
    const rf::FieldEffects defaults;
    const rf::BandChange change = rf::most_band_change(
        *material.radio, band, plan_.roughness.on ? std::optional(defaults.roughness_model) : std::nullopt,
        plan_.scattering.on, material.name);
    const double reflected_db = reflects ? gained_db(change.reflection) : 0.0;
    const double through_db = gained_db(change.transmission);
    // Walls take the places of reflections where they change more.
    const uint32_t passed = !reflects || through_db > reflected_db ? walls : 0;
    return passed * through_db + (depth - passed) * reflected_db;
  }

  const EffectPlan& plan_;
  const Scenario& scenario_;
  const scene::Scene& scene_;
  double longest_m_;
  std::set<uint32_t> materials_;
  double lowest_hz_ = 0.0;
};

std::string dispersion_bound(const ChannelChange& change, double longest_m, double tolerance_db) {
  const Band band = band_of(*change.channel);
  const std::string surfaces =
      change.surfaces_db > 0.0 ? fmt::format("{:.3g} dB by {} interactions with '{}', ", change.surfaces_db,
                                             change.channel->limits.max_depth, change.material)
                               : "";
  return fmt::format(
      "at most {:.3g} dB and {:.3g} degrees of a path over {:.4g} MHz at {:.4g} GHz: {}{:.3g} dB by {:.0f} m "
      "of air; tolerance {:.3g} dB",
      change.db(), change.degrees(), band.width_hz() * 1e-6, band.carrier_hz * 1e-9, surfaces, change.air_db,
      longest_m, tolerance_db);
}

}  // namespace

Band band_of(const ChannelConfig& channel) {
  const double below = channel.subcarriers / 2, above = channel.subcarriers - 1 - channel.subcarriers / 2;
  return {channel.carrier_hz, channel.carrier_hz - below * channel.subcarrier_spacing_hz,
          channel.carrier_hz + above * channel.subcarrier_spacing_hz};
}

void plan_dispersion(EffectPlan& plan, const Planner& planner, const Scenario& scenario,
                     const scene::Scene& scene, double longest_m) {
  if (scenario.channels.empty()) return planner.decide(plan.dispersion, false, "no channel");
  ChannelChange most;
  try {
    const BandBounds bounds(plan, scenario, scene, longest_m);
    for (const ChannelConfig& channel : scenario.channels) {
      ChannelChange change = bounds.of(channel);
      if (most.channel == nullptr || change.db() > most.db()) most = std::move(change);
    }
  } catch (const UserError& error) {
    return planner.decide(plan.dispersion, false,
                          fmt::format("the models do not cover all of the band: {}", error.what()));
  }
  // A field for every subcarrier makes the channel's tick several times as long, so it has to be asked for.
  planner.decide(plan.dispersion, false,
                 most.db() == 0.0 ? "nothing changes over the band"
                 : most.db() > scenario.tolerance_db
                     ? "not asked for (effects: {dispersion: on}): more than the tolerance"
                     : "within the tolerance: materials and air as at the carrier",
                 most.db() == 0.0 ? "" : dispersion_bound(most, longest_m, scenario.tolerance_db));
}

}  // namespace greatx::sim
